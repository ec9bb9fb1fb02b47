#!/bin/sh
# Renders the synthetic data (tools/synthetic/README.md) into a folder:
# scripts/synthetic.sh FOLDER [--frames N] [--scenes SCENE...] [--path-lights LIGHT...] [--size W H] [--jobs N]
. "$(dirname "$0")/lib.sh"

need povray python3-opencv
exec /usr/bin/python3 "$root/tools/synthetic/render.py" "$@"
