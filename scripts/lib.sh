# shellcheck shell=sh
# Shared by the scripts here; sourced, not run. Sets root (the repository) and cache.
set -eu
root=$(cd "$(dirname "$0")/.." && pwd)
cache="${XDG_CACHE_HOME:-$HOME/.cache}/opencv_iib"
jobs=$(getconf _NPROCESSORS_ONLN)

say() { echo "== $*"; }

# need PACKAGE...: installs those Debian packages that are missing.
need() {
    if ! command -v apt-get >/dev/null || ! command -v dpkg-query >/dev/null; then
        say "no apt on this system; these Debian packages, or what equals them, must be there: $*"
        return
    fi
    missing=""
    for package in "$@"; do
        [ "$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null)" = installed ] ||
            missing="$missing $package"
    done
    [ -n "$missing" ] || return 0
    as_root=""
    if [ "$(id -u)" != 0 ]; then
        command -v sudo >/dev/null || {
            echo "missing packages, and neither root nor sudo to install them:$missing" >&2
            exit 1
        }
        as_root=sudo
    fi
    say "installing with apt:$missing"
    $as_root apt-get -q update
    $as_root env DEBIAN_FRONTEND=noninteractive apt-get -q -y install --no-install-recommends $missing
}

# The stand-alone build of the whole project.
build_packages="g++ cmake ninja-build pkg-config libopencv-dev"
