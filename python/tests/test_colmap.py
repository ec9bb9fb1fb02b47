"""Databases for COLMAP: content, interruptions, workers, mistakes."""
import concurrent.futures
import os
import shutil
import sqlite3
import unittest
from contextlib import closing
from unittest import mock

import numpy as np

from collection import Collection
from opencv_iib import _core, _parallel
from opencv_iib._files import only_writer
from opencv_iib._two_views import magsac
from opencv_iib.colmap import SettingsChanged, pipeline, search
from opencv_iib.colmap.database import MAX_IMAGE_ID, Database, pair_id
from support import cv2, optional, run_command, texture

distributed, pycolmap = optional('distributed'), optional('pycolmap')


class WhatIsWritten(Collection):

    def test_rows(self):
        counts = self.build()
        self.assertEqual((counts['images'], counts['pairs'], counts['verified pairs'], counts['failed']), (3, 3, 3, 0))
        self.assertEqual([name for name, in self.query('SELECT name FROM images ORDER BY name')],
                         ['a.png', 'b.png', 'more/c.png'])
        self.assertEqual(self.query('SELECT DISTINCT cols FROM keypoints'), [(4,)])
        self.assertEqual(self.query('SELECT width, height, prior_focal_length FROM cameras'), [(400, 300, 0)] * 3)
        params = np.frombuffer(self.query('SELECT params FROM cameras')[0][0])
        np.testing.assert_allclose(params, [1.2 * 400, 200, 150, 0])
        self.assertEqual(self.query('PRAGMA user_version'), [(3800,)])
        self.assertEqual(sorted(name for name, in self.query("SELECT name FROM sqlite_master WHERE type='table'") if 'iib' in name),
                         ['iib_files', 'iib_searched', 'iib_settings'], 'what a later run grows from, without the codes')
        self.assertEqual(self.files(), ['database.db', 'images'])
        # verified matches are the known shift
        points = {number: np.frombuffer(data, np.float32).reshape(rows, 4)
                  for number, rows, data in self.query('SELECT image_id, rows, data FROM keypoints')}
        rows, data = self.query(f'SELECT rows, data FROM two_view_geometries WHERE pair_id={pair_id(1, 2)}')[0]
        found = np.frombuffer(data, np.uint32).reshape(rows, 2)
        errors = np.abs(points[1][found[:, 0], :2] - points[2][found[:, 1], :2] - (30, 20)).max(axis=1)
        self.assertGreater(rows, 30)
        self.assertGreater((errors < 2).mean(), .8)

    def test_cameras_that_are_known(self):
        camera = 'opencv,400,300,500,501,200,150,.1,.01,0,0'
        for name in ('a.png', 'b.png'):
            shutil.copy(self.images / name, self.images / 'more' / name)
        self.assertEqual(run_command('colmap', self.images, self.database, '--points', '300', '--verify', 'magsac', '--camera', camera,
                                     '--camera-of', 'more=OPENCV_FISHEYE,400,300,400,400,200,150,0,0,0,0')[0], 0)
        rows = self.query('SELECT name, camera_id, model, prior_focal_length, params FROM images NATURAL JOIN cameras ORDER BY name')
        self.assertEqual([row[:4] for row in rows], [('a.png', 1, 4, 1), ('b.png', 1, 4, 1), *((f'more/{n}.png', 2, 5, 1) for n in 'abc')])
        self.assertEqual(np.frombuffer(rows[0][4]).tolist(), [500, 501, 200, 150, .1, .01, 0, 0])
        for wrong in (['--camera', 'PINHOLE,9'], ['--camera-of', 'more'], ['--camera-of', 'more=FISH,1,2,3'],
                      ['--camera', 'x=PINHOLE,400,300,400,400,200,150'], ['--camera-of', 'mroe=PINHOLE,400,300,400,400,200,150']):
            self.check_mistake('', 'colmap', self.images, self.folder / 'x.db', *wrong)
        wrong, mask = 'PINHOLE,300,400,9,9,150,200', self.folder / 'mask.png'
        cv2.imwrite(str(mask), np.ones((9, 9), np.uint8))
        for message, *options in (('a.png: its camera has 300 x 400', '--camera', wrong), ('more/a.png: its camera has 300 x 400', '--camera-of', f'more={wrong}'),
                               ('its mask .* 9 x 9', '--mask', mask), ('two cameras of more/', *['--camera-of', f'more={camera}', '--camera-of', f'./more/={camera}'])):
            self.check_mistake(message, 'colmap', self.images, self.folder / 'x.db', *options)
        self.assertFalse((self.folder / 'x.db').exists())
        cv2.imwrite(str(self.images / 'small.png'), np.zeros((9, 9), np.uint8))
        self.assertEqual(run_command('colmap', self.images, self.folder / 'x.db', '--points', '300', '--verify', 'magsac', '--camera', camera)[0], 4)

    def test_pairs_stored_the_other_way_round(self):
        self.assertEqual((pair_id(1, 2), pair_id(2, 1)), (2147483647 + 2,) * 2)
        with Database(str(self.database), {}) as database:
            matrix = np.arange(9.).reshape(3, 3)
            database.add_pair(5, 2, np.array([[1, 7], [3, 4]]), np.array([[1, 7]]), matrix)
            row = database._db.execute('SELECT matches.data, two_view_geometries.data, F FROM matches JOIN '
                                       'two_view_geometries USING (pair_id)').fetchone()
            self.assertEqual(list(database.pairs()), [(2, 5)])
        self.assertEqual(np.frombuffer(row[0], np.uint32).reshape(-1, 2).tolist(), [[7, 1], [4, 3]])
        self.assertEqual(np.frombuffer(row[1], np.uint32).tolist(), [7, 1])
        np.testing.assert_array_equal(np.frombuffer(row[2]).reshape(3, 3), matrix.T)

    def test_magsac_without_a_geometry(self):
        inliers, matrix = magsac(np.zeros((3, 2)), np.zeros((3, 2)))
        self.assertEqual((inliers.tolist(), matrix), ([False] * 3, None))
        self.assertEqual(len(magsac(np.ones((50, 2)), np.ones((50, 2)))[0]), 50)

    @unittest.skipIf(shutil.which('colmap') is None, 'no program colmap')
    def test_colmap_verifies(self):
        counts = self.build(verify='colmap')
        self.assertEqual((counts['pairs'], counts['verified pairs']), (3, 3))
        self.assertEqual(self.query('SELECT COUNT(*) FROM descriptors'), [(0,)])


