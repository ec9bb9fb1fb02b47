#!/bin/sh
# Builds the Debian packages in build/debian from a clean copy of the tracked files. Fails on lintian errors.
. "$(dirname "$0")/lib.sh"

[ $# = 0 ] || fail "takes no argument"
need $build_packages debhelper dpkg-dev fakeroot lintian
folder="$build/debian"
rm -rf "$folder"
mkdir -p "$folder/opencv-iib"
copy_tree "$folder/opencv-iib"
cd "$folder/opencv-iib"
say "building the packages"
dpkg-buildpackage -us -uc
say "lintian"
lintian --fail-on error --info "$folder"/*.changes
say "the packages: $(ls "$folder"/*.deb | tr '\n' ' ')"
