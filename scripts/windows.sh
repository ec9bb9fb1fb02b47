#!/bin/sh
# Cross-compiles OpenCV, the modules and their tests for Windows with Debian's MinGW, and runs the tests under Wine.
#   scripts/windows.sh [--gtest_...]
# OpenCV's source is that of the newest opencv-contrib-python 4, from pip: Debian's lacks PNG. The first run takes about half an
# hour on two cores.
. "$(dirname "$0")/helpers/lib.sh"

for argument in "$@"; do
    case "$argument" in
    --gtest_?*) ;;
    *) fail "$argument is no option --gtest_... of the test programs" ;;
    esac
done
need $compiler_packages g++-mingw-w64-x86-64-posix wine64 wine libz-mingw-w64-dev python3-venv
source="$("$python3" "$root/scripts/helpers/opencv_contrib_source.py" 4)/opencv"
toolchain="-DCMAKE_TOOLCHAIN_FILE=$root/cmake/mingw.cmake"
opencv="$cache/opencv-windows"

if [ ! -d "$opencv" ]; then
    say "cross-compiling OpenCV for Windows in $opencv.build (once)"
    off=""
    for feature in IPP ITT OPENCL OPENCLAMDFFT OPENCLAMDBLAS LAPACK EIGEN KLEIDICV PROTOBUF FLATBUFFERS ADE QUIRC \
        OBSENSOR FFMPEG GSTREAMER JPEG TIFF WEBP OPENJPEG JASPER OPENEXR AVIF MSMF DSHOW DIRECTX WIN32UI; do
        off="$off -DWITH_$feature=OFF"
    done
    for part in TESTS PERF_TESTS EXAMPLES JAVA opencv_apps opencv_python3; do
        off="$off -DBUILD_$part=OFF"
    done
    quietly "$opencv.log" cmake -S "$source" -B "$opencv.build" -G Ninja "$toolchain" $off -DCMAKE_BUILD_TYPE=Release \
        -DBUILD_LIST=core,imgproc,features2d,flann,calib3d,imgcodecs,videoio,highgui -DBUILD_PNG=ON -DBUILD_ZLIB=ON \
        -DCPU_DISPATCH= -DOPENCV_GENERATE_PKGCONFIG=OFF
    quietly "$opencv.log" cmake --build "$opencv.build" --parallel "$jobs"
    quietly "$opencv.log" cmake --install "$opencv.build" --prefix "$opencv.new"
    mv "$opencv.new" "$opencv"
    rm -rf "$opencv.build"
fi

build="$root/build-windows"
configure "$toolchain" "-DOPENCV_SOURCE_DIR=$source" "-DOpenCV_DIR=$opencv/lib/cmake/opencv4" -DIIB_BUILD_TESTS=ON -DIIB_BUILD_TOOLS=OFF
programs="opencv_test_iib opencv_test_iib_index opencv_test_iib_geometry"
build_targets $programs

# Where Windows looks for libraries: the build, OpenCV, and the compiler's own.
WINEPATH="$build;$opencv/bin;/usr/x86_64-w64-mingw32/lib"
WINEPATH="$WINEPATH;$(dirname "$(x86_64-w64-mingw32-g++-posix -print-file-name=libstdc++-6.dll)")"
export WINEPATH WINEDEBUG=-all WINEPREFIX="$cache/wine"
for program in $programs; do
    say "$program under Wine"
    wine "$build/$program.exe" "$@"
done
