#!/bin/sh
# Compiles every source of the modules and their samples for macOS, arm64 and x86-64, with the clang of PyPI's ziglang and
# the headers of the installed OpenCV. Nothing is linked or run: scripts/helpers/macos.sh
. "$(dirname "$0")/lib.sh"

[ $# = 0 ] || fail "takes no arguments"
need $build_packages python3-venv
zig="$cache/zig/bin/python-zig"
[ -x "$zig" ] || {
    "$python3" -m venv "$cache/zig"
    "$cache/zig/bin/pip" install --quiet ziglang
}
for architecture in aarch64 x86_64; do
    build="$root/build-macos-$architecture"
    # Not as CMAKE_CXX_COMPILER, whose arguments would count as a change of an existing folder. CMake identifies the compiler by an
    # object file: before linking, zig would compile all of libc++.
    export CXX="$zig c++ -target $architecture-macos.11.0"
    configure -DCMAKE_SYSTEM_NAME=Darwin -DCMAKE_SYSTEM_PROCESSOR=$architecture -DCMAKE_BUILD_TYPE=Debug \
        -DCMAKE_CXX_COMPILER_ID_TEST_FLAGS_FIRST=-c \
        -DCMAKE_TRY_COMPILE_TARGET_TYPE=STATIC_LIBRARY -DCMAKE_INSTALL_NAME_TOOL=/bin/true \
        "-DOpenCV_DIR=$(pkg-config --variable=libdir opencv4)/cmake/opencv4" \
        -DCMAKE_COMPILE_WARNING_AS_ERROR=ON -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON -DIIB_BUILD_TESTS=OFF -DIIB_BUILD_TOOLS=OFF
    say "compiling in $build"
    ninja -C "$build" -t targets all | sed -n 's/^\(.*\.o\): CXX_COMPILER.*/\1/p' | xargs ninja -C "$build"
done
