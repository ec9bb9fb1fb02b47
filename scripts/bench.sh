#!/bin/sh
# What describing costs beside cv::ORB on this machine: prints a table and writes iib_benchmark.json.
#   scripts/bench.sh [--rounds=N] [--json=FILE]
. "$(dirname "$0")/lib.sh"

# shellcheck disable=SC2086
need $build_packages
log="$root/build-tools.log"
{ cmake -S "$root" -B "$root/build-tools" -G Ninja -DIIB_BUILD_TESTS=OFF &&
    cmake --build "$root/build-tools" --target iib_benchmark; } >"$log" 2>&1 || { tail -n 30 "$log"; exit 1; }
"$root/build-tools/tools/benchmark/iib_benchmark" "$@"
