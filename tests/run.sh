#!/usr/bin/env bash
# tests/run.sh [CMAKE_OPTION...]: builds and runs the tests; installs what is missing first (Debian, Ubuntu).
# The last line is `N passed, M failed`; the exit status is 0 only when something ran and nothing failed.
#
# Environment: LIGHTSWITCH_TEST_LABEL is quick (default), long or all; LIGHTSWITCH_BUILD_DIR, LIGHTSWITCH_JOBS: .ci/setup.sh.
set -u
source "$(dirname "${BASH_SOURCE[0]}")/../.ci/setup.sh"
exec < /dev/null

passed=0
failed=0
finish() {
  echo "$passed passed, $failed failed"
  [ "$passed" -gt 0 ] && [ "$failed" -eq 0 ]
  exit
}

# Long tests are built only to be run.
case ${LIGHTSWITCH_TEST_LABEL:=quick} in
  quick) long=OFF ;;
  *) long=ON ;;
esac
if ! configure_project -DLIGHTSWITCH_TEST_LONG=$long "$@"; then
  echo "tests: the build could not be configured"
  failed=1
  finish
fi

# What can be built is tested even when something cannot, which counts as one failure.
if ! build_targets lightswitch_tests; then
  echo "tests: the build failed"
  failed=1
fi

case $LIGHTSWITCH_TEST_LABEL in
  quick | long) select=(--label-regex "^$LIGHTSWITCH_TEST_LABEL\$") ;;
  all) select=() ;;
  *) echo "tests: LIGHTSWITCH_TEST_LABEL is '$LIGHTSWITCH_TEST_LABEL': it must be quick, long or all" >&2; exit 2 ;;
esac
results=$build/test-results.xml
rm -f "$results"
ctest --test-dir "$build" ${select[@]+"${select[@]}"} --parallel "$jobs" --output-on-failure --output-junit "$results"
ctest_status=$?

if [ -f "$results" ]; then
  # Each test is one <testcase> line; a test that could not even start has the status "notrun".
  passed=$(grep -c '<testcase .*status="run"' "$results")
  failed=$((failed + $(grep -cE '<testcase .*status="(fail|notrun)"' "$results")))
  # A test that says why it cannot run here (code 77, such as without a browser) is neither.
  failed=$((failed - $(grep -c '<skipped message="SKIP_RETURN_CODE=77"' "$results")))
fi
# Whatever the list of results says, ctest's own verdict stands.
[ $ctest_status -eq 0 ] || [ "$failed" -gt 0 ] || failed=1
[ "$passed" -gt 0 ] || [ "$failed" -gt 0 ] || echo "tests: nothing has the label $LIGHTSWITCH_TEST_LABEL"
finish
