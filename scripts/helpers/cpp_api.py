#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0

"""Writes doc/api.md, the public names of the headers. What changed or went since the last release, of which header, class and
line, has its own name and its class's as `code` in one item of CHANGELOG.md's newest section, under "Backward incompatible" if it
was stable; changed bases of a class, and headers whose promise changed, have theirs. A release is a tag; before the first one, the last
commit `release: VERSION`. Where git knows neither (a shallow clone), that is since the last commit, or since the page was written.

It does not see what is the same in letters (another meaning, a macro's or constant's value), nor whether the item tells the truth.
"""
import argparse
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGE = ROOT / 'doc/api.md'
STABLE = 'stable: a minor version breaks it only with a word in the changelog and a way to change one\'s code'
MAY_CHANGE = 'may change: its names and answers are as new as its measurements'
HEADERS = {  # by folder, with what is promised
    'modules/iib/include': STABLE,
    'modules/iib_index/include': STABLE,
    'modules/iib_geometry/include': MAY_CHANGE,
}
MARKS = re.compile(r'\b(CV_EXPORTS(_\w+)?|CV_WRAP(_AS\s*\(\w+\))?|CV_OUT|CV_IN_OUT|CV_PROP(_RW)?)(?!\w)')


def declarations(text):
    """(depth, line) of each public class, member, function, enum and type of a header, without comments and bodies."""
    text = re.sub(r'//! @cond.*?//! @endcond', '', text, flags=re.DOTALL)
    text = re.sub(r'/\*.*?\*/|//[^\n]*', '', text, flags=re.DOTALL)
    text = re.sub(r'^\s*#(.*\\\n)*.*$', '', text, flags=re.MULTILINE)
    scopes, start, at = [], 0, 0  # of each scope its kind and whether what follows is public

    def closing(at):
        depth = 0
        while True:
            depth += {'{': 1, '}': -1}.get(text[at], 0)
            at += 1
            if not depth:
                return at

    def seen():
        return all(public for _, public in scopes)

    def line(end):
        head = re.sub(r'\s+', ' ', MARKS.sub('', text[start:end])).strip()
        head = re.sub(r' (?=[(),])|(?<=\() ', '', head) if '(' in head else head
        return re.sub(r'\)(?=[=\w])', ') ', head)

    def depth():
        return sum(kind == 'class' for kind, _ in scopes)

    while at < len(text):
        label = re.compile(r'\s*(public|protected|private)\s*:(?!:)').match(text, start) if start == at else None
        if label:
            scopes[-1] = ('class', label[1] == 'public')
            start = at = label.end()
            continue
        if text[at] == '{':
            head = line(at)
            if re.match(r'namespace\b', head):
                scopes.append(('namespace', True))
            elif re.match(r'(class|struct)\b', head) and '(' not in head:
                if seen():
                    yield depth(), head
                scopes.append(('class', head.startswith('struct')))
            elif head.startswith('enum') or head.count('(') != head.count(')') or head.endswith('='):
                at = closing(at)  # values belong to what is declared
                continue
            else:
                if seen():
                    yield depth(), re.sub(r'\)\s*:.*', ')', head) + ';'  # without a constructor's initializers
                start = at = closing(at)
                continue
            start = at = at + 1
        elif text[at] == '}':
            if not scopes:
                raise ValueError('a scope ends that has not begun: ' + line(at))
            scopes.pop()
            start = at = at + 1
        elif text[at] == ';':
            head = line(at)
            if head and seen() and not re.match(r'(class|struct) \w+$|using namespace', head):
                yield depth(), head + ';'
            start = at = at + 1
        else:
            at += 1


def page():
    lines = ['# Public names, and what is promised of them', '',
             'Made from the headers by `scripts/helpers/cpp_api.py`; a test fails where they differ. What is in `opencv2/iib/detail` is for the',
             'modules here, and no part of the interface. Files and bits: [releasing](releasing.md). Python and commands:',
             '[another list](api_python.md).']
    for folder, promise in HEADERS.items():
        for header in sorted((ROOT / folder).rglob('*.hpp')):
            found = [] if 'detail' in header.parts else list(declarations(header.read_text()))
            if found:
                lines += section(header.relative_to(ROOT / folder), promise, 'cpp', found)
    return '\n'.join(lines) + '\n'


