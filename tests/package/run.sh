#!/usr/bin/env bash
# run.sh WAY: builds a consumer of the project in a temporary directory, and runs it. WAY is a directory of tests/package, whose
# consumer must print the version; or `readme`, the first program of README.md with the CMakeLists.txt there, against what is
# installed before anything is built; or `by_hand`, with the compiler's command there. From the environment: CMAKE, SOURCE, BUILD
# (configured), VERSION, HAS_EXR and HAS_LOAD of the project, CXX and CMAKE_GENERATOR.
set -eu
way=${1:?usage: run.sh WAY}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# The first block of README.md in the language $1.
readme_block() { awk -v fence="\`\`\`$1" '$0 == fence { inside = 1; next } /^```/ { if (inside) exit } inside' "$SOURCE/README.md"; }

mkdir "$work/consumer"
cd "$work"
# The consumer uses the same Embree as the project.
embree=$(sed -n 's/^embree_DIR:[A-Z]*=//p' "$BUILD/CMakeCache.txt")
options=("-Dembree_DIR=$embree")

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
  readme)
    "$CMAKE" -S "$SOURCE" -B "$work/lightswitch" "${options[@]}" > "$work/log"
    "$CMAKE" --install "$work/lightswitch" --prefix "$work/installed" >> "$work/log"
    options+=("-DCMAKE_PREFIX_PATH=$work/installed")
    readme_block cmake > "$work/consumer/CMakeLists.txt"
    readme_block cpp > "$work/consumer/main.cpp"
    "$CMAKE" -S "$work/consumer" -B "$work/build" "${options[@]}"
    "$CMAKE" --build "$work/build"
    "$work/build/my_renderer"
    [ -s cornell-box.png ]
    exit
    ;;
  by_hand)
    command=$(grep '^g++ ' "$SOURCE/README.md" | sed "s|^g++|\"$CXX\"|; s|lightswitch/include|\"$SOURCE/include\"|")
    major=$(sed -n 's/.*embree-\([34]\).*/\1/p' <<< "$embree")
    command=${command//-lembree3/-lembree${major:-3}}
    [ "$HAS_EXR" = ON ] || command=$(sed 's/-DLIGHTSWITCH_HAS_EXR=1//; s/-ltinyexr//' <<< "$command")
    [ "$HAS_LOAD" = ON ] || command=${command//-lpugixml/}
    prefix=${embree%/lib*}
    cp "$SOURCE/tests/package/main.cpp" .
    CPATH="$prefix/include" LIBRARY_PATH="$prefix/lib" bash -eu -c "$command -DLIGHTSWITCH_EMBREE_MAJOR=${major:-3}"
    output=$(LD_LIBRARY_PATH="$prefix/lib${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}" ./my_renderer)
    echo "$output"
    [[ $output == *"lightswitch $VERSION"* ]]
    exit
    ;;
esac

cp "$SOURCE/tests/package/main.cpp" "$SOURCE/tests/package/$way/CMakeLists.txt" "$work/consumer/"
"$CMAKE" -S "$work/consumer" -B "$work/build" -DCMAKE_BUILD_TYPE=Debug "${options[@]}"
"$CMAKE" --build "$work/build"
output=$("$work/build/consumer")
echo "$output"
[[ $output == *"lightswitch $VERSION"* ]]
