#!/bin/sh
# Learns a selection: scripts/train.sh --out=selection.yml FOLDER...; build/tools/training/iib_train --help lists the options.
# With --presets or --presets=FILE first, it trains the built-in presets, in place or into FILE, on tilde_webcam and amos_daynight,
# which are in $OPENCV_TEST_DATA_PATH/illumination, and on the walks in FOLDER, which is WALKS/path of
# tools/synthetic/views.py WALKS/path --scenes room terrain --seed 0 --walk 20 --depth
. "$(dirname "$0")/helpers/lib.sh"

case "${1:-}" in
--presets | --presets=?*)
    presets=$1
    [ "$1" != --presets ] || presets="--presets=$root/modules/iib/src/descriptor/presets.generated.hpp"
    shift
    data="${OPENCV_TEST_DATA_PATH:?the folder that holds illumination/}/illumination"
    for sequence in tilde_webcam amos_daynight; do
        [ -d "$data/$sequence" ] || fail "the presets are learned from $data/$sequence, which is not there"
    done
    set -- "$presets" "$@" "$data/tilde_webcam" "$data/amos_daynight"
    ;;
esac
check_options "$root/tools/training/train.cpp" "$@"
[ $# != 0 ] || fail "a FOLDER to train on is needed (see --help)"
need $build_packages
build_tools iib_train
exec "$build/tools/training/iib_train" "$@"
