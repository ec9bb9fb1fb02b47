#!/bin/sh
# Measures searches among many codes, and prints the figures: exact at several widths beside faiss's, a mapped index of ten
# million codes, Dask's workers. Takes a quarter of an hour of a machine that does nothing else, 2 GB of memory and of disk, and pip's
# package index.
# With --document the results go to doc/results, from where the tables of doc/scale.md are made anew.
#   scripts/helpers/scale.sh [--document] [--mapped=N] [--rounds=N]
. "$(dirname "$0")/lib.sh"

out="$build/scale.json"
if [ "${1:-}" = --document ]; then
    out="$root/doc/results/scale.json"
    shift
fi
for argument in "$@"; do
    case "$argument" in
    --mapped=*[!0-9]* | --rounds=*[!0-9]* | --*=0) fail "$argument is no number above 0" ;;
    --mapped=?* | --rounds=?*) ;;
    *) fail "unknown option $argument; there are --mapped=, --rounds=" ;;
    esac
done
need $build_packages python3-venv python3-dev $pages_packages
commit=$(measured_commit)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$build"
say "building the package"
"$python3" -m venv "$work/environment"
"$work/environment/bin/pip" install --quiet "${root}[distributed]" opencv-python-headless faiss-cpu
say "measuring"
"$work/environment/bin/python" "$root/tools/scale/measure.py" --out "$out" "$@"
[ "$out" != "$build/scale.json" ] || exit 0
remember "$out" "$commit" "$(sed -n 's/^ "machine": "\(.*\)",$/\1/p' "$out")"
"$python3" -B "$root/tools/pages/pages.py"
