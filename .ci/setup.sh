# shellcheck shell=bash
# Sourced by the scripts that build: from a fresh clone to built targets.
#
# Environment:
#   LIGHTSWITCH_BUILD_DIR  build directory (default: build/ in the checkout)
#   LIGHTSWITCH_JOBS       parallel compilations and tests (default: one per processor)

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=${LIGHTSWITCH_BUILD_DIR:-$root/build}
jobs=${LIGHTSWITCH_JOBS:-$(nproc 2> /dev/null || getconf _NPROCESSORS_ONLN)}

# A checkout elsewhere finds what this one has compiled.
export CCACHE_BASEDIR=${CCACHE_BASEDIR:-$root} CCACHE_NOHASHDIR=${CCACHE_NOHASHDIR:-1}
# Without these ccache compiles anew whatever is precompiled.
export CCACHE_SLOPPINESS=${CCACHE_SLOPPINESS:-pch_defines,time_macros}

# Versions of Clang that will do, the newest first; newest_clang prints the compiler of the first that is installed.
clang_versions=(22 21 20 19 18 17 16)
newest_clang() {
  local version
  for version in "${clang_versions[@]}"; do
    if command -v "clang++-$version" > /dev/null; then echo "clang++-$version"; return; fi
  done
}

# configure_project [CMAKE_OPTION...]: installs what is missing and configures. Options stay in
# the build directory until they are given another value.
configure_project() {
  bash "$root/.ci/install" || return 1
  local generator=()
  if [ ! -f "$build/CMakeCache.txt" ] && [ -z "${CMAKE_GENERATOR-}" ] && command -v ninja > /dev/null; then
    generator=(-G Ninja)
  fi
  cmake -S "$root" -B "$build" ${generator[@]+"${generator[@]}"} "$@"
}

# build_targets TARGET...: builds as much of the targets as can be built; fails when anything could not.
build_targets() {
  local keep_going=(-k)
  grep -q '^CMAKE_GENERATOR:INTERNAL=Ninja' "$build/CMakeCache.txt" && keep_going=(-k 0)
  cmake --build "$build" --parallel "$jobs" --target "$@" -- "${keep_going[@]}"
}
