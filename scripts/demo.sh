#!/bin/sh
# Matches two images of one scene, with IIB and with ORB, and writes a picture; without images the project's day and night
# pair. The first run installs what is missing through apt and builds the library in build/.
#   scripts/demo.sh [IMAGE_A IMAGE_B] [--OPTION=VALUE]...
# The options, with their defaults:
table="$(dirname "$0")/../modules/iib/samples/iib_demo.cpp"

more_help() {
    sed -n 's/^ *"{\([a-z]* *\)| *\([^|]*\) | \(.*\)}";*$/  --\1 \2 \3/p' "$table"
}

. "$(dirname "$0")/helpers/lib.sh"

check_options "$table" "$@"
for argument in "$@"; do
    case "$argument" in
    --*=*) ;;
    -*) fail "$argument takes its value behind an equals sign, --option=value" ;;
    esac
done
case $operands in
0)
    pair="$root/tools/synthetic"
    set -- "$pair/day.png" "$pair/night.png" --homography="$pair/H_day_night" "$@"
    ;;
2) ;;
*) fail "two images are needed, not $operands (--help)" ;;
esac

# shellcheck disable=SC2086
need $build_packages
build_library iib_demo
exec "$build/iib_demo" "$@"
