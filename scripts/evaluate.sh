#!/bin/sh
# Reproduces the paper's experiments on folders of image sequences and writes CSV files and one page.
#   scripts/evaluate.sh [--out FOLDER] [options of iib_evaluation] DATA...
# Results go to results/ unless --out says otherwise; an interrupted run goes on where it stopped.
. "$(dirname "$0")/lib.sh"

out="$root/results"
pictures=""
previous=""
for argument in "$@"; do
    [ "$previous" != --out ] || out="$argument"
    [ "$argument" != --no-pictures ] || pictures=--no-pictures
    previous="$argument"
done

# shellcheck disable=SC2086
need $build_packages python3-matplotlib
say "building the evaluation in $root/build-tools"
log="$root/build-tools.log"
{ cmake -S "$root" -B "$root/build-tools" -G Ninja -DIIB_BUILD_TESTS=OFF &&
    cmake --build "$root/build-tools" --target iib_evaluation; } >"$log" 2>&1 || { tail -n 30 "$log"; exit 1; }

"$root/build-tools/tools/evaluation/iib_evaluation" --out "$out" "$@"
page=$(/usr/bin/python3 "$root/tools/evaluation/report/report.py" $pictures "$out")
say "results and page: $page"
