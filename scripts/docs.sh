#!/bin/sh
# Builds the documentation's site in build/docs/html: guides, tutorials, the C++ reference (Doxygen), the Python reference,
# examples with their output, results and localization. Warnings and dead links are errors. Without a package index the examples
# have no output, and the Python reference lacks the extension's methods.
#   scripts/docs.sh [WHEEL]
# WHEEL: the Python package. Without it the package is built, with the tests' static library if there is one.
. "$(dirname "$0")/helpers/lib.sh"

[ $# -le 1 ] || fail "takes one wheel, not $*"
wheel="${1:-$root}"
[ -e "$wheel" ] || fail "there is no wheel $wheel"
case "$root" in *" "*) fail "Doxygen links no pages in a folder with a blank in its path: $root" ;; esac
need doxygen python3 python3-venv python3-dev $build_packages
version=$(project_version)
rm -rf "$build/docs"
pictures="$build/docs/pictures" environment="$build/docs/environment" library="$build/libopencv_iib_static.a"
mkdir -p "$pictures"
cd "$root"
[ -f "$library" ] || library=""
"$python3" -m venv "$environment"
if "$environment/bin/pip" install --quiet --retries 0 --timeout 15 opencv-python-headless pycolmap; then
    say "installing the package, and running its examples"
    "$environment/bin/pip" install --quiet "--config-settings=cmake.define.IIB_STATIC_LIBRARY=$library" "$wheel"
    "$environment/bin/python" scripts/helpers/python_api.py >"$build/docs/python_api.md"
    GLOG_minloglevel=1 "$environment/bin/python" scripts/helpers/python_examples.py "$pictures" >"$build/docs/python_examples.md"
    "$environment/bin/opencv-iib" align tools/synthetic/view_noon.jpg tools/synthetic/view_panned.jpg --out "$build/docs/align"
else
    say "skipped: the examples' output, and methods of the extension (pip reaches no package index)"
    "$python3" scripts/helpers/python_api.py >"$build/docs/python_api.md"
    "$python3" scripts/helpers/python_examples.py >"$build/docs/python_examples.md"
fi
{
    cat doc/Doxyfile
    echo "PROJECT_NUMBER = $version"
    echo "OUTPUT_DIRECTORY = \"$build/docs\""
    echo "INPUT += \"$build/docs/python_api.md\" \"$build/docs/python_examples.md\""
    echo "IMAGE_PATH += \"$pictures\""
} | root=$(pwd -P) doxygen -
cp -R doc/results doc/localization CITATION.cff "$build/docs/html"
[ ! -d "$build/docs/align" ] || cp -R "$build/docs/align" "$build/docs/html"
"$python3" scripts/helpers/links_test.py "$build/docs/html"
say "the documentation: $build/docs/html/index.html"
