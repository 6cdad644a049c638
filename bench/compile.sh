#!/usr/bin/env bash
# bench/compile.sh [COMPILER [OPTION...]]: what compiling costs, for a whole program and for each method on each scene type:
# seconds of processor time, peak memory, and kilobytes of machine code. Options are -std=c++20 -O3 and those of the g++ line
# in the README unless others are given.
#
# Exit status 1 when a pair of method and scene type has more code than its limit: unlike seconds, that does not depend on
# the machine.
set -eu
cd "$(dirname "${BASH_SOURCE[0]}")/.."
compiler=${1:-c++}
[ $# -le 1 ] || shift
[ $# -gt 0 ] && [ "$1" != "$compiler" ] && options=("$@") || options=(-O3 -DNDEBUG -DLIGHTSWITCH_HAS_EXR=1)
limit_kb=250
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# measure NAME FILE: sets kb; prints a line.
measure() {
  local seconds memory
  { /usr/bin/env bash -c 'TIMEFORMAT="%U"; time "$@"' _ "$compiler" -std=c++20 "${options[@]}" -Iinclude -c "$2" -o "$work/o"; } 2> "$work/time" ||
    { cat "$work/time" >&2; exit 2; }
  seconds=$(tail -n 1 "$work/time")
  memory=$(python3 - "$compiler" "$2" "$work/o" "${options[@]}" <<'PYTHON'
import resource, subprocess, sys
compiler, source, output, *options = sys.argv[1:]
subprocess.run([compiler, "-std=c++20", *options, "-Iinclude", "-fsyntax-only", source], check=True)
print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss // 1024)
PYTHON
  )
  kb=$(($(size "$work/o" | awk 'NR == 2 { print $1 }') / 1024))
  printf '%-34s %8s %10s %8s\n' "$1" "$seconds" "$memory" "$kb"
}

printf '%-34s %8s %10s %8s\n' '' 'CPU s' 'parse MB' 'code kB'
measure 'samples/01_minimal.cpp' samples/01_minimal.cpp
measure 'samples/02_switch.cpp (any x any)' samples/02_switch.cpp
over=0
for scene in DiffuseScene FullScene TexturedScene; do
  echo '#include <lightswitch/lightswitch.hpp>' > "$work/none.cpp"
  measure "$scene: headers alone" "$work/none.cpp"
  for method in Silhouette Phong PathTracer PathTracerNee LightTracer Bdpt PhotonMapping Vcm Mlt; do
    cat > "$work/pair.cpp" <<CPP
#include <lightswitch/lightswitch.hpp>
namespace ls = lightswitch;
ls::Image f(const ls::$scene& scene) { return ls::render(scene, ls::$method{}); }
CPP
    measure "  $method" "$work/pair.cpp"
    [ "$kb" -le "$limit_kb" ] || { echo "  above the limit of $limit_kb kB" && over=1; }
  done
done
exit $over
