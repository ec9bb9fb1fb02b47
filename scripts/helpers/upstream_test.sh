#!/bin/sh
# Creates the opencv_contrib branches in an empty repository. Checks that each keeps its size limit, the last equals modules/iib
# without test/real, and the first has the same golden bits. Exits with 77 outside of a clone.
. "$(dirname "$0")/lib.sh"

[ $# = 0 ] || fail "takes no argument"
git -C "$root" rev-parse --verify -q HEAD >/dev/null 2>&1 || exit 77
contrib=$(mktemp -d)
trap 'rm -rf "$contrib"' EXIT
contrib_checkout "$contrib"
"$root/scripts/upstream.sh" --sizes "$contrib"

git -C "$root" ls-files modules/iib | grep -v "^modules/iib/test/real/" | while read -r file; do
    cmp "$root/$file" "$contrib/$file"
done
[ "$(git -C "$contrib" ls-files modules/iib | wc -l)" = "$(git -C "$root" ls-files modules/iib | grep -vc "/test/real/")" ] ||
    fail "the last branch has other files than modules/iib"
hashes=$(sed -n 's/.*{\(0x[0-9a-f]\{16\}\),.*/\1/p' "$root/upstream/descriptor/test/test_descriptor.cpp")
[ "$(echo "$hashes" | wc -l)" -ge 10 ] || fail "upstream/descriptor has no golden bits"
for hash in $hashes; do
    grep -q "$hash" "$root/modules/iib/test/descriptor/test_descriptor_golden.cpp" || fail "modules/iib has no golden bits $hash"
done
