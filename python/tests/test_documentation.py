"""Every Python program of every page runs unchanged, with this package."""
import importlib.util
import re
import subprocess
import sys
import unittest
from unittest import mock

import numpy as np

from support import REPOSITORY, InFolder, cv2, texture

PAGES = [REPOSITORY / 'README.md', *sorted((REPOSITORY / 'doc').glob('*.md')), *sorted(REPOSITORY.glob('modules/*/*.md')),
         *sorted(REPOSITORY.glob('modules/*/tutorials/*.markdown'))]
# The files of OpenCV 5's networks are not here. These classes have the names and arguments of 5.0.0 that the guide uses,
# and no others.
NETWORKS = '''
images = [day, night]
K1 = K2 = np.float64([[400, 0, 320], [0, 400, 240], [0, 0, 1]])
class ALIKED:
    @staticmethod
    def create(modelPath):
        return ALIKED()
    def detectAndCompute(self, image, mask):
        return cv2.SIFT_create(1000).detectAndCompute(image, mask)
class LightGlueMatcher:
    @staticmethod
    def create(modelPath):
        return LightGlueMatcher()
    def setPairInfo(self, queryKpts, trainKpts, queryImageSize, trainImageSize):
        self.counts = len(np.reshape(queryKpts, (-1, 2))), len(np.reshape(trainKpts, (-1, 2)))
        assert queryImageSize == (640, 480) and trainImageSize == (640, 480)
    def match(self, queryDescriptors, trainDescriptors):
        assert self.counts == (len(queryDescriptors), len(trainDescriptors))
        return cv2.BFMatcher(cv2.NORM_L2, True).match(queryDescriptors, trainDescriptors)
for one in ALIKED, LightGlueMatcher:
    assert {name for name in vars(one) if name[0] != '_'} <= set(dir(getattr(cv2, one.__name__, one)))
    setattr(cv2, one.__name__, one)
'''
# For each program of each page: its arguments and what it prints. For a fragment: code before it, code after it, and what both
# print. For a program that another test runs: the test.
RUNS = {
    'README.md': [('day.png night.png', r'^\d{3,} matches\n$')],
    'python.md': [('image_a, image_b = day, night', 'print(len(pairs), matched_a.shape == matched_b.shape)', r'^\d{3} True\n'),
                  ('', 'print(len(matches))', r'^\d{3}\n')],
    'scale.md': [('folder, codes, queries = "codes", codes_day, codes_night', 'print(indices.shape)', r'^\(1000, 5\)\n'),
                 ('python/examples/test_postgres.py',), ('python/examples/test_postgres.py',)],
    'colmap.md': [('import os; os.mkdir("images"); os.rename("day.png", "images/a.png"); os.rename("night.png", "images/b.png")',
                   'print(counts)', "'images': 2")],
    'guide.md': [('image1, image2 = day, night; K1 = K2 = np.float64([[400, 0, 320], [0, 400, 240], [0, 0, 1]])', 'print(len(pose.inliers))', r'^\d{3,}\n'),
                 (NETWORKS, 'print(len(refined.points1), pose.found)', r'^\d{2,} ')],
    'maps.md': [('python/tests/test_localization.py',)],
    'iib_day_night.markdown': [('day.png night.png', r'^\d{3} of \d{3,} matches agree')],
    'iib_relative_pose.markdown': [('day.png night.png 400 picture.png', r'^\d{2,} of \d{3,} matches agree')],
    'iib_presets.markdown': [('', r'^128 bytes.*\n64 bytes')],
    'iib_localization.markdown': [('day.png depth.png night.png 400', r'^True \d{3} of \d{3} points agree')],
    'iib_align.markdown': [('day.png night.png aligned.png', r'^\d{2,} matches agree')],
    'iib_saving_index.markdown': [('night.png day.png', r'^\d{3} matches in day.png\n')],
}
BEFORE = '''
import cv2, opencv_iib, numpy as np
day, night = cv2.imread('day.png'), cv2.imread('night.png')
codes_day, codes_night = (opencv_iib.detect_and_describe(image, 1000).codes for image in (day, night))
'''


def programs(page):
    return re.findall('^```(?:python|py)\n(.*?)^```', page.read_text(), re.S | re.M)


