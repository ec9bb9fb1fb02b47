#!/bin/sh
# Builds the module and its tests against the installed OpenCV, in build/, and runs them all.
# Arguments go to CMake: scripts/test.sh -DOPENCV_SOURCE_DIR=...
# scripts/test.sh --sanitize runs them under the address and undefined-behaviour sanitizers, then under the thread
# sanitizer, each in a build folder of its own, and the short ones in valgrind; --sanitize=address,undefined,
# --sanitize=thread and --sanitize=valgrind one of these.
. "$(dirname "$0")/lib.sh"

# run BUILD NOT_TO_RUN CMAKE_ARGUMENT...: configures, builds and tests, but for the tests that match NOT_TO_RUN.
run() {
    build=$1 not_to_run=$2
    shift 2
    configure -DIIB_BUILD_TESTS=ON -DIIB_BUILD_TOOLS=ON "$@"
    say "building library, tests and tools"
    cmake --build "$build"
    [ -n "${OPENCV_TEST_DATA_PATH:-}" ] || say "OPENCV_TEST_DATA_PATH is not set: tests on real images skip"
    ctest --test-dir "$build" --output-on-failure --parallel "$jobs" --exclude-regex "$not_to_run"
}

sanitize() {
    sanitizers=$1
    shift
    export TSAN_OPTIONS="suppressions=$root/cmake/sanitizer/threads.supp"
    # Not what compiles or times: those tests see nothing more in an instrumented build. Real images once, not for each
    # instruction set: ten times as slow here, they took a quarter of an hour, and each set's kernels have their oracles.
    # Little optimization, since instrumented code takes long to compile.
    run "$root/build-$(echo "$sanitizers" | tr , -)" "perf-smoke|headers|newer-opencv|readme|synthetic|IIB_Real \\[" \
        "-DIIB_SANITIZE=$sanitizers" -DCMAKE_CXX_FLAGS_RELEASE=-O1 "$@"
}

memcheck() {
    need valgrind
    build="$root/build-valgrind"
    # The baseline's kernels: valgrind knows no AVX-512, and the library asks the emulated processor what it has.
    configure -DIIB_BUILD_TOOLS=OFF -DCMAKE_BUILD_TYPE=RelWithDebInfo "$@"
    say "building opencv_test_iib"
    cmake --build "$build" --target opencv_test_iib
    valgrind --error-exitcode=1 --leak-check=no --quiet "$build/opencv_test_iib" \
        --gtest_filter='IIB_Golden*:IIB_Hamming*:IIB_Error*:IIB_IO*:IIB_Matcher.*:IIB_MatcherEdges*:IIB_MatcherFile*-*no_limit*'
}

# Before anything is installed: a mistake in the arguments.
case "${1:-}" in
--sanitize | --sanitize=valgrind | --sanitize=address,undefined | --sanitize=thread) ;;
-D?* | "") ;;
*) fail "$1 is neither -DNAME=VALUE for CMake nor one of --sanitize, --sanitize=address,undefined," \
    "--sanitize=thread and --sanitize=valgrind" ;;
esac
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
*)
    # the synthetic data, the evaluation's report, the Python package and apps/localization are tested where these are
    need povray python3-opencv python3-jinja2 python3-venv python3-dev python3-numpy libceres-dev libunwind-dev
    run "$root/build" '^$' -DIIB_BUILD_APPS=ON "$@"
    ;;
esac