class Searches(Collection):

    def setUp(self):
        super().setUp()
        world = cv2.resize(texture(320, 240, seed=3), (1280, 960), interpolation=cv2.INTER_CUBIC)
        maps = {'a.png': (.45, 0), 'b.png': (.45, 5), 'near.png': (1.6, 0), 'more/c.png': (.5, 130)}
        self.maps = {}
        for name, (zoom, angle) in maps.items():
            self.maps[name] = np.vstack([cv2.getRotationMatrix2D((960, 480), angle, zoom) + [[0, 0, -710], [0, 0, -280]], [0, 0, 1]])
            cv2.imwrite(str(self.images / name), cv2.warpAffine(world, self.maps[name][:2], (500, 400), flags=cv2.INTER_AREA))

    def test_images_from_near_and_far_and_rotated_are_joined(self):
        tables = [f'SELECT * FROM {table} ORDER BY 1' for table in ('keypoints', 'matches', 'two_view_geometries')]
        self.assertEqual(self.build(search=False)['verified pairs'], 3)  # few points of near.png match by chance
        points, *before = map(self.query, tables)
        self.assertGreaterEqual(self.build(force=True)['verified pairs'], 5)
        keypoints = {row[0]: np.frombuffer(row[3], np.float32).reshape(row[1:3]) for row in self.query(tables[0])}
        for number, rows, _, data in points:
            self.assertEqual(keypoints[number][:rows].tobytes(), data)
        for old, table in zip(before, tables[1:]):
            self.assertIn(old[0], self.query(table), 'an ordinary pair')
        names = dict(self.query('SELECT image_id, name FROM images'))
        searched = self.query('SELECT pair_id, rows, data FROM two_view_geometries NATURAL JOIN iib_searched')
        self.assertEqual(len(searched), 4)
        for key, rows, data in searched:
            a, b = divmod(key, MAX_IMAGE_ID)
            matches = np.frombuffer(data, np.uint32).reshape(-1, 2).T
            self.assertEqual([len(np.unique(side)) for side in matches], [rows, rows])
            moved = cv2.transform(keypoints[a][None, matches[0], :2] - .5, (self.maps[names[b]] @ np.linalg.inv(self.maps[names[a]]))[:2])[0]
            errors = np.linalg.norm(moved - keypoints[b][matches[1], :2] + .5, axis=1)
            self.assertLess(np.median(errors), 2)
            self.assertGreater(np.count_nonzero(errors < 4), 100)

    def test_images_that_show_nothing(self):
        for name, size in (('flat.png', (300, 400)), ('small.png', (9, 9)), ('smallest.png', (1, 1))):
            cv2.imwrite(str(self.images / name), np.full(size, 9, np.uint8))
        counts = self.build()
        self.assertEqual((counts['images'], counts['failed']), (7, 0))
        self.assertEqual(self.query('SELECT DISTINCT found FROM iib_searched'), [(1,)])

    def test_a_search_goes_on_and_images_of_a_finished_database_keep_their_points(self):
        self.build()
        rows = self.dump()
        with self.ended_in(search, 'magsac', 3):
            self.build(workers=1)
        self.build()
        self.assertEqual(self.dump(), rows)
        near = (self.images / 'near.png').rename(self.folder / 'near.png')
        self.build()
        points = 'SELECT image_id, rows FROM keypoints WHERE image_id < 4'
        before = self.query(points)
        near.rename(self.images / 'near.png')
        self.assertGreater(self.build()['verified pairs'], 4)
        self.assertEqual(self.query(points), before)
        with mock.patch.object(search, 'search_pair', side_effect=AssertionError):
            self.build()


