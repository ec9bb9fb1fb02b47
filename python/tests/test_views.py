"""Matches at any zoom, rotation and tilt."""
import unittest

import numpy as np

import opencv_iib

from support import texture


def rotated(image):
    """Rotated by 90 degrees clockwise, and darker."""
    return np.ascontiguousarray(np.rot90(image, -1) // 2 + 10)


class Views(unittest.TestCase):

    def test_a_rotated_image(self):
        image = texture(640, 480)
        matcher = opencv_iib.ViewMatcher(image, 800)
        for result in (opencv_iib.matchViews(image, rotated(image), 800), matcher.match(rotated(image))):
            self.assertTrue(result.found)
            self.assertEqual(result.reason, '')
            count = len(result.points1)
            self.assertGreater(count, 200)
            expected = np.column_stack([479 - result.points1[:, 1], result.points1[:, 0]])
            self.assertGreater((np.abs(result.points2 - expected).max(axis=1) < 3).mean(), .95)
            np.testing.assert_allclose(result.view, [[0, -1, 479], [1, 0, 0], [0, 0, 1]], atol=3)
            self.assertEqual([each.shape for each in (result.points2, result.covariances, result.similarities)], [(count, 2), (count, 3), (count,)])

    def test_what_could_be_random(self):
        result = opencv_iib.matchViews(texture(200, 200), np.full((200, 200), 7, np.uint8))
        self.assertFalse(result.found)
        self.assertIn('random', result.reason)
        self.assertIsNone(result.view)
        self.assertEqual((result.points1.shape, result.covariances.shape), ((0, 2), (0, 3)))

    def test_mistakes(self):
        image = texture(100, 100)
        for mistaken in (dict(maxTilt=.5), dict(maxFeatures=-1), dict(mask1=np.ones((3, 3), np.uint8))):
            with self.assertRaises(opencv_iib.error, msg=mistaken):
                opencv_iib.matchViews(image, image, **mistaken)
