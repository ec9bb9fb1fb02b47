#!/bin/sh
# Fuzzes the library with clang's libFuzzer, address and undefined-behaviour sanitizers:
# scripts/fuzz.sh [--plain] [--keep] [-s SECONDS] [TARGET...]. By default every target of fuzz, 60 seconds each, one per core.
# New inputs stay in the cache folder; 200 random ones start the next run, of any checkout. A failing input is kept in
# build-fuzz/failures: once the bug is fixed, add it to fuzz/corpus, with a test.
# --plain leaves the sanitizers out and makes inputs smaller, so that many more are compared with the oracles.
# --keep adds the smallest inputs that reach new code to fuzz/corpus.
. "$(dirname "$0")/helpers/lib.sh"

corpus="$cache/fuzz"
plain="" keep="" seconds=60
while true; do
    case "${1:-}" in
    --plain) plain=yes ;;
    --keep) keep=yes ;;
    -s)
        case "${2:-}" in
        "" | *[!0-9]*) fail "-s takes a number of seconds" ;;
        esac
        seconds=$2
        shift
        ;;
    *) break ;;
    esac
    shift
done
known=$(sed -n 's/^set(fuzz_targets \(.*\))$/\1/p' "$root/fuzz/CMakeLists.txt")
[ $# -gt 0 ] || set -- $known
for target in "$@"; do
    case " $known " in
    *" $target "*) ;;
    *) fail "there is no target $target; there are: $known" ;;
    esac
done
need $build_packages clang xz-utils
if [ -n "$plain" ]; then
    build="$root/build-fuzz-plain" longest=40
    # Where numbers are compared is not recorded: it takes half of the time.
    configure -DCMAKE_CXX_COMPILER=clang++ -DIIB_SANITIZE=fuzzer \
        -DCMAKE_CXX_FLAGS=-fno-sanitize-coverage=trace-cmp
else
    build="$root/build-fuzz" longest=512
    # The last sanitizer finds casts of numbers too large for an integer, whose result depends on the machine.
    configure -DCMAKE_CXX_COMPILER=clang++ -DIIB_SANITIZE=fuzzer,address,undefined,float-cast-overflow
fi
say "building the targets"
# shellcheck disable=SC2046
cmake --build "$build" --target $(printf 'iib_fuzz_%s ' "$@")

# What costs more than the library's own work: a record of where each block of memory was allocated, a long wait before
# it is used again, libFuzzer's statistics of rare features and its search for leaks, and files on a disk. The suites
# under the sanitizers have all of it.
export ASAN_OPTIONS="malloc_context_size=0:quarantine_size_mb=4:${ASAN_OPTIONS:-}"
[ -d /dev/shm ] && export OPENCV_TEMP_PATH=/dev/shm
failures="$root/build-fuzz/failures"
mkdir -p "$failures" "$corpus"

# run TARGET OPTION... FOLDER...: as a child that goes when this process is ended.
run() {
    target=$1
    shift
    "$build/fuzz/iib_fuzz_$target" "$@" -entropic=0 -detect_leaks=0 -timeout=60 -rss_limit_mb=4096 -max_len=$longest \
        -artifact_prefix="$failures/$target-" >>"$build/$target.log" 2>&1 &
    child=$!
    trap 'kill $child; exit 1' TERM
    wait $child
}

# replay TARGET: its inputs with the kernels of each other instruction set.
replay() {
    for off in AVX512-SKX,AVX512-ICL AVX2,AVX512-SKX,AVX512-ICL SSE4.1,SSE4.2,AVX,AVX2,AVX512-SKX,AVX512-ICL; do
        export OPENCV_CPU_DISABLE=$off
        run "$1" -runs=0 "$build/$1.corpus" "$root/fuzz/corpus/$1" || return 1
    done
    unset OPENCV_CPU_DISABLE
}

# save TARGET: what a run has found, also one that was interrupted.
save() {
    mkdir -p "$corpus/$1"
    [ ! -d "$build/$1.corpus" ] || cp -R "$build/$1.corpus/." "$corpus/$1"
}

# sample TARGET: some of what was kept. A slow target would do nothing else in its time, were it to begin with all of it.
sample() {
    save "$1"
    rm -rf "$build/$1.corpus"
    mkdir "$build/$1.corpus"
    ls "$corpus/$1" | shuf -n 200 | while read -r input; do
        cp "$corpus/$1/$input" "$build/$1.corpus"
    done
}

# fuzz TARGET: leaves a file beside its log if nothing was found.
fuzz() {
    sample "$1"
    : >"$build/$1.log"
    run "$1" -max_total_time="$seconds" -print_final_stats=1 "$build/$1.corpus" "$root/fuzz/corpus/$1" && found="" || found=yes
    save "$1"
    if [ -z "$found" ] &&
        { [ -n "$plain" ] || replay "$1"; } &&
        # Into the first folder; the lines that are reached count, not how often.
        { [ -z "$keep" ] || run "$1" -merge=1 -use_counters=0 "$root/fuzz/corpus/$1" "$corpus/$1"; }; then
        executions=$(sed -n 's/^stat::number_of_executed_units: *//p' "$build/$1.log" | head -n 1)
        echo "$1: $executions executions, $(ls "$corpus/$1" | wc -l) inputs kept"
        touch "$build/$1.passed"
    else
        tail -n 30 "$build/$1.log" | sed "s/^/$1: /"  # others write meanwhile
    fi
}

children=""
trap 'kill $children; exit 1' INT TERM
say "$*: $seconds s each, $jobs at a time"
running=0
for target in "$@"; do
    rm -f "$build/$target.passed"
    fuzz "$target" &
    children="$children $!"
    running=$((running + 1))
    if [ $((running % jobs)) = 0 ]; then
        wait
        children=""
    fi
done
wait
failed=""
for target in "$@"; do
    [ -e "$build/$target.passed" ] || failed="$failed $target"
done
[ -z "$failed" ] || {
    echo "failed:$failed; the inputs are in $failures" >&2
    exit 1
}
