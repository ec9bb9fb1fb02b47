import copy
import gzip
import os
import pickle
import unittest

import numpy as np

import opencv_iib
from opencv_iib import IIB
from support import InFolder, cv2, fnv1a, grid, scatter, texture

#: Arguments, and hashes of the bits with BORDER_CLAMP and BORDER_REFLECT: some of modules/iib/test/descriptor/test_descriptor_golden.cpp.
GOLDEN = {
    'default': ({}, 0x7c4943b59e478a06, 0x2e989fe2274d8bf2),
    'mapping boxes': ({'mapping': IIB.MAPPING_BOXES, 'channels': 59, 'granularity': 5}, 0xcad76b68589c37fa, 0x35fcadab22d3f94b),
    'overlap': ({'overlap': True}, 0x00d9099cf996758a, 0xb6fd87a0cae57e55),
    'extra channels': ({'extraChannels': 3}, 0x3ad673a19c71489b, 0xd050ead518708479),
    'orientation of keypoints': ({'useOrientation': True}, 0xc9b6b569adef32d3, 0xcf5d28d3a6d3c3cf),
    '16U': ({'dtype': np.uint16}, 0x3a73cd0cc49a4d35, 0xacd8eaffd184a7b8),
    '32F': ({'dtype': np.float32}, 0xe2fae45b47d39a52, 0xf7c8c748aa6ac915),
    '8U colour': ({'colours': 3}, 0x5f19de037522b744, 0xb45d221b4e67cc73),
    '32F colour': ({'dtype': np.float32, 'colours': 3}, 0x5dbab4a1ac078b99, 0x2f0bca6c2417e44b),
}


def golden_image(dtype, colours):
    image = texture(320 * colours, 240, np.uint8 if dtype == np.uint8 else np.uint16)
    if dtype == np.float32:
        image = (image / 4096 - 3).astype(np.float32)  # exact
    return image.reshape(240, 320, colours) if colours > 1 else image


class Bits(unittest.TestCase):

    def test_golden_hashes_of_the_cpp_tests(self):
        keypoints = np.vstack([scatter(320, 240, 500, 3, 40, 2), [[160, 120, 300, -1]]]).astype(np.float32)
        for name, (options, *hashes) in GOLDEN.items():
            with self.subTest(name):
                arguments = dict(options)
                image = golden_image(arguments.pop('dtype', np.uint8), arguments.pop('colours', 1))
                iib = IIB.create(**arguments)
                extra = [texture(320, 240, np.uint16 if i % 2 else np.uint8, 100 + i)
                         for i in range(iib.getExtraChannels())]
                for border, expected in zip((IIB.BORDER_CLAMP, IIB.BORDER_REFLECT), hashes):
                    iib.setBorder(border)
                    _, descriptors = iib.computeWithChannels(image, extra, keypoints)
                    self.assertEqual(fnv1a(descriptors), expected)


