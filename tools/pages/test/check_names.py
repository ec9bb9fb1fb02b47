#!/usr/bin/env python3
"""Looks up what pages name: check_names.py BUILD

Files and anchors of links; the symbol of a link to a source file; scripts; options and experiments of programs in the folder BUILD, by
their --help; columns and rows of CSV files, as in "rows `a.csv`: `NAME`, `NAME`".
"""
import functools
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[3]
BUILD = pathlib.Path(sys.argv[1])
PROGRAMS = {'evaluate.sh': 'tools/evaluation/iib_evaluation', 'train.sh': 'tools/training/iib_train'}
COMMANDS = '--help' + (ROOT / 'python/opencv_iib/__main__.py').read_text()  # has the options of opencv-iib
EVALUATION = BUILD / PROGRAMS['evaluate.sh']


def anchors(text):
    heads = re.findall(r'^#+ (.*)$', text, re.M)
    return {re.sub(r'[^\w -]', '', head.lower()).replace(' ', '-') for head in heads} | set(re.findall(r'id="([^"]+)"', text))


def wrong_links(text, page):
    for words, target in re.findall(r'\[([^]]*)\]\(([^)]*)\)', re.sub(r'^```.*?^```', '', text, flags=re.M | re.S)):
        if target.startswith('http'):
            continue
        name, _, anchor = target.partition('#')
        file = (page.parent / name).resolve() if name else page
        if not file.exists():
            yield 'there is no ' + target
        elif anchor and anchor not in anchors(text if file == page else file.read_text()):
            yield 'no anchor ' + target
        elif file.suffix in ('.cpp', '.hpp') and words[:1] == '`' and not re.search(r'\b%s\b' % words.strip('`'), file.read_text()):
            yield '%s is not in %s' % (words, name)


@functools.lru_cache(None)
def help_of(program):
    """The help of a program or script; empty if it was not built."""
    return subprocess.run([program, '--help'], capture_output=True, text=True).stdout if program.is_file() else ''


def wrong_commands(text):
    for command in re.findall(r'`((?:scripts/|tools/|opencv-iib )[^`]*)`', text):
        script, *words = command.split()
        program = BUILD / PROGRAMS.get(pathlib.Path(script).name, '')
        if '/' in script and not (ROOT / script).exists():
            yield 'there is no ' + script
            continue
        options = {word.partition('=')[0] for word in words if word.startswith('--')}
        known = COMMANDS if script == 'opencv-iib' else (help_of(ROOT / script) if options else '') + help_of(program)
        for option in options if program == BUILD or program.is_file() else ():
            if not re.search(option + r'\b', known):
                yield '%s has no option %s' % (script, option)
        for experiment in re.findall(r'--only (\S+)', command) if EVALUATION.is_file() else ():
            if not re.search(r'\b%s\b' % experiment, help_of(EVALUATION)):
                yield 'there is no experiment ' + experiment


def wrong_rows(text):
    for name, listed in re.findall(r'rows? `(\w+\.csv)`: ((?:`[^`]+`(?:, )?)+)', text):
        file = next(ROOT.glob('doc/*/' + name), ROOT / name)
        fields = {field for line in file.read_text().splitlines() for field in line.split(',')} if file.is_file() else set()
        for row in re.findall('`([^`]+)`', listed):
            if row not in fields:
                yield '%s has no row %s' % (name, row)
    for column, name in re.findall(r'column `(\w+)` of `(\w+\.csv)`', text):
        file = next(ROOT.glob('doc/*/' + name), ROOT / name)
        if not file.is_file() or column not in file.read_text().split('\n', 1)[0].split(','):
            yield '%s has no column %s' % (name, column)


def wrong(text, page):
    return [*wrong_links(text, page), *wrong_commands(text), *wrong_rows(text)]


def main():
    found = ['%s: %s' % (page.relative_to(ROOT), what) for pages in ('*.md', 'doc/**/*.md', '*/*/README.md', '*/*/tutorials/*.markdown')
             for page in ROOT.glob(pages) for what in wrong(page.read_text(), page)]
    sys.exit('\n'.join(found) or 0)


if __name__ == '__main__':
    main()
