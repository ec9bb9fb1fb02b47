#!/bin/sh
# Reproduces the paper's experiments on folders of image sequences and writes CSV files, means and one page.
#   scripts/evaluate.sh [--document] [--contrib [--nonfree]] [--out FOLDER] [options of iib_evaluation] DATA...
# Results go to results/ or --out; an interrupted run of iib_evaluation continues. --document puts their
# summaries and the page into doc/results and updates the tables of the README; --contrib adds the descriptors of
# opencv_contrib, whose source pip downloads (BEBLID, TEBLID, LATCH and more), --nonfree SURF, whose licence is not free.
. "$(dirname "$0")/helpers/lib.sh"

document="" contrib="" nonfree=OFF
while :; do
    case "${1:-}" in
    --document) document=yes ;;
    --contrib) contrib=yes ;;
    --nonfree) nonfree=ON ;;
    *) break ;;
    esac
    shift
done
[ "$nonfree$contrib" != ON ] || fail "--nonfree needs --contrib"
check_options "$root/tools/evaluation/main.cpp" "$@"
[ $# != 0 ] || fail "a folder of DATA is needed (see --help)"
out="$root/results" tool="" package="" previous=""
for argument in "$@"; do
    case "=$previous=$argument=" in
    *=--out=*=) out="${argument#--out=}" ;;
    *=--only=estimators= | *=--only=controls= | *=--only=alignment= | *=--only=uncertainty= | *=--only=views=) package=yes ;;
    *=--only=*=) tool=yes ;;
    esac
    case "$argument" in --*=*) previous="" ;; *) previous="$argument" ;; esac
done
[ -n "$tool$package" ] || tool=yes package=yes
pairs="$out/pairs"

need $build_packages $pages_packages python3-opencv python3-venv python3-dev
[ -z "$contrib" ] || contrib=$(contrib_argument)
[ -z "$tool" ] || build_tools ${contrib:+"$contrib" -DIIB_CONTRIB_NONFREE=$nonfree} iib_evaluation

# An earlier run's rows are kept: $pairs/commits has the commits of all.
commit=$(measured_commit)
[ ! -d "$pairs" ] || [ -e "$pairs/commits" ] || echo "not recorded" >"$pairs/commits"
mkdir -p "$pairs"
grep -qxF -e "$commit" "$pairs/commits" 2>/dev/null || echo "$commit" >>"$pairs/commits"

for image in view_noon.jpg view_overcast.jpg day.png night.png view_noon.jpg view_panned.jpg street_noon.jpg street_winter.jpg facade_noon.jpg facade_night.jpg facade_noon.jpg facade_turned.jpg; do
    set -- "$@" --compare "$root/tools/synthetic/$image"
done
for selection in "$root"/doc/results/AdaBoost-*.json; do
    set -- "$@" --descriptor "$selection"
done
[ -z "$tool" ] || "$build/tools/evaluation/iib_evaluation" "$@" --out "$pairs"
if [ -n "$package" ]; then
    environment="$cache/evaluation-environment"
    say "installing the Python package in $environment"
    "$python3" -m venv --system-site-packages "$environment"
    library=""  # of the tests, if they were built here: it saves minutes
    ! cmake --build "$build" --target opencv_iib_static >/dev/null 2>&1 || library="$build/libopencv_iib_static.a"
    if "$environment/bin/pip" install --quiet "--config-settings=cmake.define.IIB_STATIC_LIBRARY=$library" "$root"; then
        "$environment/bin/pip" install --quiet poselib || say "skipped: PoseLib's poses (pip has no poselib here)"
        "$environment/bin/python" -B "$root/tools/evaluation/evaluate.py" "$@" --out "$pairs"
    else
        say "skipped: poses, alignment, views and uncertainty (pip reaches no package index)"
    fi
fi
[ -z "$document" ] || out="$root/doc/results"
[ ! -e "$pairs/fixed_points.csv" ] || cp "$pairs/settings.txt" "$out"
machine="$(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1), $jobs threads"
[ -z "$contrib" ] ||
    machine="$machine, opencv_contrib $(sed -n 's/^Version: \([0-9]*[.][0-9]*[.][0-9]*\).*/\1/p' "${contrib#*=}/PKG-INFO")"
[ ! -e "$pairs/pictures" ] || cp -r "$pairs/pictures" "$out"
"$python3" -B "$root/tools/pages/summaries.py" "$pairs" "$out" "$(paste -sd';' "$pairs/commits")" "$machine"
if [ -n "$document" ]; then
    "$python3" -B "$root/tools/pages/pages.py"
elif [ -e "$out/fixed_points.csv" ]; then
    "$python3" -B "$root/tools/pages/pages.py" --results "$out"
fi
say "results: $out, of each pair of images: $pairs"
