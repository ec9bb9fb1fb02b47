#!/bin/sh
# Renders the synthetic data (tools/synthetic/README.md) into a folder:
# scripts/helpers/synthetic.sh FOLDER [--frames N] [--scenes SCENE...] [--size W H] [--jobs N]
. "$(dirname "$0")/lib.sh"

[ $# -gt 0 ] || fail "a FOLDER is needed (see --help)"
for argument in "$@"; do
    case "$argument" in
    --*)
        grep -qF "add_argument(\"${argument%%=*}\"" "$root/tools/synthetic/render.py" ||
            fail "unknown option $argument (--help lists them)"
        ;;
    esac
done
need povray python3-opencv
exec "$python3" "$root/tools/synthetic/render.py" "$@"
