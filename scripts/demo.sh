#!/bin/sh
# Matches two images of one scene, with the detector's own descriptor and with IIB, and writes a picture; without images
# the project's day and night pair. The first run installs what is missing through apt and builds the library in build/.
#   scripts/demo.sh [IMAGE_A IMAGE_B] [--OPTION VALUE | --OPTION=VALUE]...
# Words are taken in any case. The options, with their defaults:
table="$(dirname "$0")/../modules/iib/samples/iib_demo_options.hpp"

more_help() {
    sed -n 's/^ *"{\([a-z]* *\)| *\([^|]*\) | \(.*\)}";*$/  --\1 \2 \3/p' "$table"
}

. "$(dirname "$0")/helpers/lib.sh"

check_options "$table" "$@"
case $operands in
0)
    pair="$root/tools/synthetic"
    set -- "$pair/day.png" "$pair/night.png" --homography "$pair/H_day_night" "$@"
    ;;
2) ;;
*) fail "two images are needed, not $operands (--help)" ;;
esac

# shellcheck disable=SC2086
need $build_packages
build_library iib_demo
exec "$build/iib_demo" "$@"
