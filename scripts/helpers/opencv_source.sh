#!/bin/sh
# Prints the folder of the OpenCV source of the installed libopencv-core-dev. The first run downloads it from the machine's apt
# mirror into the cache; the system's apt settings do not change.
. "$(dirname "$0")/lib.sh"

[ $# = 0 ] || fail "takes no argument"
version=$(dpkg-query -W -f '${source:Version}' libopencv-core-dev 2>/dev/null) || {
    echo "libopencv-core-dev is not installed as a Debian package" >&2
    exit 1
}
tree="$cache/opencv-$version"
mkdir -p "$cache"
exec 9>"$cache/source.lock"
flock 9

if [ ! -f "$tree/CMakeLists.txt" ]; then
    work=$(mktemp -d "$cache/fetch.XXXXXX")
    trap 'rm -rf "$work"' EXIT
    mkdir -p "$work/parts" "$work/lists/partial" "$work/tree"
    # The machine's binary entries, turned into source entries.
    for list in /etc/apt/sources.list /etc/apt/sources.list.d/*.list; do
        [ -f "$list" ] && sed -n 's/^deb[[:space:]]/deb-src /p' "$list" >"$work/parts/$(basename "$list" .list).list"
    done
    for list in /etc/apt/sources.list.d/*.sources; do
        [ -f "$list" ] && sed 's/^Types:.*/Types: deb-src/' "$list" >"$work/parts/$(basename "$list")"
    done
    apt() {
        apt-get -q -o Dir::Etc::SourceList=/dev/null -o Dir::Etc::SourceParts="$work/parts" \
            -o Dir::State::Lists="$work/lists" -o Dir::Cache="$work" -o APT::Sandbox::User="$(id -un)" "$@"
    }
    echo "fetching the source of opencv $version with apt" >&2
    cd "$work"
    quietly log apt update
    quietly log apt source --download-only --tar-only "opencv=$version"
    tar -xf opencv_*.orig.tar.* -C tree --strip-components=1
    mv "$work/tree" "$tree"
fi
echo "$tree"
