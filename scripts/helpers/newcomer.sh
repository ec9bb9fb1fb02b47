#!/bin/sh
# Runs every command of README.md and of the first program in doc/install.md, in order, on a bare Debian made by debootstrap, like someone
# who has just unpacked a release: the `sh` blocks except those for a wheel, with the files of the `cmake`, `cpp` and `python` blocks.
# The paths contain spaces. Needs root; the bare system stays in the cache.
#   scripts/helpers/newcomer.sh [SUITE] [WHEEL]    by default bookworm
# With a wheel of scripts/wheel.sh, only the commands for a wheel and the Python program, in a system without a compiler: from pip
# to the program's output in ten seconds of processor time, which other work on the machine hardly changes.
. "$(dirname "$0")/lib.sh"

wheel=""
case "${1:-}" in *.whl) set -- bookworm "$1" ;; esac
[ $# -le 2 ] || fail "takes one release and one wheel, not $*"
[ $# -lt 2 ] || { [ -f "$2" ] && wheel=$(readlink -f "$2"); } || fail "there is no wheel $2"
suite=${1:-bookworm}
check_suites "$suite"
[ "$(id -u)" = 0 ] || fail "a bare system can only be made and entered as root"
need debootstrap python3
bare="$cache/newcomer-$suite.tar"
mkdir -p "$cache"
work=$(mktemp -d "$cache/newcomer.XXXXXX")
trap 'rm -rf "$work"' EXIT
if [ ! -f "$bare" ]; then
    say "making a bare $suite"
    debootstrap --variant=minbase --include=ca-certificates,git,sudo "$suite" "$work/made" >"$cache/newcomer-$suite.log"
    tar -C "$work/made" -cf "$bare.new" .
    mv "$bare.new" "$bare"
    rm -rf "$work/made"
fi
mkdir "$work/root"
tar -C "$work/root" -xf "$bare"
reach_network "$work/root"

# The root is temporary: dpkg need not wait for the disk after each file.
echo force-unsafe-io >"$work/root/etc/dpkg/dpkg.cfg.d/newcomer"

home="$work/root/root"
mkdir "$home/the repository" "$home/my project"
copy_tree "$home/the repository"
cp "$root/tools/synthetic/day.png" "$root/tools/synthetic/night.png" "$home/my project"
# The blocks as files. Commands with match_pair belong to the user's own project.
"$python3" - "$root" "$home" <<'PYTHON'
import pathlib
import re
import sys

root, home = map(pathlib.Path, sys.argv[1:3])
install = (root / 'doc/install.md').read_text()
readme = (root / 'README.md').read_text() + install[install.index('## A first program'):install.index('## Where it was tested')]
names = {'cmake': 'CMakeLists.txt', 'cpp': 'match_pair.cpp', 'python': 'match_pair.py'}
blocks = re.findall(r'^```(sh|cmake|cpp|python)\n(.*?)^```$', readme, re.MULTILINE | re.DOTALL)
script = []
for language, text in blocks:
    if language == 'sh':
        if '.whl' not in text:
            script += ['cd "$HOME/%s"' % ('my project' if 'match_pair' in text else 'the repository'), text]
    elif not (home / 'my project' / names[language]).exists() and (language != 'cpp' or 'int main' in text):
        (home / 'my project' / names[language]).write_text(text)
(home / 'commands.sh').write_text('\n'.join(['set -ex', *script]))


def line(part):
    """The only line of the `sh` blocks with this in it."""
    found, = (line for language, text in blocks if language == 'sh' for line in text.splitlines() if part in line)
    return found


(home / 'wheel.sh').write_text(f"""set -ex
apt-get update
apt-get install --yes --no-install-recommends python3-venv
if command -v cc; then exit 1; fi
{line('-m venv')}
cd "$HOME/my project"
spent() {{ cut -d" " -f16,17 /proc/$$/stat | tr " " +; }}  # processor time of the commands that ended, in 10 ms
start=$(($(spent)))
{line('.whl')}
{line('match_pair.py')}
taken=$((($(spent) - start) * 10))
echo "README's Python program took $taken ms of processor time, pip's included"
[ $taken -lt 10000 ]
""")
PYTHON
[ -z "$wheel" ] || {
    cp "$wheel" "$home/my project"
    mv "$home/wheel.sh" "$home/commands.sh"
}
say "running the README's commands in $work/root"
(within "$work/root" "XDG_CACHE_HOME=/root/a cache" sh /root/commands.sh </dev/null 2>&1 || touch "$work/failed") | tee "$work/log"
[ ! -e "$work/failed" ] || exit 1
programs=2  # in Python and in C++
[ -z "$wheel" ] || programs=1
[ "$(grep -cx '[1-9][0-9]* matches' "$work/log")" = $programs ] || fail "not each of README's $programs programs found matches"
say "every command of the README ran"
