#!/bin/sh
# Makes the site of the documentation with Doxygen in build/docs/html; any warning is an error.
. "$(dirname "$0")/helpers/lib.sh"

[ $# = 0 ] || fail "takes no argument"
need doxygen
version=$(sed -n 's/^project(opencv_iib VERSION \([0-9.]*\).*/\1/p' "$root/CMakeLists.txt")
rm -rf "$build/docs"
mkdir -p "$build/docs"
cd "$root"
{
    cat doc/Doxyfile
    echo "PROJECT_NUMBER = $version"
    echo "OUTPUT_DIRECTORY = \"$build/docs\""
} | doxygen -
say "the documentation: $build/docs/html/index.html"
