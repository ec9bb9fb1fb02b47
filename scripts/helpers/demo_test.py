#!/usr/bin/env python3
"""Runs the demo on its pair, and with user mistakes (one line, exit code 2): demo_test.py DEMO OPENCV_VERSION"""
import os
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAIR = ROOT / 'tools/synthetic'
DAY, NIGHT = str(PAIR / 'day.png'), str(PAIR / 'night.png')
MOVED = [str(PAIR / name) for name in ('demo_noon.jpg', 'demo_night.jpg')]
TRUTH = ['--homography=' + str(PAIR / 'H_demo'), '--depth=' + str(PAIR / 'demo_depth.png')]
FILES = {'text.png': 'not an image', 'flat.pgm': 'P2 64 64 1\n' + 64 * 64 * '0 ', 'singular.txt': '1 0 0 0 1 0 0 0 0',
         'noise.pgm': 'P2 160 120 255\n' + ' '.join(str(i * i * 7919 % 9973 % 256) for i in range(160 * 120)) + '\n',
         'short.txt': '1 0 0 0', 'true.txt': (PAIR / 'H_day_night').read_text()}
MISTAKES = [[], [DAY], ['missing.png', NIGHT], ['text.png', NIGHT], ['flat.pgm', 'flat.pgm']] + [
    [DAY, NIGHT, option] for option in (
        '--homography=missing.txt', '--homography=short.txt', '--homography=singular.txt', '--depth=' + DAY, '--out=no-such-folder/picture.png',
        '--out=picture.unknown')] + [[DAY, NIGHT, '--homography=true.txt', '--depth=' + DAY]]
# By the true homography matches are "correct", by an estimated one "consistent". IIB has the most in each.
LINE = r'\nIIB ([1-9]\d+) of \d+ {0}, SIFT (\d+) of \d+ {0}, ORB (\d+) of \d+ {0}\n'
EXPECTED = [([DAY, NIGHT], r'consistent: within 3 pixels of a MAGSAC homography' + LINE.format('consistent')),
            ([DAY, NIGHT, '--homography=true.txt'], r'correct: within 3 pixels of the truth' + LINE.format('correct')),
            ([*MOVED, *TRUTH], r'correct: within 3 pixels of the truth' + LINE.format('correct'))]



def run(*arguments):
    return subprocess.run([os.path.abspath(sys.argv[1]), *arguments], cwd=folder, capture_output=True, text=True)


def shown(arguments):
    """What the demo prints of two images, with the last lines a person reads."""
    done = run(*arguments, '--out=picture.png')
    if done.returncode or not re.search(r'\n[^\n]*IIB[^\n]*\npicture: picture.png\n$', done.stdout) or not (folder / 'picture.png').exists():
        wrong.append(f'{arguments}: no summary or no picture: {done}')
    (folder / 'picture.png').unlink(missing_ok=True)
    return done.stdout


wrong = []
with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    for file, text in FILES.items():
        (folder / file).write_text(text)
    for mistake in MISTAKES:
        done = run(*mistake)
        if done.returncode != 2 or done.stdout or not re.fullmatch('iib_demo: [^\n]+\n', done.stderr):
            wrong.append(f'a mistake: {done}')
    if not re.search('--depth.*--homography.*--out', run('--help').stdout, re.DOTALL):
        wrong.append('--help does not list the options')
    for arguments, pattern in EXPECTED:
        found = re.search(pattern, shown(arguments))
        if not found or int(found[1]) < 4 * max(1, int(found[2]), int(found[3])):
            wrong.append(f'{arguments}: not four times as many right matches as the others, all upright: {found}')
    if sys.argv[2].startswith('4.6.'):  # other versions may detect other points
        claim = re.search('`(IIB [0-9]+ of [0-9]+ correct, SIFT [^`]*)`', (ROOT / 'README.md').read_text())[1]
        if f'\n{claim}\n' not in shown(EXPECTED[-1][0]):
            wrong.append(f'the README claims {claim}')
    # nothing in common
    done = run(DAY, 'noise.pgm', '--homography=true.txt', '--out=picture.png')
    if done.returncode != 3 or not re.fullmatch('iib_demo: nothing agrees[^\n]+\n', done.stderr):
        wrong.append(f'no match: {done}')
sys.exit('\n'.join(wrong) or 0)
