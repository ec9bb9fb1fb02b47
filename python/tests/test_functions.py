"""Functions from arrays to arrays, and tensors."""
import unittest

import numpy as np

import opencv_iib
from support import texture


class Tensor:
    """Like tensors of torch and kornia: no array, but with DLPack and the array interface."""

    def __init__(self, array):
        self.array = array

    def __array__(self, dtype=None, copy=None):
        return self.array

    def __dlpack__(self, **keywords):
        return self.array.__dlpack__(**keywords)

    def permute(self, *axes):
        return Tensor(self.array.transpose(axes))


class Functions(unittest.TestCase):

    def setUp(self):
        self.image = np.kron(texture(80, 60), np.ones((4, 4), np.uint8))

    def test_they_are_the_recommended_chain(self):
        other = np.roll(self.image, (7, 5), (0, 1))
        iib, expected, found = opencv_iib.IIB.createRecommended(200), [], []
        for image in (self.image, other):
            keypoints, codes = iib.detectAndCompute(image)
            rows = opencv_iib.keypoints_to_array(keypoints)
            features = opencv_iib.detect_and_describe(image, 200)
            for array, same in zip(features, (rows[:, :2], rows[:, 2], codes)):
                self.assertEqual(array.dtype, same.dtype)
                np.testing.assert_array_equal(array, same)
            found.append(features.codes)
        self.assertEqual(len(found[0]), 200)
        pairs, distances = opencv_iib.match(*found)
        expected = opencv_iib.HierarchicalMatcher.createRecommended().match(*found)
        self.assertGreater(len(expected), 50)
        self.assertEqual(pairs.tolist(), [[m.queryIdx, m.trainIdx] for m in expected])
        self.assertEqual(distances.tolist(), [m.distance for m in expected])
        every = opencv_iib.match(*found, opencv_iib.HierarchicalMatcher())
        self.assertEqual(every.pairs[:, 0].tolist(), list(range(200)))

    def test_nothing_found(self):
        points, sizes, codes = opencv_iib.detect_and_describe(np.zeros((100, 100), np.uint8))
        self.assertEqual((points.shape, sizes.shape, codes.shape), ((0, 2), (0,), (0, 128)))
        some = opencv_iib.detect_and_describe(self.image).codes
        for a, b in ((codes, codes), (codes, some), (some, codes)):
            pairs, distances = opencv_iib.match(a, b)
            self.assertEqual((pairs.shape, pairs.dtype, distances.shape), ((0, 2), np.int32, (0,)))

    def test_tensors_with_channels_first(self):
        rows = np.dstack([np.roll(self.image, 9 * i, 1) for i in range(3)])  # blue, green, red
        alpha = np.dstack([rows, self.image])
        try:
            import torch
            tensors = Tensor, torch.from_numpy
        except ImportError:
            tensors = Tensor,
        for tensor in tensors:
            for image in (self.image, rows, alpha, rows.astype(np.float32) / 255):
                expected = opencv_iib.detect_and_describe(image)
                planes = image[None] if image.ndim == 2 else np.stack([image[..., i] for i in (2, 1, 0, 3)[:image.shape[2]]])
                aside = tensor(np.ascontiguousarray(np.moveaxis(planes, 0, 2)))  # kornia's are not contiguous
                for given in (tensor(planes), tensor(planes[None]), tensor(image), aside.permute(2, 0, 1)):
                    self.assertTrue(all(map(np.array_equal, opencv_iib.detect_and_describe(given), expected)), planes.shape)
            codes, keypoints = tensor(expected.codes), np.column_stack([expected.points, expected.sizes])
            self.assertEqual(opencv_iib.match(codes, codes).pairs.tolist(), opencv_iib.match(*[expected.codes] * 2).pairs.tolist())
            iib = opencv_iib.IIB()
            np.testing.assert_array_equal(iib.compute(self.image, tensor(keypoints))[1], iib.compute(self.image, keypoints)[1])
        with self.assertRaises(opencv_iib.error):
            opencv_iib.detect_and_describe(planes)  # channels come first, which cannot be known of a numpy array
        if len(tensors) > 1:
            with self.assertRaisesRegex((RuntimeError, TypeError, opencv_iib.error), 'grad'):
                opencv_iib.detect_and_describe(torch.from_numpy(planes).requires_grad_())
