#!/usr/bin/env bash
# rules.sh RULE DIRECTORY: checks one rule on all headers in DIRECTORY (include/lightswitch; for no_approx all of tests), and lists what
# breaks it.
set -u
rule=${1:?usage: rules.sh RULE DIRECTORY}
cd "${2:?usage: rules.sh RULE DIRECTORY}" || exit 2

# Succeeds when exactly one header has an #include that matches regex $1: the header $2, if given.
only_one() {
  local found
  found=$(grep -rlE "^[[:space:]]*#[[:space:]]*include.*$1" . | sed 's|^\./||')
  [ -n "$found" ] && [ "$found" = "${2:-${found%%[[:space:]]*}}" ] ||
    { printf 'exactly one header (%s) is to include %s, but these do:\n%s\n' "${2:-any}" "$1" "${found:-none}"; return 1; }
}

# Succeeds when standard input is empty; otherwise shows it under the heading $1.
nothing() {
  local found
  found=$(cat)
  [ -z "$found" ] || { printf '%s\n%s\n' "$1" "$found"; return 1; }
}

[ "$(find . -name '*.hpp' | wc -l)" -gt 0 ] || { echo "no headers in $PWD"; exit 2; }

case $rule in
  one_rtcore) only_one 'rtcore' embree/api.hpp ;;
  one_glm) only_one '[<"]glm/' core/math.hpp ;;
  one_stb) only_one 'stb_' ;;
  angle_includes) grep -rnE '^[[:space:]]*#[[:space:]]*include[[:space:]]*"' . | nothing 'use #include <lightswitch/...>:' ;;
  arithmetic) grep -rL --include='*.hpp' '^#include <lightswitch/' . | grep -vx './core/floating_point.hpp' |
    nothing 'no way leads to core/floating_point.hpp from:' ;;
  unit_float) grep -rnE '(static_cast<float>|float) *\([^()]*next(_2d)?\(\)' . | nothing 'would round up to 1, use next_float():' ;;
  no_approx) grep -rnE --include='*.[ch]pp' '\<Approx\>' . | nothing 'takes 1 for small, use test::relative (tests/support/relative.hpp):' ;;
  pragma_once) grep -rL --include='*.hpp' '^#pragma once$' . | nothing 'no #pragma once in:' ;;
  length) find . -name '*.hpp' -exec awk 'END { if (FNR > 320) print FILENAME ": " FNR " lines" }' {} \; |
    nothing 'headers longer than 320 lines:' ;;
  no_inl) find . -type f ! -name '*.hpp' | nothing 'only .hpp files belong in include/:' ;;
  *) echo "unknown rule: $rule"; exit 2 ;;
esac
