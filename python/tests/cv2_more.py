#!/usr/bin/env python3
"""Of cv2.iib, what misc/python/test/test_iib.py has no room for: scripts/intree.sh runs it. A patch of opencv_contrib may have a
million bytes."""
import unittest

import cv2
import numpy as np


def noise(seed, shape=(120, 160)):
    image = np.random.default_rng(seed).integers(0, 256, shape, np.uint8)
    return cv2.GaussianBlur(image, (5, 5), 0)


def grid(size=10.0):
    return [cv2.KeyPoint(x, y, size) for y in range(0, 120, 20) for x in range(0, 160, 20)]


class DescriptorTest(unittest.TestCase):

    def test_detect_and_compute_equals_detect_then_compute(self):
        iib = cv2.iib.IIBDescriptorExtractor.create()
        keypoints, descriptors = iib.detectAndCompute(noise(2), None)
        again = iib.compute(noise(2), iib.detect(noise(2)))
        self.assertGreater(len(keypoints), 0)
        self.assertEqual([k.pt for k in keypoints], [k.pt for k in again[0]])
        np.testing.assert_array_equal(descriptors, again[1])

    def test_mistakes_raise(self):
        IIB = cv2.iib.IIBDescriptorExtractor
        nan = np.full((50, 60), np.nan, np.float32)
        for culprit, call in (
                ('granularity is 7', lambda: IIB.create(granularity=7)),
                ('no such detector', lambda: IIB.scaleFactorFor('no such detector')),
                ('selection', lambda: IIB.create().setSelection(np.zeros((1, 5), np.float32))),
                ('the image is NaN', lambda: IIB.create().compute(nan, grid())),
                ('type CV_64FC1', lambda: IIB.create().compute(nan.astype(np.float64), grid())),
                ('extra channel', lambda: IIB.create(extraChannels=1).compute(noise(9), grid())),
                ('keypoint 0', lambda: IIB.create().compute(noise(9), [cv2.KeyPoint(3, 3, 0)]))):
            with self.assertRaisesRegex(cv2.error, culprit):
                call()


class MatcherTest(unittest.TestCase):

    def setUp(self):
        rng = np.random.default_rng(6)
        self.query = rng.integers(0, 256, (50, 170), np.uint8)
        self.train = rng.integers(0, 256, (70, 170), np.uint8)
        self.train[10:60] = self.query ^ (rng.random((50, 170)) < 0.1)
        self.levels = cv2.iib.IIBDescriptorExtractor.create().levelSizes()

    def test_match_equals_brute_force(self):
        for cross_check in (False, True):
            matcher = cv2.iib.HierarchicalMatcher.create(self.levels, crossCheck=cross_check)
            ours = matcher.match(self.query, self.train)
            theirs = cv2.BFMatcher(cv2.NORM_HAMMING, cross_check).match(self.query, self.train)
            self.assertEqual([(m.queryIdx, m.trainIdx, m.distance) for m in ours],
                             [(m.queryIdx, m.trainIdx, m.distance) for m in theirs])
            self.assertEqual(len(ours), 50)

    def test_create_without_level_sizes_takes_any_width(self):
        matcher = cv2.iib.HierarchicalMatcher.create()
        self.assertEqual(len(matcher.levelSizes()), 0)
        for width in (170, 32):
            query, train = self.query[:, :width].copy(), self.train[:, :width].copy()
            theirs = cv2.BFMatcher(cv2.NORM_HAMMING).match(query, train)
            self.assertEqual([(m.trainIdx, m.distance) for m in matcher.match(query, train)],
                             [(m.trainIdx, m.distance) for m in theirs])
        matcher.add([self.train])
        self.assertEqual(list(matcher.levelSizes()), [170])
        self.assertEqual(len(matcher.knnMatch(self.query, 2)), 50)
        np.testing.assert_array_equal(matcher.getTrainDescriptors()[0], self.train)

    def test_recommended(self):
        matcher = cv2.iib.HierarchicalMatcher.createRecommended()
        self.assertTrue(matcher.getCrossCheck())
        self.assertAlmostEqual(matcher.getMaxRatio(), 0.9, 6)
        self.assertEqual(matcher.getMode(), cv2.iib.HierarchicalMatcher_EXACT)
        self.assertEqual([m.trainIdx for m in matcher.match(self.query, self.train)], list(range(10, 60)))

    def test_match_cost_is_one_for_brute_force_and_less_for_thresholds(self):
        matcher = cv2.iib.HierarchicalMatcher.create(
            self.levels, mode=cv2.iib.HierarchicalMatcher_THRESHOLD)
        matcher.match(self.query, self.train)
        self.assertTrue(0 < matcher.matchCost() < 1)


if __name__ == '__main__':
    unittest.main()
