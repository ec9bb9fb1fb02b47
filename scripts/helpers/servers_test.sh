#!/bin/sh
# Tests that need servers: python/examples/postgres.py with its own PostgreSQL; Dask workers that lose their network, each in
# its own namespace (root).
#   scripts/helpers/servers_test.sh PYTHON
# PYTHON: an interpreter that has the package, psycopg and distributed.
. "$(dirname "$0")/lib.sh"

[ $# = 1 ] || fail "takes an interpreter"
command -v "$1" >/dev/null 2>&1 || fail "there is no interpreter $1"
command -v pg_virtualenv >/dev/null || fail "no PostgreSQL is installed"
say "tests with PostgreSQL"
(cd "$root/python/examples" && IIB_POSTGRES=dbname=postgres pg_virtualenv -o fsync=off "$1" -m unittest test_postgres)

# Names of namespaces are mounts below /run/netns: they need a mount namespace.
isolated() {
    unshare --net --mount sh -c 'mount -t tmpfs none /run && ip link set lo up && "$@"' sh "$@"
}
isolated ip netns add probe || fail "Debian's iproute2 is missing, or network namespaces cannot be made here"
say "tests of networks"
cd "$root/python/tests"
IIB_NETWORK=1 isolated "$1" -m unittest test_network
