#!/usr/bin/env python3
"""Prints the folder of the newest OpenCV source with opencv_contrib beside it, from the source distribution of
opencv-contrib-python, which pip downloads into the cache once: `opencv` and `opencv_contrib` in that folder. Delete it from
the cache to get a newer one. Works on Windows and macOS too.

    scripts/helpers/opencv_contrib_source.py [MAJOR]      4 (default) or 5
"""
import glob
import os
import subprocess
import sys
import tarfile
import tempfile
import venv


def fetch(major, tree):
    """pip in an environment of its own: Debian's Python and isolated builds have none."""
    print('fetching the source of opencv-contrib-python %s with pip' % major, file=sys.stderr)
    with tempfile.TemporaryDirectory(dir=os.path.dirname(tree), prefix='fetch.') as work:
        venv.create(work + '/venv', with_pip=True)
        pip = work + ('/venv/Scripts/pip.exe' if os.name == 'nt' else '/venv/bin/pip')
        subprocess.run([pip, 'download', '--quiet', '--no-deps', '--no-binary', 'opencv-contrib-python', '--dest', work,
                        'opencv-contrib-python>=%d,<%d' % (major, major + 1)], check=True, stdout=sys.stderr)
        with tarfile.open(glob.glob(work + '/*.tar.gz')[0]) as packed:
            packed.extractall(work + '/tree')
        try:
            os.rename(glob.glob(work + '/tree/*')[0], tree)
        except OSError:
            if not complete(tree):  # else another process has brought it meanwhile
                raise


def complete(tree):
    return os.path.exists(tree + '/opencv/CMakeLists.txt')


if sys.argv[2:] or sys.argv[1:] not in ([], ['4'], ['5']):
    sys.exit(__doc__)
chosen = int((sys.argv[1:] or ['4'])[0])
cache = os.environ.get('XDG_CACHE_HOME') or os.path.expanduser('~/.cache')
folder = os.path.join(cache, 'opencv_iib', 'opencv-contrib-%d' % chosen)
os.makedirs(os.path.dirname(folder), exist_ok=True)
if not complete(folder):
    fetch(chosen, folder)
print(folder)
