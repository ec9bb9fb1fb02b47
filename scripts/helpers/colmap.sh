#!/bin/sh
# Reconstructs scenes with known poses with Debian's COLMAP, plain and relit, by COLMAP's own SIFT, by ORB and by IIB on
# ORB's keypoints, and prints the table of doc/colmap.md (python/examples/compare_colmap.py). About ten minutes.
#   scripts/helpers/colmap.sh [SCENE...]     by default those in $OPENCV_TEST_DATA_PATH/strecha
. "$(dirname "$0")/lib.sh"

if [ $# = 0 ]; then
    [ -d "${OPENCV_TEST_DATA_PATH:-}/strecha" ] || fail "give scenes, or set OPENCV_TEST_DATA_PATH to where strecha/ is"
    set -- "$OPENCV_TEST_DATA_PATH"/strecha/*/
fi
check_folders "$@"
need $build_packages colmap python3-venv python3-dev

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
say "building the package"
"$work/venv/bin/pip" install --quiet "$root[colmap]"
"$work/venv/bin/python" "$root/python/examples/compare_colmap.py" "$@"
