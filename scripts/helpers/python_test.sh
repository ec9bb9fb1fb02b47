#!/bin/sh
# Installs the Python package into clean virtual environments and runs python/tests and tools/evaluation/test there: with pip's newest OpenCV, and
# with Debian's (python3-opencv). Without a package index for pip it skips with a message; with --servers it fails.
#   scripts/helpers/python_test.sh [--servers] [LIBRARY]
# --servers: also with PostgreSQL, and with Dask's workers in network namespaces (needs root).
# LIBRARY: the module as a static library of position-independent code, built with the installed OpenCV, like ctest's entry
# `python`; the wheel is left beside it. Without it the whole package is built, which takes minutes.
. "$(dirname "$0")/lib.sh"

servers=""
if [ "${1:-}" = --servers ]; then
    servers=yes
    shift
fi
[ $# -le 1 ] || fail "takes one library, not $*"
library="${1:-}"
[ -z "$library" ] || [ -f "$library" ] || fail "there is no library $library"
[ -n "$library" ] || need $build_packages python3-venv python3-dev python3-opencv python3-numpy

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# check ENVIRONMENT PACKAGE...: runs the tests in this environment, with these packages.
check() {
    environment="$work/$1"
    shift
    "$environment/bin/pip" install --quiet "$@"
    for tests in python/tests tools/evaluation/test; do
        (cd "$root/$tests" && "$environment/bin/python" -B -m unittest discover)
    done
}

skip() {
    [ -z "$servers" ] || fail "no python tests: $*"
    say "skipped: python tests ($*)"
    exit 0
}

"$python3" -m venv "$work/newest" 2>"$work/log" || skip "no virtual environments: python3-venv is missing"
"$work/newest/bin/pip" --retries 0 --timeout 15 download --quiet --no-deps --dest "$work/probe" nanobind 2>"$work/log" ||
    skip "pip reaches no package index"

say "building the package"
set -- "--config-settings=build-dir=$work/build"
[ -z "$library" ] || set -- "$@" "--config-settings=cmake.define.IIB_STATIC_LIBRARY=$library"
"$work/newest/bin/pip" wheel --quiet --no-deps --wheel-dir "$work" "$@" "$root"
[ -z "$library" ] || cp "$work"/*.whl "$(dirname "$library")"

say "python tests with pip's newest OpenCV"
check newest "$work"/*.whl opencv-python-headless h5py pycolmap distributed tifffile mypy
if [ -n "$servers" ]; then
    "$work/newest/bin/pip" install --quiet "psycopg[binary]"
    "$root/scripts/helpers/servers_test.sh" "$work/newest/bin/python"
fi

if "$python3" -c 'import cv2' 2>"$work/log"; then
    say "python tests with Debian's OpenCV"
    "$python3" -m venv --system-site-packages "$work/debian"
    check debian "$work"/*.whl
else
    [ -z "$servers" ] || fail "no python tests with Debian's OpenCV: python3-opencv is missing"
    say "skipped: python tests with Debian's OpenCV (python3-opencv is missing)"
fi
