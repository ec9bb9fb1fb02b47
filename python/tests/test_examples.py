"""The examples run from top to bottom and find what they show."""
import importlib.util
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np
import opencv_iib
from support import REPOSITORY

EXAMPLES = REPOSITORY / 'python/examples'


class Examples(unittest.TestCase):

    def run_example(self, name, pattern, *arguments, needs=('cv2',), picture=None):
        missing = [module for module in needs if importlib.util.find_spec(module) is None]
        if missing or not (REPOSITORY / 'tools/synthetic').is_dir():
            self.skipTest('%s is missing' % (', '.join(missing) or 'the clone'))
        text = (EXAMPLES / name).read_text()
        self.assertGreaterEqual(text.count('\n# %% '), 4)
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run([sys.executable, '-B', EXAMPLES / name, *arguments], cwd=folder, capture_output=True, text=True)
            if picture is not None:
                import cv2
                drawn = cv2.imread(str(Path(folder, picture)))
                self.assertTrue(drawn is not None and drawn.std() > 10, 'no picture')
        self.assertEqual(done.returncode, 0, done.stderr)
        found = re.search(pattern, done.stdout)
        self.assertTrue(found, done.stdout)
        return [float(number) for number in found.groups()]

    def test_day_night(self):
        matches, agree = self.run_example('day_night.py', r'(\d+) matches, (\d+) agree')
        self.assertGreater(agree, 200)  # 234 are right; OpenCV's estimators, by version, find 213 to 221 of them
        self.assertLess(matches, 1.3 * agree)

    def test_align(self):
        matches, error = self.run_example('align.py', r'(\d+) matches agree; .* by ([\d.]+) pixels')
        self.assertGreater(matches, 200)
        self.assertLess(error, 1.25)
        self.assertGreater(error, .25)  # errors of the corners: .52, .32, .04 and .48

    def test_poses(self):
        number = r' *([-\d.]+) *'
        right, down, ahead, _, turn, _ = self.run_example('poses.py', r'towards \[%s\] turned by \[%s\]' % (number * 3, number * 3))
        self.assertGreater(right, .98)
        self.assertAlmostEqual(turn, -5, delta=1)

    def test_reconstruction(self):
        images, = self.run_example('reconstruction.py', r'num_reg_frames = (\d+)', needs=('cv2', 'pycolmap'))
        self.assertEqual(images, 9)

    def test_webcam_year(self):
        aligned, of, sharper = self.run_example('webcam_year.py', r'(\d+) of (\d+) pictures are aligned\n(?:.*\n)*.* is ([\d.]+) times as sharp',
                                               picture='webcam_year.jpg')
        self.assertEqual((aligned, of), (23, 23))
        self.assertGreater(sharper, 1.2)

    def test_two_flights(self):
        morning, both, registered, points, shared = self.run_example(
            'two_flights.py', r'morning: (\d+) images(?:.*\n)*and evening: (\d+) images(?:.*\n)*(\d+) images in one model; of (\d+) points (\d+)',
            needs=('cv2', 'pycolmap'), picture='two_flights.png')
        self.assertEqual((morning, both, registered), (7, 14, 14))
        self.assertGreater(shared, .2 * points)

    def test_robot_at_night(self):
        found, centimetres = self.run_example('robot_at_night.py', r'(\d+) of 20 places are found, half of them within ([\d.]+) cm',
                                              needs=('cv2', 'pycolmap'), picture='robot_at_night.jpg')
        self.assertGreaterEqual(found, 19)
        self.assertLess(centimetres, 5)

    def test_million_codes(self):
        best, of, votes, next_, same = self.run_example(
            'million_codes.py', r'image (\d+) of (\d+) has (\d+) votes, the next (\d+); (\d+) are', '20000')
        self.assertEqual((best, of), (100, 101))
        # Random codes take hardly any of the matches that brute force finds among the day's codes alone.
        sys.path.insert(0, str(EXAMPLES))
        self.addCleanup(sys.path.remove, str(EXAMPLES))
        import scene
        small = opencv_iib.IIB.createFor(opencv_iib.HessianDetector(500), 'SMALL')
        day, night = scene.PICTURES.values()
        keypoints = small.detect(day)
        by_day, by_night = (np.unpackbits(small.compute(image, keypoints)[1], axis=1).astype(int) for image in (day, night))
        distances = by_night @ (1 - by_day.T) + (1 - by_night) @ by_day.T
        right = (distances.argmin(axis=1) == np.arange(len(distances))).sum()
        self.assertGreater(right, .4 * len(distances))
        self.assertGreater(same, .95 * right)
        self.assertLessEqual(same, right)
