import unittest

import numpy as np
from support import texture

import opencv_iib
from opencv_iib import propagateMatches, refineMatches


class Refinement(unittest.TestCase):
    """A picture, and the same one shifted by whole pixels under changed illumination."""

    def setUp(self):
        whole = texture(420, 320, seed=5)
        self.images = whole[10:310, 10:410], (whole[13:313, 12:412] * .6 + 20).astype(np.uint8)
        self.rows = opencv_iib.keypoints_to_array(opencv_iib.HessianDetector.create(100).detect(self.images[0]))
        self.rows = self.rows[np.all((self.rows[:, :2] > 30) & (self.rows[:, :2] < 270), axis=1)]
        self.moved = self.rows.copy()
        self.moved[:, :2] += np.float32([-2.4, -2.7])
        self.pairs = np.stack([np.arange(len(self.rows), dtype=np.int32)] * 2, axis=1)

    def test_arrays(self):
        points1, points2, covariances, similarities = refineMatches(self.images[0], self.rows, self.images[1], self.moved, self.pairs)
        n = len(self.rows)
        self.assertEqual([a.shape for a in (points1, points2, covariances, similarities)], [(n, 2), (n, 2), (n, 3), (n,)])
        np.testing.assert_array_equal(points1, self.rows[:, :2])
        self.assertLess(np.median(np.abs(points2 - points1 - np.float32([-2, -3]))[similarities > 0]), .05)

    def test_lists_of_pairs(self):
        for function in (refineMatches, propagateMatches):
            arguments = self.images[0], self.rows, self.images[1], self.moved
            for found, expected in zip(function(*arguments, self.pairs.tolist()), function(*arguments, self.pairs)):
                np.testing.assert_array_equal(found, expected)
            for wrong in ([0], 'x', None, 5, [(0, 0), (1,)], [[0, 0, 0]], np.float32([[0, 0]])):
                with self.assertRaisesRegex((TypeError, opencv_iib.error), '^matches.*array'):
                    function(*arguments, wrong)

    def test_propagation(self):
        given = self.pairs[::4]
        pairs, points1, points2, covariances, similarities = propagateMatches(
            self.images[0], self.rows, self.images[1], self.moved, given)
        n = len(pairs)
        self.assertGreater(n, .8 * len(self.rows))
        np.testing.assert_array_equal(pairs[:len(given)], given)
        self.assertEqual([a.shape for a in (points1, points2, covariances, similarities)], [(n, 2), (n, 2), (n, 3), (n,)])
        matches = propagateMatches(self.images[0], self.rows, self.images[1], self.moved,
                                   [opencv_iib.DMatch(*pair, 0, 7) for pair in given.tolist()]).matches
        self.assertEqual([(m.queryIdx, m.trainIdx) for m in matches], [tuple(pair) for pair in pairs.tolist()])
        self.assertEqual({m.distance for m in matches[:len(given)]}, {7})
        self.assertGreater(min(m.distance for m in matches[len(given):]), 1e38)
        nothing = propagateMatches(self.images[0], self.rows, self.images[1], self.moved, given[:0])
        self.assertEqual([a.shape for a in nothing], [(0, 2), (0, 2), (0, 2), (0, 3), (0,)])
