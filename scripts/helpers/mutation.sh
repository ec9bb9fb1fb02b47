#!/bin/sh
# Mutation testing: whether the tests notice each of the wrong lines in tools/mutation/mutants.txt; ends with an error
# if one survives. Takes a build and some 15 seconds a mutant on two cores.
# scripts/helpers/mutation.sh [--only NAME...]
. "$(dirname "$0")/lib.sh"

[ $# -eq 0 ] || [ "$1" = --only ] || fail "it takes no option but --only, not $1"
[ $# -ne 1 ] || fail "--only takes names of mutants"
for name in "$@"; do
    [ "$name" = --only ] || grep -q "^$name: " "$root/tools/mutation/mutants.txt" ||
        fail "there is no mutant $name in tools/mutation/mutants.txt"
done
need $build_packages python3
exec python3 "$root/tools/mutation/mutate.py" --source "$root" --work "$cache/mutation" "$@"
