#!/bin/sh
# Tests python/examples/postgres.py with a real server of PostgreSQL in a temporary folder, reached by a socket in it alone.
# Skips with a word where no server is installed (Debian: postgresql).
#   scripts/helpers/postgres_test.sh PYTHON
# PYTHON: an interpreter that has the package and psycopg.
. "$(dirname "$0")/lib.sh"

[ $# = 1 ] || fail "takes an interpreter"
command -v "$1" >/dev/null 2>&1 || fail "there is no interpreter $1"
programs=$(dirname "$(ls /usr/lib/postgresql/*/bin/initdb 2>/dev/null | sort -V | tail -1)")
if [ ! -x "$programs/initdb" ]; then
    say "skipped: tests of PostgreSQL (no server is installed)"
    exit 0
fi
server=$(mktemp -d)
stop() {
    [ ! -f "$server/data/postmaster.pid" ] || as_postgres pg_ctl --mode immediate stop >/dev/null
    rm -rf "$server"
}
trap stop EXIT
trap 'exit 1' HUP INT TERM

# The server does not run as root.
as_user=""
if [ "$(id -u)" = 0 ]; then
    as_user="runuser -u postgres --"
    chown postgres "$server"
fi
as_postgres() {
    (
        program=$programs/$1
        shift
        cd "$server" && $as_user env PGDATA="$server/data" "$program" "$@"
    )
}
say "tests with PostgreSQL of $programs"
{
    as_postgres initdb --username postgres --auth trust --encoding UTF8 --no-locale --no-sync &&
        as_postgres pg_ctl --wait --log "$server/log" --options "-k $server -c listen_addresses= -c fsync=off" start
} >"$server/start" || {
    cat "$server/start" "$server/log" >&2
    exit 1
}
cd "$root/python/examples"
IIB_POSTGRES="host=$server user=postgres dbname=postgres" "$1" -m unittest test_postgres
