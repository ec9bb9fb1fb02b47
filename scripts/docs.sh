#!/bin/sh
# Makes the site of the documentation in build/docs/html: guides, tutorials and the C++ reference with Doxygen, the reference of
# the Python package, and the pages of results and of localization. Any warning and any dead link is an error.
. "$(dirname "$0")/helpers/lib.sh"

[ $# = 0 ] || fail "takes no argument"
case "$root" in *" "*) fail "Doxygen links no pages in a folder with a blank in its path: $root" ;; esac
need doxygen python3
version=$(sed -n 's/^project(opencv_iib VERSION \([0-9.]*\).*/\1/p' "$root/CMakeLists.txt")
rm -rf "$build/docs"
mkdir -p "$build/docs"
cd "$root"
for page in python_api python_examples; do
    python3 "scripts/helpers/$page.py" >"$build/docs/$page.md"
done
{
    cat doc/Doxyfile
    echo "PROJECT_NUMBER = $version"
    echo "OUTPUT_DIRECTORY = \"$build/docs\""
    echo "INPUT += \"$build/docs/python_api.md\" \"$build/docs/python_examples.md\""
} | doxygen -
cp -R doc/results doc/localization CITATION.cff "$build/docs/html"
python3 scripts/helpers/links_test.py "$build/docs/html"
say "the documentation: $build/docs/html/index.html"
