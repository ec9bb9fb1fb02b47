#!/bin/sh
# Builds OpenCV's own source with these modules through OPENCV_EXTRA_MODULES_PATH, and runs its C++ tests, its performance tests
# (a smoke run) and its Python tests.
#   scripts/intree.sh [--short] [--modules FOLDER] [--source debian|contrib|contrib-5] [options of CMake]
# --short: only what scripts/test.sh does not test: that the sources build here, give the same bits (golden tests)
# and the API of C++ and Python. OpenCV is built with little optimization and only for AVX512_ICL, for which it has no code
# itself.
# --modules: only the module iib of another folder: its C++ tests, and a smoke run of the descriptor's performance tests.
# debian: the distribution's source of its OpenCV. contrib: the newest OpenCV 4 with opencv_contrib's xfeatures2d,
# from the source distribution of opencv-contrib-python; contrib-5: the newest OpenCV 5 in the same way.
# JOBS limits the parallel jobs. The last line names the build's folder.
. "$(dirname "$0")/helpers/lib.sh"

dispatch="SSE4_1;SSE4_2;AVX;FP16;AVX2;AVX512_SKX;AVX512_ICL"
flags=-O3 tests="*" geometry="*" short="" quick=""
if [ "${1:-}" = --short ]; then
    # The widest instruction set of this machine, which a test needs.
    dispatch="AVX2"
    ! grep -qw avx512bw /proc/cpuinfo || dispatch="AVX512_SKX"
    ! grep -qw avx512_vpopcntdq /proc/cpuinfo || dispatch="AVX512_ICL"
    flags=-O1 short=.short
    tests="IIB_Golden*:IIB_IO*:IIB_Errors*:IIB_Input*:IIB_KeyPoints*:IIB_MatcherCreate*:IIB_MatcherEdges*:IIB_IndexFile*:IIB_InstructionSets*"
    tests="$tests-*upper_halves*" # which compilers free from -O2 on
    geometry="RelativePose*:Verdict*:Alignment*:Localization*"
    # Most of the compile time goes into OpenCV's headers, and with ccache OpenCV precompiles none.
    quick="-DENABLE_PRECOMPILED_HEADERS=ON -DENABLE_CCACHE=OFF -DCMAKE_CXX_COMPILER_LAUNCHER= -DWITH_OPENCL=OFF"
    shift
fi
modules=""
if [ "${1:-}" = --modules ]; then
    modules=${2:-}
    [ -d "$modules/iib" ] || fail "there is no module iib in '$modules'"
    shift 2
fi
kind=debian
case "${1:-}" in
--source)
    kind="${2:-}"
    shift $(($# > 1 ? 2 : 1))
    ;;
--source=*)
    kind="${1#--source=}"
    shift
    ;;
esac
check_definitions "$@"

extra_modules="${modules:-$root/modules}"
list=iib,ts,flann,calib3d,imgcodecs
[ -n "$modules" ] || list=$list,iib_index,iib_geometry,python3
case "$kind" in
debian)
    need $build_packages xz-utils libpng-dev zlib1g-dev python3-dev python3-numpy
    source=$("$root/scripts/helpers/opencv_source.sh")
    build="$source.intree$short"
    # Files that Debian's source lacks.
    options="-DWITH_QUIRC=OFF -DWITH_PROTOBUF=OFF -DWITH_ADE=OFF -DWITH_JPEG=OFF"
    ;;
contrib | contrib-5)
    need $build_packages libpng-dev libjpeg-dev zlib1g-dev python3-dev python3-numpy python3-venv
    major=4
    [ "$kind" = contrib ] || major=5
    source=$("$python3" "$root/scripts/helpers/opencv_contrib_source.py" "$major")
    build="$source.intree$short"
    # Only xfeatures2d of opencv_contrib: CMake reads every module of a given folder.
    mkdir -p "$source/chosen"
    ln -sfn "$source/opencv_contrib/modules/xfeatures2d" "$source/chosen/xfeatures2d"
    extra_modules="$source/chosen;$extra_modules"
    list="$list,xfeatures2d,imgcodecs"
    source="$source/opencv"
    # Downloads nothing: without their tables, BoostDesc and VGG throw when they are created.
    options="-DOPENCV_SKIP_FEATURES2D_DOWNLOADING=ON -DWITH_PROTOBUF=OFF -DWITH_ADE=OFF -DWITH_QUIRC=OFF"
    options="$options -DWITH_AVIF=OFF -DWITH_OBSENSOR=OFF -DWITH_FLATBUFFERS=OFF -DWITH_OPENCL=OFF"
    ;;
