import atexit
import copy
import csv
import functools
import io
import os
import pickle
import re
import shutil
import tempfile
import threading
import unittest
from contextlib import redirect_stderr
from pathlib import Path
from unittest import mock

import numpy as np

import opencv_iib
from opencv_iib import _core, _upright
from opencv_iib.localization import Camera, Localizer, Location, build, smooth_poses, update
from opencv_iib.localization import maps, run as runs
from support import REPOSITORY, Commands, cv2, files_end_at, optional, run_command, seconds_until_interrupt, steps_meanwhile, texture

pycolmap = optional('pycolmap')

SIZE = WIDTH, HEIGHT = 320, 240
CAMERA = f'PINHOLE,{WIDTH},{HEIGHT},300,300,160,120'
STRECHA = os.path.join(os.environ.get('OPENCV_TEST_DATA_PATH', ''), 'strecha', 'Herz-Jesus-P8')
PLACES = [(-1.5, 0), (-1, .3), (-.5, 0), (0, .3), (.5, 0), (1, .3)]  #: x and y in front of a wall at z = 5


def wall(seed):
    """1200 x 900, a hundred pixels a metre."""
    return cv2.resize(texture(240, 180, seed=seed), (1200, 900), interpolation=cv2.INTER_CUBIC)


def rigid(turn, place):
    """4 x 4, of a camera at a place."""
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = turn, -turn @ np.array(place)
    return pose


def pose(x, y):
    """Camera from world, turned towards the middle of the wall."""
    return rigid(cv2.Rodrigues(np.array([.05 * y, .1 * x, 0]))[0], [x, y, 0])


def photograph(picture, cam_from_world, lit=lambda grey: grey):
    camera = np.array([[300, 0, 159.5], [0, 300, 119.5], [0, 0, 1]])
    matrix = cam_from_world[:3]
    from_wall = camera @ (np.stack([matrix[:, 0], matrix[:, 1], 5 * matrix[:, 2] + matrix[:, 3]], axis=1))
    from_pixels = np.array([[.01, 0, -6], [0, .01, -4.5], [0, 0, 1]])  # to metres
    return lit(cv2.warpPerspective(picture, from_wall @ from_pixels, SIZE))


def evening(grey, noise=2):
    shade = np.linspace(10, 40, WIDTH) * (grey / 255) ** 1.5
    return np.clip(shade + np.random.default_rng(1).normal(5, noise, grey.shape), 0, 255).astype(np.uint8)


def write_model(folder, poses, camera=CAMERA):
    """A COLMAP model without points, of poses by name."""
    os.makedirs(folder, exist_ok=True)
    _core.writeModel(folder, [_core.PosedImage(name, Camera.parse(camera), pose, np.empty((0, 2))) for name, pose in poses.items()])


def trajectory(folder, name='trajectory.txt'):
    """By names without blanks: centre, quaternion x y z w."""
    lines = [line.split() for line in Path(folder, name).read_text().splitlines() if line[0] != '#']
    return {line[0]: np.array(line[1:], float) for line in lines}


def dimmed(picture, seed):
    """Gamma 2.2, a ramp to a quarter across the image, half the light, and noise."""
    light = (picture / 255) ** 2.2 * np.linspace(.5, .125, picture.shape[1])[:, None] * 255
    return np.clip(light + np.random.default_rng(seed).normal(0, 2, picture.shape), 0, 255).astype(np.uint8)


NAMES = [*(f'left side/{i} of 6.png' for i in range(3)), '0.png', '1.png', '2.png']  #: of the images at these places
TRUTH = {'a/b': (-.8, .1), 'a-b': (-.2, .2), 'c': (.3, .1)}  #: where those in the dark are


