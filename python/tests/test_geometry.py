"""Poses and alignment, from arrays."""
import os
import pickle
import subprocess
import sys
import unittest

import numpy as np

import opencv_iib
from support import cv2, texture

FACADE = os.path.join(os.environ.get('OPENCV_TEST_DATA_PATH', ''), 'strecha', 'entry-P10', 'images', '0000.jpg')
CAMERA = np.array([[500, 0, 320], [0, 500, 240], [0, 0, 1.0]])


def views(count=100):
    """Pixels of points in two views, N x 2; the second camera stands to the right by 1."""
    random = np.random.default_rng(1)
    points = np.stack([*random.uniform(-3, 3, (2, count)), random.uniform(6, 12, count)], axis=1)
    seen = [moved @ CAMERA.T for moved in (points, points - [1, 0, 0])]
    return [(s[:, :2] / s[:, 2:]).astype(np.float32) for s in seen]


class RelativePose(unittest.TestCase):

    def test_a_camera_that_moved_to_the_right(self):
        first, second = views()
        second[:30] = second[29::-1]
        found, R, t, inliers, covariance = opencv_iib.findRelativePose(first, second, CAMERA, CAMERA)
        self.assertTrue(found)
        self.assertEqual(opencv_iib.findRelativePose(first, second, CAMERA, CAMERA).reason, '')
        self.assertTrue(opencv_iib.findRelativePose(first, second, CAMERA, CAMERA, covariances=np.ones((len(first), 3))).found)
        with self.assertRaisesRegex(opencv_iib.error, 'covariances'):
            opencv_iib.findRelativePose(first, second, CAMERA, CAMERA, covariances=np.ones((2, 3)))
        np.testing.assert_allclose(R, np.eye(3), atol=1e-3)
        np.testing.assert_allclose(t, [[-1], [0], [0]], atol=3e-3)
        self.assertEqual((inliers.shape, covariance.shape), ((100, 1), (5, 5)))
        self.assertGreaterEqual(inliers.sum(), 70)
        self.assertLess(inliers[:30].sum(), 10)

    def test_too_few(self):
        first, second = views(4)
        pose = opencv_iib.findRelativePose(first, second, CAMERA, CAMERA.tolist())
        self.assertEqual((pose.found, pose.R, pose.t, pose.covariance), (False, None, None, None))
        self.assertEqual(pose.inliers.tolist(), [[0]] * 4)
        self.assertEqual(pose.reason, 'no pose agrees with five matches or more')
        again = pickle.loads(pickle.dumps(pose))
        self.assertEqual((type(again), again.reason, tuple(again[:3])), (opencv_iib.RelativePose, pose.reason, (False, None, None)))


class Alignment(unittest.TestCase):

    def test_a_window_of_the_same_picture(self):
        picture = texture(400, 300, seed=1)
        found, transform, error, matches = opencv_iib.alignImages(
            picture, picture[16:, 32:] // 2 + 40, opencv_iib.AlignmentModel.TRANSLATION)
        self.assertTrue(found)
        np.testing.assert_allclose(transform, [[1, 0, 32], [0, 1, 16], [0, 0, 1]], atol=.1)
        self.assertEqual((error.shape, matches.shape[1]), ((4, 1), 4))
        self.assertLess(error.max(), .2)
        np.testing.assert_allclose(matches[:, 2:] + [32, 16], matches[:, :2], atol=2)
        chosen = opencv_iib.alignImages(picture, picture[16:, 32:] // 2 + 40, opencv_iib.AlignmentModel.AUTO)
        np.testing.assert_allclose(chosen.transform, transform, atol=1e-9)
        self.assertEqual((chosen.simplest, chosen.note), (opencv_iib.AlignmentModel.TRANSLATION, ''))
        self.assertIn('TRANSLATION', opencv_iib.alignImages(picture, picture[16:, 32:] // 2 + 40).note)

    def test_other_pictures(self):
        alignment = opencv_iib.alignImages(*(texture(640, 480, seed=seed)[290:] for seed in (1, 2)))  # below their rectangle
        self.assertEqual((alignment.found, alignment.transform, alignment.error), (False, None, None))
        self.assertRegex(alignment.reason, '^the images have too few matches$|could be random')

    @unittest.skipIf(cv2 is None, 'no cv2')
    @unittest.skipUnless(os.path.isfile(FACADE), 'OPENCV_TEST_DATA_PATH has no strecha/entry-P10')
    def test_a_picture_on_a_large_map_is_not_at_windows_that_look_alike(self):
        large = cv2.resize(cv2.imread(FACADE, cv2.IMREAD_GRAYSCALE), None, fx=4, fy=4, interpolation=cv2.INTER_CUBIC)
        x, y, zoom, tilt = 2012.23, 965.81, 1.36, .18
        turn = cv2.getRotationMatrix2D((0, 0), 210.04, 1 / zoom)[:, :2]
        corners = np.array([[-320 * (1 - tilt), -240], [320 * (1 - tilt), -240], [320 * (1 + tilt), 240], [-320 * (1 + tilt), 240]]) @ turn.T + (x, y)
        true = cv2.getPerspectiveTransform(np.float32([[0, 0], [639, 0], [639, 479], [0, 479]]), np.float32(corners))
        seen = cv2.warpPerspective(large, true, (640, 480), flags=cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP)
        for seed in range(4):
            noise = np.random.default_rng(seed).normal(0, 2, seen.shape)
            picture = ((seen / 255) ** 1.3 * .41 * 255 + noise).clip(0, 255).astype(np.uint8)
            found = opencv_iib.alignImages(large, picture)
            self.assertTrue(found.found, found.reason)
            middle, right = (cv2.perspectiveTransform(np.array([[[320., 240]]]), by).ravel() for by in (found.transform, true))
            np.testing.assert_allclose(middle, right, atol=2)


@unittest.skipUnless(os.path.exists('/proc/self/clear_refs'), 'no account of memory on this system')
class Memory(unittest.TestCase):

    def test_photographs_of_12_megapixels_take_six_bytes_a_pixel_at_the_most(self):
        program = """
import numpy as np
import opencv_iib
from support import texture

def peak(name):
    with open('/proc/self/status') as status:
        return next(1024 * int(line.split()[1]) for line in status if line.startswith(name))

def measure(step):
    before = peak('VmRSS')
    with open('/proc/self/clear_refs', 'w') as forgotten:
        forgotten.write('5')
    step()
    print((peak('VmHWM') - before) / first[:, :, 0].size)

opencv_iib.setNumThreads(1)
small = texture(400, 300, seed=1)
first = np.repeat(np.repeat(small, 10, 0), 10, 1)[:, :, None].repeat(3, 2)
second = first // 2 + 40
points, sizes, _ = opencv_iib.detect_and_describe(small, 1000)
rows, pairs = np.column_stack([10 * points + 4.5, 10 * sizes]), np.arange(len(points)).repeat(2).reshape(-1, 2)
measure(lambda: opencv_iib.detect_and_describe(first, 4000))
measure(lambda: opencv_iib.propagateMatches(first, rows, second, rows, pairs))
measure(lambda: opencv_iib.alignImages(first, second))
matcher, codes = opencv_iib.HierarchicalMatcher(), np.ones((400000, 128), np.uint8)  # 4.3 bytes a pixel
measure(lambda: matcher.add(codes))
"""
        done = subprocess.run([sys.executable, '-c', program], capture_output=True, text=True)
        self.assertEqual(len(done.stdout.split()), 4, done.stderr)
        for bytes_of_a_pixel in map(float, done.stdout.split()):
            self.assertLess(bytes_of_a_pixel, 6)
