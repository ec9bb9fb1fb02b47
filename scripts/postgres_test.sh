#!/bin/sh
# Tests opencv_iib.postgres with a real server of PostgreSQL in a temporary folder, reached by a socket in it alone.
# Skips with a word where no server is installed (Debian: postgresql).
#   scripts/postgres_test.sh [PYTHON]
# PYTHON: an interpreter that has the package and psycopg; without it both are installed into a clean virtual
# environment, which takes minutes.
. "$(dirname "$0")/lib.sh"

[ $# -le 1 ] || fail "takes one interpreter, not $*"
python="${1:-}"

programs=$(dirname "$(ls /usr/lib/postgresql/*/bin/initdb 2>/dev/null | sort -V | tail -1)")
if [ ! -x "$programs/initdb" ]; then
    say "skipped: tests of PostgreSQL (no server is installed)"
    exit 0
fi

work=$(mktemp -d)
server=$work/server
mkdir "$server"
# The server does not run as root.
as_user=""
if [ "$(id -u)" = 0 ]; then
    as_user="runuser -u postgres --"
    chown postgres "$server"
    chmod 755 "$work"
fi
stop() {
    [ ! -f "$server/data/postmaster.pid" ] || $as_user "$programs/pg_ctl" --pgdata "$server/data" --mode immediate stop >/dev/null
    rm -rf "$work"
}
trap stop EXIT

if [ -z "$python" ]; then
    need $build_packages python3-venv python3-dev
    say "building the package"
    /usr/bin/python3 -m venv "$work/environment"
    python=$work/environment/bin/python
    "$python" -m pip install --quiet "$root[postgres]" opencv-python-headless
fi

say "tests with PostgreSQL of $programs"
(
    cd "$server"
    $as_user "$programs/initdb" --pgdata "$server/data" --username postgres --auth trust --no-sync >"$work/log" &&
        $as_user "$programs/pg_ctl" --pgdata "$server/data" --wait --log "$server/log" \
            --options "-k $server -c listen_addresses= -c fsync=off" start >>"$work/log"
) || {
    cat "$work/log" "$server/log" >&2
    exit 1
}
cd "$root/python/tests"
IIB_POSTGRES="host=$server user=postgres dbname=postgres" "$python" -m unittest test_postgres
