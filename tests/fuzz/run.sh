#!/usr/bin/env bash
# tests/fuzz/run.sh [SECONDS [READER...]]: fuzzes each reader of files (or those named) for so many seconds, 10 by default,
# with libFuzzer under the address and undefined-behaviour sanitizers. What no `Error` stops is a finding: its bytes are
# left in build/fuzz/findings. The last line is `N passed, M failed`.
#
# Environment: CXX, a Clang with sanitizers (default: the newest clang++-N); LIGHTSWITCH_BUILD_DIR, LIGHTSWITCH_JOBS:
# .ci/setup.sh.
set -u
cd "$(dirname "${BASH_SOURCE[0]}")/../.." || exit 1
export LIGHTSWITCH_BUILD_DIR=${LIGHTSWITCH_BUILD_DIR:-$PWD/build/fuzz}
source .ci/setup.sh
exec < /dev/null

seconds=${1:-10}
shift
readers=("$@")
if [ ${#readers[@]} -eq 0 ]; then
  for source in tests/fuzz/*.cpp; do
    reader=${source##*/}
    readers+=("${reader%.cpp}")
  done
fi
export CXX=${CXX:-$(newest_clang)}
# The targets' files, in memory if there is such a place; libFuzzer ends without cleaning up.
[ -d /dev/shm ] && files=$(mktemp -d /dev/shm/lightswitch-fuzz-XXXXXX) || files=$(mktemp -d)
trap 'rm -rf "$files"' EXIT
export TMPDIR=$files

if ! configure_project -DLIGHTSWITCH_FUZZ=ON -DLIGHTSWITCH_BUILD_SAMPLES=OFF -DLIGHTSWITCH_BUILD_BENCH=OFF \
    -DLIGHTSWITCH_TEST_STRUCTURE=OFF || ! build_targets "${readers[@]/#/fuzz_}"; then
  echo "0 passed, 1 failed"
  exit 1
fi

# Valid files to begin with: those that the tests have, and those beside this script.
seeds() {
  case $1 in
    xml) find tests/data -name '*.xml' ;;
    obj | ply) find tests/data -name "*.$1" -size -20k ;;
    serialized | pfm) find tests/data -name "*.$1" ;;
    bitmap) find tests/data -name '*.png' -size -20k ;;
    spectrum) find tests/data -name '*.spd' ;;
  esac
  find "tests/fuzz/seeds/$1" -type f 2> /dev/null
}

passed=0
failed=0
mkdir -p "$build/findings"
for reader in "${readers[@]}"; do
  corpus=$build/corpus/$reader
  mkdir -p "$corpus"
  seeds "$reader" | while read -r file; do cp "$file" "$corpus/"; done
  log=$build/$reader.log
  if "$build/tests/fuzz/fuzz_$reader" -seed=1 -max_total_time="$seconds" -timeout=10 -rss_limit_mb=2048 -max_len=16384 \
      -print_final_stats=1 -artifact_prefix="$build/findings/$reader-" "$corpus" > "$log" 2>&1; then
    passed=$((passed + 1))
    echo "$reader: $(awk '/number_of_executed_units/ { print $2 }' "$log") inputs, nothing found"
  else
    failed=$((failed + 1))
    echo "$reader: found something ($log):"
    grep -m 3 -E 'ERROR|runtime error|SUMMARY' "$log"
  fi
done
echo "$passed passed, $failed failed"
[ "$passed" -gt 0 ] && [ "$failed" -eq 0 ]
