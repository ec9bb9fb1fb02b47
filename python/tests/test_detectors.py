import copy
import gc
import pickle
import unittest
import weakref

import numpy as np

import opencv_iib
from opencv_iib import HessianDetector, HierarchicalMatcher, IIB, NormalizedDetector, estimateRotation, matchRotated
from support import cv2, texture


class Watching:
    """A detector that stores its image and mask, and finds one keypoint."""

    def getDefaultName(self):
        return 'Feature2D.SIFT'

    def detect(self, image, mask=None):
        self.image, self.mask = image, mask
        return np.array([[20, 30, 5]], np.float32)


class Hessian(unittest.TestCase):

    def test_parameters_and_pickle(self):
        detector, values = HessianDetector(50, threshold=.5), {'Scales': 4, 'Sigma': 3, 'NormalizationSigma': 6, 'WorkingSize': 700}
        for name, value in values.items():
            getattr(detector, 'set' + name)(value)
        for twin in (detector, copy.copy(detector), copy.deepcopy(detector), pickle.loads(pickle.dumps(detector))):
            self.assertEqual([getattr(twin, 'get' + name)() for name in ('MaxFeatures', 'Threshold', *values)], [50, .5, *values.values()])
        detector.setMaxFeatures(0)
        self.assertEqual(detector.getMaxFeatures(), 0)


class Normalized(unittest.TestCase):

    def test_sigma_and_mask_get_there(self):
        detector, image = Watching(), texture(160, 120)
        normalized = NormalizedDetector(detector)
        self.assertEqual(normalized.getSigma(), 4)
        self.assertEqual([k.pt for k in normalized.detect(image // 4)], [(20, 30)])
        seen = detector.image
        self.assertEqual((seen.shape, seen.dtype), (image.shape, np.uint8))
        self.assertLess(abs(seen.mean() - 128), 4)  # normalized
        normalized.setSigma(9)
        mask = np.zeros((120, 160), np.uint8)
        mask[3, 5] = 255
        normalized.detect(image, mask > 0)
        self.assertEqual(normalized.getSigma(), 9)
        self.assertTrue((seen != detector.image).any())
        np.testing.assert_array_equal(detector.mask, mask)

    def test_mistakes_raise(self):
        with self.assertRaisesRegex(opencv_iib.error, 'does not describe'):
            NormalizedDetector(Watching()).compute(texture(50, 50), [])
        with self.assertRaisesRegex(TypeError, 'detect'):
            NormalizedDetector(object())

    def test_an_object_whose_extractor_asks_it_for_keypoints_is_collected(self):
        class Owner(Watching):
            def __init__(self, wrap):
                self.iib = IIB.createFor(wrap(self))

        for wrap in (lambda owner: owner, NormalizedDetector):
            owner = Owner(wrap)
            self.assertEqual(len(owner.iib.detect(texture(60, 60))), 1)
            watched = weakref.ref(owner)
            del owner
            gc.collect()
            self.assertIsNone(watched())
        iib = IIB.createFor(NormalizedDetector(Watching()))
        self.assertEqual(iib.getScaleFactor(), 20)
        gc.collect()
        self.assertEqual(len(copy.copy(iib).detect(texture(60, 60))), 1)

    def test_pickle_and_copy(self):
        normalized = NormalizedDetector(Watching(), 7)
        for twin in (copy.copy(normalized), copy.deepcopy(normalized)):
            self.assertEqual((twin.getSigma(), len(twin.detect(texture(60, 60)))), (7, 1))
        other = pickle.loads(pickle.dumps(normalized))
        self.assertEqual(other.getSigma(), 7)
        with self.assertRaisesRegex(RuntimeError, 'SIFT was not pickled'):
            other.detect(texture(60, 60))
        iib = IIB.createFor(NormalizedDetector(HessianDetector(20)))
        self.assertEqual(len(pickle.loads(pickle.dumps(iib)).detect(texture(160, 120))), 20)

    @unittest.skipIf(cv2 is None, 'no cv2')
    def test_it_describes_as_the_detector_inside(self):
        orb, image = cv2.ORB_create(100), texture(320, 240)
        normalized = NormalizedDetector(orb)
        self.assertEqual((normalized.descriptorSize(), normalized.defaultNorm()), (32, cv2.NORM_HAMMING))
        keypoints, descriptors = normalized.detectAndCompute(image)
        self.assertGreater(len(keypoints), 20)
        np.testing.assert_array_equal(descriptors, orb.compute(image, keypoints)[1])


class MatchRotated(unittest.TestCase):

    def setUp(self):
        image = texture(320, 320)
        self.images = image, np.ascontiguousarray(np.rot90(image, -1))  # clockwise
        self.extractor = IIB.createPreset(IIB.PRESET_UNIVERSAL, 2)
        self.extractor.setOrientation(IIB.ORIENTATION_KEYPOINT)
        self.matcher = HierarchicalMatcher.createRecommended()
        places = np.stack(np.meshgrid(np.arange(40, 280, 12), np.arange(40, 280, 12)), 2).reshape(-1, 2)
        turned = np.stack([319 - places[:, 1], places[:, 0]], 1)
        self.rows = [np.hstack([p, np.full((len(p), 1), 24)]).astype(np.float32) for p in (places, turned)]

    def call(self, rotation=-1, **keypoints):
        return matchRotated(*self.images, self.extractor, self.matcher, rotation, **keypoints)

    def test_arrays(self):
        rotation, first, second, matches = self.call(keypoints1=self.rows[0], keypoints2=self.rows[1])
        self.assertLess(abs(rotation - 90), 1)
        self.assertGreater(len(matches), 0.9 * len(first))
        self.assertGreater(np.mean(matches[:, 0] == matches[:, 1]), 0.95)
        for given, described, angle in zip(self.rows, (first, second), (-1, rotation)):
            np.testing.assert_array_equal(described[:, :3], given)
            np.testing.assert_array_equal(described[:, 3], np.float32(angle))
        # the same steps by hand
        codes = [self.extractor.compute(image, rows)[1] for image, rows in zip(self.images, (first, second))]
        by_hand = self.matcher.match(*codes)
        self.assertEqual([(m.queryIdx, m.trainIdx, m.distance) for m in by_hand], [tuple(m) for m in matches.tolist()])

    def test_the_angle_of_objects_and_of_arrays(self):
        pairs = np.stack([np.arange(len(self.rows[0]), dtype=np.int16)] * 2, axis=1)
        angle = estimateRotation(*self.rows, pairs)
        self.assertLess(abs(angle - 90), 1)
        objects = [[opencv_iib.KeyPoint(*row) for row in rows.tolist()] for rows in self.rows]
        self.assertEqual(estimateRotation(*objects, [opencv_iib.DMatch(*pair, 0, 1.) for pair in pairs.tolist()]), angle)

    def test_it_detects(self):
        rotation, first, second, matches = self.call()
        self.assertLess(abs(rotation - 90), 2)
        self.assertEqual([k.pt for k in first], [k.pt for k in self.extractor.detect(self.images[0])])
        self.assertEqual({k.angle for k in first}, {-1})
        self.assertGreater(len(matches), 50)
        self.assertEqual(self.call(90)[0], 90)
