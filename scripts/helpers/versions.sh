#!/bin/sh
# Builds and tests the module in the OpenCV source of other Debian releases, each in its own root in the cache:
# scripts/helpers/versions.sh [suite...], by default trixie (OpenCV 4.10). newcomer.sh tests the stand-alone build. Needs root.
. "$(dirname "$0")/lib.sh"

check_suites "$@"
[ "$(id -u)" = 0 ] || fail "a root of another release can only be made and entered as root"
need debootstrap
mkdir -p "$cache"
[ $# -gt 0 ] || set -- trixie
for suite in "$@"; do
    base="$cache/debian-$suite"
    if [ ! -f "$base/etc/debian_version" ]; then
        say "making $base"
        rm -rf "$base.new"
        debootstrap --variant=minbase --include=ca-certificates "$suite" "$base.new" >"$cache/debian-$suite.log"
        mv "$base.new" "$base"
    fi
    reach_network "$base"
    say "copying the working tree into $base"
    rm -rf "$base/root/opencv_iib"
    mkdir -p "$base/root/opencv_iib"
    copy_tree "$base/root/opencv_iib"
    within "$base" sh -c "cd /root/opencv_iib && scripts/intree.sh"
    say "$suite: passed"
done
