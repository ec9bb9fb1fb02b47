#!/bin/sh
# Reproduces the paper's experiments on folders of image sequences and writes CSV files and one page.
#   scripts/evaluate.sh [--out FOLDER] [options of iib_evaluation] DATA...
# Results go to results/ unless --out says otherwise; an interrupted run goes on where it stopped.
. "$(dirname "$0")/lib.sh"

check_options "$root/tools/evaluation/main.cpp" "$@"
out="$root/results"
previous=""
for argument in "$@"; do
    [ "$previous" != --out ] || out="$argument"
    case "$argument" in --out=*) out="${argument#--out=}" ;; esac
    previous="$argument"
done

# shellcheck disable=SC2086
need $build_packages python3-jinja2
build_tools iib_evaluation

"$build/tools/evaluation/iib_evaluation" --out "$out" "$@"
page=$(/usr/bin/python3 "$root/tools/evaluation/report/report.py" "$out")
say "results and page: $page"
