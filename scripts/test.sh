#!/bin/sh
# Builds the modules and their tests against the installed OpenCV, in build/, and runs them. Lists skipped tests and why.
#   scripts/test.sh [--all] [--sanitize[=KIND]] [-DNAME=VALUE for CMake]...
# --all: also the long ones, which .ci/nightly runs (ctest's label `nightly`).
# --sanitize: under the address and undefined-behaviour sanitizers, then under the thread sanitizer, each in its own build
# folder, and the short ones in valgrind. KIND: one of address,undefined and thread and valgrind.
. "$(dirname "$0")/helpers/lib.sh"

# run BUILD CMAKE_ARGUMENT...: configures, builds and tests.
run() {
    build=$1
    shift
    configure -DIIB_BUILD_TESTS=ON "$@"
    say "building library, tests and tools"
    cmake --build "$build"
    [ -n "${OPENCV_TEST_DATA_PATH:-}" ] || say "OPENCV_TEST_DATA_PATH is not set: tests on real images skip"
    status=0
    ctest --test-dir "$build" --output-on-failure --parallel "$jobs" $chosen || status=$?
    say "skipped, and why"
    # GoogleTest's tests by name, and what scripts say.
    awk '/^\[ RUN / { name = $4 }
        /^\[ +SKIP +\]/ { sub(/^\[ +SKIP +\] */, ""); print name ": " $0 }
        /^== skipped: / { sub(/^== skipped: /, ""); print }' "$build/Testing/Temporary/LastTest.log" | sort -u
    return $status
}

sanitize() {
    sanitizers=$1
    shift
    export TSAN_OPTIONS="suppressions=$root/cmake/sanitizer/threads.supp"
    # The thread sanitizer is slow, and threads do not depend on instruction sets: it skips suites under a pin, NAME [PIN].
    [ "$sanitizers" != thread ] || chosen="$chosen --exclude-regex \\["
    # Recording where memory was allocated took a third of the time: set it to read a report.
    export ASAN_OPTIONS="malloc_context_size=0:${ASAN_OPTIONS:-}"
    # Little optimization, since instrumented code takes long to compile. Tools are tested at night.
    run "$root/build-$(echo "$sanitizers" | tr , -)" "-DIIB_SANITIZE=$sanitizers" "-DIIB_BUILD_TOOLS=$all" \
        -DCMAKE_CXX_FLAGS_RELEASE=-O1 "$@"
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

all=OFF chosen="--label-exclude nightly"
if [ "${1:-}" = --all ]; then
    all=ON chosen=""
    shift
fi
kind=""
case "${1:-}" in
--sanitize=valgrind | --sanitize=address,undefined | --sanitize=thread) kind=${1#--sanitize=} ;;
--sanitize) kind=every ;;
esac
[ -z "$kind" ] || shift
check_definitions "$@"
need $build_packages xz-utils
case "$kind" in
every)
    sanitize address,undefined "$@"
    sanitize thread "$@"
    memcheck "$@"
    ;;
valgrind) memcheck "$@" ;;
?*) sanitize "$kind" "$@" ;;
*)
    # the synthetic data, the evaluation's report, and the Python package are tested where these are
    need povray python3-opencv $pages_packages python3-venv python3-dev python3-numpy
    run "$root/build" -DIIB_BUILD_TOOLS=ON "$@"
    ;;
esac