class FirstExample(unittest.TestCase):

    @unittest.skipUnless((REPOSITORY / 'doc/python.md').exists(), 'the documentation is not beside these tests')
    def test_that_of_pypi_needs_what_pip_brings_alone(self):
        image = texture(320, 240)
        names = {'image_a': image, 'image_b': image // 2}
        with mock.patch.dict(sys.modules, {'cv2': None}):
            exec(programs(REPOSITORY / 'doc/python.md')[0], names)
        self.assertGreater(len(names['pairs']), 100)
        self.assertEqual(names['matched_a'].shape, names['matched_b'].shape)


@unittest.skipIf(cv2 is None, 'no cv2')
@unittest.skipUnless((REPOSITORY / 'tools/synthetic/day.png').exists(), 'the documentation is not beside these tests')
class Documentation(InFolder):

    def setUp(self):
        super().setUp()
        self.images = {name: cv2.imread(str(REPOSITORY / f'tools/synthetic/{name}.png')) for name in ('day', 'night')}
        for name, image in self.images.items():
            for suffix in ('png', 'jpg'):
                cv2.imwrite(str(self.folder / f'{name}.{suffix}'), image)
        depth = np.add.outer(np.arange(image.shape[0]), np.arange(image.shape[1])) % 997 + 2000
        cv2.imwrite(str(self.folder / 'depth.png'), depth.astype(np.uint16))

    def run_program(self, program, *run):
        if len(run) == 1:
            self.skipTest(f'in {run[0]}, which has what it needs')
        if len(run) == 3:
            program = '\n'.join([BEFORE, run[0], program, run[1]])
            program = 'def main():\n' + re.sub('^', '    ', program, flags=re.M) + "\nif __name__ == '__main__':\n    main()\n"
            program = program.replace("'scheduler:8786'", 'distributed.LocalCluster(n_workers=1, dashboard_address=None)')
        for module in re.findall(r'^ *import (\w+)', program, re.M):
            if importlib.util.find_spec(module) is None:
                self.skipTest(f'no {module}')
        (self.folder / 'program.py').write_text(program)
        arguments = run[0].split() if len(run) == 2 else []
        done = subprocess.run([sys.executable, 'program.py', *arguments], capture_output=True, text=True, cwd=self.folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertRegex(done.stdout, run[-1])

    def test_programs_say_what_is_wrong(self):
        cv2.imwrite(str(self.folder / 'flat.png'), np.full_like(self.images['day'], 77))
        pages = {page.name: page for page in reversed(PAGES)}
        for name, arguments, message in (
                ('README.md', '', 'two images'), *((name, '', 'usage: ') for name, run in RUNS.items() if name.startswith('iib_') and run[0][0]),
                ('iib_saving_index.markdown', 'day.png flat.png', 'no keypoints in flat.png'), ('README.md', 'gone.png day.png', 'gone.png'), ('iib_day_night.markdown', 'day.png gone.png', 'gone.png'),
                ('iib_day_night.markdown', 'day.png flat.png', 'only 0 matches'), ('iib_align.markdown', 'day.png gone.png a.png', 'gone.png'),
                ('iib_align.markdown', 'day.png flat.png a.png', 'too few matches'), ('iib_saving_index.markdown', 'gone.png day.png', 'gone.png'),
                ('iib_localization.markdown', 'day.png depth.png gone.png 400', 'gone.png'),
                ('iib_localization.markdown', 'day.png depth.png flat.png 400', 'only 0 matches'),
                ('iib_relative_pose.markdown', 'day.png gone.png 400 a.png', 'gone.png'),
                ('iib_relative_pose.markdown', 'day.png flat.png 400 a.png', 'no pose agrees')):
            with self.subTest(page=name, arguments=arguments):
                (self.folder / 'program.py').write_text(programs(pages[name])[0])
                done = subprocess.run([sys.executable, 'program.py', *arguments.split()], capture_output=True, text=True, cwd=self.folder)
                self.assertEqual(done.returncode, 1)
                self.assertRegex(done.stderr, rf'^(\[ *WARN.*\n)?[^\n]*{message}[^\n]*\n$')

    def test_the_readme_says_what_its_program_prints(self):
        claim = re.search(r'# prints: (\d+)\d\d matches', PAGES[0].read_text())  # other versions of OpenCV may find a few others
        self.run_program(programs(PAGES[0])[0], 'day.png night.png', rf'^{claim[1]}\d\d matches\n$')

    def test_every_program_is_known(self):
        self.assertGreater(len(PAGES), 15)
        self.assertEqual({page.name: len(programs(page)) for page in PAGES if programs(page)},
                         {page: len(runs) for page, runs in RUNS.items()})

    def test_programs(self):
        for page in PAGES:
            for program, run in zip(programs(page), RUNS.get(page.name, ())):
                with self.subTest(page=page.name, run=run):
                    self.setUp()
                    self.run_program(program, *run)
