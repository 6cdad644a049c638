#!/usr/bin/env bash
# rules.sh RULE DIRECTORY: checks one rule on all headers in DIRECTORY (include/lightswitch; for no_approx all of tests), and lists what
# breaks it.
set -u
rule=${1:?usage: rules.sh RULE DIRECTORY}
documents=$(cd "$(dirname "$0")/../../docs" && pwd) || exit 2
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

# Which folder stands on which: an include goes to its own folder or to one on a lower floor.
floors() {
  # The picture of the floors in docs/design.md, top first.
  local picture
  picture=$(awk '/^## Layout$/ { here = 1 } here && /^```/ { if (inside) exit; inside = 1; next } inside' "$documents/design.md")
  [ -n "$picture" ] || { echo "there is no picture of the floors in $documents/design.md"; exit 1; }
  grep -rE --include='*.hpp' '^#include <lightswitch/' . | picture=$picture awk -F'[/:<>]' '
    BEGIN {
      number = split(ENVIRON["picture"], lines, "\n")
      for (i = 1; i <= number; ++i) {
        split(lines[i], parts, "#")  # what follows is a comment
        count = split(parts[1], names, " ")
        for (j = 1; j <= count; ++j) floor[names[j]] = number - i + 1
      }
    }
    $2 !~ /[.]hpp$/ {  # a header in a folder
      from = $2; to = $6
      if (!(from in floor)) print "./" from " has no floor: give it one in docs/design.md"
      else if (from != to && !(to in floor) && to != "version.hpp") print $0
      else if (from != to && !(floor[to] < floor[from])) print $0
    }' | sort -u | nothing 'includes that climb, or go sideways (core at the bottom; see the floors in docs/design.md):'
}

# Methods compute with densities as types: none takes the number out of one. Densities are known by `pdf` at the end of a name, and by being
# declared as one.
densities() {
  local names
  names=$(grep -rhoE '(SolidAngle|Area|Emission)Pdf&? +\w+' method | awk '{ printf "%s%s", (NR > 1 ? "|" : ""), $NF }')
  grep -rnE "(pdf_?|\\<($names))(\(.*\))?[.]value\>" method | nothing 'methods that unwrap a density (see core/pdf.hpp):'
}

[ "$(find . -name "*.[ch]pp" | wc -l)" -gt 0 ] || { echo "no C++ files in $PWD"; exit 2; }

case $rule in
  one_rtcore) only_one 'rtcore' embree/api.hpp ;;
  one_glm) only_one '[<"]glm/' core/math.hpp ;;
  one_stb) only_one '[</]stb_image_write\.h>' film/png.hpp && only_one '[</]stb_image\.h>' texture/stb_image.hpp ;;
  angle_includes) grep -rnE '^[[:space:]]*#[[:space:]]*include[[:space:]]*"' . | nothing 'use #include <lightswitch/...>:' ;;
  arithmetic) grep -rL --include='*.hpp' '^#include <lightswitch/' . | grep -vx './core/floating_point.hpp' |
    nothing 'no way leads to core/floating_point.hpp from:' ;;
  unit_float) grep -rnE '(static_cast<float>|float) *\([^()]*next(_2d)?\(\)' . | nothing 'would round up to 1, use next_float():' ;;
  no_approx) grep -rnE --include='*.[ch]pp' '\<Approx\>' . | nothing 'takes 1 for small, use test::relative (tests/support/relative.hpp):' ;;
  pragma_once) grep -rL --include='*.hpp' '^#pragma once$' . | nothing 'no #pragma once in:' ;;
  length) find . -name '*.hpp' ! -path ./report/page.hpp -exec awk 'END { if (FNR > 320) print FILENAME ": " FNR " lines" }' {} \; |
    nothing 'headers longer than 320 lines:' ;;
  floors) floors ;;
  densities) densities ;;
  width) find . \( -name '*.[ch]pp' -o -name '*.js' -o -name '*.css' -o -name '*.html' \) ! -path ./report/page.hpp -exec awk 'length > 120 { print FILENAME ":" FNR }' {} + |
    nothing 'lines longer than 120 columns:' ;;
  no_inl) find . -type f ! -name '*.hpp' ! -path './report/page/*' | nothing 'only .hpp files belong in include/:' ;;
  *) echo "unknown rule: $rule"; exit 2 ;;
esac
