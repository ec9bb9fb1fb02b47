#!/bin/sh
# Measures each step from an image to a pose on this machine, and ORB, BFMatcher, optical flow and MAGSAC for comparison. It runs
# opencv_perf_iib, opencv_perf_iib_index and opencv_perf_iib_geometry several times: with all instruction sets, with AVX2, with
# SSE4.2. The least time of each test counts. Prints tables and writes build/speed.csv; the programs' XML stays in build/speed.
# --document writes to doc/results and updates README.md, doc/performance.md and their chart.
# --contrib adds BEBLID, TEBLID and LATCH of opencv_contrib, whose source pip downloads.
#   scripts/bench.sh [--contrib] [--document] [--rounds=N]
. "$(dirname "$0")/helpers/lib.sh"

contrib="" out="$build" rounds=3
for argument in "$@"; do
    case "$argument" in
    --contrib) contrib=yes ;;
    --document) out="$root/doc/results" ;;
    --rounds=0 | --rounds=*[!0-9]* | --rounds=) fail "$argument is no number above 0" ;;
    --rounds=*) rounds=${argument#*=} ;;
    *) fail "unknown option $argument; there are --contrib, --document, --rounds=" ;;
    esac
done
need $build_packages xz-utils $pages_packages
[ -z "$contrib" ] || contrib=$(contrib_argument)
find_data
commit=$(measured_commit)
configure -DIIB_BUILD_TESTS=ON ${contrib:+"$contrib"}
programs="opencv_perf_iib opencv_perf_iib_index opencv_perf_iib_geometry"
build_targets $programs
# For half a second each, and the least time counts: neither few samples nor a busy machine's outliers are errors.
options="--perf_strategy=base --perf_time_limit=0.5 --perf_min_samples=1 --perf_max_deviation=0 --perf_max_outliers=100"
rm -rf "$build/speed"
mkdir -p "$build/speed"
for round in $(seq "$rounds"); do
    for without in "" AVX512-SKX,AVX512-ICL AVX2,AVX512-SKX,AVX512-ICL; do
        say "round $round of $rounds${without:+, without $without}"
        export OPENCV_CPU_DISABLE="$without"
        for program in $programs; do
            quietly "$build/speed/log" "$build/$program" $options \
                --gtest_output="xml:$build/speed/$program.$round.${without%%,*}.xml"
        done
    done
done
unset OPENCV_CPU_DISABLE
machine=$(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1)
"$python3" -B "$root/tools/pages/speed.py" "$out/speed.csv" "$commit" "$machine" "$build"/speed/*.xml
"$python3" -B "$root/tools/pages/timings.py" "$out"
[ "$out" = "$build" ] || "$python3" -B "$root/tools/pages/pages.py"
