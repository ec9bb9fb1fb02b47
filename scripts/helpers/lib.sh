# shellcheck shell=sh
# Shared by all scripts; sourced first, with the script's own arguments. Sets root (the repository), cache, build
# and jobs. Answers --help with the comment at the head of the script, and the output of its function more_help if
# it has one, before it installs or builds anything.
set -eu
root=$(cd "$(dirname "$0")" && pwd)
root=${root%/helpers}
root=${root%/*}  # of scripts/ or .ci/
cache="${XDG_CACHE_HOME:-$HOME/.cache}/opencv_iib"
jobs=$(getconf _NPROCESSORS_ONLN)

# The Python of every script: the system's, for which apt installs packages, even if pyenv or conda comes first in the PATH.
python3=${IIB_PYTHON:-/usr/bin/python3}
[ -n "${IIB_PYTHON:-}" ] || [ -x "$python3" ] || python3=python3

for argument in "$@"; do
    case "$argument" in
    -h | --help)
        sed -n '2,${/^#/!q;s/^# \{0,1\}//p}' "$0"
        ! command -v more_help >/dev/null || more_help
        exit 0
        ;;
    esac
done

say() { echo "== $*"; }

# fail MESSAGE: reports a user's mistake in one line, status 2.
fail() {
    echo "$(basename "$0"): $*" >&2
    exit 2
}

# check_options SOURCE ARGUMENT...: checks that the tool with these KEYS in its source has the options, before anything is
# installed for it. The tool checks their values itself.
check_options() {
    keys=$(sed -n 's/^ *"{\([a-z-]*\) *|.*/\1/p' "$1")
    shift
    for argument in "$@"; do
        name=${argument%%=*}
        case "$argument" in
        -*) echo "$keys" | grep -qxF -e "${name#--}" || fail "unknown option $name; there are $(echo "$keys" | sed '/./s/^/--/' | paste -sd' ')" ;;
        esac
    done
}

# check_definitions ARGUMENT...: checks that each is a definition for CMake.
check_definitions() {
    for argument in "$@"; do
        case "$argument" in
        -D?*) ;;
        *) fail "$argument is not -DNAME=VALUE for CMake (see --help)" ;;
        esac
    done
}

# check_suites SUITE...: checks that each may be the name of a release of Debian or Ubuntu.
check_suites() {
    for suite in "$@"; do
        case "$suite" in
        *[!a-z]*) fail "$suite is not the name of a release, such as trixie" ;;
        esac
    done
}

# Finds the images of the tests, if they are beside the repository.
find_data() {
    if [ -z "${OPENCV_TEST_DATA_PATH:-}" ] && [ -d "$root/../shared/data" ]; then
        OPENCV_TEST_DATA_PATH=$(cd "$root/../shared/data" && pwd)
        export OPENCV_TEST_DATA_PATH
    fi
}

# need PACKAGE...: installs missing Debian packages.
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
# With make, CMake's default, like README's own project.
compiler_packages="g++ cmake make ninja-build"
build_packages="$compiler_packages pkg-config libopencv-dev"
pages_packages="python3-pandas python3-jinja2 python3-matplotlib"  # of tools/pages

# Demo, installation, tests and tools share one build folder, so that the library is compiled once.
build="$root/build"

# configure CMAKE_ARGUMENT...: prints only what a person should read. An existing folder keeps its generator and its targets.
new_folder=""
configure() {
    [ -f "$build/CMakeCache.txt" ] || set -- -G Ninja $new_folder "$@"
    say "configuring $build"
    cmake -S "$root" -B "$build" --log-level=NOTICE "$@"
}

# build_targets TARGET...: builds targets of the configured folder.
build_targets() {
    say "building $*"
    cmake --build "$build" --target "$@"
}

# build_library TARGET...: builds the library and targets that need nothing else. A new folder gets neither tests nor tools.
build_library() {
    new_folder="-DIIB_BUILD_TESTS=OFF -DIIB_BUILD_TOOLS=OFF"
    configure
    build_targets "$@"
}

# quietly LOG COMMAND...: prints the end of the log only if the command fails.
quietly() {
    log=$1
    shift
    "$@" >"$log" 2>&1 || {
        tail -n 30 "$log" >&2
        exit 1
    }
}

# copy_tree FOLDER: copies the files that git tracks or would add into an existing folder.
copy_tree() {
    git -C "$root" ls-files -z --cached --others --exclude-standard | tar -C "$root" --null -T - -c | tar -C "$1" -x
}

# reach_network ROOT: gives a system in a folder this one's host names, and its configuration of pip and certificates if any.
reach_network() {
    for file in /etc/resolv.conf /etc/hosts /etc/pip.conf /etc/ssl/certs/ca-certificates.crt; do
        [ ! -f $file ] || cp $file "$1$file"
    done
}

# within ROOT [NAME=VALUE]... COMMAND...: runs in that system, in a separate mount namespace, so that nothing stays mounted.
within() {
    system=$1
    shift
    unshare --mount sh -c 'mount -t proc proc "$1/proc" && exec chroot "$@"' sh "$system" /usr/bin/env -i HOME=/root \
        PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin "$@"
}

# contrib_checkout FOLDER: makes a repository that stands in for opencv_contrib.
contrib_checkout() {
    git init -q "$1"
    git -C "$1" config user.name test
    git -C "$1" config user.email test
    mkdir "$1/modules"
    echo "modules of opencv_contrib" >"$1/modules/README.md"
    git -C "$1" add modules
    git -C "$1" commit -q -m "A checkout of opencv_contrib"
}

project_version() { sed -n 's/^project(opencv_iib VERSION \([0-9.]*\).*/\1/p' "$root/CMakeLists.txt"; }

# The measured commit; "dirty" if files other than those with figures differ from it.
measured_commit() {
    commit=$(git -C "$root" rev-parse --short HEAD 2>/dev/null) || commit=unknown
    [ "$commit" = unknown ] || git -C "$root" diff --quiet HEAD -- . ':!doc' ':!README.md' || commit="$commit, dirty"
    echo "$commit"
}

# The argument of configure that gives the tools the descriptors of opencv_contrib.
contrib_argument() {
    need python3-venv >&2
    contrib=$("$python3" "$root/scripts/helpers/opencv_contrib_source.py" 4)
    echo "-DIIB_CONTRIB_SOURCE=$contrib"
}

# build_tools [-DNAME=VALUE]... TARGET...: builds programs of tools/, below $build/tools.
build_tools() {
    new_folder="-DIIB_BUILD_TESTS=OFF"
    definitions=""
    while [ "${1#-D}" != "$1" ]; do
        definitions="$definitions $1"
        shift
    done
    configure -DIIB_BUILD_TOOLS=ON $definitions
    build_targets "$@"
}
