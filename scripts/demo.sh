#!/bin/sh
# Matches two images of one scene, by default the project's own day and night pair, and writes a picture.
# scripts/demo.sh [imageA imageB] [--detector NAME] [--granularity G] [--homography FILE] [--out FILE]
. "$(dirname "$0")/lib.sh"

need $build_packages
build="$root/build-demo"
say "building the demo in $build"
{
    cmake -S "$root" -B "$build" -G Ninja -DIIB_BUILD_TESTS=OFF && cmake --build "$build" --target iib_demo
} >"$build.log" 2>&1 || {
    cat "$build.log" >&2
    exit 1
}

# Every option takes a value; what else there is are images.
images=0
value=no
for argument in "$@"; do
    case "$value$argument" in
    no-*) value=yes ;;
    no*) images=$((images + 1)) ;;
    *) value=no ;;
    esac
done
if [ $images = 0 ]; then
    pair="$root/tools/synthetic"
    set -- "$pair/day.png" "$pair/night.png" --homography "$pair/H_day_night" "$@"
fi
exec "$build/iib_demo" "$@"
