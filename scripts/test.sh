#!/bin/sh
# Builds the module and its tests against the installed OpenCV, in build/, and runs them all.
# Arguments go to CMake: scripts/test.sh -DOPENCV_SOURCE_DIR=... -DIIB_SANITIZE=address,undefined
. "$(dirname "$0")/lib.sh"

need $build_packages xz-utils
say "building in $root/build"
cmake -S "$root" -B "$root/build" -G Ninja "$@"
cmake --build "$root/build"
[ -n "${OPENCV_TEST_DATA_PATH:-}" ] || say "OPENCV_TEST_DATA_PATH is not set: tests on real images skip"
ctest --test-dir "$root/build" --output-on-failure --parallel "$jobs"
