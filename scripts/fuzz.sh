#!/bin/sh
# Fuzzes the library with clang's libFuzzer, address and undefined-behaviour sanitizers:
# scripts/fuzz.sh [-s SECONDS] [TARGET...]. By default every target of fuzz, 60 seconds each. What is
# found on the way stays in build-fuzz/corpus and makes the next run start further on; an input that fails is
# kept in build-fuzz/failures and belongs into fuzz/corpus, with a test, once the defect is mended.
. "$(dirname "$0")/lib.sh"

seconds=60
if [ "${1:-}" = -s ]; then
    case "${2:-}" in
    "" | *[!0-9]*) fail "-s takes a number of seconds" ;;
    esac
    seconds=$2
    shift 2
fi
known=$(sed -n 's/^set(fuzz_targets \(.*\))$/\1/p' "$root/fuzz/CMakeLists.txt")" tools"
# shellcheck disable=SC2086
[ $# -gt 0 ] || set -- $known
for target in "$@"; do
    case " $known " in
    *" $target "*) ;;
    *) fail "there is no target $target; there are: $known" ;;
    esac
done
# shellcheck disable=SC2086
need $build_packages clang llvm xz-utils
build="$root/build-fuzz"
# The last sanitizer finds casts of numbers too large for an integer, whose result depends on the machine.
configure -DCMAKE_CXX_COMPILER=clang++ \
    -DIIB_SANITIZE=fuzzer,address,undefined,float-cast-overflow "-DCMAKE_CXX_FLAGS=-fprofile-instr-generate -fcoverage-mapping"
say "building the targets"
# shellcheck disable=SC2046
cmake --build "$build" --target $(printf 'iib_fuzz_%s ' "$@")

# covered PROFILE: the share of the library's lines that ran.
covered() {
    llvm-cov report "$build/libopencv_iib.so" -instr-profile="$1" | awk '$1 == "TOTAL" { print $10 }'
}

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
    echo "$target: $executions executions, $(ls "$found" | wc -l) inputs kept," \
        "$(covered "$build/$target.profdata") of the library's lines"
done
llvm-profdata merge -o "$build/all.profdata" "$build"/*.profraw
echo "all targets that have run together: $(covered "$build/all.profdata") of the library's lines"
[ -z "$failed" ] || {
    echo "failed:$failed; the inputs are in $build/failures" >&2
    exit 1
}
