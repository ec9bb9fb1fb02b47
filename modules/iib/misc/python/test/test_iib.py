#!/usr/bin/env python3
# This file is part of OpenCV project.
# It is subject to the license terms in the LICENSE file found in the top-level directory
# of this distribution and at http://opencv.org/license.html.

import unittest

import cv2
import numpy as np


def noise(seed, shape=(120, 160)):
    image = np.random.default_rng(seed).integers(0, 256, shape, np.uint8)
    return cv2.GaussianBlur(image, (5, 5), 0)


def grid(size=10.0):
    return [cv2.KeyPoint(x, y, size) for y in range(0, 120, 20) for x in range(0, 160, 20)]


class DescriptorTest(unittest.TestCase):

    def test_compute_returns_keypoints_and_descriptors(self):
        keypoints, descriptors = cv2.iib.IIBDescriptorExtractor.create().compute(noise(1), grid())
        self.assertEqual([k.pt for k in keypoints], [k.pt for k in grid()])
        self.assertEqual(descriptors.shape, (len(keypoints), 170))
        self.assertEqual(descriptors.dtype, np.uint8)

    def test_layout_and_constants(self):
        IIB = cv2.iib.IIBDescriptorExtractor
        iib = IIB.create(granularity=3, mapping=cv2.iib.IIBDescriptorExtractor_MAPPING_HAAR)
        self.assertEqual(list(iib.levelSizes()), [2, 6, 24])
        self.assertEqual(iib.descriptorSize(), 32)
        self.assertEqual(iib.getChannels(), cv2.iib.IIBDescriptorExtractor_CHANNELS_DEFAULT)
        self.assertAlmostEqual(IIB.scaleFactorFor('AKAZE'), 12)

    def test_extra_channels_change_the_descriptor(self):
        iib = cv2.iib.IIBDescriptorExtractor.create(extraChannels=1)
        depth = noise(3).astype(np.float32)
        _, with_depth = iib.computeWithChannels(noise(1), [depth], grid())
        _, with_other = iib.computeWithChannels(noise(1), [noise(4)], grid())
        self.assertEqual(with_depth.shape, with_other.shape)
        self.assertFalse(np.array_equal(with_depth, with_other))

    def test_selection_is_a_numpy_array(self):
        iib = cv2.iib.IIBDescriptorExtractor.create()
        _, whole = iib.compute(noise(6), grid())
        # level 1 has one quad: all channels, all bits
        quads = np.array([[1, channel, 0, 0, 15] for channel in range(4)], np.int32)
        iib.setSelection(quads)
        np.testing.assert_array_equal(iib.getSelection(), quads)
        self.assertEqual(list(iib.levelSizes()), [2])
        _, coarse = iib.compute(noise(6), grid())
        np.testing.assert_array_equal(coarse, whole[:, :2])

    def test_border_drop_returns_the_keypoints_that_are_left(self):
        iib = cv2.iib.IIBDescriptorExtractor.create()
        iib.setBorder(cv2.iib.IIBDescriptorExtractor_BORDER_DROP)
        keypoints, descriptors = iib.compute(noise(8), grid())
        self.assertEqual([k.pt for k in keypoints],
                         [k.pt for k in grid() if 9 <= k.pt[0] < 150 and 9 <= k.pt[1] < 110])
        self.assertEqual(len(descriptors), len(keypoints))


class MatchRotatedTest(unittest.TestCase):

    def test_of_images_and_of_keypoints(self):
        first = noise(10, (240, 240))
        second = np.ascontiguousarray(np.rot90(first, -1))  # clockwise
        iib = cv2.iib.IIBDescriptorExtractor.createPreset(cv2.iib.IIBDescriptorExtractor_PRESET_UNIVERSAL)
        iib.setOrientation(cv2.iib.IIBDescriptorExtractor_ORIENTATION_KEYPOINT)
        matcher = cv2.iib.HierarchicalMatcher.createRecommended()
        rotation, a, b, matches = cv2.iib.matchRotated(first, second, iib, matcher)
        self.assertLess(abs(rotation - 90), 2)
        self.assertGreater(len(matches), 20)
        again = cv2.iib.matchRotated(first, iib.detect(first), second, iib.detect(second), iib, matcher)
        self.assertEqual(rotation, again[0])
        for one, other in zip((a, b), again[1:3]):
            self.assertEqual([(k.pt, k.angle) for k in one], [(k.pt, k.angle) for k in other])
        self.assertEqual([(m.queryIdx, m.trainIdx) for m in matches], [(m.queryIdx, m.trainIdx) for m in again[3]])
        self.assertEqual(cv2.iib.matchRotated(first, second, iib, matcher, 90.0)[0], 90)


class Codes(unittest.TestCase):

    def setUp(self):
        rng = np.random.default_rng(6)
        self.query = rng.integers(0, 256, (50, 170), np.uint8)
        self.train = rng.integers(0, 256, (70, 170), np.uint8)
        self.train[10:60] = self.query ^ (rng.random((50, 170)) < 0.1)
        self.levels = cv2.iib.IIBDescriptorExtractor.create().levelSizes()


class MatcherTest(Codes):

    def test_recommended_chain(self):
        image = np.random.default_rng(3).integers(0, 256, (120, 160)).astype(np.uint8)
        image = cv2.GaussianBlur(image, (0, 0), 1.5)
        keypoints, codes = cv2.iib.IIB.createRecommended(60).detectAndCompute(image, None)
        found = cv2.iib.HessianDetector.create(60).detect(image)
        self.assertEqual([k.pt for k in keypoints], [k.pt for k in found])
        matches = cv2.iib.HierarchicalMatcher.createRecommended().match(codes, codes)
        self.assertEqual([m.trainIdx for m in matches], [m.queryIdx for m in matches])
        self.assertGreater(len(matches), 30)

    def test_arrays_equal_matches(self):
        matcher = cv2.iib.HierarchicalMatcher.create(self.levels)
        matches = matcher.knnMatch(self.query, self.train, 3)
        indices, distances = matcher.knnMatchArrays(self.query, self.train, k=3)[:2]
        np.testing.assert_array_equal(indices, [[m.trainIdx for m in row] for row in matches])
        np.testing.assert_array_equal(distances, [[m.distance for m in row] for row in matches])
        matcher.add([self.train])
        added = matcher.knnMatchArrays(self.query, k=3)
        np.testing.assert_array_equal(added[0], indices)
        np.testing.assert_array_equal(added[1], distances)
        np.testing.assert_array_equal(added[2], np.zeros_like(indices))

    def test_clone_keeps_its_class_and_codes(self):
        matcher = cv2.iib.HierarchicalMatcher.create(self.levels, crossCheck=True)
        matcher.add([self.train])
        clone = matcher.clone()
        self.assertIsInstance(clone, cv2.iib.HierarchicalMatcher)
        self.assertEqual([m.trainIdx for m in clone.match(self.query)],
                         [m.trainIdx for m in matcher.match(self.query)])
        self.assertTrue(matcher.clone(emptyTrainData=True).getCrossCheck())
        self.assertEqual(len(matcher.clone(True).getTrainDescriptors()), 0)


if __name__ == '__main__':
    unittest.main()
