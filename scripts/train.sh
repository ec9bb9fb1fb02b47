#!/bin/sh
# Learns a selection: scripts/train.sh --out=selection.yml FOLDER..., options with --help.
# With --presets first it trains the built-in presets on tilde_webcam and amos_daynight, which lie in
# $OPENCV_TEST_DATA_PATH/illumination.
. "$(dirname "$0")/lib.sh"

need $build_packages
say "building in $root/build"
cmake -S "$root" -B "$root/build" -G Ninja
cmake --build "$root/build" --target iib_train
case "${1:-}" in
--presets)
    shift
    data="${OPENCV_TEST_DATA_PATH:?the folder that holds illumination/}/illumination"
    exec "$root/build/tools/training/iib_train" --presets="$root/modules/iib/src/descriptor/presets.generated.hpp" "$@" \
        "$data/tilde_webcam" "$data/amos_daynight"
    ;;
*) exec "$root/build/tools/training/iib_train" "$@" ;;
esac