class Runs(Collection):

    def test_an_existing_database_is_kept(self):
        self.database.write_bytes(b'precious')
        with self.assertRaisesRegex(FileExistsError, '--force'):
            self.build()
        self.assertEqual(self.database.read_bytes(), b'precious')
        self.build(force=True)
        self.assertEqual(self.query('SELECT COUNT(*) FROM images'), [(3,)])

    def grow(self, described, **options):
        """Builds again. :return: images that are described, and pairs that are matched."""
        seen, pairs = [], []
        describe, match = pipeline.describe_image, pipeline.opencv_iib.match
        with mock.patch.object(pipeline, 'describe_image', lambda folder, options, name: seen.append(name) or describe(folder, options, name)), \
                mock.patch.object(pipeline.opencv_iib, 'match', lambda *a: pairs.append(1) or match(*a)):
            counts = self.build(**options)
        self.assertEqual(sorted(seen), described)
        return counts, len(pairs)

    def test_a_finished_database_grows(self):
        self.build()
        old = {table: self.query(f'SELECT * FROM {table}') for table in ('cameras', 'images', 'keypoints', 'matches', 'two_view_geometries')}
        with closing(sqlite3.connect(self.database)) as connection:  # a newer COLMAP does so when it opens the file
            connection.execute('ALTER TABLE images ADD COLUMN frame INTEGER')
            connection.execute('PRAGMA user_version=4000')
        self.assertEqual(self.grow([])[1], 0)
        self.assertEqual(self.query('PRAGMA user_version'), [(3800,)])
        shutil.copy(self.images / 'a.png', self.images / 'd.png')
        counts, matched = self.grow(['a.png', 'b.png', 'd.png', 'more/c.png'])
        self.assertEqual((counts['images'], counts['pairs'], matched), (4, 6, 3))
        for table, rows in old.items():
            self.assertLessEqual(set(rows), set(self.query(f'SELECT * FROM {table}')))
        grown = {row[1]: row[2:] for row in self.query('SELECT name, rows, data FROM images NATURAL JOIN keypoints')}
        (self.images / 'more/c.png').write_bytes((self.images / 'more/c.png').read_bytes() + b'more')
        (self.images / 'b.png').unlink()
        self.assertEqual(self.grow(['a.png', 'd.png', 'more/c.png'])[0]['pairs'], 3)
        self.database.unlink()
        self.build(workers=1)
        self.assertEqual({row[1]: row[2:] for row in self.query('SELECT name, rows, data FROM images NATURAL JOIN keypoints')},
                         {name: row for name, row in grown.items() if name != 'b.png'})

    def test_an_image_keeps_its_number(self):
        names = 'SELECT name, image_id, camera_id FROM images ORDER BY name'
        self.build()
        before, points = self.query(names), self.query('SELECT * FROM keypoints')
        for name in ('a.png', 'more/c.png'):
            os.utime(self.images / name, (1, 1))  # like cp and rsync
        moved = self.images.rename(self.folder / 'moved')
        self.images = moved
        self.assertEqual(self.grow([])[1], 0)
        self.assertEqual((self.query(names), self.query('SELECT * FROM keypoints')), (before, points))
        shutil.copy(self.images / 'b.png', self.images / 'a.png')
        self.assertEqual(self.grow(['a.png', 'b.png', 'more/c.png'])[1], 2)
        self.assertEqual(self.query(names), before)
        same = [data for data, in self.query("SELECT data FROM keypoints NATURAL JOIN images WHERE name < 'c'")]
        self.assertEqual(same[0], same[1])
        (self.images / 'a.png').write_bytes(b'no image any more')
        self.assertEqual(self.build()['failed'], 1)
        self.assertEqual(self.query(names), before[1:])
        shutil.rmtree(self.images)
        self.images.mkdir()
        cv2.imwrite(str(self.images / 'z.png'), texture(400, 300))
        self.assertEqual(self.build(force=True)['images'], 1)
        self.images = self.images.rename(self.folder / 'images')
        cv2.imwrite(str(self.images / 'z.png'), texture(400, 300, seed=5))
        with self.assertRaisesRegex(SettingsChanged, 'other images, none of which is in'):
            self.build()

    def test_one_setting_has_many_texts(self):
        camera = '{},400,300,690.10,690,200,150'
        self.build(camera_of=['more/=' + camera.format('pinhole')])
        self.assertEqual(self.grow([], camera_of=['./more=' + camera.format('PINHOLE').replace('690.10', '690.1')])[1], 0)
        with self.assertRaisesRegex(SettingsChanged,
                                    r'settings \(cameras more/=PINHOLE,400,300,690.1,690,200,150, now none, ratio 0.92, now 0.8, search on, now off\): use them'):
            self.build(ratio=.8, search=False)
        with mock.patch('opencv_iib.__version__', '0.3'), self.assertRaisesRegex(SettingsChanged, r'settings \(version \d.*, now 0.3\): use them'):
            self.build(ratio=.8)

    def test_only_images_of_new_pairs_are_described_again(self):
        self.build(pairs='sequential', neighbours=1)
        shutil.copy(self.images / 'a.png', self.images / 'z.png')
        self.assertEqual(self.grow(['more/c.png', 'z.png'], pairs='sequential', neighbours=1)[1], 1)
        with self.assertRaisesRegex(SettingsChanged, '--force'):
            self.build(pairs='sequential', neighbours=2)
        with self.ended_in(pipeline, 'match_pairs'):
            shutil.copy(self.images / 'a.png', self.images / 'y.png')
            self.build(pairs='sequential', neighbours=1)
        self.assertEqual(self.build(pairs='sequential', neighbours=1)['images'], 5)

    def test_an_interrupted_run_goes_on(self):
        self.interrupt()
        self.assertFalse(self.database.exists())
        with self.assertRaisesRegex(SettingsChanged, '--force'):
            self.build(points=200)
        with only_writer(f'{self.database}.partial'), self.assertRaisesRegex(BlockingIOError, 'another process'):
            self.build()
        real, described, matched = pipeline.magsac, [], []
        with mock.patch.object(pipeline, 'ImageFile', lambda *file: described.append(file)), \
                mock.patch.object(pipeline, 'magsac', lambda *a: matched.append(1) or real(*a)):
            counts = self.build()
        self.assertEqual(described, [])
        self.assertLess(len(matched), 3)
        self.assertEqual((counts['images'], counts['pairs']), (3, 3))
        with self.ended_in(_core.WholeFile, 'commit'):  # the file is complete, but not renamed yet
            self.build(force=True)
        self.assertEqual(self.build(force=True), counts)
        with self.ended_in(_core.WholeFile, 'commit'):
            self.build(force=True)
        self.assertLess(self.build(force=True, points=200)['keypoints'], counts['keypoints'], 'other options than the unfinished run')
        self.assertEqual(self.files(), ['database.db', 'images'])

    def test_images_changed_or_removed_after_an_interruption(self):
        (self.images / 'more/c.png').rename(self.images / 'c.png')
        shutil.copy(self.images / 'b.png', self.images / 'd.png')
        self.interrupt()
        shutil.copy(self.images / 'c.png', self.images / 'b.png')
        (self.images / 'a.png').unlink()
        self.assertEqual(self.build()['images'], 3)
        self.assertEqual(self.query('SELECT name FROM images ORDER BY name'), [('b.png',), ('c.png',), ('d.png',)])
        b, c = (self.query(f"SELECT data FROM keypoints NATURAL JOIN images WHERE name='{name}.png'") for name in 'bc')
        self.assertEqual(b, c)
        self.assertEqual(self.query('SELECT COUNT(*) FROM cameras'), [(3,)])
        numbers = {number for number, in self.query('SELECT image_id FROM images')}
        for key, in self.query('SELECT pair_id FROM matches'):
            self.assertLessEqual(set(divmod(key, MAX_IMAGE_ID)), numbers)

    @unittest.skipIf(pycolmap is None, 'no pycolmap')
    def test_the_newest_colmap_reads_it_and_an_interrupted_run_goes_on_after_it(self):
        self.interrupt()
        pycolmap.Database.open(f'{self.database}.partial').close()  # upgrades it to its own schema
        counts = self.build()
        self.assertGreater(self.query('PRAGMA user_version')[0][0], 3800)
        with pycolmap.Database.open(self.database) as database:
            self.assertEqual((database.num_images(), database.num_keypoints(), database.num_verified_image_pairs()),
                             (3, counts['keypoints'], 3))
            self.assertEqual(database.read_camera(1).width, 400)

    def test_what_no_unfinished_run_has_left_stays(self):
        partial = self.folder / 'database.db.partial'
        self.database.write_bytes(b'precious')

        def expect_kept(path):
            content = path.read_bytes()
            for force in (True, False):
                if not force:
                    self.database.unlink(missing_ok=True)
                with self.assertRaisesRegex(FileExistsError, 'not of an unfinished run'):
                    self.build(force=force)
            self.assertEqual(path.read_bytes(), content)
            path.unlink()
        for name in ('.partial', '.partial-wal', '.partial-journal'):
            (self.folder / f'database.db{name}').write_bytes(b'precious' * 1000)
            expect_kept(self.folder / f'database.db{name}')
        self.assertEqual(self.files(), ['images'], 'nothing is left of refused runs')
        with closing(sqlite3.connect(partial)) as other:
            other.execute('CREATE TABLE images (name_of_another_program TEXT)')
        expect_kept(partial)
        (self.folder / 'database.db.new').write_bytes(b'precious')
        self.assertEqual(self.build()['images'], 3)
        self.assertEqual(self.files(), ['database.db', 'database.db.new', 'images'])

    def test_a_full_disk_leaves_the_old_file(self):
        self.database.write_bytes(b'precious')
        real = Database.add_image

        def full(database, *arguments):
            pages = database._db.execute('PRAGMA page_count').fetchone()[0]
            database._db.execute(f'PRAGMA max_page_count={pages}')
            real(database, *arguments)
        with mock.patch.object(Database, 'add_image', full), self.assertRaisesRegex(sqlite3.Error, 'full'):
            self.build(force=True)
        self.assertEqual(self.database.read_bytes(), b'precious')

    def test_nothing_is_left_of_a_run_that_described_nothing(self):
        shutil.rmtree(self.images)
        self.images.mkdir()
        (self.images / 'broken.png').write_bytes(b'no image')
        self.database.write_bytes(b'precious')
        with self.assertRaisesRegex(ValueError, 'none of the 1 images'):
            self.build(force=True)
        self.assertEqual(self.database.read_bytes(), b'precious')
        self.assertEqual(self.files(), ['database.db', 'images'])

    def test_a_link_is_followed(self):
        (self.folder / 'disk').mkdir()
        self.database.symlink_to('disk/x.db')
        for force in (False, True):
            self.build(force=force)
            self.assertEqual((os.readlink(self.database), os.listdir(self.folder / 'disk')), ('disk/x.db', ['x.db']))


