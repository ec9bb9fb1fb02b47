#!/bin/sh
# Cross-compiles the modules and their tests for another processor, and runs the tests of descriptors, matching, files and poses under
# qemu-user, including golden hashes.
#   scripts/helpers/emulated.sh arm64|armhf [--gtest_...]      64 bits with NEON; 32 bits without
#   scripts/helpers/emulated.sh arm64 --wheel                  the wheel for Debian's Python, and python/tests with it
# The architecture's packages come from the machine's apt mirror and are unpacked in the cache; the system's package database
# does not change. Options go to the test programs: scripts/helpers/emulated.sh arm64 --gtest_filter='IIB_Golden*'
. "$(dirname "$0")/lib.sh"

architecture="${1:-}"
case "$architecture" in
arm64) processor=aarch64 triplet=aarch64-linux-gnu qemu=qemu-aarch64-static ;;
armhf) processor=armv7l triplet=arm-linux-gnueabihf qemu=qemu-arm-static ;;
*) fail "takes arm64 or armhf, not '$architecture'" ;;
esac
shift
packages=libopencv-dev wheel=""
if [ "$architecture $*" = "arm64 --wheel" ]; then
    packages="python3-venv libpython3-dev libstdc++6" wheel=-python
    shift
fi
for argument in "$@"; do
    case "$argument" in
    --gtest_?*) ;;
    *) fail "$argument is neither an option --gtest_... of the test programs nor, with arm64, --wheel" ;;
    esac
done
need $build_packages "g++-$triplet" qemu-user-static xz-utils
version=$(dpkg-query -W -f '${source:Version}' libopencv-core-dev)
sysroot="$cache/$architecture-$version$wheel"

if [ ! -d "$sysroot" ]; then
    say "fetching $packages for $architecture"
    mkdir -p "$cache"
    work=$(mktemp -d "$cache/$architecture.XXXXXX")
    trap 'rm -rf "$work"' EXIT
    mkdir -p "$work/lists/partial" "$work/archives/partial" "$work/root/usr/lib" "$work/root/usr/bin"
    : >"$work/status"
    apt() {
        apt-get -q -o APT::Architecture="$architecture" -o APT::Architectures="$architecture" -o Dir::State::Lists="$work/lists" \
            -o Dir::State::status="$work/status" -o Dir::Cache="$work" -o APT::Sandbox::User="$(id -un)" \
            -o Debug::NoLocking=1 "$@"
    }
    apt update >"$work/log" 2>&1 || :  # one of several suites may be inconsistent for a while
    quietly "$work/log" apt -y --no-install-recommends --download-only install $packages
    # Only files, in the merged layout of /usr; no maintainer script runs.
    for folder in lib bin sbin; do
        ln -s "usr/$folder" "$work/root/$folder"
    done
    for package in "$work"/archives/*.deb; do
        dpkg-deb --fsys-tarfile "$package" | tar -x -C "$work/root" --keep-directory-symlink
    done
    mv "$work/root" "$sysroot"
fi

if [ -n "$wheel" ]; then
    # Only Python and its virtual environments run under qemu; CMake and the compilers are this machine's.
    python="$sysroot/usr/bin/python3-emulated"
    cat >"$python" <<EOF
#!/bin/sh
exec $qemu -0 "\$0" -L "$sysroot" "$sysroot/usr/bin/python3" "\$@"
EOF
    chmod +x "$python"
    export CMAKE_TOOLCHAIN_FILE="$sysroot/toolchain.cmake" CXXFLAGS="-idirafter $sysroot/usr/include"
    cat >"$CMAKE_TOOLCHAIN_FILE" <<EOF
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR $processor)
set(CMAKE_C_COMPILER $triplet-gcc)
set(CMAKE_CXX_COMPILER $triplet-g++)
EOF
    "$root/scripts/wheel.sh" "$python"
    environment="$root/build-$architecture-python"
    rm -rf "$environment"
    "$python" -m venv "$environment"
    "$environment/bin/pip" install --quiet --no-index --no-deps --find-links "$build/wheel" opencv-iib
    "$environment/bin/pip" install --quiet opencv-python-headless
    say "python/tests under qemu"
    cd "$root/python/tests"
    "$environment/bin/python" -m unittest discover
    say "README's Python program under qemu"
    sed -n '/^```python$/,/^```$/{/^```/!p;/^```$/q}' "$root/README.md" >"$environment/match_pair.py"
    "$environment/bin/python" "$environment/match_pair.py" "$root/tools/synthetic/day.png" "$root/tools/synthetic/night.png" |
        grep -x '[1-9][0-9]* matches'
    exit 0
fi

libraries="$sysroot/usr/lib/$triplet"
# Debian selects BLAS and LAPACK by alternatives, which maintainer scripts set.
path="$libraries:$libraries/blas:$libraries/lapack:$sysroot/usr/lib"
build="$root/build-$architecture"
configure -DIIB_BUILD_TOOLS=OFF "-DOpenCV_DIR=$libraries/cmake/opencv4" \
    -DCMAKE_SYSTEM_NAME=Linux "-DCMAKE_SYSTEM_PROCESSOR=$processor" "-DCMAKE_CXX_COMPILER=$triplet-g++" \
    "-DCMAKE_EXE_LINKER_FLAGS=-Wl,-rpath-link,$path" "-DCMAKE_SHARED_LINKER_FLAGS=-Wl,-rpath-link,$path"
programs="opencv_test_iib opencv_test_iib_index opencv_test_iib_geometry"
build_targets $programs
# Only a part of iib_geometry's tests, so that the step stays below 90 minutes.
poses="RelativePose*:Verdict*:Localization.under_changed_illumination:Alignment.finds_each_kind*"
# A 64-bit kernel returns positions in folders of ext4 that a 32-bit C library refuses; in memory file systems they are small.
[ ! -d /dev/shm ] || export OPENCV_TEMP_PATH=/dev/shm
for program in $programs; do
    say "$program under qemu"
    filter="*"
    [ "$program" != opencv_test_iib_geometry ] || filter=$poses
    "$qemu" -L "$sysroot" -E "LD_LIBRARY_PATH=$path" "$build/$program" "--gtest_filter=$filter" "$@"
done
