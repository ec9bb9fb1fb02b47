#!/usr/bin/env python3
"""Tests of cv2.iib that do not fit into misc/python/test/test_iib.py; scripts/intree.sh runs them. A patch of opencv_contrib may have a
million bytes."""
import os
import pathlib
import sys
import tempfile
import unittest

import cv2
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / 'modules/iib/misc/python/test'))
from test_iib import Codes, grid, noise  # noqa: E402


class DescriptorTest(unittest.TestCase):

    def test_mistakes_raise(self):
        IIB = cv2.iib.IIBDescriptorExtractor
        nan = np.full((50, 60), np.nan, np.float32)
        for culprit, call in (('granularity is 7', lambda: IIB.create(granularity=7)), ('the image is NaN', lambda: IIB.create().compute(nan, grid()))):
            with self.assertRaisesRegex(cv2.error, culprit):
                call()

    def test_maps_are_in_a_list(self):
        iib = cv2.iib.IIBDescriptorExtractor.create(extraChannels=1)
        with self.assertRaisesRegex(cv2.error, 'a list of maps'):
            iib.computeWithChannels(noise(1), noise(3), grid())

    def test_short_names_are_the_same_objects(self):
        self.assertIs(cv2.iib.IIB, cv2.iib.IIBDescriptorExtractor)
        self.assertEqual(cv2.iib.IIB_create(granularity=2).getGranularity(), 2)
        self.assertEqual(cv2.iib.IIB_createPreset(cv2.iib.IIB_PRESET_BALANCED).descriptorSize(), 64)

    def test_parameters_survive_a_file(self):
        iib = cv2.iib.IIBDescriptorExtractor.create(
            scaleFactor=3.5, granularity=3, channels=51, mapping=cv2.iib.IIBDescriptorExtractor_MAPPING_PAIRWISE,
            useOrientation=True)
        iib.setSelection(np.array([[1, 0, 0, 0, 5], [3, 3, 6, 1, 8]], np.int32))
        loaded = cv2.iib.IIBDescriptorExtractor.create()
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, 'iib.yml')
            iib.write(path)
            loaded.read(path)
        for name in (name for name in dir(iib) if name.startswith('get') and name != 'getDetector'):
            np.testing.assert_array_equal(getattr(iib, name)(), getattr(loaded, name)(), name)
        np.testing.assert_array_equal(iib.compute(noise(7), grid())[1], loaded.compute(noise(7), grid())[1])


class MatcherTest(Codes):

    def test_index_survives_a_file(self):
        matcher = cv2.iib.HierarchicalMatcher.create(self.levels)
        matcher.add([self.train])
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, 'index.bin')
            matcher.saveIndex(path)
            loaded = cv2.iib.HierarchicalMatcher.loadIndex(path)
        self.assertEqual([m.trainIdx for m in loaded.match(self.query)],
                         [m.trainIdx for m in matcher.match(self.query)])


class GeometryTest(unittest.TestCase):

    def test_views_and_transforms_of_a_rotated_and_a_moved_picture(self):
        picture = cv2.GaussianBlur(noise(5, (320, 400)), (0, 0), 2)
        found, points1, points2, *_, reason = cv2.iib.matchViews(picture, cv2.rotate(picture, cv2.ROTATE_90_CLOCKWISE))
        self.assertTrue(found, reason)
        rotated = np.column_stack((319 - points1[:, 1], points1[:, 0]))
        np.testing.assert_allclose(np.median(points2 - rotated, axis=0), 0, atol=.1)
        found, transform, *_, simplest, _ = cv2.iib.alignImages(picture, picture[16:, 32:], model=cv2.iib.ALIGN_AUTO)
        self.assertEqual((found, simplest), (True, cv2.iib.ALIGN_TRANSLATION))
        np.testing.assert_allclose(transform, [[1, 0, 32], [0, 1, 16], [0, 0, 1]], atol=.1)


if __name__ == '__main__':
    unittest.main()
