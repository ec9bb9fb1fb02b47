#!/bin/sh
# `.ci/nightly --document` and `table` in a small repository whose steps are stand-ins: what failed is told, what was skipped is
# counted, the tree stays as it was committed, and only a whole night of one commit is one.
. "$(dirname "$0")/lib.sh"

[ $# = 0 ] || fail "takes no argument"
command -v git >/dev/null || {
    say "skipped: .ci/nightly --document (there is no git)"
    exit 0
}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$work/programs" "$work/tree/.ci" "$work/tree/scripts/helpers" "$work/tree/doc/results" "$work/tree/tools/pages"
printf '#!/bin/sh\nprintf installed\n' >"$work/programs/dpkg-query"  # nothing is to be installed
printf '#!/bin/sh\nexit 0\n' >"$work/programs/apt-get"
cp "$root/.ci/nightly" "$work/tree/.ci"
cd "$work/tree"
unset GIT_DIR GIT_WORK_TREE GIT_INDEX_FILE
export GIT_CONFIG_GLOBAL=/dev/null  # which may ask for a key
cp "$root/scripts/helpers/lib.sh" scripts/helpers
cat >scripts/helpers/macos.sh <<'EOF2'
#!/bin/sh
echo "== skipped: one thing"
echo "Ran 7 tests in 1.0s"
echo "OK (skipped=2)"
EOF2
printf '#!/bin/sh\nprintf "one after the other..."\nexit 1\n' >scripts/helpers/package.sh  # its last line has no end
printf '#!/bin/sh\n' >scripts/fuzz.sh  # has no executions to tell of
chmod +x "$work/programs"/* scripts/fuzz.sh scripts/helpers/*
echo "step,commit,started,minutes,counts,result" >doc/results/night.csv
git init -q .
git add .
git -c user.name=test -c user.email=test commit -q -m "Stand-ins"
commit=$(git rev-parse --short HEAD)
export XDG_CACHE_HOME="$work/cache" PATH="$work/programs:$PATH" IIB_PYTHON=true
rows="$work/cache/opencv_iib/night.csv"

# expect WHAT COMMAND...
expect() {
    what=$1
    shift
    "$@" || {
        echo "$what:" >&2
        cat "$work/out" "$rows" >&2
        exit 1
    }
}

code=0
.ci/nightly --document macos package >"$work/out" 2>&1 || code=$?
expect "a night with a step that fails ends with 1, not $code" [ $code = 1 ]
expect "tests are counted, and what was skipped" grep -qx "macos,$commit,[-0-9]* [:0-9]*,[01],7 tests (3 skipped),passed" "$rows"
expect "what failed is told" grep -qx "package,$commit,[-0-9]* [:0-9]*,[01],,failed" "$rows"
expect "the tree stays as it was" [ -z "$(git status --porcelain)" ]
echo >new.sh
! .ci/nightly --document macos >"$work/out" 2>&1 || expect "a new file is not committed" false
expect "the new file is told" grep -q "git status" "$work/out"
rm new.sh

! .ci/nightly table >"$work/out" 2>&1 || expect "two steps are no night" false
expect "a step that failed is told" grep -qx "package failed" "$work/out"
expect "a step that was not run is told" grep -qx "tests was not run" "$work/out"
expect "a night that lacks something writes nothing" [ -z "$(git status --porcelain)" ]
# night MINUTES APART: rows of a whole night, whose steps began so many minutes one after the other.
steps=$(sed -n 's/^known="\(.*\)"$/\1/p' .ci/nightly)
night() {
    start=1767225600  # of 2026
    for step in $steps; do
        echo "$step,$commit,$(date -u -d "@$start" '+%F %H:%M'),$1,1 tests,passed"
        start=$((start + 60 * $2))
    done >"$rows"
}
night 18 18
expect "a whole night is one" .ci/nightly table >"$work/out" 2>&1
git add .
git -c user.name=test -c user.email=test commit -q -m "The table"
expect "its table changes no code" .ci/nightly table >"$work/out" 2>&1
night 19 19
! .ci/nightly table >"$work/out" 2>&1 || expect "more than six hours are no night" false
night 35 17
expect "minutes of steps beside each other count once" .ci/nightly table >"$work/out" 2>&1
expect "the table has what was run" grep -q "^macos,$commit,.*,passed$" doc/results/night.csv
expect "the time of the whole night is told" grep -qx "all,,,358,," doc/results/night.csv
night 1 1
sed -i "/^python/s/1 tests/(1 skipped)/" "$rows"
! .ci/nightly table >"$work/out" 2>&1 || expect "where a step skipped all there is no night" false
expect "what counted nothing is told" grep -qx "python counted nothing" "$work/out"
night 1 1
sed -i "s/^bits,$commit/bits,$(git rev-parse --short HEAD)/" "$rows"
! .ci/nightly table >"$work/out" 2>&1 || expect "two commits are no night" false
git checkout -q .
echo "exit 0" >>scripts/fuzz.sh
git -c user.name=test -c user.email=test commit -q -a -m "Other code"
! .ci/nightly table >"$work/out" 2>&1 || expect "a night of other code is none" false
expect "what was run on other code is told" grep -qx "tests was run on other code, of $commit" "$work/out"
