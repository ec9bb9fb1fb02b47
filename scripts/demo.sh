#!/bin/sh
# Matches two images of one scene, with the detector's own descriptor and with IIB, and writes a picture; without images
# the project's day and night pair. The first run installs what is missing through apt and builds the library in build/.
#   scripts/demo.sh [IMAGE_A IMAGE_B] [--OPTION VALUE | --OPTION=VALUE]...
# Words are taken in any case. The options, with their defaults:
table="$(dirname "$0")/../modules/iib/samples/iib_demo_options.hpp"

# The program's own table of options, as lines "NAME | DEFAULT | TEXT".
option_table() {
    sed -n 's/^ *"{\([a-z]* *|[^|]*|.*\)}";*$/\1/p' "$table"
}

more_help() {
    option_table | while IFS='|' read -r name default text; do
        printf '  --%s %-13s %s\n' "$name" "$default" "$text"
    done
}

. "$(dirname "$0")/helpers/lib.sh"

# check OPTION VALUE: is there such an option, and does it take the value?
check() {
    line=$(option_table | sed -n "s/^$1 *|//p")
    [ -n "$line" ] || fail "unknown option --$1 (--help lists them)"
    [ -n "$2" ] || fail "option --$1 needs a value"
    case "$line" in
    *\[*)
        words=$(echo "$line" | sed 's/.*\[\(.*\)\].*/\1/')
        echo "$words" | tr ' ' '\n' | grep -qixF -e "$2" || fail "--$1 takes one of $words, not $2"
        ;;
    esac
    [ "$1" != homography ] || [ -r "$2" ] || fail "cannot read the homography file $2"
}

# Mistakes are told before anything is installed.
images=0
option=""
for argument in "$@"; do
    if [ -n "$option" ]; then
        check "$option" "$argument"
        option=""
        continue
    fi
    case "$argument" in
    --*=*)
        option=${argument%%=*}
        check "${option#--}" "${argument#*=}"
        option=""
        ;;
    --?*) option=${argument#--} ;;
    -*) fail "unknown option $argument (--help lists them)" ;;
    *)
        [ -r "$argument" ] || fail "cannot read the image $argument"
        images=$((images + 1))
        ;;
    esac
done
[ -z "$option" ] || check "$option" ""
case $images in
0)
    pair="$root/tools/synthetic"
    set -- "$pair/day.png" "$pair/night.png" --homography "$pair/H_day_night" "$@"
    ;;
2) ;;
*) fail "two images are needed, not $images (--help)" ;;
esac

# shellcheck disable=SC2086
need $demo_packages
build_library iib_demo
exec "$build/iib_demo" "$@"
