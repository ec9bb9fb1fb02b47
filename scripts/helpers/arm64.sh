#!/bin/sh
# Cross-compiles the module and its tests for arm64 (NEON) and runs them under qemu-user: golden hashes included.
# The arm64 packages come from the machine's own apt mirror and are unpacked in the cache; the system's package
# database does not change. Arguments go to the test program: scripts/helpers/arm64.sh --gtest_filter='IIB_Golden*'
. "$(dirname "$0")/lib.sh"

for argument in "$@"; do
    case "$argument" in
    --gtest_?*) ;;
    *) fail "$argument is no option --gtest_... of the test program" ;;
    esac
done
need $build_packages g++-aarch64-linux-gnu qemu-user-static xz-utils
version=$(dpkg-query -W -f '${source:Version}' libopencv-core-dev)
sysroot="$cache/arm64-$version"

if [ ! -d "$sysroot" ]; then
    say "fetching libopencv-dev for arm64"
    work=$(mktemp -d "$cache/arm64.XXXXXX")
    trap 'rm -rf "$work"' EXIT
    mkdir -p "$work/lists/partial" "$work/archives/partial" "$work/root/usr/lib" "$work/root/usr/bin"
    : >"$work/status"
    apt() {
        apt-get -q -o APT::Architecture=arm64 -o APT::Architectures=arm64 -o Dir::State::Lists="$work/lists" \
            -o Dir::State::status="$work/status" -o Dir::Cache="$work" -o APT::Sandbox::User="$(id -un)" \
            -o Debug::NoLocking=1 "$@"
    }
    (
        apt update && apt -y --no-install-recommends --download-only install libopencv-dev
    ) >"$work/log" 2>&1 || {
        tail -n 5 "$work/log" >&2
        exit 1
    }
    # The files alone, in the merged layout of /usr; no maintainer script runs.
    for folder in lib bin sbin; do
        ln -s "usr/$folder" "$work/root/$folder"
    done
    for package in "$work"/archives/*.deb; do
        dpkg-deb --fsys-tarfile "$package" | tar -x -C "$work/root" --keep-directory-symlink
    done
    mv "$work/root" "$sysroot"
fi

libraries="$sysroot/usr/lib/aarch64-linux-gnu"
# Debian selects BLAS and LAPACK by alternatives, which maintainer scripts set.
path="$libraries:$libraries/blas:$libraries/lapack:$sysroot/usr/lib"
build="$root/build-arm64"
configure -DIIB_BUILD_TOOLS=OFF "-DOpenCV_DIR=$libraries/cmake/opencv4" \
    -DCMAKE_SYSTEM_NAME=Linux -DCMAKE_SYSTEM_PROCESSOR=aarch64 -DCMAKE_CXX_COMPILER=aarch64-linux-gnu-g++ \
    "-DCMAKE_EXE_LINKER_FLAGS=-Wl,-rpath-link,$path" "-DCMAKE_SHARED_LINKER_FLAGS=-Wl,-rpath-link,$path"
cmake --build "$build" --target opencv_test_iib

say "opencv_test_iib under qemu"
qemu-aarch64-static -L "$sysroot" -E "LD_LIBRARY_PATH=$path" "$build/opencv_test_iib" "$@"
