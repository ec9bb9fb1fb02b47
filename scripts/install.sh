#!/bin/sh
# Builds the library in build/ and installs it with headers, CMake package and pkg-config file:
#   scripts/install.sh [--prefix=FOLDER]
# The folder is /usr/local or --prefix. Missing packages are installed through apt, and sudo is asked
# for if the user may not write.
. "$(dirname "$0")/helpers/lib.sh"

prefix=/usr/local
case $#,${1:-} in
0,) ;;
1,--prefix=?*) prefix=${1#--prefix=} ;;
2,--prefix) prefix=$2 ;;
*) fail "takes --prefix=FOLDER alone, not $*" ;;
esac
case "$prefix" in
/*) ;;
*) prefix="$PWD/$prefix" ;;
esac

need $build_packages
build_library iib_installed

# The nearest existing folder decides whether root is needed.
existing="$prefix"
while [ ! -d "$existing" ]; do
    existing=$(dirname "$existing")
done
as_root=""
[ -w "$existing" ] || as_root=sudo
say "installing in $prefix"
$as_root cmake --install "$build" --prefix "$prefix"
case "$prefix" in
/usr | /usr/local)
    # Adds the library to the loader's cache.
    $as_root ldconfig
    ;;
*)
    pc=$(find "$prefix" -name opencv_iib.pc)
    echo "A project finds it with"
    echo "  cmake -DCMAKE_PREFIX_PATH='$prefix' ..."
    echo "  export PKG_CONFIG_PATH='$(dirname "$pc")'"
    ;;
esac