@functools.lru_cache(maxsize=None)
def mapped():
    """A folder with `images` of the wall, their `model`, its `map`, and other images in the `dark`."""
    folder = tempfile.mkdtemp()
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    images, model, picture = os.path.join(folder, 'images'), os.path.join(folder, 'model'), wall(3)
    for name in ('images/left side', 'dark/a'):
        os.makedirs(os.path.join(folder, name))
    for name, place in zip(NAMES, PLACES):
        cv2.imwrite(os.path.join(images, name), photograph(picture, pose(*place)))
    for name, place in TRUTH.items():
        cv2.imwrite(os.path.join(folder, 'dark', name + '.png'), photograph(picture, pose(*place), evening))
    write_model(model, {name: pose(*place) for name, place in zip(NAMES, PLACES)})
    status, _, errors = run_command('map', '--model', model, '--images', images, '--out', os.path.join(folder, 'map'), '--points', '400')
    assert status == 0, errors
    return folder


@unittest.skipIf(cv2 is None, 'no cv2')
class Localization(Commands):

    @classmethod
    def setUpClass(cls):
        cls.folder, cls.truth = mapped(), TRUTH
        cls.images, cls.model, cls.map, cls.dark = (os.path.join(cls.folder, name) for name in ('images', 'model', 'map', 'dark'))
        cls.poses = {name: pose(*place) for name, place in zip(NAMES, PLACES)}

    def path(self, name):
        return os.path.join(tempfile.mkdtemp(dir=self.folder), name)

    def grey(self, name='c'):
        return cv2.imread(os.path.join(self.dark, name + '.png'), cv2.IMREAD_GRAYSCALE)

    def check(self, location, name='c'):
        self.assertEqual(location.reason, '')
        error = location.cam_from_world @ np.linalg.inv(pose(*self.truth[name]))
        self.assertLess(np.linalg.norm(error[:3, 3]), .05)
        self.assertLess(np.linalg.norm(error[:3, :3] - np.eye(3)), .02)

    def localize(self, out, *arguments, map=None, images=None):
        return run_command('localize', '--map', map or self.map, '--images', images or self.dark, '--out', out, *arguments)[::2]

    def test_another_light_is_localized_and_written(self):
        out = self.path('out')
        for _ in range(2):  # the second replaces the first
            self.assertEqual(self.localize(out, '--camera', CAMERA, '--pictures')[0], 0)
        self.assertEqual(sorted(os.listdir(out)), ['cameras.bin', 'frames.csv', 'images.bin', 'matches', 'points3D.bin', 'trajectory.txt'])
        for name in self.truth:  # a/b and a-b stay apart
            self.assertEqual(cv2.imread(os.path.join(out, 'matches', name + '.png')).shape, (HEIGHT, WIDTH, 3))
        self.assertEqual(Path(out, 'trajectory.txt').read_text().splitlines()[0], '# name tx ty tz qx qy qz qw')
        found = trajectory(out)
        self.assertEqual(list(found), sorted(self.truth))
        for name, place in self.truth.items():
            true = pose(*place)
            self.assertLess(np.linalg.norm(found[name][:3] - [*place, 0]), .05)
            half = cv2.Rodrigues(true[:3, :3].T)[0].ravel() / 2
            self.assertGreater(found[name][3:] @ [*half, 1] / np.linalg.norm([*half, 1]), .9999)  # of small angles
        lines = Path(out, 'frames.csv').read_text().splitlines()
        self.assertRegex(lines[0], '^name,found,reason,matches,inliers,x_x,x_y,x_z,x_rx,')
        rows = list(csv.DictReader(lines))
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
        self.assertEqual((repr(camera), eval(repr(camera))), ("Camera('PINHOLE', 320, 240, [300.0, 300.0, 160.0, 120.0])", camera))
        self.assertTrue(found.found and not nothing.found)
        self.assertNotEqual(found, nothing)
        self.assertRegex(repr(found), rf'^Location\(centre \[.*\], {found.inliers} of {found.matches} matches agree\)$')
        self.assertEqual(repr(nothing), f'Location(reason={nothing.reason!r})')
        self.assertEqual(repr(localizer), f'Localizer({os.path.abspath(self.map)!r}, points=1000, lines=False)')
        made = Location(found.cam_from_world[:3], found.covariance, '', found.matches, found.inliers, found.pixels, found.points)
        for value, same in ((camera, camera), (found, made), (nothing, nothing), (localizer, Localizer(Path(self.map)))):
            self.assertEqual((copy.copy(value), pickle.loads(pickle.dumps(value))), (same, same))
            self.assertNotEqual(value, 'another')
        self.check(pickle.loads(pickle.dumps(localizer)).localize(self.grey(), pickle.loads(pickle.dumps(camera))))
        self.assertEqual(len(smooth_poses([0, 1], [made, Location()], np.zeros((0, 7)))), 2)

    def test_photographs_that_are_stored_turned(self):
        from test_upright import STORED, png, stored
        folder, out, localizer = self.path('turned'), self.path('out'), Localizer(self.map)
        os.makedirs(folder)
        found = {}
        for orientation in STORED:
            turn = _upright.Turn(orientation, *stored(self.grey(), orientation).shape[1::-1])
            Path(folder, f'{orientation}.png').write_bytes(png(stored(self.grey(), orientation), orientation))
            if orientation in (1, 3, 6, 8):
                width, height = stored(self.grey(), orientation).shape[::-1]
                camera = Camera('PINHOLE', width, height, (300, 300, width / 2, height / 2))
                location = found[orientation] = localizer.localize(stored(self.grey(), orientation), camera, None, orientation)
                moved = np.eye(4)
                moved[:2, :2] = turn.matrix[:2, :2].T
                self.check(Location(moved @ location.cam_from_world, location.covariance))
                seen = camera.project(location.points @ location.cam_from_world[:3, :3].T + location.cam_from_world[:3, 3])
                self.assertLess(np.abs(seen - location.pixels).max(), 2)
                near = localizer.localize(stored(self.grey(), orientation), camera, location.cam_from_world, orientation)
                np.testing.assert_allclose(near.cam_from_world, location.cam_from_world, atol=.02)
        status, errors = self.localize(out, '--camera', 'SIMPLE_PINHOLE,240,320,300,120,160', images=folder)
        self.assertEqual((status, sorted(trajectory(out))), (4, ['6', '8']))
        np.testing.assert_allclose(trajectory(out)['6'][:3], -found[6].cam_from_world[:3, :3].T @ found[6].cam_from_world[:3, 3], atol=.01)
        self.assertEqual(self.localize(out, '--camera', 'SIMPLE_PINHOLE,240,320,300,120,160', '--no-exif', images=folder)[0], 3)
        status, text, _ = run_command('update', '--map', self.map, '--images', folder, '--out', self.path('new'), '--camera', CAMERA)
        self.assertEqual((status, '2 localized' in text), (4, True))

    def test_maps_of_photographs_that_are_stored_turned(self):
        from test_upright import png, stored
        model, images, out = self.path('model'), self.path('images'), self.path('map')
        posed, turns = [], dict(zip(self.poses, (1, 6, 8, 3, 6, 1)))
        for name, orientation in turns.items():
            image = stored(cv2.imread(os.path.join(self.images, name), cv2.IMREAD_GRAYSCALE), orientation)
            os.makedirs(os.path.dirname(os.path.join(images, name)), exist_ok=True)
            Path(images, name).write_bytes(png(image, orientation))
            turned = np.eye(4)
            turned[:2, :2] = _upright.Turn(orientation, *image.shape[::-1]).matrix[:2, :2]
            camera = Camera.parse(CAMERA).upright({6: 8, 8: 6}.get(orientation, orientation))
            posed.append(_core.PosedImage(name, camera, turned @ self.poses[name], np.empty((0, 2))))
        os.makedirs(model)
        _core.writeModel(model, posed)
        self.assertEqual(run_command('map', '--model', model, '--images', images, '--out', out, '--points', '400')[0], 0)
        self.check(Localizer(out).localize(self.grey(), CAMERA))
        Path(images, 'query.png').write_bytes(png(stored(self.grey(), 6), 6))
        for name in turns:
            os.unlink(os.path.join(images, name))
        self.assertEqual(self.localize(self.path('out'), map=out, images=images)[0], 0)  # by the map's camera, turned

    def test_masks(self):
        masks, out, found = self.path('masks'), self.path('map'), self.path('out')
        mask = np.full((HEIGHT, WIDTH), 255, np.uint8)
        mask[:, :WIDTH // 2] = 0
        for name in [*self.poses, 'c.png']:
            os.makedirs(os.path.dirname(os.path.join(masks, name)), exist_ok=True)
            cv2.imwrite(os.path.join(masks, name + '.png'), mask)
        status, text, _ = run_command('map', '--model', self.model, '--images', self.images, '--out', out, '--points', '400', '--mask', masks)
        self.assertEqual(status, 0)
        location = Localizer(out).localize(self.grey(), CAMERA)
        self.check(location)
        seen = Localizer(self.map).localize(self.grey(), CAMERA, mask=mask)
        self.assertGreaterEqual(seen.pixels[:, 0].min(), WIDTH // 2 - 1)
        self.assertLess(Localizer(self.map).localize(self.grey(), CAMERA).pixels[:, 0].min(), WIDTH // 2 - 9)
        with self.assertRaisesRegex(opencv_iib.error, "a mask is CV_8UC1"):
            Localizer(self.map).localize(self.grey(), CAMERA, mask=mask[1:])
        status, _ = self.localize(found, '--camera', CAMERA, '--mask', masks, '--max-size', '300')
        self.assertEqual(status, 0)
        self.assertEqual(run_command('update', '--map', self.map, '--images', self.dark, '--camera', CAMERA, '--mask', masks, '--max-size', '300',
                                     '--out', self.path('new'))[0], 0)

    def test_an_imu_gives_poses_to_images_that_tell_nothing(self):
        localizer = Localizer(self.map)
        location, nothing = (localizer.localize(image, CAMERA) for image in (self.grey(), np.zeros((HEIGHT, WIDTH), np.uint8)))
        times = [8_500_000_000 + 500_000_000 * i for i in range(6)]
        own = location.cam_from_world
        readings = np.zeros((1001, 7))  # of a camera that stands still
        readings[:, 0], readings[:, 4:] = 8e9 + 5e6 * np.arange(1001), own[:3, :3] @ [0, -9.81, 0]
        locations = [location, nothing, *[location] * 4]
        smoothed = smooth_poses(np.array(times), locations, readings)
        self.assertEqual(smoothed.reason, '')
        for found in smoothed:
            np.testing.assert_allclose(found, own, atol=1e-3)
        wrong = smooth_poses(times, locations, readings * ([1] + [30] * 6))
        self.assertRegex(wrong.reason, 'contradict the images')
        self.assertEqual([pose is None for pose in wrong], [False, True, *[False] * 4])
        self.assertEqual([pose is None for pose in smooth_poses(times, locations, readings[:0])], [False, True, *[False] * 4])
        for text, wrong in (('M x 7', (times, locations, readings[:, 1:])), ('M x 7', (times, locations, readings * np.nan)),
                            ('and rise', (times[::-1], locations, readings)), ('5 times of 6', (times[1:], locations, readings)),
                            ('an integer', ([.5] * 6, locations, readings)), ('a pose is', (times, locations, readings, [1]))):
            with self.assertRaisesRegex((TypeError, ValueError, opencv_iib.error), text):
                smooth_poses(*wrong)

    def test_maps_of_the_papers_points(self):
        made = self.path('paper')
        status, _, errors = run_command('map', '--model', self.model, '--images', self.images, '--out', made, '--orb-and-akaze')
        self.assertEqual(status, 0, errors)
        self.check(Localizer(made).localize(photograph(wall(3), pose(*self.truth['c'])), CAMERA))
        self.assertRegex(Localizer(made).localize(self.grey(), CAMERA).reason, 'too few')  # recommended points would be seen

    def test_the_gil_is_released(self):
        localizer, image = Localizer(self.map, 400), self.grey()
        self.assertGreater(steps_meanwhile(lambda: [localizer.localize(image, CAMERA) for _ in range(20)]), 3)

    @unittest.skipUnless((REPOSITORY / 'doc/maps.md').exists(), 'the documentation is not beside these tests')
    def test_the_program_of_the_page(self):
        program, = re.findall('```python\n(.*?)```', (REPOSITORY / 'doc/maps.md').read_text(), re.S)
        program = re.sub(r'PINHOLE[\d,.]+', CAMERA, program).replace("'MAP'", repr(self.map))
        names = {'names': [os.path.join(self.dark, name + '.png') for name in sorted(self.truth)]}
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

    def test_an_interrupted_map(self):
        images, count = [], 40
        for i in range(count):
            images.append((f'{i}.png', pose(-1.5 + 3 * i / count, 0)))
        model, folder, out = self.path('model'), self.path('images'), self.path('map')
        write_model(model, dict(images))
        os.makedirs(folder)
        view = photograph(wall(3), pose(0, 0))
        for name, _ in images:
            cv2.imwrite(os.path.join(folder, name), view)
        read = maps.decode_grey

        def slowly(path):
            threading.Event().wait(.2)
            return read(path)
        with mock.patch.object(maps, 'decode_grey', slowly), redirect_stderr(io.StringIO()):
            self.assertLess(seconds_until_interrupt(lambda: build(model, folder, out, workers=1), .5), 2)
        self.assertEqual(self.localize(self.path('out'), map=out)[0], 1)  # there is no map

    def test_status_counts_the_images_with_a_pose_and_says_why(self):
        mixed, out = self.path('mixed'), self.path('out')
        shutil.copytree(self.dark, mixed)
        cv2.imwrite(os.path.join(mixed, 'elsewhere.png'), photograph(wall(9), pose(0, 0)))
        status, errors = self.localize(out, '--camera', CAMERA, images=mixed)
        self.assertEqual(status, 4)
        self.assertRegex(errors, 'elsewhere.png: too few matches')
        rows = {row['name']: row for row in csv.DictReader(Path(out, 'frames.csv').read_text().splitlines())}
        self.assertRegex(rows['elsewhere.png']['reason'], 'too few matches')
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
        with open(os.path.join(out, 'frames.csv'), newline='') as file:
            rows = {row['name']: row for row in csv.DictReader(file)}
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
        for told, taken in ((305, 300), (400, 400)):
            with mock.patch.object(runs, 'exif_focal_length', return_value=told):
                self.assertEqual(runs.find_camera(b'', WIDTH, HEIGHT, known).params[0], taken)
                self.assertEqual(runs.find_camera(b'', 640, 480, known).params, [told, 320, 240])

    def test_cameras_of_a_map_that_agree_are_one(self):
        model, made, out = self.path('model'), self.path('map'), self.path('out')

        def build_with(focals):
            os.makedirs(model, exist_ok=True)
            images = [_core.PosedImage(name, Camera('SIMPLE_RADIAL', WIDTH, HEIGHT, (focal, 160, 120, focal / 3e4 - .01)), place,
                                       np.empty((0, 2))) for (name, place), focal in zip(self.poses.items(), focals)]
            _core.writeModel(model, images)
            status, _, errors = run_command('map', '--model', model, '--images', self.images, '--out', made, '--points', '400', '--force')
            self.assertEqual(status, 0, errors)
        build_with((297, 298, 300, 301, 302, 303))
        status, errors = self.localize(out, map=made)
        self.assertEqual((status, errors.count('the middle one of 6 cameras of the map, which agree')), (0, 1))
        self.assertIn('[301.0, 160.0, 120.0', errors)
        told = []
        list(runs.localize_stream(made, [os.path.join(self.dark, name) for name in os.listdir(self.dark)], log=told.append))
        self.assertRegex('|'.join(told), r'^[^|]*the middle one of 6 cameras of the map, which agree$')
        self.assertIn('which agree', run_command('update', '--map', made, '--images', self.dark, '--out', self.path('new'))[2])
        build_with((297, 298, 300, 301, 302, 330))
        status, errors = self.localize(out, map=made)
        self.assertEqual((status, errors.count('6 cameras of the map have its size, which differ: give --camera PINHOLE,320,240,F,F,160,120')),
                         (3, 3))

    def test_mistakes_get_one_line(self):
        out, empty = self.path('out'), self.path('empty')
        os.makedirs(empty)
        localize = '--map', self.map, '--images', self.dark, '--out', out
        self.check_mistake('camera', 'localize', *localize, '--camera', 'FISH,1,2,3')
        self.check_error('is no map', 'localize', '--map', self.images, *localize[2:])
        self.check_mistake('(map has no lines|lines need OpenCV)', 'localize', *localize, '--lines')
        for name in ('no', os.path.join(self.map, 'map.iib')):
            self.check_error('there is no folder', 'localize', '--map', self.map, '--images', name, '--out', out)
        self.check_error('no images below', 'localize', '--map', self.map, '--images', empty, '--out', out)
        mapping = 'map', '--images', self.images, '--out', out, '--model'
        self.check_error('model', *mapping, self.images)
        self.check_error('there is no folder', 'map', '--images', 'no', '--out', out, '--model', self.model)
        missing = self.path('model')
        write_model(missing, {**self.poses, 'missing.png': np.eye(4)})
        self.check_error('missing.png is missing', *mapping, missing)
        wrong = self.path('model')
        write_model(wrong, dict(zip(self.poses, (pose(y, x) for x, y in PLACES))))
        self.check_error('fit the poses', *mapping, wrong)
        larger = self.path('model')
        write_model(larger, self.poses, 'PINHOLE,640,480,300,300,320,240')
        self.check_error('320 x 240.*640 x 480', *mapping, larger)
        self.assertFalse(os.path.exists(out) and os.listdir(out))

    def test_what_is_there_is_replaced_by_force_alone(self):
        out = self.path('map')
        shutil.copytree(self.map, out)
        arguments = 'map', '--model', self.model, '--images', self.images, '--points', '300', '--out'
        self.check_error('--force', *arguments, out)
        self.assertEqual(run_command(*arguments, out, '--force')[0], 0)
        foreign = self.path('mine')
        os.makedirs(foreign)
        Path(foreign, 'letter.txt').touch()
        self.check_error('letter.txt', *arguments, foreign, '--force')
        self.check_error('holds letter.txt', 'localize', '--map', self.map, '--images', self.dark, '--out', foreign)

    def test_what_the_user_puts_beside_results_stays(self):
        out = self.path('out')
        self.assertEqual(self.localize(out, '--pictures')[0], 0)
        self.assertEqual(self.localize(out, '--pictures')[0], 0)
        for name in ('matches/notes.txt', 'matches/mine.png'):
            Path(out, name).write_text('precious')
            self.check_error('holds ' + name, 'localize', '--map', self.map, '--images', self.dark, '--out', out)
            self.assertEqual(Path(out, name).read_text(), 'precious')
            os.unlink(os.path.join(out, name))
        foreign = self.path('foreign')
        os.makedirs(foreign)
        for text in ('name,camera\na,b\n', 'x\0' * 200000, ''):
            Path(foreign, 'frames.csv').write_text(text)
            self.check_error('holds frames.csv', 'localize', '--map', self.map, '--images', self.dark, '--out', foreign)
            self.assertEqual(Path(foreign, 'frames.csv').read_text(), text)
        for beside in ('.partial', '.partial.old', '.new', '.iib_partial'):
            os.makedirs(out + beside)
            Path(out + beside, 'thesis').write_text('precious')
        self.assertEqual(self.localize(out)[0], 0)
        self.assertFalse(os.path.exists(os.path.join(out, 'matches')))
        for beside in ('.partial', '.partial.old', '.new', '.iib_partial'):
            self.assertEqual(Path(out + beside, 'thesis').read_text(), 'precious')

    def test_an_update_replaces_another_map_by_force_alone(self):
        other = self.path('other')
        shutil.copytree(self.map, other)
        before = Path(other, 'map.iib').read_bytes()
        arguments = 'update', '--map', self.map, '--images', self.dark, '--out', other
        self.check_error('--force', *arguments)
        self.assertEqual(Path(other, 'map.iib').read_bytes(), before)
        self.assertEqual(run_command(*arguments, '--force')[0], 0)
        self.assertNotEqual(Path(other, 'map.iib').read_bytes(), before)

    def test_refusals_come_before_work(self):
        out = self.path('out')
        with mock.patch.object(_core, 'Localizer', side_effect=AssertionError):
            self.check_mistake('FISH', 'localize', '--map', self.map, '--images', self.dark, '--out', out, '--camera', 'FISH,1,2,3')
            self.check_error('holds .*png', 'localize', '--map', self.map, '--images', self.dark, '--out', self.images)
        with mock.patch.object(maps, 'decode_grey', side_effect=AssertionError):
            self.check_mistake('points is 0', 'map', '--model', self.model, '--images', self.images, '--out', out, '--points', '0')
            self.check_mistake('points is -1', 'map', '--model', self.model, '--images', self.images, '--out', out, '--points', '-1', '--orb-and-akaze')
        self.assertFalse(os.path.exists(out))
        if os.getuid():  # root may write everywhere
            closed = self.path('map')
            shutil.copytree(self.map, closed)
            os.chmod(closed, 0o500)
            with mock.patch.object(runs, 'decode_grey', side_effect=AssertionError):
                self.check_error('check the folder and its rights', 'update', '--map', closed, '--images', self.dark)

    def test_links_are_followed_and_results_are_no_images(self):
        folder = self.path('disk')
        images, out = os.path.join(folder, 'images'), os.path.join(folder, 'images/out')
        shutil.copytree(self.dark, images)
        shutil.copytree(self.map, os.path.join(folder, 'map'))
        os.symlink('disk/map', folder + 'map')
        os.symlink('disk/images/out', folder + 'out')  # dangling
        for _ in range(2):
            self.assertEqual(self.localize(folder + 'out', '--pictures', images=images)[0], 0)
            self.assertEqual(len(trajectory(out)), 3)
            self.assertTrue(os.path.islink(folder + 'out'))
        self.assertEqual(run_command('update', '--map', folder + 'map', '--images', self.dark)[0], 0)
        self.assertTrue(os.path.islink(folder + 'map'))

    def test_paths_that_are_not_utf8(self):
        folder = self.path('x') + '/caf\udce9'
        shutil.copytree(self.dark, folder + '/images')
        shutil.copytree(self.images, folder + '/mapped')
        self.assertEqual(run_command('map', '--model', self.model, '--images', folder + '/mapped', '--out', folder + '/map')[0], 0)
        self.assertEqual(self.localize(folder + '/out', map=folder + '/map', images=folder + '/images')[0], 0)
        self.assertEqual(run_command('update', '--map', folder + '/map', '--images', folder + '/images')[0], 0)
        self.assertEqual(len(trajectory(folder + '/out')), 3)

    def test_a_full_disk_leaves_the_old_results(self):
        out, map = self.path('out'), self.path('map')
        shutil.copytree(self.map, map)
        self.assertEqual(self.localize(out, '--pictures')[0], 0)
        largest = max(os.path.getsize(os.path.join(out, name)) for name in os.listdir(out))
        before = trajectory(out), sorted(os.listdir(out))
        for size in (0, 50, 200, 600, largest - 1):
            with files_end_at(size):
                status, _ = self.localize(out)
            self.assertEqual((status, before[1]), (1, sorted(os.listdir(out))))
        self.assertEqual(trajectory(out).keys(), before[0].keys())
        largest = max(os.path.getsize(os.path.join(map, name)) for name in os.listdir(map))
        for size in (0, 5000, largest // 2):
            with files_end_at(size):
                self.assertEqual(run_command('update', '--map', map, '--images', self.dark)[0], 1)
            self.check(Localizer(map).localize(self.grey(), CAMERA))

    def test_an_update_adds_a_light(self):
        out, night = self.path('map'), self.path('night')
        os.makedirs(night)
        for name, place in self.truth.items():
            view = photograph(wall(3), pose(*place), lambda grey: evening(grey, noise=6))
            cv2.imwrite(os.path.join(night, name.replace('/', ' ') + '.png'), view)
        with redirect_stderr(io.StringIO()):
            counts = update(self.map, night, CAMERA, out)
            self.assertEqual((counts['images'], counts['localized']), (3, 3))
            self.assertGreater(counts['added'], 0)
            self.check(Localizer(out).localize(self.grey(), CAMERA))
            old, new = (Localizer(map, 400).localize(view, CAMERA).inliers for map in (self.map, out))
            self.assertGreater(new, 1.2 * old)
            again = update(out, night)
        self.assertEqual((again['localized'], again['added']), (3, 0))

    def test_an_update_says_why_an_image_has_no_pose(self):
        mixed, out = self.path('mixed'), self.path('new')
        os.makedirs(mixed)
        cv2.imwrite(os.path.join(mixed, 'elsewhere.png'), photograph(wall(9), pose(0, 0)))
        Path(mixed, 'broken.png').touch()
        arguments = 'update', '--map', self.map, '--images', mixed, '--out', out, '--camera', CAMERA
        status, text, errors = run_command(*arguments)
        self.assertEqual((status, '2 images, 0 localized' in text), (3, True))
        self.assertRegex(errors, r'broken.png: the file is empty\nelsewhere.png: too few matches')
        shutil.copy(os.path.join(self.dark, 'c.png'), mixed)
        self.assertEqual(run_command(*arguments, '--force')[0], 4)

    @unittest.skipUnless(os.path.isdir(STRECHA), 'OPENCV_TEST_DATA_PATH has no strecha/Herz-Jesus-P8')
    def test_photographs_within_five_centimetres_also_relit(self):
        truth = trajectory(STRECHA, 'poses.txt')
        camera = ','.join(Path(STRECHA, 'cameras.txt').read_text().splitlines()[-1].split()[1:])
        model, made, poses = self.path('sparse'), self.path('map'), {}
        for name in sorted(os.listdir(os.path.join(STRECHA, 'images'))):
            numbers = truth[os.path.splitext(name)[0]]
            sine = np.linalg.norm(numbers[3:6])
            turn = cv2.Rodrigues(numbers[3:6] * 2 * np.arctan2(sine, numbers[6]) / sine)[0].T
            poses[name] = rigid(turn, numbers[:3])
        write_model(model, dict(list(poses.items())[::2]), camera)
        with redirect_stderr(io.StringIO()):
            self.assertEqual(build(model, os.path.join(STRECHA, 'images'), made)['images'], len(poses) - len(poses) // 2)
        localizer = Localizer(made)
        for n, (name, true) in enumerate(list(poses.items())[1::2]):
            picture = cv2.imread(os.path.join(STRECHA, 'images', name))
            for image in (picture, dimmed(picture, n)):
                found = localizer.localize(image, camera).cam_from_world
                error = found @ np.linalg.inv(true)
                self.assertLess(np.linalg.norm(np.linalg.inv(found)[:3, 3] - np.linalg.inv(true)[:3, 3]), .05, name)
                self.assertGreater((np.trace(error[:3, :3]) - 1) / 2, np.cos(np.radians(.25)), name)


if __name__ == '__main__':
    unittest.main()
