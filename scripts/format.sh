#!/bin/sh
# Formats every C++ source with clang-format and .clang-format: scripts/format.sh [--check]
# --check changes nothing and fails where a file would change. Generated tables are left out.
# Versions format differently. 14.0.6 is used: Debian 12's, or pip's on other systems. Without either it prints a line.
. "$(dirname "$0")/helpers/lib.sh"

case "${1:-}" in
"") mode=-i ;;
--check) mode="--dry-run -Werror" ;;
*)
    echo "format.sh takes no argument but --check, not $1" >&2
    exit 2
    ;;
esac
version=14.0.6
# has PROGRAM: whether it is clang-format of that version.
has() { "$1" --version 2>/dev/null | grep -qwF "$version"; }

pinned="$cache/clang-format-$version/bin/clang-format"
if has clang-format; then
    clang_format=clang-format
elif has clang-format-14; then
    clang_format=clang-format-14
else
    clang_format=$pinned
    if ! has "$pinned"; then
        need python3-venv
        "$python3" -m venv "$cache/clang-format-$version"
        "$cache/clang-format-$version/bin/pip" --retries 0 --timeout 15 install --quiet "clang-format==$version" || {
            say "skipped: the format (there is no clang-format $version, neither here nor from pip)"
            exit 0
        }
    fi
fi
cd "$root"
git ls-files -z '*.cpp' '*.hpp' | grep -zv '\.generated\.hpp$' | xargs -0 "$clang_format" $mode
