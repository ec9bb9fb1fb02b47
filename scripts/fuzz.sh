#!/bin/sh
# Fuzzes the library with clang's libFuzzer, address and undefined-behaviour sanitizers:
# scripts/fuzz.sh [-s SECONDS] [TARGET...]. By default every target of fuzz, 60 seconds each. What is
# found on the way stays in build-fuzz/corpus and makes the next run start further on; an input that fails is
# kept in build-fuzz/failures and belongs into fuzz/corpus, with a test, once the defect is mended.
. "$(dirname "$0")/lib.sh"

seconds=60
if [ "${1:-}" = -s ]; then
    seconds=$2
    shift 2
fi
need $build_packages clang llvm xz-utils
build="$root/build-fuzz"
[ $# -gt 0 ] || set -- descriptor matcher parameters index tools

say "building in $build"
# The last sanitizer finds casts of numbers too large for an integer, whose result depends on the machine.
cmake -S "$root" -B "$build" -G Ninja -DCMAKE_CXX_COMPILER=clang++ \
    -DIIB_SANITIZE=fuzzer,address,undefined,float-cast-overflow "-DCMAKE_CXX_FLAGS=-fprofile-instr-generate -fcoverage-mapping"
cmake --build "$build" --target $(printf 'iib_fuzz_%s ' "$@")

mkdir -p "$build/failures"
failed=""
for target in "$@"; do
    program="$build/fuzz/iib_fuzz_$target"
    found="$build/corpus/$target"
    seeds="$root/fuzz/corpus/$target"
    mkdir -p "$found"
    say "$target, $seconds s"
    LLVM_PROFILE_FILE=/dev/null "$program" -max_total_time="$seconds" -timeout=60 -rss_limit_mb=4096 -max_len=1024 -print_final_stats=1 \
        -artifact_prefix="$build/failures/$target-" "$found" "$seeds" >"$build/$target.log" 2>&1 || {
        failed="$failed $target"
        tail -n 30 "$build/$target.log"
        continue
    }
    executions=$(sed -n 's/^stat::number_of_executed_units: *//p' "$build/$target.log")
    LLVM_PROFILE_FILE="$build/$target.profraw" "$program" -runs=0 "$found" "$seeds" >/dev/null 2>&1
    llvm-profdata merge -o "$build/$target.profdata" "$build/$target.profraw"
    lines=$(llvm-cov report "$build/libopencv_iib.so" -instr-profile="$build/$target.profdata" |
        awk '$1 == "TOTAL" { print $10 }')
    echo "$target: $executions executions, $(ls "$found" | wc -l) inputs kept, $lines of the library's lines"
done
[ -z "$failed" ] || {
    echo "failed:$failed; the inputs are in $build/failures" >&2
    exit 1
}
