#!/usr/bin/env bash
# samples/run.sh [CMAKE_OPTION...]: builds the program `lightswitch` and the samples, and lists them; installs what is
# missing first (Debian, Ubuntu). Environment: .ci/setup.sh.
set -u
source "$(dirname "${BASH_SOURCE[0]}")/../.ci/setup.sh"

# What is run once everything is built, in the directory of the built programs.
run_samples() {
  local program found=no
  for program in ./lightswitch ./[0-9][0-9]_*; do
    [ -f "$program" ] && [ -x "$program" ] || continue
    echo "$PWD/${program#./}"
    found=yes
  done
  [ $found = yes ] || echo "samples: there are none"
}

configure_project "$@" && build_targets lightswitch_samples || exit 1
cd "$build/samples" && run_samples
