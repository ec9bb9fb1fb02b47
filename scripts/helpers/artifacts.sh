#!/bin/sh
# Lists the wheels and the source distribution that scripts/wheel.sh (and emulated.sh arm64 --wheel) built, and the Debian packages of
# package.sh, with their bytes and SHA-256, in doc/results/artifacts.csv and in doc/releasing.md. All must be of this version, and as new as the
# step of the night in doc/results/night.csv that makes them.
. "$(dirname "$0")/lib.sh"

[ $# = 0 ] || fail "takes no argument"
version=$(project_version)
table="$root/doc/results/artifacts.csv"
work=$(mktemp)
trap 'rm -f "$work"' EXIT

# list STEP FILE...: rows of what this step made.
list() {
    step=$1
    shift
    started=$(sed -n "s/^$step,[^,]*,\([^,]*\),.*/\1/p" "$root/doc/results/night.csv")
    [ -n "$started" ] || fail "doc/results/night.csv has no step $step, before which nothing is a release's (doc/releasing.md)"
    for file in "$@"; do
        [ -f "$file" ] || fail "there is no $file: doc/releasing.md tells what makes it"
        [ -n "$(find "$file" -newermt "$started UTC")" ] || fail "$file is older than the night's step $step"
        echo "$(basename "$file"),$(wc -c <"$file"),$(sha256sum <"$file" | cut -d ' ' -f 1)"
    done
}

{
    echo "file,bytes,sha256"
    list wheel "$build/wheel/opencv_iib-$version"-*_x86_64.whl
    list arm64 "$build/wheel/opencv_iib-$version"-*_aarch64.whl
    list wheel "$build/wheel/opencv_iib-$version.tar.gz"
    list package "$build/debian"/*"_${version}_"*.deb
} >"$work"
cp "$work" "$table"
need $pages_packages
"$python3" -B "$root/tools/pages/pages.py"
