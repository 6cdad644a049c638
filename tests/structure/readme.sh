#!/usr/bin/env bash
# readme.sh FILE COMPILER...: every ```cpp block of FILE compiles as a program of its own (COMPILER... with all its options; the
# source is appended) and ends in words, not in std::terminate, when the library refuses something; and the first one is
# samples/01_minimal.cpp to the letter, without its comments.
set -eu
file=${1:?usage: readme.sh FILE COMPILER...}
shift
root=$(cd "$(dirname "$file")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

awk -v work="$work" '/^```cpp$/ { ++n; inside = 1; next } /^```/ { inside = 0 } inside { print > (work "/" n ".cpp") }' "$file"
blocks=("$work"/*.cpp)
[ -f "${blocks[0]}" ] || { echo "$file has no C++ code"; exit 1; }
diff <(grep -v '^//' "$root/samples/01_minimal.cpp" | sed '/./,$!d') "$work/1.cpp" || {
  echo "the first program of $file is not samples/01_minimal.cpp"
  exit 1
}
for block in "${blocks[@]}"; do
  grep -q '^} catch (const ls::Error& error) {$' "$block" || { echo "a program of $file does not catch ls::Error:"; cat "$block"; exit 1; }
  "$@" -fsyntax-only "$block"
done
echo "${#blocks[@]} programs compile"
