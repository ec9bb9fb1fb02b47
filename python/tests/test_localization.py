import copy
import os
import pickle
import re
import shutil
import unittest
from pathlib import Path
from unittest import mock

import numpy as np

import opencv_iib
from opencv_iib import _core, error
from opencv_iib._exif import MIRRORED
from opencv_iib._files import RECORD
from opencv_iib.localization import Camera, Localizer, Location, smooth_poses
from opencv_iib.localization import run as runs
from support import REPOSITORY, cv2, optional, rows_of, run_command, steps_meanwhile
from wall import CAMERA, HEIGHT, OnWall, PLACES, WIDTH, photograph, pose, trajectory, wall, write_model

pycolmap = optional('pycolmap')


class Localization(OnWall):

    def test_another_light_is_localized_and_written(self):
        out = self.path('out')
        for _ in range(2):  # the second result replaces the first
            self.assertEqual(self.localize(out, '--camera', CAMERA, '--pictures')[0], 0)
        self.assertEqual(sorted(os.listdir(out)), [RECORD, 'cameras.bin', 'frames.csv', 'images.bin', 'matches', 'points3D.bin', 'trajectory.txt'])
        for name in self.truth:  # a/b and a-b get different names
            self.assertEqual(cv2.imread(os.path.join(out, 'matches', name + '.png')).shape, (HEIGHT, WIDTH, 3))
        self.assertEqual(Path(out, 'trajectory.txt').read_text().splitlines()[0], '# name tx ty tz qx qy qz qw')
        found = trajectory(out)
        self.assertEqual(list(found), sorted(self.truth))
        for name, place in self.truth.items():
            true = pose(*place)
            self.assertLess(np.linalg.norm(found[name][:3] - [*place, 0]), .05)
            half = cv2.Rodrigues(true[:3, :3].T)[0].ravel() / 2
            self.assertGreater(found[name][3:] @ [*half, 1] / np.linalg.norm([*half, 1]), .9999)  # of small angles
        rows = rows_of(out, 'frames.csv')
        self.assertEqual(list(rows[0])[:9], ['name', 'found', 'reason', 'matches', 'inliers', 'x_x', 'x_y', 'x_z', 'x_rx'])
        self.assertEqual([row['found'] for row in rows], ['1'] * 3)
        self.assertGreater(int(rows[0]['inliers']), 15)
        self.assertLess(float(rows[0]['x_x']) ** .5, .05)
        for row in rows:
            np.testing.assert_array_equal([float(row[column]) for column in runs.POSE], found[os.path.splitext(row['name'])[0]])

    @unittest.skipIf(pycolmap is None, 'no pycolmap')
    def test_colmap_reads_what_is_written_and_its_objects_are_taken(self):
        out = self.path('out')
        self.localize(out)
        model, mapped = pycolmap.Reconstruction(out), pycolmap.Reconstruction(self.map)
        self.assertEqual((model.num_reg_images(), model.num_cameras()), (3, 1))
        self.assertEqual({image.name for image in mapped.images.values()}, set(self.poses))
        self.assertGreater(mapped.num_points3D(), 200)
        self.assertLess(np.median([abs(point.xyz[2] - 5) for point in mapped.points3D.values()]), .02)  # on the wall
        image = next(image for image in model.images.values() if image.name == 'c.png')
        location = Localizer(self.map).localize(self.grey(), model.cameras[image.camera_id], image.cam_from_world().matrix())
        self.check(location)
        np.testing.assert_allclose(location.cam_from_world[:3], image.cam_from_world().matrix(), atol=.01)

    def test_a_location(self):
        localizer = Localizer(self.map)
        location = localizer.localize(self.grey(), CAMERA)
        self.check(location)
        self.assertEqual((location.cam_from_world.shape, location.covariance.shape), ((4, 4), (6, 6)))
        self.assertGreaterEqual(location.matches, location.inliers)
        self.assertEqual(len(location.pixels), len(location.points))
        own = location.cam_from_world
        seen = Camera.parse(CAMERA).project(location.points @ own[:3, :3].T + own[:3, 3])
        self.assertLess(np.abs(seen - location.pixels).max(), 2)
        np.testing.assert_allclose(Camera.parse(CAMERA).undistorted(location.pixels), location.pixels, atol=1e-9)
        np.testing.assert_allclose(Camera.parse(CAMERA).matrix, [[300, 0, 159.5], [0, 300, 119.5], [0, 0, 1]])
        near = localizer.localize(cv2.cvtColor(self.grey(), cv2.COLOR_GRAY2BGR), localizer.cameras[0], prior=own[:3])
        self.check(near)
        nothing = localizer.localize(np.zeros((HEIGHT, WIDTH), np.uint8), CAMERA)
        self.assertEqual((nothing.cam_from_world, nothing.covariance, nothing.inliers), (None, None, 0))
        self.assertRegex(nothing.reason, 'too few')

    def test_values_are_shown_compared_sent_and_made(self):
        camera = Camera('pinhole', WIDTH, HEIGHT, (300, 300, 160, 120))
        localizer = Localizer(self.map)
        found, nothing = localizer.localize(self.grey(), camera), localizer.localize(np.zeros((HEIGHT, WIDTH), np.uint8), camera)
        self.assertEqual((camera, {camera}), (Camera.parse(CAMERA.lower()), set(localizer.cameras)))
        self.assertNotEqual(camera, Camera('PINHOLE', WIDTH, HEIGHT, (300, 300, 160, 121)))
        self.assertEqual(str(camera), 'PINHOLE,320,240,300,300,160,120')
        self.assertEqual((repr(camera), eval(repr(camera))), ("Camera('PINHOLE', 320, 240, [300.0, 300.0, 160.0, 120.0])", camera))
        self.assertTrue(found.found and not nothing.found)
        self.assertNotEqual(found, nothing)
        self.assertRegex(repr(found), rf'^Location\(centre \[.*\], {found.inliers} of {found.matches} matches agree\)$')
        self.assertEqual(repr(nothing), f'Location(reason={nothing.reason!r})')
        self.assertEqual(repr(localizer), f'Localizer({os.path.abspath(self.map)!r}, points=1000, lines=False)')
        made = Location(found.cam_from_world[:3], found.covariance, '', found.matches, found.inliers, found.pixels, found.points)
        for value, same in ((camera, camera), (found, made), (nothing, nothing), (localizer, Localizer(Path(self.map)))):
            self.assertEqual((copy.copy(value), pickle.loads(pickle.dumps(value))), (same, same))
            self.assertIs(type(pickle.loads(pickle.dumps(value))), type(value))
            self.assertNotEqual(value, 'another')
        self.check(pickle.loads(pickle.dumps(localizer)).localize(self.grey(), pickle.loads(pickle.dumps(camera))))
        self.assertEqual(len(smooth_poses([0, 1], [made, Location()], np.zeros((0, 7)))), 2)

    def test_photographs_that_are_stored_turned(self):
        from test_upright import STORED, png, stored
        folder, out = self.path('turned'), self.path('out')
        os.makedirs(folder)
        for orientation in STORED:
            Path(folder, f'{orientation}.png').write_bytes(png(stored(self.grey(), orientation), orientation))
        for more in ((), ('--no-exif',)):  # images are found at any rotation; only EXIF says that one is mirrored
            status, _ = self.localize(out, '--camera', 'SIMPLE_PINHOLE,240,320,300,120,160', *more, images=folder)
            self.assertEqual((status, sorted(trajectory(out))), (4, ['6', '8']))
            np.testing.assert_allclose(trajectory(out)['6'][:3], [*self.truth['c'], 0], atol=.05)
            for command in (('localize', '--out', self.path('l')), ('update', '--out', self.path('u'))):
                errors = run_command(*command, '--map', self.map, '--images', folder, *more)[2]
                for orientation in MIRRORED:
                    self.assertRegex(errors, rf'{orientation}.png: its EXIF data say that it is stored mirrored \(orientation {orientation}\)')
        status, text, _ = run_command('update', '--map', self.map, '--images', folder, '--out', self.path('new'), '--camera', CAMERA)
        self.assertEqual((status, '2 localized' in text), (4, True))

    def test_arguments_of_smooth_poses(self):
        localizer = Localizer(self.map)
        location, nothing = (localizer.localize(image, CAMERA) for image in (self.grey(), np.zeros((HEIGHT, WIDTH), np.uint8)))
        times, readings = np.arange(6), np.zeros((0, 7))
        locations = [location, nothing, *[location] * 4]
        found = smooth_poses(times, locations, readings)
        self.assertEqual(([pose is None for pose in found], found.reason), ([False, True, *[False] * 4], ''))
        for text, wrong in (('M x 7', (times, locations, readings[:, 1:])), ('M x 7', (times, locations, np.full((1, 7), np.nan))),
                            ('and rise', (times[::-1], locations, readings)), ('5 times of 6', (times[1:], locations, readings)),
                            ('an integer', ([.5] * 6, locations, readings)), ('a pose is', (times, locations, readings, [1]))):
            with self.assertRaisesRegex((TypeError, ValueError, opencv_iib.error), text):
                smooth_poses(*wrong)

    def test_the_gil_is_released(self):
        localizer, image = Localizer(self.map, 400), self.grey()
        self.assertGreater(steps_meanwhile(lambda: [localizer.localize(image, CAMERA) for _ in range(20)]), 3)

    @unittest.skipUnless((REPOSITORY / 'doc/maps.md').exists(), 'the documentation is not beside these tests')
    def test_the_program_of_the_page(self):
        program, = re.findall('```python\n(.*?)```', (REPOSITORY / 'doc/maps.md').read_text(), re.S)
        program = re.sub(r'PINHOLE[\d,.]+', CAMERA, program).replace("'MAP'", repr(self.map)).replace("'evening/*'", repr(self.dark + '/*.png'))
        names = {}
        exec(program, names)
        self.check(names['location'])

    def test_wrong_arguments(self):
        localizer = Localizer(self.map)
        for pattern, image, camera, prior in (
                ('320 x 240 pixels and its camera 640 x 480', self.grey(), 'PINHOLE,640,480,300,300,320,240', None),
                ('8-bit', self.grey().astype(np.float32), CAMERA, None), ('a pose is', self.grey(), CAMERA, np.eye(3)),
                ('a pose is', self.grey(), CAMERA, np.full((4, 4), np.nan)), ('camera model FISH', self.grey(), 'FISH,1,2,3', None)):
            with self.assertRaisesRegex((ValueError, opencv_iib.error), pattern):
                localizer.localize(image, camera, prior)

    def test_status_counts_the_images_with_a_pose_and_says_why(self):
        mixed, out = self.path('mixed'), self.path('out')
        shutil.copytree(self.dark, mixed)
        cv2.imwrite(os.path.join(mixed, 'elsewhere.png'), photograph(wall(9), pose(0, 0)))
        status, errors = self.localize(out, '--camera', CAMERA, images=mixed)
        self.assertEqual(status, 4)
        self.assertRegex(errors, 'elsewhere.png: too few matches')
        self.assertRegex({row['name']: row['reason'] for row in rows_of(out, 'frames.csv')}['elsewhere.png'], 'too few matches')
        shutil.rmtree(mixed)
        os.makedirs(mixed)
        Path(mixed, 'broken.png').write_bytes(b'nothing')
        status, errors = self.localize(out, '--camera', CAMERA, images=mixed)
        self.assertEqual((status, errors.count('not an image')), (3, 1))

    @unittest.skipIf(os.name == 'nt', 'such names cannot be had there')
    def test_one_image_ends_nothing(self):
        mixed, out = self.path('mixed'), self.path('out')
        os.makedirs(os.path.join(mixed, 'locked'))
        names = ['c.png', 'c.jpg', 'c.jpg.png', '#1.png', 'a\nb.png', 'caf\udce9.png', 'x' * 251 + '.png']
        for name in names:
            shutil.copy(os.path.join(self.dark, 'c.png'), os.path.join(mixed, name))
        os.symlink('loop.png', os.path.join(mixed, 'loop.png'))
        os.mkfifo(os.path.join(mixed, 'pipe.png'))
        for _ in range(2):
            self.assertEqual(self.localize(out, '--camera', CAMERA, '--pictures', images=mixed)[0], 4)
        rows = {row['name']: row for row in rows_of(out, 'frames.csv')}
        self.assertEqual(sorted(trajectory(out)), ['c.jpg', 'c.jpg.png', 'c.png', 'x' * 251])
        self.assertEqual(sorted(os.listdir(os.path.join(out, 'matches'))), ['c.jpg.png', 'c.jpg.png.png', 'c.png.png', 'x' * 251 + '.png'])
        self.assertEqual([row['found'] for row in rows.values()].count('1'), 4)
        for name in ('#1.png', 'a\nb.png', 'caf\\udce9.png'):
            self.assertRegex(rows[name]['reason'], 'rename it')
        self.assertRegex(rows['pipe.png']['reason'], 'not a file')
        self.assertEqual(run_command('update', '--map', self.map, '--images', mixed, '--camera', CAMERA, '--out', self.path('map'))[0], 4)
        with mock.patch('os.scandir', side_effect=PermissionError(13, 'Permission denied', 'x/locked')):
            self.check_error('x/locked cannot be read: Permission denied', 'localize', '--map', self.map, '--images', mixed, '--out', out)

    def test_an_image_without_exif_takes_the_maps_only_camera_of_its_size(self):
        out, images = self.path('out'), self.path('images')
        self.assertEqual(self.localize(out)[0], 0)
        os.makedirs(images)
        cv2.imwrite(os.path.join(images, 'small.png'), self.grey()[1:])
        self.assertEqual(self.localize(out, images=images)[0], 3)
        self.assertRegex(Path(out, 'frames.csv').read_text(), '0 cameras of the map have its size: give --camera')
        known = Localizer(self.map).cameras
        for by_exif, taken in ((305, 300), (400, 400)):
            with mock.patch.object(runs, 'exif_focal_length', return_value=by_exif):
                self.assertEqual(runs.find_camera(b'', WIDTH, HEIGHT, known).params[0], taken)
                self.assertEqual(runs.find_camera(b'', 640, 480, known).params, [by_exif, 320, 240])

    def test_mistakes_get_one_line(self):
        out, empty = self.path('out'), self.path('empty')
        os.makedirs(empty)
        localize = '--map', self.map, '--images', self.dark, '--out', out
        self.check_error('is no map', 'localize', '--map', self.images, *localize[2:])
        self.check_mistake("(map has no lines|built without OpenCV's module line_descriptor)", 'localize', *localize, '--lines')
        mapping = 'map', '--images', self.images, '--out', out, '--model'
        for lacks in "this library was built without OpenCV's module line_descriptor", 'OpenCV 5 has no AKAZE':  # the library's words
            with mock.patch.object(_core, 'buildMap', side_effect=error(lacks)):
                self.check_mistake(lacks, *mapping, self.model)
        self.check_mistake('no images below', 'localize', '--map', self.map, '--images', empty, '--out', out)
        self.check_error('model', *mapping, self.images)
        wrong = self.path('model')
        write_model(wrong, dict(zip(self.poses, (pose(y, x) for x, y in PLACES))))
        self.check_error('fit the poses', *mapping, wrong)
        larger = self.path('model')
        write_model(larger, self.poses, 'PINHOLE,640,480,300,300,320,240')
        self.assertEqual(run_command(*mapping, larger)[0], 1)
        self.assertRegex(run_command(*mapping, larger)[2], r'\nmap: no keypoint was found in any .* of; .*320 x 240 .* 640 x 480: left out of the map\n$')
        self.assertFalse(os.path.exists(out) and os.listdir(out))

    def test_every_command_takes_paths_that_are_not_utf8_and_is_quiet(self):
        folder = self.path('x') + '/caf\udce9'
        shutil.copytree(self.dark, folder + '/images')
        shutil.copytree(self.images, folder + '/mapped')
        Path(folder, 'pairs.txt').write_text('c.png a-b.png\n')
        pair, images, of = (f'{folder}/images/c.png', f'{folder}/images/a-b.png'), f'{folder}/images', ('--images', f'{folder}/images')
        for arguments in (('demo', *pair, '--out', folder + '/x.png'), ('match', *pair, '--out', folder + '/x.csv'),
                          ('match', '--pairs', folder + '/pairs.txt', *of, '--out', folder + '/matched'), ('align', *pair, '--out', folder + '/aligned'),
                          ('colmap', images, folder + '/x.db', '--points', '300', '--verify', 'magsac'),
                          ('map', '--model', self.model, '--images', folder + '/mapped', '--out', folder + '/map', '--points', '400'),
                          ('localize', '--map', folder + '/map', *of, '--out', folder + '/out'), ('update', '--map', folder + '/map', *of)):
            with self.subTest(arguments):
                status, out, _ = run_command(*arguments)
                self.assertIn(status, (0, 3))
                out.encode()  # like a terminal
                self.assertEqual(run_command(*arguments, '--quiet', *(['--force'] if arguments[0] == 'map' else []))[1:], ('', ''))
        self.assertEqual(len(trajectory(folder + '/out')), 3)

    def test_no_command_replaces_what_is_the_users(self):
        c, listing = os.path.join(self.dark, 'c.png'), Path(self.path('pairs.txt'))
        listing.write_text('c.png a-b.png\n')
        for command, *arguments in (('localize', '--map', self.map, '--images', self.dark, '--pictures'), ('align', c, self.dark),
                                    ('map', '--model', self.model, '--images', self.images, '--points', '400', '--force'),
                                    ('match', '--pairs', listing, '--images', self.dark, '--points', '300')):
            out, foreign = self.path('out'), self.path('foreign')
            first = run_command(command, *arguments, '--out', out)
            self.assertIn(first[0], (0, 3, 4))
            made = sorted(os.listdir(out))
            for name in ('notes.txt', 'views/mine.png', 'matches/mine.png', '.hidden', 'rigs.bin'):
                with self.subTest(command=command, name=name):
                    os.makedirs(os.path.dirname(os.path.join(out, name)), exist_ok=True)
                    Path(out, name).write_text('precious')
                    self.check_error('holds ' + name, command, *arguments, '--out', out)
                    self.assertEqual(Path(out, name).read_text(), 'precious')
                    os.unlink(os.path.join(out, name))
            os.makedirs(foreign)
            for name in set(made) - {RECORD}:
                if command != 'map' and os.path.isfile(os.path.join(out, name)):  # --force replaces a map
                    Path(foreign, name).write_bytes(b'precious' * 9999)  # the command would write it
                    self.check_error('holds ' + name, command, *arguments, '--out', foreign)
                    self.assertEqual(Path(foreign, name).read_bytes(), b'precious' * 9999)
                    os.unlink(os.path.join(foreign, name))
            beside = [out + end for end in ('.partial', '.partial.old', '.new', '.old')]
            for name in beside:
                Path(name).write_text('precious')
            self.assertEqual(run_command(command, *arguments, '--out', out)[0], first[0])
            self.assertEqual(([Path(name).read_text() for name in beside], set(os.listdir(out)) - {'matches', 'views'}),
                             (['precious'] * 4, set(made) - {'matches', 'views'}))
