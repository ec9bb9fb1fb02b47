#!/usr/bin/env python3
"""Runs the demo on its pair, and with each mistake a user can make (one line, exit code 2): demo_test.py DEMO OPENCV_VERSION"""
import os
import pathlib
import random
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAIR = ROOT / 'tools/synthetic'
DAY, NIGHT = str(PAIR / 'day.png'), str(PAIR / 'night.png')
DETECTORS = ('FAST', 'AGAST', 'ORB', 'BRISK', 'AKAZE', 'KAZE', 'SIFT', 'GFTT', 'MSER')
FILES = {'text.png': 'not an image', 'flat.pgm': 'P2 64 64 1\n' + 64 * 64 * '0 ', 'singular.txt': '1 0 0 0 1 0 0 0 0',
         'short.txt': '1 0 0 0', 'true.txt': (PAIR / 'H_day_night').read_text()}
MISTAKES = [[], [DAY], [DAY, NIGHT, DAY], ['missing.png', NIGHT], ['text.png', NIGHT], ['flat.pgm', 'flat.pgm']] + [
    [DAY, NIGHT, *options.split()] for options in (
        '--colour red', '--detector', '--detector SURFER', '--detector=', '--preset MINUTE', '--granularity 3',
        '--orientation north', '--preset default --granularity 7', '--preset default --granularity four',
        '--homography missing.txt', '--homography short.txt', '--homography singular.txt', '--out no-such-folder/picture.png',
        '--out picture.unknown')]
# Judged by the true homography, matches are correct; by an estimated one, consistent.
EXPECTED = [('--detector=orb', r'\nIIB \d+ of \d+ consistent, ORB: no homography found in \d+ matches\n')] + [
    (f'--homography=true.txt {options}', pattern) for options, pattern in (
        ('', r'\nIIB \d+ of \d+ correct, ORB \d+ of \d+ correct\n'), ('--preset=tiny', r'\nIIB +32 '),
        ('--preset=default', r'\nIIB +170 '), ('--preset=default --granularity=2', r'\nIIB +10 '),
        ('--preset Balanced --orientation=KEYPOINT', r'\nIIB +64 '), ('--detector=simpleblob', r'\nIIB \d+ of \d+ correct\n'),
        ('--detector=akaze --normalize=yes', r'\nIIB [1-9]\d\d of \d+ correct'),
        ('--orientation=gradient', r'\nIIB \d+ of \d+ correct'))]


def run(*arguments):
    return subprocess.run([os.path.abspath(sys.argv[1]), *arguments], cwd=folder, capture_output=True, text=True)


def shown(options):
    """What the demo prints of its pair, with the last lines a person reads."""
    done = run(DAY, NIGHT, '--out', 'picture.png', *options.split())
    if done.returncode != (3 if '\nIIB 0 of' in done.stdout else 0) or not re.search(r'\n[^\n]*IIB[^\n]*\npicture: [^\n]*picture.png\n$', done.stdout) or \
            not (folder / 'picture.png').exists():
        wrong.append(f'{options}: no summary or no picture: {done}')
    (folder / 'picture.png').unlink(missing_ok=True)
    return done.stdout


wrong = []
with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    for file, text in FILES.items():
        (folder / file).write_text(text)
    noise = random.Random(1)
    (folder / 'noise.ppm').write_text('P3 200 200 255\n' + ' '.join(str(noise.randrange(256)) for _ in range(3 * 200 * 200)) + '\n')
    done = run(DAY, 'noise.ppm')
    if done.returncode != 3 or not re.fullmatch('iib_demo: nothing agrees[^\n]+\n', done.stderr) or 'no homography' not in done.stdout:
        wrong.append(f'nothing to match: {done}')
    for mistake in MISTAKES:
        done = run(*mistake)
        if done.returncode != 2 or done.stdout or not re.fullmatch('iib_demo: [^\n]+\n', done.stderr):
            wrong.append(f'a mistake: {done}')
    if not re.search('--detector.*--preset', run('--help').stdout, re.DOTALL):
        wrong.append('--help does not list the options')
    if sys.argv[2].startswith('4.6.'):  # other versions may detect other points
        claim = re.search('`(IIB [0-9]+ of [0-9]+ correct, ORB [^`]*)`', (ROOT / 'README.md').read_text())[1]
        EXPECTED.append(('--homography=true.txt', re.escape(f'\n{claim}\n')))
    wrong += [f'{options}: no {pattern}' for options, pattern in EXPECTED if not re.search(pattern, shown(options))]
    for detector in DETECTORS:
        table = shown(f'--homography=true.txt --detector {detector}')
        correct = {row: int(number) for row, number in re.findall(r'^(\w+) +\d+ +\d+ +(\d+) ', table, re.MULTILINE)}
        if correct.get('IIB', 0) < 20 or correct.get(detector, 0) >= correct['IIB']:
            wrong.append(f'{detector}: few matches of IIB, or not more than of its own descriptor: {correct}')
sys.exit('\n'.join(wrong) or 0)
