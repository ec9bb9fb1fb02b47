#!/bin/sh
# What describing costs beside cv::ORB on this machine, what matching costs beside BFMatcher and, where Python (IIB_PYTHON,
# if that is set) has faiss and opencv_iib, beside faiss's flat index, what small work costs, and how much slower all that is without AVX-512 and without
# AVX2: prints tables and writes build/benchmark*.json. With --document the results go to
# doc/results, from where the tables of README.md and doc/performance.md and their picture are made anew. --contrib adds
# BEBLID, TEBLID and LATCH of opencv_contrib, whose source pip brings.
#   scripts/bench.sh [--contrib] [--document] [--rounds=N]
. "$(dirname "$0")/helpers/lib.sh"

contrib="" results="$build"
while :; do
    case "${1:-}" in
    --contrib) contrib=yes ;;
    --document) results="$root/doc/results" ;;
    *) break ;;
    esac
    shift
done
check_options "$root/tools/benchmark/benchmark.cpp" "$@"
[ "$operands" = 0 ] || fail "takes options alone (--help tells more)"
document="${results#"$build"}"
need $build_packages python3 ${document:+python3-matplotlib}
[ -z "$contrib" ] || contrib=$(contrib_argument)
build_tools ${contrib:+"$contrib"} iib_benchmark
for without in "" _without_avx512:AVX512-SKX,AVX512-ICL _without_avx2:AVX2,AVX512-SKX,AVX512-ICL; do
    say "measuring${without:+ without ${without#*:}}"
    OPENCV_CPU_DISABLE=${without#*:} "$build/tools/benchmark/iib_benchmark" "$@" --json="$results/benchmark${without%:*}.json"
done
"$python3" "$root/scripts/helpers/figures.py" --print "$results"
if "$python3" -c "import faiss, opencv_iib" 2>/dev/null; then
    "$python3" "$root/tools/scale/measure.py" --flat
fi
if [ -n "$document" ]; then
    "$python3" "$root/tools/benchmark/plot.py" "$results/benchmark.json" "$root/doc/speed.svg"
    "$python3" "$root/scripts/helpers/figures.py" --write
fi
