#!/bin/sh
# Installs the Python package into clean virtual environments and runs python/tests there: with pip's newest OpenCV, and
# with Debian's (python3-opencv). Skips with a word where there is no package index.
. "$(dirname "$0")/lib.sh"

[ $# = 0 ] || fail "takes no argument, not $1"
need $build_packages python3-venv python3-dev python3-opencv python3-numpy

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# check PYTHON PACKAGE...: the tests in a new environment, with these packages.
check() {
    python=$1
    shift
    "$work/$python/bin/pip" install --quiet "$@" || return 1
    (cd "$root/python/tests" && "$work/$python/bin/python" -m unittest discover)
}

/usr/bin/python3 -m venv "$work/newest"
if ! "$work/newest/bin/pip" download --quiet --no-deps --dest "$work/probe" nanobind 2>"$work/log"; then
    say "skipped: python tests (pip reaches no package index)"
    exit 0
fi
say "building the package"
"$work/newest/bin/pip" wheel --quiet --no-deps --wheel-dir "$work/wheel" "$root"

say "python tests with pip's newest OpenCV"
check newest "$work"/wheel/*.whl opencv-python-headless pillow h5py

say "python tests with Debian's OpenCV"
/usr/bin/python3 -m venv --system-site-packages "$work/debian"
check debian "$work"/wheel/*.whl