class Arrays(unittest.TestCase):

    def setUp(self):
        self.image, self.iib = texture(160, 120), IIB.create()
        self.expected = self.iib.compute(self.image, grid())[1]

    def check(self, image, keypoints=None):
        given = grid() if keypoints is None else keypoints
        kept, descriptors = self.iib.compute(image, given)
        self.assertIs(kept, given)
        np.testing.assert_array_equal(descriptors, self.expected)

    def test_strided_fortran_read_only_and_big_endian_images(self):
        wide = np.zeros((240, 320), np.uint8)
        wide[::2, ::2] = self.image
        self.check(wide[::2, ::2])
        self.check(np.asfortranarray(self.image))
        self.check(self.image[::-1][::-1])
        locked = self.image.copy()
        locked.flags.writeable = False
        self.check(locked)
        np.testing.assert_array_equal(locked, texture(160, 120))
        deep = self.image.astype(np.uint16) * 7
        np.testing.assert_array_equal(self.iib.compute(deep.astype('>u2'), grid())[1],
                                      self.iib.compute(deep.astype('<u2'), grid())[1])

    def test_array_interface(self):
        class Foreign:
            __array_interface__ = self.image.__array_interface__
            keep = self.image
        self.check(Foreign())

    def test_keypoint_arrays(self):
        rows = grid()
        self.check(self.image, rows.astype(np.float64))
        self.check(self.image, np.hstack([rows, np.full((48, 1), -1, np.float32)]))
        seven = np.zeros((48, 7), np.float32)
        seven[:, :3], seven[:, 3] = rows, -1
        self.check(self.image, seven)
        self.check(self.image, np.asfortranarray(seven))

    def test_keypoint_objects_come_back_themselves(self):
        for make in filter(None, (opencv_iib.KeyPoint, cv2 and cv2.KeyPoint)):
            keypoints = [make(x, y, size) for x, y, size in grid().tolist()]
            self.check(self.image, keypoints)
            self.check(self.image, tuple(keypoints))

    def test_border_drop_gives_back_what_is_left(self):
        self.iib.setBorder(IIB.BORDER_DROP)
        inside = [(x, y) for x, y, _ in grid().tolist() if 9 <= x < 150 and 9 <= y < 110]
        rows, descriptors = self.iib.compute(self.image, grid())
        self.assertEqual([tuple(r[:2]) for r in rows.tolist()], inside)
        self.assertEqual(len(descriptors), len(inside))
        keypoints = [opencv_iib.KeyPoint(x, y, size) for x, y, size in grid().tolist()]
        left, _ = self.iib.compute(self.image, keypoints)
        self.assertTrue(all(any(k is l for k in keypoints) for l in left))
        self.assertEqual([k.pt for k in left], inside)

    def test_nothing_to_describe(self):
        for keypoints in ([], (), np.empty((0, 7), np.float32)):
            kept, descriptors = self.iib.compute(self.image, keypoints)
            self.assertIs(kept, keypoints)
            self.assertEqual(descriptors.shape, (0, 170))
        self.assertEqual(self.iib.compute(np.empty((0, 0), np.uint8), grid())[1].shape, (0, 170))

    def test_mistakes_raise_one_clear_exception(self):
        for culprit, call in (
                ('granularity is 7', lambda: IIB.create(granularity=7)),
                ('selection', lambda: self.iib.setSelection(np.zeros((1, 5), np.float32))),
                ('the image: arrays of int64', lambda: self.iib.compute(self.image.astype(np.int64), grid())),
                ('the image: an array of 2 or 3', lambda: self.iib.compute(np.zeros((2, 2, 2, 2)), grid())),
                ('not of 2', lambda: self.iib.compute(self.image, grid()[:, :2]))):
            with self.subTest(culprit), self.assertRaisesRegex(opencv_iib.error, culprit):
                call()
        for what in ('text', None, object(), [object()]):
            with self.subTest(what), self.assertRaisesRegex(TypeError, 'the image'):
                self.iib.compute(what, grid())
        with self.assertRaises(AttributeError):
            self.iib.compute(self.image, [object()])


class MyIIB(IIB): pass
class MyHessian(opencv_iib.HessianDetector): pass
class MyNormalized(opencv_iib.NormalizedDetector): pass
class MyMatcher(opencv_iib.HierarchicalMatcher): pass
class MyIndex(opencv_iib.MappedIndex): pass


