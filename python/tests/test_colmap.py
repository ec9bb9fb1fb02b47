import concurrent.futures
import io
import os
import re
import shutil
import sqlite3
import struct
import tempfile
import unittest
import zlib
from contextlib import closing, contextmanager, redirect_stderr, redirect_stdout
from pathlib import Path
from unittest import mock

import numpy as np

import opencv_iib
from support import REPOSITORY, cv2, optional, texture

if cv2 is not None:
    from opencv_iib._files import only_writer
    from opencv_iib.__main__ import main
    from opencv_iib.colmap import FeatureOptions, Options, SettingsChanged, build_database, hloc, parallel, pipeline
    from opencv_iib.colmap import pairs as pair_lists
    from opencv_iib.colmap.database import MAX_IMAGE_ID, Database, pair_id
    from opencv_iib.colmap.features import DETECTORS, Features, to_colmap
    from opencv_iib.colmap.images import exif_focal_length, read_grey, write_picture
    from opencv_iib.colmap.verify import magsac
    from opencv_iib.demo import demo

distributed, h5py, pycolmap = map(optional, ('distributed', 'h5py', 'pycolmap'))


@unittest.skipIf(cv2 is None, 'no cv2')
class ColmapTest(unittest.TestCase):

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.images = os.path.join(self.folder.name, 'images')
        self.database = os.path.join(self.folder.name, 'database.db')
        os.makedirs(os.path.join(self.images, 'more'))
        world = cv2.resize(texture(160, 120, seed=3), (640, 480), interpolation=cv2.INTER_CUBIC)
        for i, name in enumerate(('a.png', 'b.png', 'more/c.png')):
            cv2.imwrite(os.path.join(self.images, name), world[20 * i:300 + 20 * i, 30 * i:400 + 30 * i])
        self.lines = []
        self.hloc = [os.path.join(self.folder.name, name) for name in ('features.h5', 'matches.h5', 'list.txt')]

    def build(self, force=False, client=None, detector='HESSIAN', workers=2, **options):
        features = FeatureOptions(detector, points=options.pop('points', 300), max_size=options.pop('max_size', 0))
        with redirect_stderr(io.StringIO()):
            return build_database(self.images, self.database, Options(features, **{'verify': 'magsac', **options}), force,
                                  workers=workers, log=self.lines.append, client=client)

    def dump(self):
        """Every row of every table, and removes the database."""
        with closing(sqlite3.connect(self.database)) as connection:
            rows = list(connection.iterdump())
        os.unlink(self.database)
        return rows

    def query(self, sql):
        with closing(sqlite3.connect(self.database)) as connection:
            return connection.execute(sql).fetchall()

    def test_what_is_written(self):
        counts = self.build()
        self.assertEqual((counts['images'], counts['pairs'], counts['verified pairs'], counts['failed']), (3, 3, 3, 0))
        self.assertEqual([name for name, in self.query('SELECT name FROM images ORDER BY name')],
                         ['a.png', 'b.png', 'more/c.png'])
        self.assertEqual(self.query('SELECT DISTINCT cols FROM keypoints'), [(4,)])
        self.assertEqual(self.query('SELECT width, height, prior_focal_length FROM cameras'), [(400, 300, 0)] * 3)
        params = np.frombuffer(self.query('SELECT params FROM cameras')[0][0])
        np.testing.assert_allclose(params, [1.2 * 400, 200, 150, 0])
        self.assertEqual(self.query('PRAGMA user_version'), [(3800,)])
        self.assertFalse([name for name, in self.query('SELECT name FROM sqlite_master') if name and 'iib' in name])
        self.assertEqual(os.listdir(self.folder.name).count('database.db.partial'), 0)

    def test_verified_matches_are_the_known_shift(self):
        self.build()
        points = {number: np.frombuffer(data, np.float32).reshape(rows, 4)
                  for number, rows, data in self.query('SELECT image_id, rows, data FROM keypoints')}
        rows, data = self.query(f'SELECT rows, data FROM two_view_geometries WHERE pair_id={pair_id(1, 2)}')[0]
        found = np.frombuffer(data, np.uint32).reshape(rows, 2)
        errors = np.abs(points[1][found[:, 0], :2] - points[2][found[:, 1], :2] - (30, 20)).max(axis=1)
        self.assertGreater(rows, 30)
        self.assertGreater((errors < 2).mean(), .8)

    def test_an_existing_database_is_kept(self):
        Path(self.database).write_bytes(b'precious')
        with self.assertRaisesRegex(FileExistsError, '--force'):
            self.build()
        self.assertEqual(Path(self.database).read_bytes(), b'precious')
        self.build(force=True)
        self.assertEqual(self.query('SELECT COUNT(*) FROM images'), [(3,)])

    def test_a_broken_image_is_a_line_and_counted(self):
        Path(self.images, 'broken.jpg').write_bytes(b'no image')
        self.assertEqual(self.build()['failed'], 1)
        self.assertEqual(len(self.lines), 1)
        self.assertIn('broken.jpg', self.lines[0])

    @contextmanager
    def ended_in(self, owner, name, number=1):
        """That the block ends with Ctrl-C in this call of a function."""
        real, calls = getattr(owner, name), []

        def call(*arguments):
            calls.append(arguments)
            if len(calls) == number:
                raise KeyboardInterrupt
            return real(*arguments)
        with mock.patch.object(owner, name, call), self.assertRaises(KeyboardInterrupt):
            yield

    def interrupt(self):
        with self.ended_in(pipeline, 'magsac', 3):
            self.build(workers=1)

    def test_an_interrupted_run_goes_on(self):
        self.interrupt()
        self.assertFalse(os.path.exists(self.database))
        real, described, matched = pipeline.magsac, [], []
        with mock.patch.object(pipeline, 'decode_grey', lambda data: described.append(data)), \
                mock.patch.object(pipeline, 'magsac', lambda *a: matched.append(1) or real(*a)):
            counts = self.build()
        self.assertEqual(described, [])
        self.assertLess(len(matched), 3)
        self.assertEqual((counts['images'], counts['pairs']), (3, 3))
        with self.ended_in(os, 'replace'):  # the file is complete but for its name
            self.build(force=True)
        self.assertEqual(self.build(force=True), counts)
        self.assertEqual(sorted(os.listdir(self.folder.name)), ['database.db', 'images'])

    def test_images_changed_or_removed_after_an_interruption(self):
        os.rename(os.path.join(self.images, 'more/c.png'), os.path.join(self.images, 'c.png'))
        shutil.copy(os.path.join(self.images, 'b.png'), os.path.join(self.images, 'd.png'))
        self.interrupt()
        shutil.copy(os.path.join(self.images, 'c.png'), os.path.join(self.images, 'b.png'))
        os.unlink(os.path.join(self.images, 'a.png'))
        self.assertEqual(self.build()['images'], 3)
        self.assertEqual(self.query('SELECT name FROM images ORDER BY name'), [('b.png',), ('c.png',), ('d.png',)])
        b, c = (self.query(f"SELECT data FROM keypoints NATURAL JOIN images WHERE name='{name}.png'") for name in 'bc')
        self.assertEqual(b, c)
        self.assertEqual(self.query('SELECT COUNT(*) FROM cameras'), [(3,)])
        numbers = {number for number, in self.query('SELECT image_id FROM images')}
        for key, in self.query('SELECT pair_id FROM matches'):
            self.assertLessEqual(set(divmod(key, MAX_IMAGE_ID)), numbers)

    def test_two_runs_at_once(self):
        with only_writer(self.database + '.partial'), self.assertRaisesRegex(BlockingIOError, 'another process'):
            self.build()
        self.assertEqual(self.build()['images'], 3)

    def test_an_unfinished_database_that_is_none(self):
        Path(self.database + '.partial').write_bytes(b'junk' * 1000)
        Path(self.database + '.partial-wal').write_bytes(b'junk' * 1000)
        with self.assertRaisesRegex(SettingsChanged, 'not a database.*--force'):
            self.build()
        self.assertEqual(self.build(force=True)['images'], 3)
        with closing(sqlite3.connect(self.database + '.partial')) as other:
            other.execute('CREATE TABLE images (name_of_another_program TEXT)')
        os.unlink(self.database)
        with self.assertRaisesRegex(SettingsChanged, 'another database.*--force'):
            self.build()
        self.assertEqual(self.build(force=True)['images'], 3)

    def test_names_that_lists_cannot_hold(self):
        for old, new in (('a.png', '#a.png'), ('b.png', 'b 1.png'), ('more/c.png', 'more/c.png')):
            os.rename(os.path.join(self.images, old), os.path.join(self.images, new))
        self.assertEqual(self.build(verify='auto')['verified pairs'], 3)
        with mock.patch.object(pipeline, 'colmap_binary', return_value='colmap'), \
                self.assertRaisesRegex(ValueError, '#a.png: .*blanks'):
            self.build(verify='colmap', force=True)
        listing = os.path.join(self.folder.name, 'pairs.txt')
        Path(listing).write_text('\ufeff# a comment\nb 1.png  more/c.png\n\n#a.png\tb 1.png\n', encoding='utf-8')
        self.assertEqual(self.build(pairs=listing, force=True)['pairs'], 2)
        if h5py is not None:
            with self.assertRaisesRegex(ValueError, 'hloc.*rename'):
                hloc.export(self.database, *self.hloc)

    def test_files_that_are_no_images_are_left_out(self):
        image = cv2.imread(os.path.join(self.images, 'a.png'))
        whole = cv2.imencode('.jpg', image)[1].tobytes()
        thumbnail = b'\xff\xe1' + struct.pack('>H', 2 + len(whole)) + whole  # in a segment of its own
        for name, data in (('half.jpg', whole[:len(whole) // 2]), ('header.jpg', whole[:300]), ('empty.jpg', b''),
                           ('thumbnail.jpg', whole[:2] + thumbnail + whole[2:len(whole) // 2]),
                           ('half.png', cv2.imencode('.png', image)[1].tobytes()[:5000])):
            Path(self.images, name).write_bytes(data)
        os.mkfifo(os.path.join(self.images, 'fifo.jpg'))
        Path(os.fsencode(self.images).decode() + '/latin\udce9.png').write_bytes(b'')
        Path(self.images, 'link.png').symlink_to('nothing.png')
        Path(self.images, 'good.jpg').write_bytes(whole[:2] + b'\xff' + thumbnail + whole[2:] + b'trailer \xff\xda')
        counts = self.build()
        self.assertEqual((counts['images'], counts['failed']), (4, 8))
        self.assertEqual(len(self.lines), 8)
        self.assertTrue(any('its name is not UTF-8' in line for line in self.lines))

    def test_other_settings_do_not_go_on_by_accident(self):
        with self.ended_in(pipeline, 'match_pairs'):
            self.build()
        with self.assertRaisesRegex(SettingsChanged, '--force'):
            self.build(points=200)
        self.assertEqual(self.build(points=200, force=True)['images'], 3)

    def test_a_full_disk_leaves_the_old_file(self):
        Path(self.database).write_bytes(b'precious')
        real = Database.add_image

        def full(database, *arguments):
            pages = database._db.execute('PRAGMA page_count').fetchone()[0]
            database._db.execute(f'PRAGMA max_page_count={pages}')
            real(database, *arguments)
        with mock.patch.object(Database, 'add_image', full), self.assertRaisesRegex(sqlite3.Error, 'full'):
            self.build(force=True)
        self.assertEqual(Path(self.database).read_bytes(), b'precious')

    def test_one_run_equals_any_number_of_workers(self):
        self.build()
        one = self.dump()
        self.build(workers=5)
        self.assertEqual(self.dump(), one)

    @unittest.skipIf(distributed is None, 'no distributed')
    def test_the_workers_of_a_client(self):
        for name in ('d.png', 'e.png'):
            shutil.copy(os.path.join(self.images, 'a.png'), os.path.join(self.images, name))
        Path(self.images, 'broken.jpg').write_bytes(b'no image')
        counts = self.build()
        lines, rows = list(self.lines), self.dump()
        self.assertEqual((counts['pairs'], len(lines)), (10, 1))
        with distributed.LocalCluster(n_workers=2, threads_per_worker=2, dashboard_address=None,
                                      silence_logs=50) as cluster, distributed.Client(cluster) as client:
            with mock.patch.object(parallel.Cluster, 'tile_side', 2):
                self.assertEqual(self.build(client=client), counts)
            self.assertEqual((self.lines[1:], self.dump()), (lines, rows))
            err = io.StringIO()
            with redirect_stdout(io.StringIO()), redirect_stderr(err):
                self.assertEqual(main(['colmap', self.images, self.database, '--points', '300', '--verify', 'magsac',
                                       '--scheduler', cluster.scheduler_address]), 0)
            self.assertEqual(self.dump(), rows)
            with mock.patch.object(parallel.Cluster, 'ahead', side_effect=concurrent.futures.CancelledError), \
                    self.assertRaisesRegex(ConnectionError, 'the scheduler has gone'):
                self.build(client=client)
            moved = self.images + '-moved'
            with mock.patch.object(pipeline.os.path, 'abspath', return_value=moved), \
                    self.assertRaisesRegex(FileNotFoundError, moved):
                self.build(client=client)

    def test_pairs(self):
        self.assertEqual(sorted(pair_lists.exhaustive(7, 2)), [(a, b) for a in range(7) for b in range(a + 1, 7)])
        pairs = list(pair_lists.exhaustive(60))
        tiles = list(pair_lists.tiles(pairs, 8))
        self.assertEqual(sorted(pair for tile in tiles for pair in tile), sorted(pairs))
        self.assertLessEqual(max(len({image for pair in tile for image in pair}) for tile in tiles), 16)
        self.assertLess(len(tiles), 1.5 * len(pairs) / 64)
        self.assertEqual(list(pair_lists.tiles(pairs, 1)), [[pair] for pair in pairs])
        self.assertEqual(list(pair_lists.sequential(4, 2)), [(0, 1), (0, 2), (1, 2), (1, 3), (2, 3)])
        listing = os.path.join(self.folder.name, 'pairs.txt')
        Path(listing).write_text('# pairs\na.png more/c.png\n')
        self.assertEqual(self.build(pairs=listing)['pairs'], 1)
        Path(listing).write_text('a.png nothing.png\n')
        with mock.patch.object(pipeline, 'describe_images', side_effect=AssertionError), \
                self.assertRaisesRegex(ValueError, 'pairs.txt:1: not the names of two images'):
            self.build(pairs=listing, force=True)
        Path(self.images, 'broken.png').write_bytes(b'no image')
        Path(listing).write_text('a.png broken.png\nb.png a.png\n')
        self.assertEqual(self.build(pairs=listing, force=True)['pairs'], 1)
        self.assertEqual(self.build(pairs='retrieval', neighbours=1, force=True)['images'], 3)
        self.assertIn(self.query('SELECT COUNT(*) FROM matches')[0][0], (2, 3))
        Path(listing).write_text('a.png b.png\nb.png a.png\nb.png broken.png\n')
        for pairs, count in (('retrieval', 3), (listing, 1)):
            steps = []
            with mock.patch.object(pipeline.Progress, 'close', lambda progress: steps.append((progress.title, progress.done))):
                counts = self.build(pairs=pairs, neighbours=2, force=True)
            self.assertEqual((steps[1], counts['pairs']), (('matching', count), count))
        self.assertEqual(list(pair_lists.distinct([(1, 2), (2, 1), (0, 1), (1, 2)])), [(1, 2), (0, 1)])

    def test_coordinates_and_pair_numbers(self):
        rows = np.array([[10, 20, 31, 90, 1, 0, -1], [0, 0, 2, -1, 1, 0, -1]], np.float32)
        np.testing.assert_allclose(to_colmap(rows), [[10.5, 20.5, 15.5, np.pi / 2], [.5, .5, 1, 0]], rtol=1e-6)
        self.assertEqual(pair_id(1, 2), pair_id(2, 1))
        self.assertEqual(pair_id(1, 2), 2147483647 + 2)

    def test_pairs_stored_the_other_way_round(self):
        with Database(self.database, {}) as database:
            matrix = np.arange(9.).reshape(3, 3)
            database.add_pair(5, 2, np.array([[1, 7], [3, 4]]), np.array([[1, 7]]), matrix)
            row = database._db.execute('SELECT matches.data, two_view_geometries.data, F FROM matches JOIN '
                                       'two_view_geometries USING (pair_id)').fetchone()
            self.assertEqual(list(database.pairs()), [(2, 5)])
        self.assertEqual(np.frombuffer(row[0], np.uint32).reshape(-1, 2).tolist(), [[7, 1], [4, 3]])
        self.assertEqual(np.frombuffer(row[1], np.uint32).tolist(), [7, 1])
        np.testing.assert_array_equal(np.frombuffer(row[2]).reshape(3, 3), matrix.T)

    def test_exif(self):
        # little-endian TIFF: one entry that points to the EXIF directory, and there a focal length of 28 mm
        tiff = struct.pack('<4sIHHHIIIHHHIHHI', b'II*\0', 8, 1, 0x8769, 4, 1, 26, 0, 1, 0xA405, 3, 1, 28, 0, 0)
        # big-endian, and there 8 mm and 1200 pixels a centimetre of the sensor, both as fractions
        big = struct.pack('>4sIHHHIIIHHHIIHHIIHHIHH8xIIII', b'MM\0*', 8, 1, 0x8769, 4, 1, 26, 0, 3, 0x920A, 5, 1, 72,
                          0xA20E, 5, 1, 80, 0xA210, 3, 1, 3, 0, 16, 2, 1200, 1)
        png, jpeg, webp = (cv2.imencode(suffix, np.zeros((40, 60), np.uint8))[1].tobytes() for suffix in ('.png', '.jpg', '.webp'))
        for exif, focal in ((tiff, 28 / 35 * 600), (big, 8 * 1200 / 10)):
            for name, data in (('JPEG', jpeg[:2] + b'\xff\xe1' + struct.pack('>H', len(exif) + 8) + b'Exif\0\0' + exif + jpeg[2:]),
                               ('PNG', png[:33] + struct.pack('>I', len(exif)) + b'eXIf' + exif + bytes(4) + png[33:]),
                               ('WebP', webp + b'EXIF' + struct.pack('<I', len(exif)) + exif), ('TIFF', exif)):
                with self.subTest(name):
                    self.assertAlmostEqual(exif_focal_length(data, 600, 400), focal)
        for data in (png, jpeg, webp, b'', tiff[:-9], big[:-1], b'II*\0' + b'\xff' * 90, jpeg[:2] + b'\xff\xe1\0\x08Exif\0\0'):
            self.assertIsNone(exif_focal_length(data, 600, 400))

    def test_a_header_of_a_huge_image_is_one_broken_image(self):
        whole = bytearray(cv2.imencode('.png', np.zeros((9, 9), np.uint8))[1].tobytes())
        whole[16:24] = struct.pack('>II', 100000, 100000)
        whole[29:33] = struct.pack('>I', zlib.crc32(whole[12:29]))
        Path(self.images, 'huge.png').write_bytes(whole)
        self.assertEqual(self.build()['failed'], 1)
        self.assertRegex(self.lines[0], '^huge.png: not an image')

    def test_paths_that_are_not_utf8(self):
        folder = os.fsdecode(os.fsencode(self.folder.name) + b'/caf\xe9')
        os.makedirs(folder)
        self.images, self.database = shutil.copytree(self.images, folder + '/images'), folder + '/x.db'
        out = io.StringIO()
        with redirect_stdout(out), redirect_stderr(io.StringIO()):
            self.assertEqual(main(['colmap', self.images, self.database, '--points', '300', '--verify', 'magsac']), 0)
            self.assertEqual(main(['demo', folder + '/images/a.png', folder + '/images/b.png', '--out', folder + '/x.png']), 0)
        out.getvalue().encode()  # as a terminal does
        self.assertTrue(os.path.getsize(folder + '/x.png'))
        with self.assertRaisesRegex(ValueError, 'end its name in'):
            write_picture(folder + '/x', np.zeros((2, 2), np.uint8))

    def test_nothing_is_left_of_a_run_that_described_nothing(self):
        shutil.rmtree(self.images)
        os.makedirs(self.images)
        Path(self.images, 'broken.png').write_bytes(b'no image')
        Path(self.database).write_bytes(b'precious')
        with self.assertRaisesRegex(ValueError, 'none of the 1 images'):
            self.build(force=True)
        self.assertEqual(Path(self.database).read_bytes(), b'precious')
        self.assertEqual(sorted(os.listdir(self.folder.name)), ['database.db', 'images'])

    def test_mistakes_are_told_before_work_begins(self):
        with mock.patch.object(pipeline, 'describe_images', side_effect=AssertionError):
            for pattern, options in (('cv2 .* has no KAZE', {'detector': 'KAZE'}), ('points is 3000000000', {'points': 3000000000}),
                                     ('max_size is -1', {'max_size': -1})):
                with mock.patch.object(cv2, 'KAZE_create', None, create=True), mock.patch.object(cv2, 'xfeatures2d', None, create=True), \
                        self.assertRaisesRegex(ValueError, pattern):
                    self.build(**options)
            with mock.patch.dict('sys.modules', {'cv2': None}), self.assertRaisesRegex(ImportError, 'pip install opencv-python'):
                self.build()
            for database, pattern in (('', 'is a folder'), (self.images, 'is a folder'),
                                      (os.path.join(self.folder.name, 'no', 'x.db'), 'there is no folder')):
                with self.assertRaisesRegex(OSError, pattern):
                    build_database(self.images, database, force=True)
        self.assertEqual(os.listdir(self.folder.name), ['images'])

    def test_a_link_is_followed(self):
        os.makedirs(os.path.join(self.folder.name, 'disk'))
        os.symlink('disk/x.db', self.database)
        for force in (False, True):
            self.build(force=force)
            self.assertEqual((os.readlink(self.database), os.listdir(self.folder.name + '/disk')), ('disk/x.db', ['x.db']))

    def test_every_detector(self):
        image = read_grey(os.path.join(self.images, 'a.png'))
        for name in DETECTORS:
            with self.subTest(name):
                try:
                    features = Features(FeatureOptions(name, 100))
                except ValueError as e:  # OpenCV 5 has three of them no more
                    self.assertIn(name, ('AKAZE', 'BRISK', 'KAZE'))
                    self.assertRegex(str(e), f'^cv2 5.* has no {name}')
                    continue
                rows, codes = features(image)
                self.assertTrue(20 < len(rows) <= 100)
                turned = Features(FeatureOptions(name, 100, orientation=True))(image)
                np.testing.assert_array_equal(turned[0], rows)
                self.assertGreater((turned[1] != codes).any(1).mean(), .8)

    def test_larger_images_are_reduced_and_points_stay_in_their_pixels(self):
        image = cv2.resize(texture(160, 120, seed=4), (641, 480), interpolation=cv2.INTER_CUBIC)
        rows, codes = Features(FeatureOptions(points=200, max_size=320))(image)
        small, plain = Features(FeatureOptions(points=200))(cv2.resize(image, (320, 240), interpolation=cv2.INTER_AREA))
        np.testing.assert_array_equal(codes, plain)
        np.testing.assert_allclose(rows[:, :2] + .5, (small[:, :2] + .5) * (641 / 320, 2), rtol=1e-6)
        np.testing.assert_allclose(rows[:, 2], small[:, 2] * 641 / 320, rtol=1e-6)
        np.testing.assert_array_equal(Features(FeatureOptions(points=200, max_size=641))(image)[0],
                                      Features(FeatureOptions(points=200))(image)[0])

    def test_magsac_without_a_geometry(self):
        inliers, matrix = magsac(np.zeros((3, 2)), np.zeros((3, 2)))
        self.assertEqual((inliers.tolist(), matrix), ([False] * 3, None))
        same = np.ones((50, 2))
        self.assertIn(len(magsac(same, same)[0]), (50,))

    def test_command_line(self):
        arguments = ['colmap', self.images, self.database, '--points', '200', '--verify', 'magsac', '--workers', '2']
        for expected in (0, 1):
            out, err = io.StringIO(), io.StringIO()
            with redirect_stdout(out), redirect_stderr(err):
                self.assertEqual(main(arguments), expected)
        self.assertIn('--force', err.getvalue())
        small = os.path.join(self.folder.name, 'small.png')
        cv2.imwrite(small, np.zeros((1, 1), np.uint8))
        Path(self.folder.name, 'other.db.partial').write_bytes(b'junk' * 1000)
        for wrong in (['colmap', self.images + '/none', 'x.db'], ['colmap', self.images, 'x.db', '--ratio', '0'],
                      ['colmap', self.images, 'x.db', '--neighbours', '-1'], ['colmap', self.images, 'x.db', '--workers', '0'],
                      ['colmap', self.images, 'x.db', '--focal', '-3'], ['colmap', self.images, 'x.db', '--focal', 'nan'],
                      ['colmap', self.images, os.path.join(self.folder.name, 'other.db')],
                      ['demo', small, small, '--out', os.path.join(self.folder.name, 'no.suffix')]):
            with redirect_stderr(io.StringIO()) as err:
                self.assertEqual(main(wrong), 1)
            self.assertEqual(err.getvalue().count('\n'), 1)

    def test_the_recommended_chain_is_the_default(self):
        features = Features(FeatureOptions(points=150))
        image = read_grey(os.path.join(self.images, 'a.png'))
        keypoints, codes = features(image)
        iib = opencv_iib.IIB.createRecommended(150)
        expected = iib.detectAndCompute(image)
        np.testing.assert_array_equal(keypoints, opencv_iib.keypoints_to_array(expected[0]))
        np.testing.assert_array_equal(codes, expected[1])
        self.assertEqual((features.extractor.getScaleFactor(), features.level_sizes()),
                         (iib.getScaleFactor(), iib.levelSizes()))

    def test_demo(self):
        out = os.path.join(self.folder.name, 'demo.png')
        with redirect_stdout(io.StringIO()) as text:
            self.assertEqual(main(['demo', os.path.join(self.images, 'a.png'), os.path.join(self.images, 'b.png'),
                                   '--points', '200', '--out', out, '--preset', 'small', '--detector', 'orb']), 0)
        self.assertRegex(text.getvalue(), r'^IIB \d+ of \d+ consistent, ORB\b.*\npicture: .*demo.png\n$')
        self.assertEqual(cv2.imread(out).shape, (2 * (44 + 640 * 300 // 400), 2 * 640, 3))
        noise = os.path.join(self.folder.name, 'noise.png')
        cv2.imwrite(noise, np.random.default_rng(1).integers(0, 256, (200, 200), np.uint8))
        with redirect_stdout(io.StringIO()) as text, redirect_stderr(io.StringIO()) as hint:
            self.assertEqual(main(['demo', os.path.join(self.images, 'a.png'), noise, '--out', out]), 3)
        self.assertRegex(text.getvalue(), r'^IIB: no homography found in \d+ matches, SIFT.*, ORB')
        self.assertIn('same place', hint.getvalue())
        for arguments, told in (([self.images + '/a.png', self.images + '/b.png', '--points', '3000000000'], 'points is 3000000000'),
                                ([self.images + '/gone.png', noise], 'gone.png: there is no such file'),
                                ([noise, noise, '--out', 'x.foo'], 'x.foo: end its name in .png')):
            with redirect_stderr(io.StringIO()) as err:
                self.assertEqual(main(['demo', *arguments]), 1)
            self.assertRegex(err.getvalue(), f'^demo: [^\n]*{told}[^\n]*\n$')

    @unittest.skipUnless((REPOSITORY / 'tools/synthetic/day.png').exists(), 'the images are not beside these tests')
    def test_the_demo_counts_as_that_of_cpp(self):
        pair = [str(REPOSITORY / f'tools/synthetic/moved_{light}.jpg') for light in ('noon', 'night')]
        iib, sift, orb = demo(*pair, os.path.join(self.folder.name, 'demo.png'))
        claim = re.search(r'`IIB \d+ of (\d+) correct, SIFT \d+ of \d+ correct, ORB \d+ of (\d+) correct`',
                          (REPOSITORY / 'README.md').read_text())
        self.assertEqual((iib.name, sift.name, orb.name), ('IIB', 'SIFT', 'ORB'))
        self.assertEqual([len(iib.good), len(orb.good)], [int(claim[1]), int(claim[2])])

    def test_names_in_any_case(self):
        self.assertEqual(FeatureOptions('orb', preset=opencv_iib.Preset.SMALL), FeatureOptions('ORB', preset='small'))
        with self.assertRaisesRegex(ValueError, 'no preset LARGE: there are DEFAULT, .*UNIVERSAL'):
            FeatureOptions(preset='large').check()

    def test_version(self):
        with redirect_stdout(io.StringIO()) as text, self.assertRaises(SystemExit):
            main(['--version'])
        self.assertEqual(text.getvalue(), f'opencv_iib {opencv_iib.__version__}\n')

    @unittest.skipUnless((REPOSITORY / 'doc/colmap.md').exists(), 'the documentation is not beside these tests')
    def test_the_example_of_the_documentation(self):
        example, = re.findall('```python\n(.*?)```', (REPOSITORY / 'doc/colmap.md').read_text(), re.S)
        where = os.getcwd()
        os.chdir(self.folder.name)
        try:
            names = {}
            with redirect_stderr(io.StringIO()):
                exec(example, names)
        finally:
            os.chdir(where)
        self.assertEqual(names['counts']['images'], 3)

    @unittest.skipIf(shutil.which('colmap') is None, 'no program colmap')
    def test_colmap_verifies(self):
        counts = self.build(verify='colmap')
        self.assertEqual((counts['pairs'], counts['verified pairs']), (3, 3))
        self.assertEqual(self.query('SELECT COUNT(*) FROM descriptors'), [(0,)])

    @unittest.skipIf(pycolmap is None, 'no pycolmap')
    def test_the_newest_colmap_reads_it(self):
        counts = self.build()
        database = pycolmap.Database.open(self.database)
        try:
            self.assertEqual((database.num_images(), database.num_keypoints(), database.num_verified_image_pairs()),
                             (3, counts['keypoints'], 3))
            self.assertEqual(database.read_camera(1).width, 400)
        finally:
            database.close()

    @unittest.skipIf(pycolmap is None, 'no pycolmap')
    def test_an_interrupted_run_goes_on_after_the_newest_colmap(self):
        self.interrupt()
        pycolmap.Database.open(self.database + '.partial').close()  # gives it its own schema
        self.assertEqual(self.build()['verified pairs'], 3)
        self.assertGreater(self.query('PRAGMA user_version')[0][0], 3800)
        pycolmap.Database.open(self.database).close()

    @unittest.skipIf(h5py is None, 'no h5py')
    def test_hloc_keeps_its_files_until_all_are_new(self):
        self.build()
        for file in self.hloc:
            Path(file).write_bytes(b'precious')
        before = sorted(os.listdir(self.folder.name))
        with mock.patch.object(hloc, '_pair', side_effect=OSError('no space left')), self.assertRaises(OSError):
            hloc.export(self.database, *self.hloc, force=True)
        self.assertEqual([Path(file).read_bytes() for file in self.hloc], [b'precious'] * 3)
        with self.assertRaisesRegex(ValueError, 'three files'):
            hloc.export(self.database, *self.hloc[:1] * 3, force=True)
        self.assertEqual(sorted(os.listdir(self.folder.name)), before)

    @unittest.skipIf(h5py is None, 'no h5py')
    def test_hloc(self):
        self.build()
        for expected in (0, 1):
            with redirect_stdout(io.StringIO()), redirect_stderr(io.StringIO()):
                self.assertEqual(main(['hloc', self.database, *self.hloc]), expected)
        for name in ('a#b.db', '100%41.db', 'what?.db'):
            self.database = shutil.copy(self.database, os.path.join(self.folder.name, name))
            self.assertEqual(hloc.export(self.database, *self.hloc, force=True), 3)
        rows, data = self.query('SELECT rows, data FROM keypoints WHERE image_id=1')[0]
        with h5py.File(self.hloc[0]) as features, h5py.File(self.hloc[1]) as matches:
            np.testing.assert_array_equal(features['a.png']['keypoints'][:] + np.float32(.5),
                                          np.frombuffer(data, np.float32).reshape(rows, 4)[:, :2])
            nearest = matches['a.png/more-c.png']['matches0']
            self.assertEqual((nearest.dtype, nearest.shape), (np.int16, (rows,)))
            self.assertTrue((nearest[:] >= -1).all())
        self.assertEqual(len(Path(self.hloc[2]).read_text().splitlines()), 3)
