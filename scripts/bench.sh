#!/bin/sh
# What describing costs beside cv::ORB on this machine, how time and memory grow, what matching costs beside BFMatcher,
# and how much slower all that is without AVX2 and AVX-512: prints tables and writes iib_benchmark.json.
#   scripts/bench.sh [--rounds=N] [--json=FILE]
. "$(dirname "$0")/lib.sh"

check_options "$root/tools/benchmark/benchmark.cpp" "$@"
# shellcheck disable=SC2086
need $build_packages
build_tools iib_benchmark
benchmark="$build/tools/benchmark/iib_benchmark"
narrow="$build/without_avx2.json"
OPENCV_CPU_DISABLE=AVX2,AVX512-SKX,AVX512-ICL "$benchmark" "$@" --json="$narrow" >/dev/null
"$benchmark" "$@" --against="$narrow"
