#!/bin/sh
# What describing costs beside cv::ORB on this machine, how time and memory grow, and how much slower it is without
# AVX2 and AVX-512: prints tables and writes iib_benchmark.json.
#   scripts/bench.sh [--rounds=N] [--json=FILE]
. "$(dirname "$0")/lib.sh"

# shellcheck disable=SC2086
need $build_packages
log="$root/build-tools.log"
{ cmake -S "$root" -B "$root/build-tools" -G Ninja -DIIB_BUILD_TESTS=OFF &&
    cmake --build "$root/build-tools" --target iib_benchmark; } >"$log" 2>&1 || { tail -n 30 "$log"; exit 1; }
benchmark="$root/build-tools/tools/benchmark/iib_benchmark"
narrow="$root/build-tools/without_avx2.json"
OPENCV_CPU_DISABLE=AVX2,AVX512-SKX,AVX512-ICL "$benchmark" "$@" --json="$narrow" >/dev/null
"$benchmark" "$@" --against="$narrow"