def section(header, promise, language, found):
    return ['', '## %s' % header, promise[0].upper() + promise[1:] + '.', '', '```' + language,
            *('    ' * depth + text for depth, text in found), '```']


def promised(text):
    """What a page promises: (header, class, line) and whether it is stable. A header's own line is its promise's first word."""
    header, stable, owners, found = '', False, [], {}
    for line in text.splitlines():
        if line.startswith('## '):
            header, owners = line[3:], ['']
        elif re.match(r'(Stable|May change): ', line, re.IGNORECASE):
            stable = line.startswith('Stable')
            found[header, '', line.split(':')[0]] = stable
        elif header and line.strip() and not line.startswith('```'):
            owners = owners[:(len(line) - len(line.lstrip())) // 4 + 1]
            found[header, owners[-1], line.strip()] = stable
            if re.match(r' *(class|struct|command) ', line):
                owners.append(name(line))
    return found


def name(line):
    """What one would call a declaration: the word before its arguments, its bases, its values or its end; of a command, its option."""
    if line.startswith('-'):
        return line.split()[0]
    if line.startswith('typedef'):
        return re.search(r'(\w+);', line)[1]
    return re.search(r'(operator\S+?|~?\w+)(?=\()|\w+(?=;| = | \{|$| :)', line)[0]


def untold(before, after):
    """What a page promised, another does not, and the newest section of the changelog does not tell where it should."""
    newest = re.split(r'^## ', (ROOT / 'CHANGELOG.md').read_text(), flags=re.MULTILINE)[1]
    if newest.split()[0] == last_tag()[1:]:
        newest = ''  # the next one's does not stand yet
    breaking = re.search(r'^### Backward incompatible\n(.*?)(^### |\Z)', newest, re.MULTILINE | re.DOTALL)

    def told(text, *words):
        code = [' '.join(re.findall('`([^`]+)`', item)) for item in re.split(r'^- ', text, flags=re.MULTILINE)]
        return any(all(re.search(r'(?<![\w-])%s(?![\w-])' % re.escape(word), item) for word in words) for item in code)

    def kept(header, owner, line):  # an enum may grow at its end
        return any(there[:2] == (header, owner) and (there[2] == line or line.startswith('enum') and there[2].startswith(line[:-3] + ','))
                   for there in now)

    now, gone = promised(after), []
    for (header, owner, line), stable in promised(before).items():
        words = [name(line), owner or name(line)]
        if line in ('Stable', 'May change'):
            words = [header.split('/')[-1]]
        elif re.match(r'(class|struct) ', line):  # changed bases have names of their own
            others = [there[2] for there in now if there[:2] == (header, owner) and there[2].split()[:2] == line.split()[:2]]
            words += [base for other in others for base in set(re.findall(r'\w+(?=,|$)', line)) ^ set(re.findall(r'\w+(?=,|$)', other))]
        if not kept(header, owner, line) and not told((breaking[1] if breaking else '') if stable else newest, *words):
            gone.append('%s: %s%s' % (header, owner and owner + ': ', line))
    return gone


def git(*arguments):
    """What git says, nothing where it cannot."""
    try:
        return subprocess.run(['git', '-C', str(ROOT), *arguments], capture_output=True, text=True, check=True).stdout
    except (OSError, subprocess.CalledProcessError):
        return ''


def last_tag():
    return git('describe', '--tags', '--abbrev=0', '--match', 'v*').strip()


def released(path):
    """The page of the last release."""
    version = last_tag() or git('log', '-1', '--format=%H', '--extended-regexp', '--grep=^release: [0-9.]+$').strip() or 'HEAD'
    return git('show', version + ':./' + path.relative_to(ROOT).as_posix()) or (path.read_text() if path.exists() else '')


def main(description, path, after):
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--check', action='store_true', help='write nothing; an error where the page would change')
    check = parser.parse_args().check
    before = path.read_text() if path.exists() else ''
    if check and before != after:
        changed = sorted(set(before.splitlines()) ^ set(after.splitlines()))
        sys.exit('%s is not of these sources; %s writes it anew:\n%s' % (path.name, pathlib.Path(sys.argv[0]).name, '\n'.join(changed)))
    missing = untold(released(path), after)
    if missing:
        sys.exit('CHANGELOG.md does not tell, by their names and where it should, that these changed:\n' + '\n'.join(missing))
    if not check:
        path.write_text(after)


if __name__ == '__main__':
    main(__doc__, PAGE, page())
