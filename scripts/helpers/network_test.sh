#!/bin/sh
# Tests Dask's workers whose network is cut while they work: each worker is in a network namespace of its own, all within
# one that ends with the tests. Needs root; skips with a word where no namespaces can be made.
#   scripts/helpers/network_test.sh PYTHON
# PYTHON: an interpreter that has the package and distributed.
. "$(dirname "$0")/lib.sh"

[ $# = 1 ] || fail "takes an interpreter"
command -v "$1" >/dev/null 2>&1 || fail "there is no interpreter $1"
if ! command -v ip >/dev/null; then
    say "skipped: tests of networks (no program ip: Debian's iproute2 has it)"
    exit 0
fi
# Names of namespaces are mounts below /run/netns: they need a mount namespace.
isolated() {
    unshare --net --mount sh -c 'mount -t tmpfs none /run && ip link set lo up && "$@"' sh "$@"
}
if ! isolated ip netns add probe 2>/dev/null; then
    say "skipped: tests of networks (network namespaces cannot be made here)"
    exit 0
fi
say "tests of networks"
cd "$root/python/tests"
IIB_NETWORK=1 isolated "$1" -m unittest test_network
