#!/bin/sh
# `.ci/nightly --document` and `table` in a small repository whose steps are stand-ins: failures are named, tests are counted, the tree
# stays as it was committed, and a table needs every step at one commit.
. "$(dirname "$0")/lib.sh"

[ $# = 0 ] || fail "takes no argument"
command -v git >/dev/null || {
    say "skipped: .ci/nightly --document (there is no git)"
    exit 0
}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$work/programs" "$work/tree/.ci" "$work/tree/scripts/helpers" "$work/tree/doc/results"
printf '#!/bin/sh\nprintf installed\n' >"$work/programs/dpkg-query"  # nothing is to be installed
printf '#!/bin/sh\nexit 0\n' >"$work/programs/apt-get"
cp "$root/.ci/nightly" "$work/tree/.ci"
cd "$work/tree"
unset GIT_DIR GIT_WORK_TREE GIT_INDEX_FILE
export GIT_CONFIG_GLOBAL=/dev/null  # which may ask for a key
cp "$root/scripts/helpers/lib.sh" scripts/helpers
cat >scripts/helpers/macos.sh <<'EOF2'
#!/bin/sh
echo "Ran 7 tests in 1.0s"
echo "== skipped: a mutant"
echo "264 of 264 mutants noticed"
EOF2
printf '#!/bin/sh\nprintf "one after the other..."\nexit 1\n' >scripts/helpers/package.sh  # its last line has no end
chmod +x "$work/programs"/* scripts/helpers/*
git init -q .
git add .
git -c user.name=test -c user.email=test commit -q -m "Stand-ins"
commit=$(git rev-parse --short HEAD)
export XDG_CACHE_HOME="$work/cache" PATH="$work/programs:$PATH" IIB_PYTHON=true
rows="$work/cache/opencv_iib/night"

# expect WHAT COMMAND...
expect() {
    what=$1
    shift
    "$@" || {
        echo "$what:" >&2
        cat "$work/out" >&2
        exit 1
    }
}

code=0
.ci/nightly --document macos package >"$work/out" 2>&1 || code=$?
expect "a night with a step that fails ends with 1, not $code" [ $code = 1 ]
expect "tests and mutants are counted" grep -qx "macos,$commit,[-0-9]* [:0-9]*,[01],271,passed" "$rows/macos"
expect "a failure is kept" grep -qx "package,$commit,[-0-9]* [:0-9]*,[01],0,failed" "$rows/package"
printf '#!/bin/sh\n' >scripts/helpers/package.sh
git -c user.name=test -c user.email=test commit -q -a -m "A package step that does nothing"
commit=$(git rev-parse --short HEAD)
! .ci/nightly --document package >"$work/out" 2>&1 || expect "a step that counts nothing does not pass" false
echo >new.sh
! .ci/nightly --document macos >"$work/out" 2>&1 || expect "a new file is not committed" false
expect "the message names git status" grep -q "git status" "$work/out"
rm new.sh
expect "the tree stays as it was" [ -z "$(git status --porcelain)" ]

steps=$(sed -n 's/^known="\(.*\)"$/\1/p' .ci/nightly)
for step in $steps; do
    echo "$step,$commit,2026-01-01 00:00,18,1,passed" >"$rows/$step"
done
expect "a whole night has a table" .ci/nightly table >"$work/out" 2>&1
git add .
git -c user.name=test -c user.email=test commit -q -m "The table"
expect "the table changes no code" .ci/nightly table >"$work/out" 2>&1
expect "the table has the steps" grep -q "^macos,$commit,.*,passed$" doc/results/night.csv
sed -i "s/passed/failed/" "$rows/bits"
sed -i "s/,$commit/,$(git rev-parse --short HEAD)/" "$rows/fuzz"
rm "$rows/wheel"
! .ci/nightly table >"$work/out" 2>&1 || expect "a night that lacks steps has no table" false
expect "failed, missing and other commits' steps are named" grep -q ": wheel bits fuzz$" "$work/out"
expect "a night that lacks something writes nothing" [ -z "$(git status --porcelain)" ]
echo "exit 0" >>scripts/helpers/macos.sh
git -c user.name=test -c user.email=test commit -q -a -m "Other code"
! .ci/nightly table >"$work/out" 2>&1 || expect "a night of other code has no table" false
expect "the commit of the night is named" grep -q "of other code, of $commit" "$work/out"