*)
    fail "--source takes debian, contrib or contrib-5, not '$kind'"
    ;;
esac

# All checkouts share one folder: a change of checkout rebuilds only the module.
exec 8>"$build.lock"
flock 8

say "building OpenCV with the module in $build (minutes for the first time)"
# Python by its whole path, since CMake takes a name for a file in this folder. OFF: formats and back ends that are not used
# here. AVX512_ICL (VPOPCNTDQ) is not in OpenCV's default list.
quietly "$build.log" cmake -S "$source" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release \
    -DOPENCV_EXTRA_MODULES_PATH="$extra_modules" -DBUILD_LIST="$list" \
    "-DPYTHON3_EXECUTABLE=$(command -v "$python3")" \
    -DCPU_DISPATCH="$dispatch" -DCMAKE_CXX_FLAGS_RELEASE="$flags -DNDEBUG" $options $quick \
    -DWITH_IPP=OFF -DWITH_ITT=OFF \
    -DWITH_TIFF=OFF -DWITH_WEBP=OFF -DWITH_OPENJPEG=OFF -DWITH_JASPER=OFF -DWITH_OPENEXR=OFF \
    -DWITH_GTK=OFF -DWITH_QT=OFF -DWITH_VTK=OFF -DWITH_FFMPEG=OFF -DWITH_GSTREAMER=OFF -DWITH_V4L=OFF \
    -DWITH_1394=OFF -DWITH_EIGEN=OFF -DWITH_LAPACK=OFF -DWITH_VA=OFF -DBUILD_JAVA=OFF "$@"
if [ -n "$modules" ]; then
    cmake --build "$build" --parallel "${JOBS:-$jobs}" --target opencv_test_iib opencv_perf_iib
    "$build/bin/opencv_test_iib" "--gtest_filter=*${short:+-*upper_halves*}"  # as above
    "$build/bin/opencv_perf_iib" --perf_min_samples=1 --perf_force_samples=1 --gtest_filter='IIB_Describe_*'
    exit 0
fi
cmake --build "$build" --parallel "${JOBS:-$jobs}" --target opencv_test_iib opencv_test_iib_index opencv_test_iib_geometry opencv_perf_iib opencv_python3

say "the libraries' symbols, in-tree"
for library in iib iib_index iib_geometry; do
    cmake "-DLIBRARY=$build/lib/libopencv_$library.so" -DNM=nm -P "$root/cmake/SymbolTest.cmake"
done
say "the modules' tests, in-tree"
"$build/bin/opencv_test_iib" --gtest_filter="$tests"
"$build/bin/opencv_test_iib_index"
"$build/bin/opencv_test_iib_geometry" --gtest_filter="$geometry"
[ -n "$short" ] || {
    say "opencv_perf_iib, in-tree, a smoke run"
    "$build/bin/opencv_perf_iib" --perf_min_samples=1 --perf_force_samples=1
}
say "cv2.iib"
export PYTHONPATH="$build/python_loader"
"$python3" "$root/modules/iib/misc/python/test/test_iib.py" -v
"$python3" "$root/python/tests/cv2_more.py" -v
say "the names that python/tests/test_names.py looks for"
"$python3" "$root/python/tests/cv2_names.py" >"$build/cv2_names.txt"
diff "$root/python/tests/cv2_names.txt" "$build/cv2_names.txt"
say "the tutorial's Python program, on the demo's pair"
sed -n '/^```python$/,/^```$/{/^```/!{/^import opencv_iib$/d;s/^# opencv_iib = /opencv_iib = /;p}}' "$root/modules/iib/tutorials/iib_day_night.markdown" >"$build/day_night.py"
pair="$root/tools/synthetic"
"$python3" "$build/day_night.py" "$pair/day.png" "$pair/night.png" >"$build/day_night.txt"
grep -x '[1-9][0-9]* of [0-9]* matches agree with' "$build/day_night.txt"
say "done: $build"