class Workers(Collection):

    @unittest.skipIf(distributed is None, 'no distributed')
    def test_the_workers_of_a_client(self):
        for name in ('d.png', 'e.png'):
            shutil.copy(self.images / 'a.png', self.images / name)
        (self.images / 'broken.jpg').write_bytes(b'no image')
        counts = self.build(workers=5)
        lines, rows = list(self.lines), self.dump()
        self.assertEqual((counts['pairs'], len(lines)), (10, 1))
        with distributed.LocalCluster(n_workers=2, threads_per_worker=2, dashboard_address=None,
                                      silence_logs=50) as cluster, distributed.Client(cluster) as client:
            with mock.patch.object(_parallel.Cluster, 'tile_side', 2):
                self.assertEqual(self.build(client=client), counts)
            self.assertEqual((self.lines[1:], self.dump()), (lines, rows))
            status, _, _ = run_command('colmap', self.images, self.database, '--points', '300', '--verify', 'magsac', '--scheduler',
                                       cluster.scheduler_address)
            self.assertEqual((status, self.dump()), (4, rows))
            with mock.patch.object(_parallel.Cluster, 'ahead', side_effect=concurrent.futures.CancelledError), \
                    self.assertRaisesRegex(ConnectionError, 'the scheduler has gone'):
                self.build(client=client)
            moved, absolute = f'{self.images}-moved', os.path.abspath
            with mock.patch.object(pipeline.os.path, 'abspath', lambda path: moved if path == str(self.images) else absolute(path)), \
                    self.assertRaisesRegex(FileNotFoundError, moved):
                self.build(client=client)


