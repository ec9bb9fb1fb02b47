#!/bin/sh
# Matches two images of one place with IIB, SIFT and ORB, and writes a picture. Without images it takes a pair of this project:
# noon, and night from another place. The first run installs missing packages with apt and builds the library in build/.
#   scripts/demo.sh [IMAGE_A IMAGE_B] [--OPTION=VALUE]...
# The options, with their defaults:
table="$(dirname "$0")/../modules/iib/samples/iib_demo.cpp"

more_help() {
    sed -n 's/^ *"{\([a-z]* *\)| *\([^|]*\) | \(.*\)}";*$/  --\1 \2 \3/p' "$table"
}

. "$(dirname "$0")/helpers/lib.sh"

check_options "$table" "$@"
images=0
for argument in "$@"; do
    case "$argument" in
    --*=*) ;;
    -*) fail "$argument takes its value behind an equals sign, --option=value" ;;
    *)
        [ -e "$argument" ] || fail "there is no $argument"
        images=$((images + 1))
        ;;
    esac
done
case $images in
0)
    pair="$root/tools/synthetic"
    set -- "$pair/demo_noon.jpg" "$pair/demo_night.jpg" --homography="$pair/H_demo" --depth="$pair/demo_depth.png" "$@"
    ;;
2) ;;
*) fail "two images are needed, not $images (--help)" ;;
esac

need $build_packages
build_library iib_demo
exec "$build/iib_demo" "$@"
