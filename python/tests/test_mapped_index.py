import pickle
import tempfile
import unittest
from pathlib import Path

import numpy as np

import opencv_iib
from opencv_iib import MappedIndex
from support import brute_force


class MappedIndexTest(unittest.TestCase):

    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name) / 'index'
        rng = np.random.default_rng(7)
        self.codes = rng.integers(0, 256, (300, 42), np.uint8)
        self.queries = rng.integers(0, 256, (20, 42), np.uint8)
        self.index = MappedIndex.create(self.folder, (2, 8, 32))
        self.index.add([self.codes[:100], self.codes[100:120]])
        self.index.add(self.codes[120:])

    def test_finds_what_brute_force_finds(self):
        for index in (self.index, MappedIndex.open(self.folder), pickle.loads(pickle.dumps(self.index))):
            rows, distances = index.search(self.queries, 5)
            expected = brute_force(self.queries, self.codes, 5)
            np.testing.assert_array_equal(rows, expected[0])
            np.testing.assert_array_equal(distances, expected[1])
            self.assertEqual((rows.dtype, distances.dtype), (np.int64, np.int32))

    def test_what_it_holds(self):
        index = MappedIndex(self.folder)
        self.assertEqual((index.levelSizes(), index.images(), index.rows(), index.segments()), ((2, 8, 32), 3, 300, 2))
        self.assertEqual([index.firstRow(image) for image in range(3)], [0, 100, 120])
        self.assertEqual([index.imageOf(row) for row in (0, 99, 100, 119, 120, 299)], [0, 0, 1, 1, 2, 2])
        np.testing.assert_array_equal(index.descriptors(1), self.codes[100:120])

    def test_one_segment(self):
        rows, _ = self.index.search(self.queries, 2, segment=1)
        np.testing.assert_array_equal(rows, brute_force(self.queries, self.codes[120:], 2)[0] + 120)

    def test_removed_images(self):
        reader = MappedIndex(self.folder)
        before = reader.search(self.queries)
        self.index.remove([0])
        np.testing.assert_array_equal(self.index.search(self.queries)[0],
                                      brute_force(self.queries, self.codes[100:], 1)[0] + 100)
        np.testing.assert_array_equal(reader.search(self.queries)[0], before[0])
        self.assertNotEqual(reader.version(), self.index.version())
        reader.refresh()
        self.assertEqual(reader.version(), self.index.version())

    def test_fewer_than_k_and_no_queries(self):
        rows, distances = self.index.search(self.queries, 301)
        self.assertTrue((rows[:, 300] == -1).all() and (distances[:, 300] == -1).all() and (rows[:, 299] >= 0).all())
        self.assertEqual(self.index.search(self.queries[:0], 3)[0].shape, (0, 3))

    def test_mistakes_raise(self):
        for call in (lambda: MappedIndex(self.folder / 'none'),
                     lambda: MappedIndex.create(self.folder, (42,)),
                     lambda: self.index.search(self.queries, 0),
                     lambda: self.index.search(self.queries[:, 1:]),
                     lambda: self.index.search(self.queries, segment=2),
                     lambda: self.index.add(self.codes[:, 1:]),
                     lambda: self.index.remove([3]),
                     lambda: self.index.imageOf(300)):
            with self.assertRaises(opencv_iib.error):
                call()
        with self.assertRaises(TypeError):
            self.index.search('codes')
