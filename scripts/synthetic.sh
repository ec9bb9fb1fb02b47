#!/bin/sh
# Renders the synthetic data (modules/iib/tools/synthetic/README.md) into a folder:
# scripts/synthetic.sh FOLDER [--frames N] [--scenes SCENE...] [--path-lights LIGHT...] [--size W H] [--jobs N]
. "$(dirname "$0")/lib.sh"

need povray python3-opencv
exec /usr/bin/python3 "$root/modules/iib/tools/synthetic/render.py" "$@"
