#!/bin/sh
# Builds OpenCV's own source, as the distribution has it, with this module through
# OPENCV_EXTRA_MODULES_PATH, and runs the tests of C++, of speed (a smoke run) and of Python there.
. "$(dirname "$0")/lib.sh"

need $build_packages xz-utils libpng-dev zlib1g-dev python3-dev python3-numpy
source=$("$root/scripts/opencv_source.sh")
# One folder for all copies of the repository: another one's path rebuilds the module alone.
build="$source.intree"
exec 8>"$build.lock"
flock 8

say "building OpenCV with the module in $build (minutes for the first time)"
# OFF: what Debian's source lacks, then formats and back ends that nothing here reads.
# AVX512_ICL (VPOPCNTDQ) is not in OpenCV's default list.
cmake -S "$source" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release \
    -DOPENCV_EXTRA_MODULES_PATH="$root/modules" -DBUILD_LIST=iib,ts,python3,flann,calib3d \
    -DPYTHON3_EXECUTABLE=/usr/bin/python3 \
    -DCPU_DISPATCH="SSE4_1;SSE4_2;AVX;FP16;AVX2;AVX512_SKX;AVX512_ICL" \
    -DWITH_QUIRC=OFF -DWITH_PROTOBUF=OFF -DWITH_ADE=OFF -DWITH_IPP=OFF -DWITH_ITT=OFF \
    -DWITH_JPEG=OFF -DWITH_TIFF=OFF -DWITH_WEBP=OFF -DWITH_OPENJPEG=OFF -DWITH_JASPER=OFF -DWITH_OPENEXR=OFF \
    -DWITH_GTK=OFF -DWITH_QT=OFF -DWITH_VTK=OFF -DWITH_FFMPEG=OFF -DWITH_GSTREAMER=OFF -DWITH_V4L=OFF \
    -DWITH_1394=OFF -DWITH_EIGEN=OFF -DWITH_LAPACK=OFF -DWITH_VA=OFF -DBUILD_JAVA=OFF >"$build.log" 2>&1 || {
    tail -n 30 "$build.log" >&2
    exit 1
}
cmake --build "$build" --target opencv_test_iib opencv_perf_iib opencv_python3

say "opencv_test_iib, in-tree"
"$build/bin/opencv_test_iib"
say "opencv_perf_iib, in-tree, a smoke run"
"$build/bin/opencv_perf_iib" --perf_min_samples=1 --perf_force_samples=1
say "cv2.iib"
export PYTHONPATH="$build/lib/python3"
/usr/bin/python3 "$root/modules/iib/misc/python/test/test_iib.py" -v
say "the README's Python program, on the demo's pair"
sed -n '/^```python$/,/^```$/{/^```/!p}' "$root/README.md" >"$build/readme.py"
pair="$root/tools/synthetic"
/usr/bin/python3 "$build/readme.py" "$pair/day.png" "$pair/night.png" | grep -x '[1-9][0-9]* mutual matches'
