#!/bin/sh
# Lists the wheels and the source distribution that scripts/wheel.sh (and emulated.sh arm64 --wheel) built, and the Debian packages of
# package.sh, with their bytes and SHA-256, in doc/results/artifacts.csv and in doc/releasing.md. All must be of this version.
. "$(dirname "$0")/lib.sh"

[ $# = 0 ] || fail "takes no argument"
version=$(project_version)
table="$root/doc/results/artifacts.csv"
work=$(mktemp)
trap 'rm -f "$work"' EXIT
for kind in "wheel/opencv_iib-$version-*_x86_64.whl" "wheel/opencv_iib-$version-*_aarch64.whl" "wheel/opencv_iib-$version.tar.gz" \
    "debian/*_${version}_*.deb"; do
    # shellcheck disable=SC2086
    ls "$build"/$kind >>"$work" 2>/dev/null || fail "there is no build/$kind: doc/releasing.md tells what makes it"
done
{
    echo "file,bytes,sha256"
    while read -r file; do
        echo "$(basename "$file"),$(wc -c <"$file"),$(sha256sum <"$file" | cut -d ' ' -f 1)"
    done <"$work"
} >"$table"
need $pages_packages
"$python3" -B "$root/tools/pages/pages.py"
