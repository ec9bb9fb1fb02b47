"""Which pairs of images are matched."""
import shutil
import struct
import zlib
from unittest import mock

import numpy as np

from collection import Collection
from opencv_iib.colmap import pairs as pair_lists
from opencv_iib.colmap import hloc, pipeline
from opencv_iib.colmap.images import gps_place
from support import optional

h5py = optional('h5py')


class Pairs(Collection):

    def setUp(self):
        super().setUp()
        self.listing = self.folder / 'pairs.txt'

    def build_listed(self, text, encoding='utf-8', **options):
        self.listing.write_text(text, encoding)
        return self.build(pairs=str(self.listing), force=True, **options)

    def test_orders(self):
        self.assertEqual(sorted(pair_lists.exhaustive(7, 2)), [(a, b) for a in range(7) for b in range(a + 1, 7)])
        pairs = list(pair_lists.exhaustive(60))
        tiles = list(pair_lists.tiles(pairs, 8))
        self.assertEqual(sorted(pair for tile in tiles for pair in tile), sorted(pairs))
        self.assertLessEqual(max(len({image for pair in tile for image in pair}) for tile in tiles), 16)
        self.assertLess(len(tiles), 1.5 * len(pairs) / 64)
        self.assertEqual(list(pair_lists.tiles(pairs, 1)), [[pair] for pair in pairs])
        self.assertEqual(list(pair_lists.sequential(4, 2)), [(0, 1), (0, 2), (1, 2), (1, 3), (2, 3)])
        self.assertEqual(list(pair_lists.distinct([(1, 2), (2, 1), (0, 1), (1, 2)])), [(1, 2), (0, 1)])

    def test_lists(self):
        self.assertEqual(self.build_listed('# pairs\na.png more/c.png\n')['pairs'], 1)
        with mock.patch.object(pipeline, 'describe_images', side_effect=AssertionError), \
                self.assertRaisesRegex(ValueError, 'pairs.txt:1: not the names of two images'):
            self.build_listed('a.png nothing.png\n')
        (self.images / 'broken.png').write_bytes(b'no image')
        self.assertEqual(self.build_listed('a.png broken.png\nb.png a.png\n')['pairs'], 1)

    def test_retrieval(self):
        self.assertEqual(self.build(pairs='retrieval', neighbours=1)['images'], 3)
        self.assertIn(self.query('SELECT COUNT(*) FROM matches')[0][0], (2, 3))

    def test_places_by_gps(self):
        def located(name, north, east, height=0):
            """Degrees, minutes and seconds in EXIF of a TIFF within a PNG."""
            def rationals(value):
                whole = abs(value) * 3600 * 1000
                return struct.pack('<6I', int(whole // 3600000), 1, int(whole // 60000 % 60), 1, round(whole % 60000), 1000)
            tiff = struct.pack('<4sIHHHIII', b'II*\0', 8, 1, 0x8825, 4, 1, 26, 0)
            tiff += struct.pack('<H', 6) + struct.pack('<HHI2s2x', 1, 2, 2, b'N\0' if north > 0 else b'S\0') + struct.pack('<HHII', 2, 5, 3, 104)
            tiff += struct.pack('<HHI2s2x', 3, 2, 2, b'E\0' if east > 0 else b'W\0') + struct.pack('<HHII', 4, 5, 3, 128)
            tiff += struct.pack('<HHIB3x', 5, 1, 1, height < 0) + struct.pack('<HHII', 6, 5, 1, 152) + struct.pack('<I', 0)
            tiff += rationals(north) + rationals(east) + struct.pack('<II', abs(height) * 10, 10)
            data = (self.images / name).read_bytes()
            (self.images / name).write_bytes(data[:33] + struct.pack('>I', len(tiff)) + b'eXIf' + tiff + struct.pack('>I', zlib.crc32(b'eXIf' + tiff))
                                             + data[33:])
        with self.assertRaisesRegex(ValueError, 'no image below .* has a place by GPS'):
            self.build(pairs='gps')
        located('a.png', 48.1, -11.5)
        located('b.png', 48.1009, -11.5, -30)
        located('more/c.png', -48.1, 11.5)
        a, b, c = (gps_place(self.images / name) for name in ('a.png', 'b.png', 'more/c.png'))
        self.assertAlmostEqual(np.linalg.norm(a - b), np.hypot(.0009 * np.pi / 180 * 6371000, 30), delta=.1)
        np.testing.assert_allclose(c, a * [1, -1, -1], atol=1e-3)
        shutil.copy(self.images / 'b.png', self.images / 'd.png')
        self.assertEqual(self.build(pairs='gps', neighbours=1)['pairs'], 3)
        pairs = {frozenset(pair) for pair in self.query('SELECT pair_id / 2147483647, pair_id % 2147483647 FROM matches')}
        number = dict(self.query('SELECT name, image_id FROM images'))
        self.assertIn(frozenset((number['b.png'], number['d.png'])), pairs)

    def test_each_pair_is_one_step(self):
        steps = []
        with mock.patch.object(pipeline.Progress, 'close', lambda progress: steps.append((progress.title, progress.done))):
            counts = self.build(pairs='retrieval', neighbours=2), self.build_listed('a.png b.png\nb.png a.png\n')
        self.assertEqual([each['pairs'] for each in counts], [3, 1])
        self.assertEqual(steps[1::2], [('matching', 3), ('matching', 1)])

    def test_names_that_lists_cannot_hold(self):
        for old, new in (('a.png', '#a.png'), ('b.png', 'b 1.png')):
            (self.images / old).rename(self.images / new)
        self.assertEqual(self.build(verify='auto')['verified pairs'], 3)
        with mock.patch.object(pipeline, 'colmap_binary', return_value='colmap'), \
                self.assertRaisesRegex(ValueError, '#a.png: .*blanks'):
            self.build(verify='colmap', force=True)
        self.assertEqual(self.build_listed('# a comment\nb 1.png  more/c.png\n\n#a.png\tb 1.png\n', 'utf-8-sig')['pairs'], 2)
        if h5py is not None:
            with self.assertRaisesRegex(ValueError, 'hloc.*rename'):
                hloc.export(str(self.database), *(str(self.folder / name) for name in ('f.h5', 'm.h5', 'list.txt')))
