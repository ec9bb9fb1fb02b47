#!/bin/sh
# Tests what needs servers, and skips with a word what cannot be had here: python/examples/postgres.py with a PostgreSQL of its own;
# Dask's workers whose network is cut while they work, each in a network namespace, all within one that ends with the tests (root).
#   scripts/helpers/servers_test.sh PYTHON
# PYTHON: an interpreter that has the package, psycopg and distributed.
. "$(dirname "$0")/lib.sh"

[ $# = 1 ] || fail "takes an interpreter"
command -v "$1" >/dev/null 2>&1 || fail "there is no interpreter $1"
if command -v pg_virtualenv >/dev/null && ls /usr/lib/postgresql/*/bin/initdb >/dev/null 2>&1; then
    say "tests with PostgreSQL"
    (cd "$root/python/examples" && IIB_POSTGRES=dbname=postgres pg_virtualenv -o fsync=off "$1" -m unittest test_postgres)
else
    say "skipped: tests of PostgreSQL (no server is installed)"
fi

# Names of namespaces are mounts below /run/netns: they need a mount namespace.
isolated() {
    unshare --net --mount sh -c 'mount -t tmpfs none /run && ip link set lo up && "$@"' sh "$@"
}
if command -v ip >/dev/null && isolated ip netns add probe 2>/dev/null; then
    say "tests of networks"
    cd "$root/python/tests"
    IIB_NETWORK=1 isolated "$1" -m unittest test_network
else
    say "skipped: tests of networks (Debian's iproute2 is missing, or network namespaces cannot be made here)"
fi
