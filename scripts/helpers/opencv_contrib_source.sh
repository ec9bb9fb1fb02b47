#!/bin/sh
# Prints the folder of the newest OpenCV source with opencv_contrib beside it, from the source distribution of
# opencv-contrib-python, which pip brings into the cache once: `opencv` and `opencv_contrib` in that folder.
#   scripts/helpers/opencv_contrib_source.sh [MAJOR]      4, or 5; 4 unless it is said
# Delete the folder from the cache to look for a newer one.
. "$(dirname "$0")/lib.sh"

[ $# -le 1 ] || fail "takes one version, not $*"
major="${1:-4}"
case "$major" in
4 | 5) ;;
*) fail "takes the major version 4 or 5, not '$major'" ;;
esac
tree="$cache/opencv-contrib-$major"
mkdir -p "$cache"
exec 9>"$tree.lock"
flock 9

if [ ! -f "$tree/opencv/CMakeLists.txt" ]; then
    work=$(mktemp -d "$cache/fetch.XXXXXX")
    trap 'rm -rf "$work"' EXIT
    echo "fetching the source of opencv-contrib-python $major with pip" >&2
    {
        python3 -m venv "$work/venv" &&
            "$work/venv/bin/pip" download --no-deps --no-binary opencv-contrib-python --dest "$work" \
                "opencv-contrib-python>=$major,<$((major + 1))" &&
            mkdir "$work/tree" &&
            tar -xzf "$work"/opencv_contrib_python-*.tar.gz -C "$work/tree" --strip-components=1
    } >"$work/log" 2>&1 || {
        tail -n 5 "$work/log" >&2
        exit 1
    }
    rm -rf "$tree"
    mv "$work/tree" "$tree"
fi
echo "$tree"
