#!/bin/sh
# Calls every script with invalid arguments: each must say so in one line and end with code 2, before it installs,
# fetches or builds anything. Programs that would do that are replaced by one that records its call.
. "$(dirname "$0")/lib.sh"

[ $# = 0 ] || fail "takes no argument"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/programs"
for program in apt-get sudo cmake ninja pip python3 debootstrap clang-format clang++ doxygen povray unshare docker; do
    printf '#!/bin/sh\necho "%s $*" >>"%s"\nexit 1\n' $program "$work/called" >"$work/programs/$program"
    chmod +x "$work/programs/$program"
done
failed=0

# refused SCRIPT ARGUMENT...
refused() {
    code=0
    (cd "$root" && PATH="$work/programs:$PATH" XDG_CACHE_HOME="$work/cache" "$@" >"$work/out" 2>"$work/error") || code=$?
    if [ $code != 2 ] || [ "$(wc -l <"$work/error")" != 1 ] || [ -s "$work/out" ] || [ -e "$work/called" ] || [ -e "$work/cache" ]; then
        echo "$*: exit code $code" >&2
        cat "$work/out" "$work/error" "$work/called" >&2 2>/dev/null || :
        rm -rf "$work/called" "$work/cache"
        failed=1
    fi
}

cd "$root"
for script in scripts/*.sh scripts/helpers/*.sh .ci/run .ci/nightly; do
    case "$script" in */lib.sh) continue ;; esac
    refused "$script" --bogus-option
done
refused scripts/bench.sh --rounds=abc
refused scripts/bench.sh --rounds=0
refused scripts/bench.sh folder
refused scripts/demo.sh no-such.png no-such.png
refused scripts/demo.sh --detector=SURF
refused scripts/demo.sh --out picture.png
refused scripts/evaluate.sh
refused scripts/fuzz.sh no-such-target
refused scripts/fuzz.sh -s soon
refused scripts/intree.sh --source=nowhere
refused scripts/intree.sh --short unknown
refused scripts/test.sh --sanitize=nothing
refused scripts/test.sh --all unknown
refused scripts/train.sh
refused scripts/upstream.sh no-such-folder
refused scripts/upstream.sh --sizes
refused scripts/wheel.sh no-such-python
refused scripts/windows.sh unknown
refused scripts/helpers/emulated.sh s390x
refused scripts/helpers/emulated.sh arm64 unknown
refused scripts/helpers/newcomer.sh bookworm trixie
refused scripts/helpers/opencv_source.sh unknown
refused scripts/helpers/servers_test.sh no-such-python
refused scripts/helpers/python_test.sh no-such-library
refused scripts/helpers/versions.sh trixie/
refused .ci/nightly no-such-step

# No script uses the first python3 in the PATH (pyenv's, conda's), which may lack packages, or runs a Python program without
# naming an interpreter.
! grep -nE '(^|[(&|] *|^ +|quietly )((/usr/bin/)?python3|"?[^ ]*\.py"?) ' scripts/*.sh scripts/helpers/*.sh .ci/run .ci/nightly || failed=1
exit $failed