class Objects(InFolder):

    def configured(self):
        iib = IIB.create(scaleFactor=3.7, granularity=3, channels=51, mapping=IIB.MAPPING_PAIRWISE)
        iib.setSelection(np.array([[1, 0, 0, 0, 5], [3, 3, 6, 1, 8]], np.int32))
        iib.setBorder(IIB.BORDER_DROP)
        iib.setOrientation(IIB.ORIENTATION_GRADIENT)
        return iib

    def expect_same(self, a, b):
        for name in ('ScaleFactor', 'Granularity', 'Channels', 'Mapping', 'Overlap', 'UseOrientation', 'Orientation',
                     'ExtraChannels', 'Border'):
            self.assertEqual(getattr(a, 'get' + name)(), getattr(b, 'get' + name)(), name)
        np.testing.assert_array_equal(a.getSelection(), b.getSelection())
        image = texture(160, 120)
        np.testing.assert_array_equal(a.compute(image, grid())[1], b.compute(image, grid())[1])

    def test_pickle_and_copy(self):
        iib = self.configured()
        for protocol in range(2, pickle.HIGHEST_PROTOCOL + 1):
            self.expect_same(iib, pickle.loads(pickle.dumps(iib, protocol)))
        for preset in opencv_iib.Preset:
            preset = IIB.createPreset(preset, 2)
            self.expect_same(preset, pickle.loads(pickle.dumps(preset)))
        self.expect_same(iib, copy.copy(iib))
        self.expect_same(iib, copy.deepcopy(iib))
        twin = copy.copy(iib)
        twin.setGranularity(2)
        self.assertEqual(iib.getGranularity(), 3)

    def test_a_deep_copy_has_a_detector_of_its_own(self):
        iib = IIB.createRecommended(50)
        self.assertIs(copy.copy(iib).getDetector(), iib.getDetector())
        copy.deepcopy(iib).getDetector().setMaxFeatures(3)
        self.assertEqual(len(iib.detect(texture(160, 120))), 50)

    def test_a_subclass_keeps_what_it_adds(self):
        opencv_iib.MappedIndex.create(self.folder, [8])
        for made in (MyIIB(), MyIIB.createRecommended(), MyHessian(), MyNormalized(MyHessian()), MyMatcher(), MyIndex(self.folder)):
            made.notes = ['mine']
            for twin in (copy.copy(made), copy.deepcopy(made), pickle.loads(pickle.dumps(made))):
                self.assertEqual((type(twin), twin.notes), (type(made), ['mine']))
            self.assertIs(copy.copy(made).notes, made.notes)
            self.assertIsNot(copy.deepcopy(made).notes, made.notes)

    def test_file(self):
        iib, other, path = self.configured(), IIB.create(), self.folder / 'iib.yml'
        iib.write(path)
        other.read(path)
        nowhere = self.folder / 'nothing' / 'iib.yml'
        for call, message in ((iib.write, 'Cannot write .*/nothing/iib.yml: check the folder'),
                           (iib.save, 'Cannot write .*/nothing/iib.yml'), (iib.read, 'nothing/iib.yml cannot be read')):
            with self.assertRaisesRegex(opencv_iib.error, message):
                call(nowhere)
        names = ['iib.xml', 'iib.json', os.fsdecode(b'\xe9.yml'), '\u65e5\u672c.yml']
        if os.name != 'nt':  # on Windows, cv::FileStorage accepts only names in the code page, and ends a name before a '?'
            names.append('a?.yml')
        for name in names:
            again = IIB.create()
            iib.save(self.folder / name)
            again.read(self.folder / name)
            self.expect_same(iib, again)
        with gzip.open(self.folder / 'packed', 'wb') as file:
            file.write(path.read_bytes())
        again.read(self.folder / 'packed')
        self.expect_same(iib, again)
        with self.assertRaisesRegex(opencv_iib.error, '.*/packed holds no parameters'):
            (self.folder / 'packed').write_bytes(path.read_bytes().partition(b'pping')[0])  # within a line, since YAML may end after a line
            again.read(self.folder / 'packed')
        self.assertEqual(len(os.listdir(self.folder)), 2 + len(names))
        self.expect_same(iib, other)

    def test_lists_of_images(self):
        iib, images = IIB.createRecommended(30), [texture(160, 120), texture(90, 80, seed=3)]
        masks = [np.zeros_like(image) for image in images]
        masks[1][:40] = 1
        for given in (images, tuple(images)):
            found = iib.detect(given)
            keypoints, codes = iib.compute(given, found)
            for image, some, same, rows, (points, expected) in zip(images, found, keypoints, codes, map(iib.detectAndCompute, images)):
                self.assertEqual([[k.pt for k in each] for each in (some, same)], [[k.pt for k in points]] * 2)
                np.testing.assert_array_equal(rows, expected)
            self.assertEqual([len(some) for some in iib.detect(given, masks)], [0, len(iib.detect(images[1], masks[1]))])
        for mistake, message in ((lambda: iib.compute(images, found[:1]), '2 images, but keypoints of 1'), (lambda: iib.detect(images, masks * 2), 'masks of 4'),
                             (lambda: iib.compute(images, None), 'keypoints of None')):
            with self.assertRaisesRegex(opencv_iib.error, message):
                mistake()
        with self.assertRaisesRegex(TypeError, 'did cv2.imread find'):
            iib.detect([images[0], None])

    def test_a_pickled_detector_says_that_it_is_missing(self):
        class Nothing:
            def detect(self, image, mask):
                return []
        iib = IIB.create()
        iib.setDetector(Nothing())
        self.assertEqual(iib.detect(texture(60, 60)), ())
        other = pickle.loads(pickle.dumps(iib))
        with self.assertRaisesRegex(RuntimeError, 'Nothing was not pickled'):
            other.detect(texture(60, 60))
        self.assertEqual(copy.copy(iib).detect(texture(60, 60)), ())

    def test_a_detector_of_python(self):
        class AKAZE:
            def detect(self, image, mask):
                assert image.shape == (60, 80) and mask is None
                return np.array([[20, 30, 5]], np.float32)
        detector = AKAZE()
        iib = IIB.createFor(detector)
        self.assertIs(iib.getDetector(), detector)
        self.assertEqual(iib.getScaleFactor(), 12)
        keypoints, descriptors = iib.detectAndCompute(texture(80, 60))
        self.assertEqual([k.pt for k in keypoints], [(20, 30)])
        self.assertEqual(descriptors.shape, (1, 170))
        with self.assertRaisesRegex(TypeError, 'detect'):
            iib.setDetector(object())


