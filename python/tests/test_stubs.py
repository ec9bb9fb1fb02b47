"""Checks the package's type stubs by mypy's stubtest. Those of the extension come from nanobind."""
import pydoc
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import opencv_iib
from support import REPOSITORY, optional

mypy = optional('mypy')


def is_a(name):
    """Whether an object's type has this name, to which older versions of nanobind add a number."""
    return lambda value: type(value).__name__.startswith(name)


# Messages of stubtest about objects that it cannot read: nanobind's functions and classes; missing constructors; copies, which a
# decorator adds; tuples with a reason beside them; and functions with a cache.
UNREADABLE = {
    'is not a function': is_a('nb_func'),
    'is inconsistent, stub is a staticmethod but runtime is not': is_a('nb_func'),
    'is inconsistent, metaclass differs': is_a('nb_type'),
    "is a disjoint base at runtime, but isn't marked with @disjoint_base in the stub":
        lambda value: is_a('nb_type')(value) or value in (opencv_iib.RelativePose, opencv_iib.Alignment),
    r'is inconsistent, stub does not have \*\*?\w+ parameter "\w+"': is_a('wrapper_descriptor'),
    r'is inconsistent, stub does not have \*args parameter "args"': is_a('nb_func'),  # on Python 3.13
    'is not present in stub': lambda value: getattr(value, '__qualname__', '').startswith('copied.<locals>.__'),
    r'is inconsistent, (stub|runtime) does not have (\*args |\*\*kwargs )?parameter "\w+"': is_a('_lru_cache_wrapper'),
}


def is_readable(line):
    """Whether stubtest can read what the line is about."""
    name, _, text = line.partition(' ')
    value = pydoc.locate(name)
    return not any(re.fullmatch(message, text) and is_it(value) for message, is_it in UNREADABLE.items())


class Stubs(unittest.TestCase):

    @unittest.skipIf(mypy is None, 'no mypy')
    def test_a_strict_program_sees_the_names_and_types(self):
        program = '''
import pathlib
import numpy as np
import opencv_iib
import opencv_iib.localization
from numpy.typing import NDArray
iib: opencv_iib.IIB = opencv_iib.IIB.createPreset(opencv_iib.Preset.UNIVERSAL, 18)
codes: NDArray[np.uint8] = iib.detectAndCompute(np.zeros((9, 9), np.uint8))[1]
rows: NDArray[np.float32] = iib.compute([[0, 0, 0]], np.zeros((9, 3), np.float32))[0]
pairs: NDArray[np.int32] = opencv_iib.match(codes, codes).pairs
mode: opencv_iib.Mode = opencv_iib.HierarchicalMatcher.createRecommended().getMode()
pose, alignment = opencv_iib.findRelativePose([], [], [], []), opencv_iib.alignImages([[0]], [[0]])
if pose.found and alignment.found:
    matrices: list[NDArray[np.float64]] = [pose.R, pose.t, pose.covariance, alignment.transform, alignment.error]
reasons: list[str] = [pose.reason, alignment.reason]
camera = opencv_iib.localization.Camera('PINHOLE', 9, 9, (9, 9, 4, 4))
places: NDArray[np.float64] = camera.project([[0, 0, 1]])
location = opencv_iib.localization.Localizer('m').localize(codes, camera)
if location.found:
    matrices += [location.cam_from_world, location.covariance @ np.eye(6)]
opencv_iib.localization.build(pathlib.Path('m'), pathlib.Path('i'), 'o')
''' + '\n'.join(f'print(opencv_iib.{name})' for name in opencv_iib.__all__)
        wrong = ("iib.setBorder('drop')", 'text: str = iib.descriptorSize()', 'iib.detect_and_compute(codes)',
                 'opencv_iib.match(codes)')
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run([sys.executable, '-m', 'mypy', '--strict', '-c', program + '\n' + '\n'.join(wrong)],
                                  capture_output=True, text=True, cwd=folder)
        first = program.count('\n') + 2
        self.assertEqual([int(line) for line in re.findall(r'^<string>:(\d+): error', done.stdout, re.M)],
                         list(range(first, first + len(wrong))), done.stdout + done.stderr)

    @unittest.skipIf(mypy is None, 'no mypy')
    @unittest.skipUnless((REPOSITORY / 'README.md').exists(), 'the documentation is not beside these tests')
    def test_programs_of_the_readme_and_examples(self):
        unknown = ['torch', 'hloc.utils.base_model', 'psycopg', *(name for name in ('cv2', 'pycolmap') if optional(name) is None)]
        with tempfile.TemporaryDirectory() as folder:
            for path in (REPOSITORY / 'python/examples').glob('*.py'):
                shutil.copy(path, folder)
            for n, program in enumerate(re.findall('^```python\n(.*?)^```', (REPOSITORY / 'README.md').read_text(), re.S | re.M)):
                Path(folder, f'readme_{n}.py').write_text(program)
            done = subprocess.run([sys.executable, '-m', 'mypy', '.'], capture_output=True, text=True, cwd=folder)
        self.assertIn('checked', done.stdout, done.stderr)
        missing = re.compile('|'.join(f'module named "{re.escape(name)}"|note: ' for name in unknown))
        self.assertEqual([line for line in done.stdout.splitlines()[:-1] if not missing.search(line)], [])

    @unittest.skipIf(mypy is None, 'no mypy')
    def test_stubtest(self):
        with tempfile.TemporaryDirectory() as cache:
            done = subprocess.run([sys.executable, '-m', 'mypy.stubtest', '--concise', 'opencv_iib'],
                                  capture_output=True, text=True, cwd=cache)
        self.assertIn('opencv_iib', done.stdout + done.stderr)
        self.assertEqual([line for line in (done.stdout + done.stderr).splitlines() if is_readable(line)], [])
