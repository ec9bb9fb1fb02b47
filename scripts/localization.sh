#!/bin/sh
# Shows long-term localization: scripts/localization.sh [OUT]
# Renders the synthetic walk (once, about half an hour of processor time, kept in the user's cache folder), maps it at
# noon, localizes the images of other lights with IIB and, in the same pipeline, with the detectors' own descriptors and
# SIFT, and writes index.html with pictures and a video, results.csv and growth.csv to OUT (results-localization). With
# OPENCV_TEST_DATA_PATH set, also localizes real photographs (strecha) and photographs of other places.
. "$(dirname "$0")/helpers/lib.sh"

[ $# -le 1 ] || fail "one folder at most, not $#"
case "${1:-}" in -*) fail "unknown option $1; the one argument is a folder" ;; esac
out=${1:-$root/results-localization}
data="$cache/localization"
# shellcheck disable=SC2086
need $build_packages libceres-dev libunwind-dev povray python3-opencv python3-jinja2
/usr/bin/python3 "$root/tools/synthetic/localization.py" "$data"
if [ -f "$build/CMakeCache.txt" ]; then
    configure -DIIB_BUILD_APPS=ON
else
    configure -DIIB_BUILD_TESTS=OFF -DIIB_BUILD_TOOLS=OFF -DIIB_BUILD_APPS=ON
fi
say "building iib_map and iib_localize"
cmake --build "$build" --target iib_map iib_localize iib_map_growth
page=$(/usr/bin/python3 "$root/apps/localization/report/localization.py" "$build/apps/localization" "$data" "$out")
say "results and page: $page"
