#!/bin/sh
# Learns a selection: scripts/train.sh --out=selection.yml FOLDER...; build/tools/training/iib_train --help lists the options.
# With --presets first it trains the built-in presets on tilde_webcam and amos_daynight, which lie in
# $OPENCV_TEST_DATA_PATH/illumination, and on the walks in FOLDER, which this renders:
# scripts/helpers/synthetic.sh FOLDER --scenes room terrain --frames 20 --quick
. "$(dirname "$0")/helpers/lib.sh"

if [ "${1:-}" = --presets ]; then
    shift
    data="${OPENCV_TEST_DATA_PATH:?the folder that holds illumination/}/illumination"
    set -- --presets="$root/modules/iib/src/descriptor/presets.generated.hpp" "$@" "$data/tilde_webcam" \
        "$data/amos_daynight"
fi
check_options "$root/tools/training/train.cpp" "$@"
[ "$operands" != 0 ] || fail "a FOLDER to train on is needed (--help tells more)"
need $build_packages
build_tools iib_train
exec "$build/tools/training/iib_train" "$@"
