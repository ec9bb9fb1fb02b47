#!/bin/sh
# Tests python/examples/postgres.py with a real server of PostgreSQL in a temporary folder, reached by a socket in it alone.
# Skips with a word where no server is installed (Debian: postgresql).
#   scripts/helpers/postgres_test.sh [--debian13 [--document=FOLDER]] [PYTHON]
# PYTHON: an interpreter that has the package and psycopg; without it both are installed into a clean virtual
# environment, which takes minutes. --debian13: with Debian 13's server and pgvector, which debootstrap puts into the
# cache; needs root. --document: instead of tests, place recognition among the images of FOLDER (SET/SEQUENCE/1.png, 2.png
# and so on, of places in changing light) is measured, and the results go to doc/results, from where the table of
# doc/scale.md is made anew.
. "$(dirname "$0")/lib.sh"

system=""
case "${1:-}" in
--debian13)
    system="$cache/postgresql-trixie"
    shift
    ;;
esac
images=""
case "$system,${1:-}" in
?*,--document=?*)
    images=${1#*=}
    shift
    ;;
*,-*) fail "unknown option ${1%%=*}; there are --debian13, and after it --document=" ;;
esac
[ $# -le 1 ] || fail "takes one interpreter, not $*"
python="${1:-}"
[ -z "$python" ] || command -v "$python" >/dev/null 2>&1 || fail "there is no interpreter $python"
[ -z "$images" ] || check_folders "$images"

work=$(mktemp -d)
server=$work/server
mkdir "$server"
stop() {
    [ ! -f "$server/data/postmaster.pid" ] || as_postgres pg_ctl --mode immediate stop >/dev/null
    rm -rf "$work"
}
trap stop EXIT
trap 'exit 1' HUP INT TERM

if [ -n "$system" ]; then
    [ "$(id -u)" = 0 ] || fail "another Debian can only be made and entered as root"
    if [ ! -d "$system" ]; then
        need debootstrap
        say "making a Debian 13 with PostgreSQL"
        mkdir -p "$cache"
        rm -rf "$system.new"
        debootstrap --variant=minbase --include=postgresql-17,postgresql-17-pgvector trixie "$system.new" >"$system.log" ||
            fail "debootstrap failed: see $system.log"
        mv "$system.new" "$system"
    fi
    # A mount namespace of its own, so that nothing stays mounted; the server stays in it.
    as_postgres() {
        unshare --mount sh -c 'mount --bind "$2" "$1/mnt" && mount --rbind /dev "$1/dev" && mount -t proc proc "$1/proc" &&
            shift 2 && exec chroot --userspec=postgres "$0" "$@"' "$system" "$system" "$server" \
            /usr/bin/env -i PGDATA=/mnt/data sh -c 'cd /mnt && "/usr/lib/postgresql/17/bin/$0" "$@"' "$@"
    }
    chown "$(chroot "$system" id -u postgres)" "$server"
    sockets=/mnt
    say "tests with PostgreSQL of Debian 13"
else
    programs=$(dirname "$(ls /usr/lib/postgresql/*/bin/initdb 2>/dev/null | sort -V | tail -1)")
    if [ ! -x "$programs/initdb" ]; then
        say "skipped: tests of PostgreSQL (no server is installed)"
        exit 0
    fi
    # The server does not run as root.
    as_user=""
    if [ "$(id -u)" = 0 ]; then
        as_user="runuser -u postgres --"
        chown postgres "$server"
        chmod 755 "$work"
    fi
    as_postgres() {
        (
            program=$programs/$1
            shift
            cd "$server" && $as_user env PGDATA="$server/data" "$program" "$@"
        )
    }
    sockets=$server
    say "tests with PostgreSQL of $programs"
fi

if [ -z "$python" ]; then
    need $build_packages python3-venv python3-dev
    say "building the package"
    /usr/bin/python3 -m venv "$work/environment"
    python=$work/environment/bin/python
    "$python" -m pip install --quiet "$root" "psycopg[binary]" opencv-python-headless
fi

{
    as_postgres initdb --username postgres --auth trust --encoding UTF8 --no-locale --no-sync >"$work/log" &&
        as_postgres pg_ctl --wait --log "$sockets/log" --options "-k $sockets -c listen_addresses= -c fsync=off" start \
            >>"$work/log"
} || {
    cat "$work/log" "$server/log" >&2
    exit 1
}
export IIB_POSTGRES="host=$server user=postgres dbname=postgres"
if [ -n "$images" ]; then
    "$python" "$root/tools/scale/places.py" --images "$images" --out "$root/doc/results/places.json"
    /usr/bin/python3 "$root/scripts/helpers/figures.py" --write
else
    cd "$root/python/examples"
    "$python" -m unittest test_postgres
fi