@unittest.skipIf(cv2 is None, 'no cv2')
class BesideCv2(unittest.TestCase):

    def test_keypoints_survive_the_array(self):
        keypoints = cv2.ORB_create(50).detect(texture(320, 240))
        rows = opencv_iib.keypoints_to_array(keypoints)
        again = opencv_iib.array_to_keypoints(rows)
        self.assertEqual(len(again), len(keypoints))
        for a, b in zip(keypoints, again):
            self.assertIsInstance(b, cv2.KeyPoint)
            self.assertEqual((a.pt, a.size, a.angle, a.response, a.octave, a.class_id),
                             (b.pt, b.size, b.angle, b.response, b.octave, b.class_id))

    def test_create_for_a_detector_of_cv2(self):
        image = texture(320, 240)
        for make, factor in ((cv2.ORB_create, 2), (cv2.SIFT_create, 20)):
            detector = make()
            iib = IIB.createFor(detector)
            self.assertEqual(iib.getScaleFactor(), factor)
            found = iib.detect(image)
            self.assertEqual([k.pt for k in found], [k.pt for k in detector.detect(image)])
            self.assertGreater(len(found), 10)
        mask = np.zeros((240, 320), np.uint8)
        mask[:, :160] = 255
        self.assertTrue(all(k.pt[0] < 161 for k in iib.detect(image, mask)))

    def test_errors_are_not_those_of_cv2(self):
        with self.assertRaises(opencv_iib.error):
            IIB.create(granularity=9)
        with self.assertRaises(cv2.error):
            cv2.ORB_create().detect(np.zeros((3, 3, 7), np.float64))
