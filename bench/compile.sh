#!/usr/bin/env bash
# bench/compile.sh [COMPILER [OPTION...]]: what compiling costs, for a whole program and for each method on each scene type:
# seconds of processor time, peak memory in MB, and kilobytes of machine code. The compiler is c++, and the options are those
# of the g++ line in the README, unless others are given.
#
# Exit status 1 when a pair of method and scene type has more code than the limit of its scene type, which is a little more
# than the largest had with GCC 12 when it was set: unlike seconds, that does not depend on the machine.
set -eu
cd "$(dirname "${BASH_SOURCE[0]}")/.."
compiler=${1:-c++}
options=("${@:2}")
[ ${#options[@]} -gt 0 ] || options=(-std=c++20 -O3 -DLIGHTSWITCH_HAS_EXR=1)
declare -A limit_kb=([DiffuseScene]=150 [FullScene]=300 [TexturedScene]=380)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# measure NAME FILE: prints a line, and sets kb.
measure() {
  local cost
  cost=$(python3 - "$compiler" "${options[@]}" -Iinclude -c "$2" -o "$work/o" <<'PYTHON'
import resource, subprocess, sys
subprocess.run(sys.argv[1:], check=True)
used = resource.getrusage(resource.RUSAGE_CHILDREN)
print(f"{used.ru_utime:8.1f} {used.ru_maxrss // 1024:8}")
PYTHON
  )
  kb=$(($(size "$work/o" | awk 'NR == 2 { print $1 }') / 1024))
  printf '%-34s %s %8s\n' "$1" "$cost" "$kb"
}

printf '%-34s %8s %8s %8s\n' '' 'seconds' 'MB' 'kB'
measure 'samples/01_minimal.cpp' samples/01_minimal.cpp
{ echo '#include <lightswitch/compiled.hpp>' && cat samples/01_minimal.cpp; } > "$work/compiled.cpp"
measure 'the same with compiled.hpp' "$work/compiled.cpp"
measure 'samples/02_switch.cpp' samples/02_switch.cpp
echo '#include <lightswitch/lightswitch.hpp>' > "$work/headers.cpp"
measure 'lightswitch.hpp alone' "$work/headers.cpp"
echo '#include <tbb/parallel_for.h>' > "$work/headers.cpp"
measure "of which oneTBB's parallel_for.h" "$work/headers.cpp"
over=0
for scene in DiffuseScene FullScene TexturedScene; do
  for method in Silhouette Phong PathTracer PathTracerNee LightTracer Bdpt PhotonMapping Vcm Mlt PathGuided; do
    cat > "$work/pair.cpp" <<CPP
#include <lightswitch/lightswitch.hpp>
namespace ls = lightswitch;
ls::Image f(const ls::$scene& scene) { return ls::render(scene, ls::$method{}); }
CPP
    measure "$scene, $method" "$work/pair.cpp"
    [ "$kb" -le "${limit_kb[$scene]}" ] || { echo "  above the limit of ${limit_kb[$scene]} kB" && over=1; }
  done
done
exit $over
