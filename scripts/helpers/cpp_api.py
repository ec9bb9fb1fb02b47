#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0

"""Writes doc/api.md, the public names of the headers. A signature that changed or went is written only if the newest section of
CHANGELOG.md has its name, so that no user meets a change that nobody told.
"""
import argparse
import pathlib
import re
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
             'modules here, and no part of the interface. Files and bits: [releasing](releasing.md).']
    for folder, promise in HEADERS.items():
        for header in sorted((ROOT / folder).rglob('*.hpp')):
            found = [] if 'detail' in header.parts else list(declarations(header.read_text()))
            if found:
                lines += ['', '## %s' % header.relative_to(ROOT / folder), promise[0].upper() + promise[1:] + '.', '', '```cpp']
                lines += ['    ' * depth + text for depth, text in found] + ['```']
    return '\n'.join(lines) + '\n'


def names(line):
    """What one would call a declaration: the word before its arguments, its members or its end."""
    return re.findall(r'\w+(?=\()|\w+(?=;| = | \{|$| :)', line)[:1]


def untold(before, after):
    """Signatures that are no longer there and of whose name the newest section of the changelog says nothing."""
    newest = re.split(r'^## ', (ROOT / 'CHANGELOG.md').read_text(), flags=re.MULTILINE)[1]
    gone = [line.strip() for line in before.splitlines() if line.strip() and line not in after.splitlines()]
    return [line for line in gone if line.endswith((';', '}')) and not any(re.search(r'\b%s\b' % name, newest) for name in names(line))]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--check', action='store_true', help='write nothing; an error where the page would change')
    check = parser.parse_args().check
    before, after = PAGE.read_text() if PAGE.exists() else '', page()
    if check and before != after:
        changed = sorted(set(before.splitlines()) ^ set(after.splitlines()))
        sys.exit('doc/api.md is not of these headers; scripts/helpers/cpp_api.py writes it anew:\n' + '\n'.join(changed))
    missing = untold(before, after)
    if missing:
        sys.exit('CHANGELOG.md does not tell that these changed:\n' + '\n'.join(missing))
    if not check:
        PAGE.write_text(after)


if __name__ == '__main__':
    main()
