#!/bin/sh
# Prints the folder of a small static OpenCV (core, imgproc, features2d, flann, calib3d) for the Python package, and builds it into
# the cache the first time, from the source that scripts/helpers/opencv_contrib_source.py brings. Installs nothing with apt.
#   scripts/helpers/static_opencv.sh [CMAKE_ARGUMENT...]
# CMAKE in the environment names another cmake. Delete the folder from the cache to build a newer one.
. "$(dirname "$0")/lib.sh"

before=""
for argument in "$@"; do
    case "$before$argument" in
    -D?* | -G*) ;;
    *) fail "$argument is not -DNAME=VALUE nor -G GENERATOR for CMake" ;;
    esac
    before=""
    [ "$argument" != -G ] || before=-G
done
cmake="${CMAKE:-cmake}"
prefix="$cache/opencv-static-4"
mkdir -p "$cache"
exec 8>"$prefix.lock"
flock 8

if [ ! -d "$prefix" ]; then
    # pip's isolated build hides other packages from every Python it starts, those of a new environment too.
    source=$(env -u PYTHONPATH "$root/scripts/helpers/opencv_contrib_source.py" 4)
    work="$prefix.build"  # stays if this is interrupted, so that the next call goes on from there
    # What CMake would look for on this machine, download, or build beside these modules.
    for feature in IPP ITT OPENCL LAPACK EIGEN VA KLEIDICV PROTOBUF FLATBUFFERS ADE QUIRC OBSENSOR 1394 FFMPEG GSTREAMER \
        V4L GTK JPEG PNG TIFF WEBP OPENJPEG JASPER OPENEXR AVIF; do
        set -- "$@" -DWITH_$feature=OFF
    done
    for part in TESTS PERF_TESTS EXAMPLES JAVA opencv_apps opencv_python3; do
        set -- "$@" -DBUILD_$part=OFF
    done
    say "building a static OpenCV in $work (once, about ten minutes)" >&2
    {
        "$cmake" -S "$source/opencv" -B "$work" "$@" -DCMAKE_BUILD_TYPE=Release -DCMAKE_INSTALL_LIBDIR=lib \
            -DBUILD_LIST=core,imgproc,features2d,flann,calib3d -DBUILD_SHARED_LIBS=OFF -DENABLE_PIC=ON -DBUILD_ZLIB=ON \
            -DOPENCV_GENERATE_PKGCONFIG=OFF &&
            "$cmake" --build "$work" --parallel "$jobs" &&
            "$cmake" --install "$work" --prefix "$prefix.new" &&
            cp "$source/opencv/LICENSE" "$source/opencv/COPYRIGHT" "$prefix.new/share/licenses/opencv4"
    } >"$prefix.log" 2>&1 || {
        tail -n 20 "$prefix.log" >&2
        exit 1
    }
    mv "$prefix.new" "$prefix"
    rm -rf "$work"
fi
echo "$prefix"
