"""Lists of pairs, and the command match with --pairs."""
import os
import shutil
import struct
import unittest
import zlib
from unittest import mock

import numpy as np

from collection import Collection
from opencv_iib import match_list
from opencv_iib._pair_list import read_list, tiles
from opencv_iib.colmap import FeatureOptions, hloc, pairs as choices, pipeline
from opencv_iib._files import RECORD
from opencv_iib._image_names import find_images
from opencv_iib.colmap.database import MAX_IMAGE_ID
from opencv_iib.measure import match_images
from opencv_iib._hdf5 import new_hdf5
from support import files_end_at, optional, run_command

fcntl, h5py = optional('fcntl'), optional('h5py')


class Lists(Collection):
    """The command match with --pairs."""

    def match(self, out, text='a.png more/c.png\nb.png a.png\na.png b.png\n', status=0, *more, described=None):
        listing = self.folder / 'pairs.txt'
        listing.write_text(text)
        with mock.patch.object(match_list.View, 'of', wraps=match_list.View.of) as of:
            self.assertEqual(run_command('match', '--pairs', listing, '--images', self.images, '--out', out, '--points', 300, *more)[0], status)
        known = [call for call in of.call_args_list if call.args[-1] is None]
        if described is not None:
            self.assertEqual(sorted(call.args[-2] for call in known), described)

    def test_a_folder_of_tables_goes_on_where_it_was(self):
        out, camera = self.folder / 'out', ('--camera', 'SIMPLE_PINHOLE,400,300,500,200,150')
        self.match(out, 'a.png more/c.png\n', 0, described=['a.png', 'more/c.png'])
        before = (out / 'a.png/more-c.png.csv').stat().st_ino
        (out / 'pairs.csv').write_bytes((out / 'pairs.csv').read_bytes() + b'b.png,a.png,1')  # like after a killed run
        self.match(out, described=['a.png', 'b.png'])
        self.assertEqual((out / 'a.png/more-c.png.csv').stat().st_ino, before)
        self.match(out, described=[])
        self.assertEqual(self.found(out), [('a.png', 'more/c.png', True), ('a.png', 'b.png', True)])
        alone = match_images(self.images / 'a.png', self.images / 'b.png', self.folder / 'alone.csv', options=FeatureOptions(points=300))
        self.assertEqual((out / 'a.png/b.png.csv').read_text(), (self.folder / 'alone.csv').read_text())
        self.assertEqual(self.rows('out/pairs.csv')[1]['matches'], str(len(alone.bits)))
        os.utime(self.images / 'b.png', (1, 1))  # like cp and rsync
        self.match(out, described=[])
        self.match(self.folder / 'posed', 'a.png b.png\n', 0, *camera)
        self.assertAlmostEqual(float(self.rows('posed/pairs.csv')[0]['r11']), 1, delta=.01)

    def found(self, out):
        """The pairs of pairs.csv or an HDF5 file, and whether each is found."""
        if out.suffix == '.h5':
            with h5py.File(out) as file:
                return [(first, second, bool(file[first][second].attrs['found'])) for first in file if first[1] == '.' for second in file[first]]
        return [(row['image_a'], row['image_b'], row['found'] == '1') for row in self.rows(out / 'pairs.csv')]

    def test_a_pair_has_one_row_whatever_changes(self):
        pairs = [('a.png', 'b.png'), ('a.png', 'd.png'), ('b.png', 'd.png')]
        text = ''.join(' '.join(pair) + '\n' for pair in pairs)
        for name in ('out', 'x.h5')[:1 + (h5py is not None)]:
            with self.subTest(name):
                out = self.folder / name
                shutil.copy(self.images / 'more/c.png', self.images / 'd.png')
                self.match(out, text)
                size = out.stat().st_size
                if name == 'x.h5':
                    with h5py.File(out, 'a') as file:
                        file['mine'] = file['more/notes'] = [1, 2]
                self.match(out, text, 0, '--preset', 'SMALL', described=['a.png', 'b.png', 'd.png'])
                self.match(out, text, described=['a.png', 'b.png', 'd.png'])
                shutil.copy(self.images / 'a.png', self.images / 'd.png')  # other content
                self.match(out, text, described=['a.png', 'b.png', 'd.png'])
                self.assertEqual(sorted(self.found(out)), [(*pair, True) for pair in pairs])
                (self.images / 'd.png').write_bytes(b'no image any more')
                for _ in range(2):
                    self.match(out, text, 4)
                self.assertEqual(self.found(out), [('a.png', 'b.png', True)])
                if name == 'x.h5':
                    self.assertLess(out.stat().st_size, size)
                    with h5py.File(out) as file:
                        self.assertEqual((file['mine'][1], file['more/notes'][1]), (2, 2), 'what the user added')
                else:
                    self.assertEqual(sorted(path.name for path in out.rglob('*') if path.is_file()), [RECORD, 'b.png.csv', 'pairs.csv'])

    def test_an_interrupted_or_killed_list_goes_on(self):
        for name, owner, function in (('one', match_list, 'measure'), ('two', match_list, 'write_whole'), ('x.h5', match_list, 'new_hdf5')):
            if name == 'x.h5' and h5py is None:
                continue
            out, calls, real = self.folder / name, [], getattr(owner, function)

            def stop(*arguments):
                calls.append(arguments)
                if len(calls) == 2 or name == 'x.h5':
                    raise KeyboardInterrupt
                return real(*arguments)
            with self.subTest(name):
                (self.folder / 'pairs.txt').write_text('a.png more/c.png\na.png b.png\n')
                with mock.patch.object(owner, function, stop):
                    status, _, errors = run_command('match', '--pairs', self.folder / 'pairs.txt', '--images', self.images, '--out', out, '--points', 300,
                                                    '--workers', 1)
                self.assertEqual((status, errors.splitlines()[-1]), (130, 'interrupted; the same command goes on from here'))
                mine, left = out.with_name('mine.12-3.tmp'), {'one': out / 'pairs.csv.12-3.tmp', 'two': out / 'a.png/more-c.png.csv.12-3.tmp'}
                for path in (mine, left.get(name, self.folder / 'x.h5.12-3.tmp')):
                    path.touch()  # like after kill -9 during the second pair
                self.match(out, described=['a.png', 'b.png'] if name == 'one' else [])
                mine.unlink()
                self.assertEqual(sorted(self.found(out)), [('a.png', 'b.png', True), ('a.png', 'more-c.png' if name == 'x.h5' else 'more/c.png', True)])
                self.assertEqual([path for path in self.folder.rglob('*.partial*')] + [path for path in self.folder.rglob('*.tmp')], [])

    @unittest.skipIf(h5py is None, 'no h5py')
    def test_a_full_disk_is_one_line(self):
        out = self.folder / 'x.h5'
        for size in (1, 5000, 50000):
            with self.assertRaises(OSError), files_end_at(size), new_hdf5(str(out)) as file:
                for n in range(100):
                    file.create_group(f'a/{n}')['x'] = np.arange(n * 100)
        out.unlink()
        self.match(self.folder / 'whole.h5', 'a.png b.png\n')
        size = (self.folder / 'whole.h5').stat().st_size
        for limit in (size // 4, size - 1000):
            with files_end_at(limit):
                self.check_error('disk|cannot be written', 'match', '--pairs', self.folder / 'pairs.txt', '--images', self.images, '--out', out, '--points', 300)
            self.assertFalse(out.exists() or [path for path in self.folder.rglob('*.tmp')])
        self.match(out, 'a.png b.png\n')

    def test_one_pair_that_cannot_be_written_ends_nothing(self):
        long = 'n' * 248 + '.png'
        shutil.copy(self.images / 'b.png', self.images / long)
        out = self.folder / 'out'
        self.match(out, f'a.png {long}\n{long} b.png\na.png b.png\n', 4)
        self.assertEqual(self.found(out), [(long, 'b.png', True), ('a.png', 'b.png', True)])

    def test_hloc_reads_the_file(self):
        if h5py is None:
            self.skipTest('no h5py')
        out = self.folder / 'x.h5'
        self.match(out, described=['a.png', 'b.png', 'more/c.png'])
        self.match(out, described=[])
        alone = match_images(self.images / 'a.png', self.images / 'more/c.png', options=FeatureOptions(points=300))
        with h5py.File(out) as file:
            group = file['a.png/more-c.png']
            np.testing.assert_array_equal(group['keypoints1'][:], alone.matches.points2)
            self.assertEqual(group['scores'].shape, (len(alone.bits),))
            self.assertEqual(sorted(file['a.png']), ['b.png', 'more-c.png'])
        with h5py.File(self.folder / 'mine.h5', 'w') as file:
            file['precious'] = 1
        self.match(self.folder / 'mine.h5', status=1)
        (self.folder / 'other').mkdir()
        for name, out in (('text.h5', 'text.h5'), ('y.h5.partial', 'y.h5'), ('other/pairs.csv.partial', 'other')):
            (self.folder / name).write_text('precious')
            self.match(self.folder / out, status=1)
            self.assertEqual((self.folder / name).read_text(), 'precious')

    @unittest.skipIf(h5py is None or fcntl is None, 'no h5py, or no such locks on this system')
    def test_a_file_that_another_process_has_open(self):
        out = self.folder / 'x.h5'
        h5py.File(out, 'w').close()
        with open(out, 'rb') as file:
            fcntl.flock(file, fcntl.LOCK_EX)
            with self.assertRaisesRegex(BlockingIOError, 'x.h5 is being written by another process'):
                match_list._Hdf5(str(out))


class Pairs(Collection):

    def setUp(self):
        super().setUp()
        self.listing = self.folder / 'pairs.txt'

    def build_listed(self, text, encoding='utf-8', **options):
        self.listing.write_text(text, encoding)
        return self.build(pairs=str(self.listing), force=True, **options)

    def test_orders(self):
        self.assertEqual(sorted(choices.exhaustive(7, 2)), [(a, b) for a in range(7) for b in range(a + 1, 7)])
        pairs = list(choices.exhaustive(60))
        found = list(tiles(pairs, 8))
        self.assertEqual(sorted(pair for tile in found for pair in tile), sorted(pairs))
        self.assertLessEqual(max(len({image for pair in tile for image in pair}) for tile in found), 16)
        self.assertLess(len(found), 1.5 * len(pairs) / 64)
        self.assertEqual(list(tiles(pairs, 1)), [[pair] for pair in pairs])
        self.assertEqual(list(choices.distinct([(1, 2), (2, 1), (0, 1), (1, 2)])), [(1, 2), (0, 1)])

    def test_names_are_in_the_order_of_people(self):
        names = ['more/im1.png', 'more/im2.png', 'more/im10.png', 'more/im010.png']
        for name in names:
            shutil.copy(self.images / 'a.png', self.images / name)
        for name in ('a.png', 'b.png', 'more/c.png'):
            (self.images / name).unlink()
        ordered = [*names[:2], names[3], names[2]]
        self.assertEqual(find_images(self.images), ordered)
        self.build(pairs='sequential', neighbours=1)
        self.assertEqual([name for name, in self.query('SELECT name FROM images ORDER BY image_id')], ordered)
        self.assertEqual([divmod(pair, MAX_IMAGE_ID) for pair, in self.query('SELECT pair_id FROM matches')], [(1, 2), (2, 3), (3, 4)])
        shutil.copy(self.images / names[0], self.images / 'more/im3.png')
        self.build(pairs='sequential', neighbours=1)
        self.assertEqual({divmod(pair, MAX_IMAGE_ID) for pair, in self.query('SELECT pair_id FROM matches')}, {(1, 2), (2, 3), (2, 5), (3, 5), (3, 4)})

    def test_lists(self):
        self.assertEqual(self.build_listed('# pairs\na.png more/c.png\n')['pairs'], 1)
        with mock.patch.object(pipeline, 'describe_images', side_effect=AssertionError), \
                self.assertRaisesRegex(ValueError, 'pairs.txt:1: no image is called nothing.png'):
            self.build_listed('a.png nothing.png\n')
        self.listing.write_bytes(b'a.png b.png\ncaf\xe9.png a.png\n')
        for arguments in (['colmap', self.images, self.folder / 'x.db', '--pairs', self.listing],
                          ['match', '--images', self.images, '--out', self.folder / 'x', '--pairs', self.listing]):
            self.check_error('pairs.txt:2: not UTF-8', *arguments)
        (self.images / 'broken.png').write_bytes(b'no image')
        self.assertEqual(self.build_listed('a.png broken.png\nb.png a.png\n')['pairs'], 1)

    def test_lines_as_programs_write_them(self):
        numbers = {'a.png': 1, 'more/c.png': 2, 'b 1,2.png': 3}
        for line in ('a.png more/c.png', 'a.png,more/c.png', '"a.png", "more/c.png"', './a.png ./more/c.png', 'a.png more\\c.png 0.87', 'a.png;more/c.png;1e-3'):
            self.listing.write_text('\ufeff\n  \n' + line + '\n')
            self.assertEqual(read_list(self.listing, numbers), ([(1, 2)], []), line)
        self.listing.write_text('b 1,2.png a.png 3\ngone.png a.png\na.png a.png\none two three\nmore/c.png a.png\n')
        pairs, wrong = read_list(self.listing, numbers)
        self.assertEqual(pairs, [(3, 1), (2, 1)])
        self.assertEqual([text.partition('pairs.txt:')[2] for text in wrong],
                         ['2: no image is called gone.png', '3: a.png is paired with itself', '4: not the names of two images'])

    def test_one_line_ends_no_list(self):
        self.listing.write_text('a.png gone.png\na.png b.png\n')
        for arguments in (['match', '--images', self.images, '--out', self.folder / 'out'], ['colmap', self.images, self.database, '--verify', 'magsac']):
            status, _, errors = run_command(*arguments, '--pairs', self.listing, '--points', 300)
            self.assertEqual(status, 4)
            self.assertIn('pairs.txt:1: no image is called gone.png\n', errors)

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
            tiff += struct.pack('<HHIB3x', 5, 1, 1, (height or 0) < 0) + struct.pack('<HHII', 6 if height is not None else 99, 5, 1, 152)
            tiff += struct.pack('<I', 0) + rationals(north) + rationals(east) + struct.pack('<II', abs(height or 0) * 10, 10)
            data = (self.images / name).read_bytes()
            (self.images / name).write_bytes(data[:33] + struct.pack('>I', len(tiff)) + b'eXIf' + tiff + struct.pack('>I', zlib.crc32(b'eXIf' + tiff))
                                             + data[33:])
        with self.assertRaisesRegex(ValueError, 'no image below .* has a place by GPS'):
            self.build(pairs='gps')
        located('a.png', 48.1, -11.5)
        located('b.png', 48.1009, -11.5, -30)
        located('more/c.png', -48.1, 11.5)
        a, b, c = choices.gps_places(self.images, ('a.png', 'b.png', 'more/c.png'))
        self.assertAlmostEqual(np.linalg.norm(a - b), np.hypot(.0009 * np.pi / 180 * 6371000, 30), delta=.1)
        np.testing.assert_allclose(c, a * [1, -1, -1, 1], atol=1e-3)
        for name, *place in (('n.png', 48.1, -11.5, None), ('o.png', 0, 0, 9)):
            shutil.copy(self.images / 'a.png', self.images / name)
            located(name, *place)
        places = list(choices.gps_places(self.images, ('n.png', 'o.png')))
        self.assertTrue(np.isnan(places[0][3]) and places[1] is None, places)
        far = [a + [0, 0, 0, 3000], a + [0, 200, 0, 3000], places[0]]  # in the mountains
        self.assertEqual(list(choices.nearest(far, 1)), [(0, 2), (1, 0), (2, 0)], 'an unknown height is not that of the sea')
        for name in ('n.png', 'o.png'):
            (self.images / name).unlink()
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
        with mock.patch('shutil.which', return_value='colmap'), \
                self.assertRaisesRegex(ValueError, '#a.png: .*blanks'):
            self.build(verify='colmap', force=True)
        self.assertEqual(self.build_listed('# a comment\nb 1.png  more/c.png\n\n#a.png\tb 1.png\n', 'utf-8-sig')['pairs'], 2)
        if h5py is not None:
            with self.assertRaisesRegex(ValueError, 'hloc.*rename'):
                hloc.export(str(self.database), *(str(self.folder / name) for name in ('f.h5', 'm.h5', 'list.txt')))
