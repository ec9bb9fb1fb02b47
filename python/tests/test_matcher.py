import copy
import pickle
import time
import unittest

import numpy as np

import opencv_iib
from opencv_iib import HierarchicalMatcher, MappedIndex
from support import InFolder, brute_force, cv2, scatter, seconds_until_interrupt, steps_meanwhile, texture

LEVELS = (2, 8, 32, 128)


def keys(rows):
    return [[(m.queryIdx, m.trainIdx, m.imgIdx, m.distance) for m in row] for row in rows]


class MatcherTest(InFolder):

    def setUp(self):
        super().setUp()
        rng = np.random.default_rng(6)
        self.query = rng.integers(0, 256, (50, 170), np.uint8)
        self.train = rng.integers(0, 256, (70, 170), np.uint8)
        self.train[10:60] = self.query ^ (rng.random((50, 170)) < .1)
        self.matcher = HierarchicalMatcher.create(LEVELS)

    def test_the_three_kinds_of_matches_agree(self):
        indices, distances = brute_force(self.query, self.train, 2)
        knn = self.matcher.knnMatch(self.query, self.train, 2)
        self.assertEqual([[(m.trainIdx, m.distance) for m in row] for row in knn],
                         [list(zip(i, d)) for i, d in zip(indices.tolist(), distances.tolist())])
        self.assertEqual(keys([self.matcher.match(self.query, self.train)]), [[row[0] for row in keys(knn)]])
        within = self.matcher.radiusMatch(self.query, self.train, 200)
        self.assertEqual([[m.trainIdx for m in row] for row in within], [[i] for i in range(10, 60)])

    def test_added_images(self):
        given = [self.train[:30].copy(), self.train[30:]]
        self.matcher.add(given)
        given[0][:] = 0  # they are copied
        self.assertFalse(self.matcher.empty())
        indices, distances, images = self.matcher.knnMatchArrays(self.query, k=2)
        expected = brute_force(self.query, self.train, 2)
        np.testing.assert_array_equal(indices + 30 * images, expected[0])
        np.testing.assert_array_equal(distances, expected[1])
        for rows in (self.matcher.knnMatch(self.query, 2), self.matcher.knnMatch(self.query, k=2)):
            np.testing.assert_array_equal([[m.trainIdx + 30 * m.imgIdx for m in row] for row in rows], expected[0])
        self.assertEqual(len(self.matcher.match(self.query)), 50)
        self.assertEqual([len(d) for d in self.matcher.getTrainDescriptors()], [30, 40])
        self.matcher.clear()
        self.assertTrue(self.matcher.empty())

    def test_masks(self):
        mask = np.ones((50, 70), np.uint8)
        mask[:, 10] = 0
        indices, _ = self.matcher.knnMatchArrays(self.query, self.train, mask=mask)
        self.assertTrue((indices != 10).all())
        np.testing.assert_array_equal(
            [m.trainIdx for m in self.matcher.match(self.query, self.train, mask)], indices.ravel())

    def test_nothing_to_match(self):
        empty = np.empty((0, 170), np.uint8)
        self.assertEqual(self.matcher.match(empty, self.train), ())
        self.assertEqual(self.matcher.knnMatchArrays(empty, self.train, k=2)[0].shape, (0, 2))
        self.assertTrue((self.matcher.knnMatchArrays(self.query, empty)[0] == -1).all())

    def expect_same(self, a, b):
        self.assertEqual((a.levelSizes(), a.getMode(), a.getThresholds(), a.getCrossCheck(), a.getMaxRatio()),
                         (b.levelSizes(), b.getMode(), b.getThresholds(), b.getCrossCheck(), b.getMaxRatio()))
        for x, y in zip(a.knnMatchArrays(self.query, k=3), b.knnMatchArrays(self.query, k=3)):
            np.testing.assert_array_equal(x, y)

    def test_pickle_copy_clone_and_file_keep_the_codes(self):
        matcher = HierarchicalMatcher.create(LEVELS, HierarchicalMatcher.THRESHOLD, .41, True)
        matcher.setMaxRatio(.93)
        matcher.add([self.train[:30], self.train[30:]])
        self.expect_same(matcher, pickle.loads(pickle.dumps(matcher)))
        for twin in (copy.copy(matcher), copy.deepcopy(matcher), matcher.clone()):
            self.expect_same(matcher, twin)
        self.assertTrue(matcher.clone(True).empty())
        matcher.saveIndex(self.folder / 'index.bin')
        self.expect_same(matcher, HierarchicalMatcher.loadIndex(self.folder / 'index.bin'))

    def test_without_level_sizes(self):
        matcher = HierarchicalMatcher.create()
        self.assertEqual(matcher.levelSizes(), ())
        matcher.add(self.train)
        self.assertEqual(matcher.levelSizes(), (170,))
        twin = pickle.loads(pickle.dumps(matcher))
        self.expect_same(matcher, twin)
        twin.clear()
        self.assertEqual(len(twin.match(self.query[:, :9], self.train[:, :9])), 50)
        chosen = HierarchicalMatcher(mode=HierarchicalMatcher.ADAPTIVE, crossCheck=True)
        self.assertEqual((chosen.getMode(), chosen.getCrossCheck()), (HierarchicalMatcher.ADAPTIVE, True))

    def test_the_gil_is_released(self):
        codes = np.random.default_rng(1).integers(0, 256, (6000, 170), np.uint8)
        self.matcher.add(codes)
        image, points, iib = np.tile(texture(320, 240), (4, 4)), np.tile(scatter(1280, 960, 5000, 3, 40, 2), (20, 1)), opencv_iib.IIB()
        index = MappedIndex.create(self.folder, LEVELS)
        index.add(codes)
        for call in (lambda: self.matcher.knnMatchArrays(codes, codes), lambda: self.matcher.knnMatchArrays(codes),
                     lambda: index.search(codes), lambda: iib.compute(image, points)):
            self.assertGreater(steps_meanwhile(call), 2)

    @unittest.skipIf(cv2 is None, 'no cv2')
    def test_matches_are_objects_of_cv2(self):
        ours = self.matcher.match(self.query, self.train)
        self.assertIsInstance(ours[0], cv2.DMatch)
        points = [cv2.KeyPoint(float(i), 5, 3) for i in range(70)]
        image = np.zeros((20, 80), np.uint8)
        self.assertIsNotNone(cv2.drawMatches(image, points, image, points, ours, None))

    def test_many_queries(self):
        """512 queries are searched at a time."""
        rng = np.random.default_rng(5)
        queries, train = rng.integers(0, 256, (1100, 4), np.uint8), rng.integers(0, 256, (60, 4), np.uint8)
        indices, distances = brute_force(queries, train, 3)
        matcher = HierarchicalMatcher()
        arrays = matcher.knnMatchArrays(queries, train, 3)
        np.testing.assert_array_equal(arrays, [indices, distances])
        self.assertEqual({array.dtype for array in arrays}, {np.dtype(np.int32)})
        self.assertEqual(matcher.matchCost(), 1)
        matcher.resetCost()
        self.assertEqual(matcher.matchCost(), 0)
        found = matcher.knnMatch(queries, train, 3)
        self.assertEqual([[(m.queryIdx, m.trainIdx) for m in row] for row in found],
                         [[(q, t) for t in row] for q, row in enumerate(indices.tolist())])
        near = matcher.radiusMatch(queries, train, 8, compactResult=True)
        self.assertEqual([row[0].queryIdx for row in near], np.flatnonzero(distances[:, 0] <= 8).tolist())
        mask = np.zeros((1100, 60), np.uint8)
        mask[np.arange(1100), np.arange(1100) % 60] = 1
        np.testing.assert_array_equal(matcher.knnMatchArrays(queries, train, 1, mask)[0].ravel(), np.arange(1100) % 60)
        for rows in (512, 588):
            with self.assertRaises(opencv_iib.error):
                matcher.knnMatchArrays(queries, train, 1, mask[:rows])
        matcher.add([train[:20], train[20:]])
        indices, distances, images = matcher.knnMatchArrays(queries, k=3)
        np.testing.assert_array_equal(indices + 20 * images, brute_force(queries, train, 3)[0])
        matcher.setCrossCheck(True)
        self.assertEqual(len(matcher.match(queries, train)), len(matcher.match(train, queries)))

    def test_an_interrupt_acts_promptly(self):
        rng = np.random.default_rng(5)
        queries, train = rng.integers(0, 256, (512, 32), np.uint8), rng.integers(0, 256, (100000, 32), np.uint8)
        index = MappedIndex.create(self.folder, [32])
        index.add(train)
        for search in (lambda codes: HierarchicalMatcher().knnMatchArrays(codes, train), index.search):
            begin = time.monotonic()
            search(queries)
            block = time.monotonic() - begin
            self.assertLess(seconds_until_interrupt(lambda: search(np.repeat(queries, 200, 0)), block), 60 * block)
