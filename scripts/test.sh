#!/bin/sh
# Builds the module and its tests against the installed OpenCV, in build/, and runs them all.
# Arguments go to CMake: scripts/test.sh -DOPENCV_SOURCE_DIR=...
# scripts/test.sh --sanitize runs them under the address and undefined-behaviour sanitizers, then under the thread
# sanitizer, each in a build folder of its own, and the short ones in valgrind; --sanitize=address,undefined,
# --sanitize=thread and --sanitize=valgrind one of these.
. "$(dirname "$0")/lib.sh"

# run BUILD CTEST_ARGUMENTS CMAKE_ARGUMENT...: configures, builds and tests.
run() {
    build=$1 tests=$2
    shift 2
    say "building in $build"
    cmake -S "$root" -B "$build" -G Ninja "$@"
    cmake --build "$build"
    [ -n "${OPENCV_TEST_DATA_PATH:-}" ] || say "OPENCV_TEST_DATA_PATH is not set: tests on real images skip"
    ctest --test-dir "$build" --output-on-failure --parallel "$jobs" $tests
}

sanitize() {
    sanitizers=$1
    shift
    export TSAN_OPTIONS="suppressions=$root/cmake/sanitizer/threads.supp"
    # Not what compiles or times: those tests see nothing more in an instrumented build.
    # Little optimization, since instrumented code takes long to compile.
    run "$root/build-$(echo "$sanitizers" | tr , -)" "-E perf-smoke|headers|newer-opencv|consumer|synthetic" \
        "-DIIB_SANITIZE=$sanitizers" -DCMAKE_CXX_FLAGS_RELEASE=-O1 "$@"
}

memcheck() {
    need valgrind
    say "building in $root/build-valgrind"
    # The baseline's kernels: valgrind knows no AVX-512, and the library asks the emulated processor what it has.
    cmake -S "$root" -B "$root/build-valgrind" -G Ninja -DIIB_BUILD_TOOLS=OFF -DCMAKE_BUILD_TYPE=RelWithDebInfo "$@"
    cmake --build "$root/build-valgrind" --target opencv_test_iib
    valgrind --error-exitcode=1 --leak-check=no --quiet "$root/build-valgrind/opencv_test_iib" \
        --gtest_filter='IIB_Golden*:IIB_Hamming*:IIB_Error*:IIB_IO*:IIB_Matcher.*:IIB_MatcherEdges*:IIB_MatcherFile*-*no_limit*'
}

need $build_packages xz-utils
case "${1:-}" in
--sanitize)
    shift
    sanitize address,undefined "$@"
    sanitize thread "$@"
    memcheck "$@"
    ;;
--sanitize=valgrind)
    shift
    memcheck "$@"
    ;;
--sanitize=address,undefined | --sanitize=thread)
    sanitizers=${1#--sanitize=}
    shift
    sanitize "$sanitizers" "$@"
    ;;
--sanitize=*)
    echo "test.sh: $1 is none of --sanitize, --sanitize=address,undefined, --sanitize=thread, --sanitize=valgrind" >&2
    exit 2
    ;;
*)
    # the synthetic data and the evaluation's report are tested where these are
    need povray python3-opencv python3-matplotlib
    run "$root/build" "" "$@"
    ;;
esac