class Mistakes(Collection):

    def test_they_are_found_before_work_begins(self):
        with mock.patch.object(pipeline, 'describe_images', side_effect=AssertionError):
            for pattern, options in (('cv2 .* has no KAZE', {'detector': 'KAZE'}), ('points is 3000000000', {'points': 3000000000}),
                                     ('max_size is -1', {'max_size': -1})):
                with mock.patch.object(cv2, 'KAZE_create', None, create=True), mock.patch.object(cv2, 'xfeatures2d', None, create=True), \
                        self.assertRaisesRegex(ValueError, pattern):
                    self.build(**options)
            with mock.patch.dict('sys.modules', {'cv2': None}), self.assertRaisesRegex(ImportError, 'pip install opencv-python'):
                self.build()
        self.assertEqual(self.files(), ['images'])

    def test_command_line(self):
        arguments = 'colmap', self.images, self.database, '--points', '200', '--verify', 'magsac', '--workers', '2'
        self.assertEqual(run_command(*arguments)[0], 0)
        self.check_error('other settings.*--force', *arguments, '--ratio', '.8')
        small = 'colmap', self.images, self.folder / 'small.db', '--points', '200', '--workers', '2'
        any_case = '--verify', 'MAGSAC', '--camera-model', 'opencv', '--pairs', 'Sequential', '--detector', 'hessian', '--preset', 'Small'
        self.assertEqual(run_command(*small, *any_case)[0], 0)
