#!/usr/bin/env bash
# run.sh WAY: builds the consumer in tests/package/WAY against the project, in a temporary directory, and runs it: it
# must succeed and print the version. From the environment: CMAKE, SOURCE, BUILD (configured) and VERSION of the project, CXX and
# CMAKE_GENERATOR.
set -eu
way=${1:?usage: run.sh WAY}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

mkdir "$work/consumer"
cp "$SOURCE/tests/package/main.cpp" "$SOURCE/tests/package/$way/CMakeLists.txt" "$work/consumer/"
options=()

# The consumer uses the same Embree as the project.
embree=$(sed -n 's/^embree_DIR:[A-Z]*=//p' "$BUILD/CMakeCache.txt")
options+=("-Dembree_DIR=$embree")

case $way in
  find_package)
    "$CMAKE" --install "$BUILD" --prefix "$work/installed" --component lightswitch_headers > "$work/log"
    # The package must not depend on where it was installed to.
    mv "$work/installed" "$work/moved"
    options+=("-Dlightswitch_ROOT=$work/moved")
    ;;
  add_subdirectory)
    options+=("-DLIGHTSWITCH_SOURCE=$SOURCE")
    ;;
  fetch_content)
    # A download of the sources: only what a build of the library needs.
    mkdir "$work/archive"
    cp -r "$SOURCE/CMakeLists.txt" "$SOURCE/LICENSE" "$SOURCE/include" "$SOURCE/.ci" "$work/archive/"
    tar -C "$work" -czf "$work/archive.tar.gz" archive
    options+=("-DLIGHTSWITCH_SOURCE=file://$work/archive.tar.gz")
    ;;
esac

"$CMAKE" -S "$work/consumer" -B "$work/build" -DCMAKE_BUILD_TYPE=Debug "${options[@]}"
"$CMAKE" --build "$work/build"
output=$("$work/build/consumer")
echo "$output"
[[ $output == *"lightswitch $VERSION"* ]]
