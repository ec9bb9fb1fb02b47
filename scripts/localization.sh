#!/bin/sh
# Measures long-term localization: scripts/localization.sh [--document | OUT]
# Renders the synthetic walk (once, about an hour of processor time, kept in the cache folder) and maps it at noon. Localizes
# images under other lights by the Python package, by its command and by a program with SIFT; also with the paper's points, lines
# and an IMU. Writes index.html with pictures, a video, results.json and localization_setups.csv to OUT (results-localization).
# --document writes to doc/localization and updates doc/paper.md. With OPENCV_TEST_DATA_PATH it also localizes real photographs
# (strecha), and photographs of other places. pip downloads pycolmap.
. "$(dirname "$0")/helpers/lib.sh"

[ $# -le 1 ] || fail "one folder at most, not $#"
out=${1:-$root/results-localization} page="--localization"
case "${1:-}" in
--document) out="$root/doc/localization" page="" ;;
-*) fail "unknown option $1; there is --document, or a folder" ;;
esac
data="$cache/localization" environment="$cache/localization-environment"
need $build_packages povray python3-opencv python3-venv python3-dev $pages_packages
"$python3" "$root/tools/synthetic/localization.py" "$data"
say "installing the Python package in $environment"
"$python3" -m venv "$environment"
"$environment/bin/pip" install --quiet "$root" opencv-python-headless pycolmap
mkdir -p "$out"
"$environment/bin/python" -B "$root/tools/localization/setups.py" "$out/localization_setups.csv" "$data"
"$environment/bin/python" -B "$root/tools/localization/measure.py" "$data" "$out"
"$python3" -B "$root/tools/pages/pages.py" ${page:+"$page" "$out"}
say "results and page: $out/index.html"
