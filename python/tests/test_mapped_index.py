import pickle

import numpy as np

from opencv_iib import HierarchicalMatcher, MappedIndex, error
from support import InFolder, brute_force


class MappedIndexTest(InFolder):

    def setUp(self):
        super().setUp()
        self.folder /= 'index'
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
        rows, _ = index.search(self.queries, 181, segment=1)
        np.testing.assert_array_equal(rows[:, :180], brute_force(self.queries, self.codes[120:], 180)[0] + 120)
        self.assertTrue((rows[:, 180] == -1).all())
        self.assertEqual(index.search(self.queries[:0], 3)[0].shape, (0, 3))
        with self.assertRaisesRegex(error, r'are 300 descriptors to find: ask for at most 3355443 for each of 20 queries'):
            index.search(self.queries, 3355444)
        many = np.zeros((4000, self.queries.shape[1]), np.uint8)  # each part of the queries alone would fit
        matcher = HierarchicalMatcher()
        matcher.add(self.codes)
        for search in (index.search, lambda queries, k: matcher.knnMatchArrays(queries, k=k), lambda queries, k: matcher.knnMatchArrays(queries, self.codes, k)):
            with self.assertRaisesRegex(error, r'are 300 descriptors to find: ask for at most 16777 for each of 4000 queries'):
                search(many, 20000)
            self.assertEqual(search(many, 301)[0].shape, (4000, 301))

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
