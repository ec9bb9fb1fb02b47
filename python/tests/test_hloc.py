"""The files that opencv-iib hloc writes, and the example of an extractor for hloc."""
import importlib.util
import shutil
import sys
import types
import unittest
from unittest import mock

import numpy as np

import opencv_iib
from collection import Collection
from opencv_iib.colmap import hloc
from support import REPOSITORY, cv2, optional, run_command, texture

h5py = optional('h5py')
EXAMPLE = REPOSITORY / 'python/examples/hloc_iib.py'


class Tensor(np.ndarray):
    def cpu(self):
        return self

    def numpy(self):
        return np.asarray(self)


def extractor():
    """The example's class, with stand-ins for the parts of torch and hloc that it uses."""
    torch, base = types.ModuleType('torch'), types.ModuleType('hloc.utils.base_model')
    torch.from_numpy = lambda array: array.view(Tensor)
    base.BaseModel = object
    stand_ins = {'torch': torch, 'hloc': types.ModuleType('hloc'), 'hloc.utils': types.ModuleType('hloc.utils'), base.__name__: base}
    spec = importlib.util.spec_from_file_location('hloc_iib', EXAMPLE)
    module = importlib.util.module_from_spec(spec)
    with mock.patch.dict(sys.modules, stand_ins):
        spec.loader.exec_module(module)
    made = module.IIB()
    made.conf = {'max_keypoints': 300}
    return made


def nearest(similarity, ratio):
    """The matches of hloc's nearest_neighbor in one direction."""
    best = np.argsort(-similarity, axis=1, kind='stable')[:, :2]
    first, second = (2 * (1 - np.take_along_axis(similarity, best, 1))).T
    return np.where(first <= ratio ** 2 * second, best[:, 0], -1)


@unittest.skipUnless(EXAMPLE.exists(), 'the examples are not beside these tests')
class Extractor(unittest.TestCase):

    def test_hlocs_matcher_finds_what_the_recommended_matcher_finds_both_ways(self):
        images = texture(320, 240, seed=4), texture(320, 240, seed=4)[3:, 5:] // 2
        found = [extractor()._forward({'image': (image[None, None] / np.float32(255)).view(Tensor)}) for image in images]
        a, b = (f['descriptors'][0] for f in found)
        self.assertEqual((a.dtype, len(a), len(found[0]['scores'][0])), (np.float32, 1024, a.shape[1]))
        np.testing.assert_array_equal(a.astype(np.float16), a)
        similarity = a.T.astype(np.float64) @ b
        forward, backward = nearest(similarity, .92 ** .5), nearest(similarity.T, .92 ** .5)
        mutual = [(i, j) for i, j in enumerate(forward) if j >= 0 and backward[j] == i]
        codes = [opencv_iib.detect_and_describe(image, 300) for image in images]
        np.testing.assert_array_equal(found[0]['keypoints'][0], codes[0].points)
        there = opencv_iib.match(codes[0].codes, codes[1].codes).pairs
        back = opencv_iib.match(codes[1].codes, codes[0].codes).pairs
        self.assertGreater(len(mutual), 50)
        self.assertEqual(set(mutual), set(map(tuple, there.tolist())) & {(i, j) for j, i in back.tolist()})


@unittest.skipIf(h5py is None, 'no h5py')
class Export(Collection):

    def setUp(self):
        super().setUp()
        self.hloc = [self.folder / name for name in ('features.h5', 'matches.h5', 'list.txt')]
        self.build()

    def export(self, paths, **keywords):
        return hloc.export(str(self.database), *map(str, paths), **keywords)

    def test_files_are_kept_until_all_are_new(self):
        for file in self.hloc:
            file.write_bytes(b'precious')
        before = self.files()
        with mock.patch.object(hloc, 'pair_name', side_effect=OSError('no space left')), self.assertRaises(OSError):
            self.export(self.hloc, force=True)
        with mock.patch.object(hloc, 'pair_name', side_effect=KeyboardInterrupt):
            self.assertEqual(run_command('hloc', self.database, *self.hloc, '--force'), (130, '', 'interrupted\n'))
        self.assertEqual([file.read_bytes() for file in self.hloc], [b'precious'] * 3)
        self.assertEqual(self.files(), before)

    def test_what_is_written(self):
        for expected in (0, 1):
            self.assertEqual(run_command('hloc', self.database, *self.hloc)[0], expected)
        for name in ('a#b.db', '100%41.db', 'what?.db'):
            self.database = shutil.copy(self.database, self.folder / name)
            self.assertEqual(self.export(self.hloc, force=True), 3)
        rows, data = self.query('SELECT rows, data FROM keypoints WHERE image_id=1')[0]
        with h5py.File(self.hloc[0]) as features, h5py.File(self.hloc[1]) as matches:
            np.testing.assert_array_equal(features['a.png']['keypoints'][:] + np.float32(.5),
                                          np.frombuffer(data, np.float32).reshape(rows, 4)[:, :2])
            nearest = matches['a.png/more-c.png']['matches0']
            self.assertEqual((nearest.dtype, nearest.shape), (np.int16, (rows,)))
            self.assertTrue((nearest[:] >= -1).all())
        self.assertEqual(len(self.hloc[2].read_text().splitlines()), 3)

    def test_nothing_is_written_of_pairs_that_verification_refused(self):
        for seed, name in enumerate(('a.png', 'b.png', 'more/c.png')):
            cv2.imwrite(str(self.images / name), cv2.resize(texture(100, 75, seed=seed + 20), (400, 300), interpolation=cv2.INTER_CUBIC))
        for verify, expected in (('none', 3), ('magsac', 0)):
            self.build(force=True, verify=verify)
            self.assertEqual(self.query('SELECT COUNT(*) FROM matches WHERE rows > 0'), [(3,)])
            self.assertEqual(self.export(self.hloc, force=True), expected)
        with h5py.File(self.hloc[1]) as matches:
            self.assertEqual((list(matches), self.hloc[2].read_text()), ([], ''))
