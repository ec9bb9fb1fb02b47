#!/bin/sh
# Formats every C++ source with clang-format and .clang-format: scripts/format.sh [--check]
# --check changes nothing and ends with an error where a file would change. Generated tables are left out.
. "$(dirname "$0")/helpers/lib.sh"

case "${1:-}" in
"") mode=-i ;;
--check) mode="--dry-run -Werror" ;;
*)
    echo "format.sh takes no argument but --check, not $1" >&2
    exit 2
    ;;
esac
need clang-format
cd "$root"
# shellcheck disable=SC2086
git ls-files -z '*.cpp' '*.hpp' | grep -zv '\.generated\.hpp$' | xargs -0 clang-format $mode
