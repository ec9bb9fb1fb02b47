import csv
import io
import json
import os
import shutil
import subprocess
import tempfile
import unittest
from concurrent.futures import ThreadPoolExecutor
from contextlib import redirect_stderr, redirect_stdout
from unittest import mock

import numpy as np

from support import cv2, optional, texture

pycolmap = optional('pycolmap')

if cv2 is not None:
    from opencv_iib.__main__ import main
    from opencv_iib.colmap import pipeline
    from opencv_iib.localization import Localizer, build_map, find_camera, parse_camera, read_map, update
    from opencv_iib.localization.folders import new_folder
    from opencv_iib.localization.geometry import refine_pose
    from opencv_iib.localization.map import compact
    from opencv_iib.localization.retrieval import Votes

SIZE = WIDTH, HEIGHT = 320, 240
CAMERA = f'PINHOLE,{WIDTH},{HEIGHT},300,300,160,120'
STRECHA = os.path.join(os.environ.get('OPENCV_TEST_DATA_PATH', ''), 'strecha', 'Herz-Jesus-P8')
PLACES = [(-1.5, 0), (-1, .3), (-.5, 0), (0, .3), (.5, 0), (1, .3)]  #: x and y in front of a wall at z = 5


def wall(seed):
    """1200 x 900, a hundred pixels a metre."""
    return cv2.resize(texture(240, 180, seed=seed), (1200, 900), interpolation=cv2.INTER_CUBIC)


def pose(x, y):
    """Camera from world, turned towards the middle of the wall."""
    turn = cv2.Rodrigues(np.array([.05 * y, .1 * x, 0]))[0]
    return pycolmap.Rigid3d(pycolmap.Rotation3d(turn), -turn @ np.array([x, y, 0]))


def photograph(picture, cam_from_world, lit=lambda grey: grey):
    matrix = cam_from_world.matrix()
    camera = np.array([[300, 0, 159.5], [0, 300, 119.5], [0, 0, 1]])
    from_wall = camera @ (np.stack([matrix[:, 0], matrix[:, 1], 5 * matrix[:, 2] + matrix[:, 3]], axis=1))
    from_pixels = np.array([[.01, 0, -6], [0, .01, -4.5], [0, 0, 1]])  # to metres
    return lit(cv2.warpPerspective(picture, from_wall @ from_pixels, SIZE))


def evening(grey):
    shade = np.linspace(10, 40, WIDTH) * (grey / 255) ** 1.5
    return np.clip(shade + np.random.default_rng(1).normal(5, 2, grey.shape), 0, 255).astype(np.uint8)


def write_model(folder, names, unit=1., text=False):
    model = pycolmap.Reconstruction()
    camera = parse_camera(CAMERA)
    camera.camera_id = 1
    model.add_camera_with_trivial_rig(camera)
    for i, (name, place) in enumerate(zip(names, PLACES), 1):
        cam_from_world = pose(*place)
        cam_from_world.translation = cam_from_world.translation * unit
        model.add_image_with_trivial_frame(pycolmap.Image(name, np.zeros((0, 2)), 1, i), cam_from_world)
    os.makedirs(folder, exist_ok=True)
    model.write_text(folder) if text else model.write(folder)


def run(*arguments):
    """Status and what was written to standard error."""
    errors = io.StringIO()
    with redirect_stderr(errors), redirect_stdout(io.StringIO()):
        status = main(list(arguments))
    return status, errors.getvalue()


def cpp(*arguments):
    program = os.path.join(os.environ['IIB_PROGRAMS'], 'iib_localize')
    subprocess.run([program, *arguments], check=True, stdout=subprocess.DEVNULL)


def poses(folder, name='trajectory.txt'):
    """By names without blanks: centre, quaternion x y z w."""
    lines = [line.split() for line in open(os.path.join(folder, name)) if line[0] != '#']
    return {line[0]: np.array(line[1:], float) for line in lines}


def dimmed(picture, seed):
    """Gamma 2.2, a ramp to a quarter across the image, half the light, and noise."""
    light = (picture / 255) ** 2.2 * np.linspace(.5, .125, picture.shape[1])[:, None] * 255
    return np.clip(light + np.random.default_rng(seed).normal(0, 2, picture.shape), 0, 255).astype(np.uint8)


@unittest.skipIf(cv2 is None, 'no cv2')
@unittest.skipIf(pycolmap is None, 'no pycolmap')
class Localization(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = temporary.name
        cls.images, cls.model, cls.map, cls.dark = (os.path.join(cls.folder, name) for name in
                                                    ('images', 'model', 'map', 'dark'))
        cls.names = [f'left side/{i} of 6.png' for i in range(3)] + [f'{i}.png' for i in range(3)]
        os.makedirs(os.path.join(cls.images, 'left side'))
        os.makedirs(cls.dark)
        picture = wall(3)
        for name, place in zip(cls.names, PLACES):
            cv2.imwrite(os.path.join(cls.images, name), photograph(picture, pose(*place)))
        cls.truth = {'a': (-.8, .1), 'b': (-.2, .2), 'c': (.3, .1)}
        for name, place in cls.truth.items():
            cv2.imwrite(os.path.join(cls.dark, name + '.png'), photograph(picture, pose(*place), evening))
        write_model(cls.model, cls.names)
        assert run('map', '--model', cls.model, '--images', cls.images, '--out', cls.map, '--points', '400')[0] == 0

    def path(self, name):
        return os.path.join(tempfile.mkdtemp(dir=self.folder), name)

    def grey(self, name):
        return cv2.imread(os.path.join(self.dark, name + '.png'), cv2.IMREAD_GRAYSCALE)

    def check(self, location, name, unit=1.):
        self.assertEqual(location.reason, '')
        found, true = location.cam_from_world.inverse(), pose(*self.truth[name]).inverse()
        self.assertLess(np.linalg.norm(found.translation / unit - true.translation), .05)
        self.assertLess(found.rotation.angle_to(true.rotation), .01)

    def check_error(self, pattern, *arguments):
        status, errors = run(*arguments)
        self.assertEqual(status, 1)
        self.assertRegex(errors.splitlines()[-1], pattern)
        self.assertNotIn('Traceback', errors)

    def test_a_map_is_a_model_of_points_that_its_keypoints_see(self):
        made = read_map(self.map)
        model = pycolmap.Reconstruction(self.map)
        self.assertEqual({image.name for image in model.images.values()}, set(self.names))
        self.assertGreater(model.num_points3D(), 200)
        self.assertTrue(0 < model.compute_mean_reprojection_error() < 1)
        depths = np.array([point.xyz[2] for point in made.model.points3D.values()])
        self.assertLess(np.median(np.abs(depths - 5)), .02)  # on the wall
        for i, codes in made.codes.items():
            self.assertEqual(codes.shape, (made.model.image(i).num_points2D(), 128))
            self.assertEqual(made.model.image(i).num_points3D, len(codes))

    def test_another_light_is_localized_and_written(self):
        out = self.path('out')
        for _ in range(2):  # the second replaces the first
            status, _ = run('localize', '--map', self.map, '--images', self.dark, '--camera', CAMERA, '--out', out,
                            '--pictures')
            self.assertEqual(status, 0)
        self.assertEqual(sorted(os.listdir(os.path.join(out, 'matches'))), ['a.png.png', 'b.png.png', 'c.png.png'])
        lines = open(os.path.join(out, 'trajectory.txt')).read().splitlines()
        self.assertEqual(lines[0], '# name tx ty tz qx qy qz qw')
        for line, (name, place) in zip(lines[1:], self.truth.items()):
            word, *numbers = line.split()
            numbers = np.array([float(number) for number in numbers])
            true = pose(*place).inverse()
            self.assertEqual(word, name)
            self.assertLess(np.linalg.norm(numbers[:3] - true.translation), .05)
            self.assertGreater(abs(numbers[3:] @ true.rotation.quat), .9999)
        rows = list(csv.DictReader(open(os.path.join(out, 'frames.csv'))))
        self.assertEqual([row['found'] for row in rows], ['1'] * 3)
        self.assertGreater(int(rows[0]['inliers']), 15)
        self.assertLess(float(rows[0]['x_x']) ** .5, .05)
        model = pycolmap.Reconstruction(out)
        self.assertEqual((model.num_reg_images(), model.num_cameras()), (3, 1))

    @unittest.skipUnless(os.environ.get('IIB_PROGRAMS'), 'no IIB_PROGRAMS, the folder of iib_localize')
    @unittest.skipUnless(os.path.isdir(STRECHA), 'OPENCV_TEST_DATA_PATH has no strecha/Herz-Jesus-P8')
    def test_photographs_in_cpp_within_five_centimetres_also_relit(self):
        truth = poses(STRECHA, 'poses.txt')
        camera = open(os.path.join(STRECHA, 'cameras.txt')).read().splitlines()[-1].split()
        model, names = pycolmap.Reconstruction(), sorted(os.listdir(os.path.join(STRECHA, 'images')))
        images, sparse, plain, relit, out = (self.path(name) for name in ('images', 'sparse', 'a', 'b', 'out'))
        for folder in (images, sparse, plain, relit):
            os.makedirs(folder)
        model.add_camera_with_trivial_rig(pycolmap.Camera(camera_id=1, model=camera[1], width=int(camera[2]),
                                                          height=int(camera[3]), params=[float(v) for v in camera[4:]]))
        for i, name in enumerate(names, 1):
            picture = cv2.imread(os.path.join(STRECHA, 'images', name))
            if i % 2 == 0:
                cv2.imwrite(os.path.join(plain, name), picture)
                cv2.imwrite(os.path.join(relit, name), dimmed(picture, i))
                continue
            cv2.imwrite(os.path.join(images, name), picture)
            place = truth[os.path.splitext(name)[0]]
            turn = pycolmap.Rotation3d(place[3:])
            model.add_image_with_trivial_frame(pycolmap.Image(name, np.zeros((0, 2)), 1, i),
                                               pycolmap.Rigid3d(turn, place[:3]).inverse())
        model.write(sparse)
        for folder in (plain, relit):
            cpp('--model', sparse, '--photographs', images, '--images', folder, '--out', out)
            found = poses(out)
            self.assertEqual(len(found), len(names) // 2)
            for name, place in found.items():
                self.assertLess(np.linalg.norm(place[:3] - truth[name][:3]), .05, name)
                self.assertGreater(abs(place[3:] @ truth[name][3:]), np.cos(np.radians(.25)), name)

    def test_status_counts_the_images_with_a_pose(self):
        mixed = self.path('mixed')
        shutil.copytree(self.dark, mixed)
        cv2.imwrite(os.path.join(mixed, 'elsewhere.png'), photograph(wall(9), pose(0, 0)))
        out = self.path('out')
        arguments = 'localize', '--map', self.map, '--camera', CAMERA, '--out', out
        self.assertEqual(run(*arguments, '--images', mixed)[0], 4)
        rows = {row['name']: row for row in csv.DictReader(open(os.path.join(out, 'frames.csv')))}
        self.assertRegex(rows['elsewhere.png']['reason'], 'too few matches')
        for name in self.truth:
            os.unlink(os.path.join(mixed, name + '.png'))
        with open(os.path.join(mixed, 'broken.png'), 'wb') as file:
            file.write(b'nothing')
        self.assertEqual(run(*arguments, '--images', mixed)[0], 3)
        for name, culprit in (('broken.jpg', 'broken.jpg and broken.png would have one pose'), ('#1.png', "'#1.png': rename it")):
            open(os.path.join(mixed, name), 'w').close()
            self.check_error(culprit, *arguments, '--images', mixed)
            os.unlink(os.path.join(mixed, name))

    def test_an_image_without_exif_takes_the_maps_only_camera_of_its_size(self):
        out, images = self.path('out'), self.path('images')
        arguments = 'localize', '--map', self.map, '--out', out, '--images'
        self.assertEqual(run(*arguments, self.dark)[0], 0)
        os.makedirs(images)
        cv2.imwrite(os.path.join(images, 'small.png'), self.grey('a')[1:])
        self.assertEqual(run(*arguments, images)[0], 3)
        self.assertRegex(open(os.path.join(out, 'frames.csv')).read(), '0 cameras of the map have its size: give --camera')
        near, far = (pycolmap.Camera(model='PINHOLE', width=WIDTH, height=HEIGHT, params=[f, f, 160, 120]) for f in (305, 400))
        for told, taken in ((near, 300), (far, 400)):
            told.has_prior_focal_length = True
            with mock.patch('pycolmap.infer_camera_from_image', return_value=told):
                self.assertEqual(find_camera('', WIDTH, HEIGHT, read_map(self.map).cameras).focal_length_x, taken)

    def test_text_models_and_any_unit(self):
        model, out, images = self.path('model'), self.path('map'), self.path('images')
        shutil.copytree(self.images, images)
        os.rename(os.path.join(images, 'left side'), os.path.join(images, 'left'))
        for name in os.listdir(os.path.join(images, 'left')):
            os.rename(os.path.join(images, 'left', name), os.path.join(images, 'left', name[0] + '.png'))
        names = [name.replace('left side', 'left').replace(' of 6', '') for name in self.names]  # COLMAP's text has no blanks
        write_model(model, names, unit=1000., text=True)
        made = build_map(model, images, out, 400)
        self.check(Localizer(made).localize(self.grey('a'), parse_camera(CAMERA)), 'a', 1000.)

    def test_rigs_of_distorted_cameras(self):
        model, images, out = pycolmap.Reconstruction(), self.path('images'), self.path('map')
        os.makedirs(images)
        rig = pycolmap.Rig(rig_id=1)  # also the number of a camera
        right = pycolmap.Rigid3d(pycolmap.Rotation3d(), np.array([-.5, 0, 0]))
        for number in (1, 2):
            camera = parse_camera(f'OPENCV,{WIDTH},{HEIGHT},300,300,160,120,0,0,0,0')
            camera.camera_id = number
            model.add_camera(camera)
            rig.add_ref_sensor(camera.sensor_id) if number == 1 else rig.add_sensor(camera.sensor_id, right)
        model.add_rig(rig)
        for number, x in enumerate((-1.5, -.5, .5), 1):
            seen = [pycolmap.Image(f'{number} {k}.png', np.zeros((0, 2)), k, 10 * number + k) for k in (1, 2)]
            frame = pycolmap.Frame(frame_id=number, rig_id=1, rig_from_world=pose(x, 0))
            for image in seen:
                image.frame_id = number
                frame.add_data_id(image.data_id)
            model.add_frame(frame)
            for image in seen:
                model.add_image(image)
                view = photograph(wall(3), model.image(image.image_id).cam_from_world())
                cv2.imwrite(os.path.join(images, image.name), view)
            model.register_frame(number)
        folder = self.path('')
        model.write(folder)
        made = build_map(folder, images, out, 400)
        self.assertEqual(made.model.num_rigs(), 1)
        self.check(Localizer(made).localize(self.grey('b'), parse_camera(CAMERA)), 'b')
        with mock.patch.object(update, 'KNOWN', .9):
            self.assertGreater(update.update_map(out, self.dark, made.model.camera(1))['added'], 0)
        self.check(Localizer(out).localize(self.grey('b'), parse_camera(CAMERA)), 'b')

    def test_pairs_are_those_that_share_points(self):
        model, out = self.path('model'), self.path('map')
        pycolmap.Reconstruction(self.map).write(os.path.dirname(model))
        made = build_map(os.path.dirname(model), self.images, out, 400)
        self.check(Localizer(made).localize(self.grey('b'), parse_camera(CAMERA)), 'b')

    def test_a_prior_gates_and_is_not_needed(self):
        localizer, camera = Localizer(self.map), parse_camera(CAMERA)
        with mock.patch.object(Localizer, '_similar', side_effect=AssertionError):
            self.check(localizer.localize(self.grey('b'), camera, pose(*self.truth['a'])), 'b')
        self.check(localizer.localize(self.grey('b'), camera, pose(40, 0)), 'b')

    def test_threads_share_a_localizer(self):
        localizer, camera = Localizer(self.map), parse_camera(CAMERA)
        with ThreadPoolExecutor(2) as pool:
            found = list(pool.map(lambda name: localizer.localize(self.grey(name), camera), 'abcabc'))
        for name, location in zip('abcabc', found):
            self.check(location, name)
        np.testing.assert_array_equal(found[0].cam_from_world.params, found[3].cam_from_world.params)

    def test_the_covariance_is_that_of_repeated_measurements(self):
        localizer, camera = Localizer(self.map), parse_camera(CAMERA)
        location = localizer.localize(self.grey('b'), camera)
        true, random, scatter = location.cam_from_world, np.random.default_rng(1), []
        exact = camera.img_from_cam(location.points @ true.matrix()[:, :3].T + true.translation)
        far = np.array([30., 10, -20])  # from the world's origin, as coordinates of a country are
        points = location.points + far
        true.translation = true.translation - true.rotation.matrix() @ far
        for _ in range(200):
            noisy = exact + random.normal(0, .2, exact.shape)
            found, covariance = refine_pose(true, camera, noisy, points)
            moved = found.inverse()
            turn = cv2.Rodrigues(moved.rotation.matrix() @ true.rotation.matrix())[0].ravel()
            scatter.append([*(moved.translation - true.inverse().translation), *turn])
        np.testing.assert_allclose(np.std(scatter, axis=0), .2 * np.sqrt(np.diag(covariance)), rtol=.25)

    def test_an_interrupted_run_goes_on(self):
        out = self.path('map')
        arguments = self.model, self.images, out, 400
        with redirect_stderr(io.StringIO()), mock.patch('opencv_iib.localization.build.match_pairs',
                                                        side_effect=KeyboardInterrupt):
            with self.assertRaises(KeyboardInterrupt):
                build_map(*arguments)
        self.assertFalse(os.path.exists(out))
        with redirect_stderr(io.StringIO()), mock.patch.object(pipeline, 'describe_image', side_effect=AssertionError):
            build_map(*arguments)
        self.assertEqual(sorted(os.listdir(out)), sorted(os.listdir(self.map)))
        self.assertFalse(os.path.exists(out + '.partial'))

    def test_wrong_models_get_one_line(self):
        arguments = '--images', self.images, '--out', self.path('map')
        self.check_error('no folder', 'map', '--model', self.path('none'), *arguments)
        self.check_error('no COLMAP model', 'map', '--model', self.images, *arguments)
        model = self.path('model')
        shutil.copytree(self.map, model)
        for name in ('cameras.bin', 'images.bin', 'points3D.bin', 'rigs.bin', 'frames.bin'):
            with self.subTest(name):
                whole = open(os.path.join(model, name), 'rb').read()
                for damaged in (whole[:-5], whole + b'.', b'', b'\xff' * len(whole), np.random.default_rng(1).bytes(500)):
                    with open(os.path.join(model, name), 'wb') as file:
                        file.write(damaged)
                    self.check_error(f'^map: {model}: {name} is damaged$', 'map', '--model', model, *arguments)
                with open(os.path.join(model, name), 'wb') as file:
                    file.write(whole)
        write_model(model + '3', [f'{n}.png' for n in range(6)], text=True)
        for name in ('cameras.txt', 'images.txt', 'rigs.txt', 'frames.txt'):
            with self.subTest(name):
                with open(os.path.join(model + '3', name)) as file:
                    whole = file.read()
                with open(os.path.join(model + '3', name), 'w') as file:
                    file.write('no model\n1 2 three\n')
                self.check_error(f'^map: {model}3: no COLMAP model, or a damaged one', 'map', '--model', model + '3', *arguments)
                with open(os.path.join(model + '3', name), 'w') as file:
                    file.write(whole)
        write_model(model + '1', [*self.names[:-1], 'missing.png'])
        self.check_error('missing.png is missing, one of 1', 'map', '--model', model + '1', *arguments)
        with mock.patch(__name__ + '.PLACES', [(y, x) for x, y in PLACES]):
            write_model(model + '2', self.names)
        self.check_error('fit the poses', 'map', '--model', model + '2', *arguments)

    def test_images_of_another_size_get_one_line(self):
        images = self.path('images')
        shutil.copytree(self.images, images)
        cv2.imwrite(os.path.join(images, '0.png'), np.zeros((HEIGHT // 2, WIDTH // 2), np.uint8))
        self.check_error('0.png has 160 x 120 pixels and its camera in the model 320 x 240', 'map', '--model', self.model,
                         '--images', images, '--out', self.path('map'))

    def test_damaged_maps_get_one_line(self):
        arguments = '--images', self.dark, '--camera', CAMERA, '--out', self.path('out')
        self.check_error('is no map', 'localize', '--map', self.images, *arguments)
        for name in os.listdir(self.map):
            with self.subTest(name):
                damaged = self.path('map')
                shutil.copytree(self.map, damaged)
                with open(os.path.join(damaged, name), 'r+b') as file:
                    file.seek(-9, os.SEEK_END)
                    file.write(b'#')
                self.check_error('or a damaged one', 'localize', '--map', damaged, *arguments)
        older = self.path('map')
        os.makedirs(older)
        with open(os.path.join(older, 'map.json'), 'w') as file:
            json.dump({'format': 1}, file)
        self.check_error('its format is not that of this version: make it again$', 'localize', '--map', older, *arguments)

    def test_wrong_cameras_get_one_line(self):
        for text, pattern in (('FISH,1,2,3', 'no camera model FISH: there are SIMPLE_PINHOLE, '),
                              ('PINHOLE,640,480,500', 'PINHOLE,WIDTH,HEIGHT and then fx, fy, cx, cy are needed'),
                              ('PINHOLE', 'are needed'), ('PINHOLE,640,480,a,b,c,d', 'are needed')):
            self.check_error(pattern, 'localize', '--map', self.map, '--images', self.dark, '--camera', text, '--out',
                             self.path('out'))

    def test_foreign_folders_are_left_alone(self):
        foreign = self.path('mine')
        os.makedirs(foreign)
        open(os.path.join(foreign, 'letter.txt'), 'w').close()
        self.check_error('holds letter.txt', 'map', '--model', self.model, '--images', self.images, '--out', foreign)
        with self.assertRaisesRegex(RuntimeError, 'middle'), new_folder(self.path('new'), ['a']) as partial:
            raise RuntimeError('middle')
        open(os.path.join(partial, 'half'), 'w').close()
        for resume, left in ((True, ['half']), (False, [])):
            with self.assertRaises(KeyboardInterrupt), new_folder(partial[:-len('.partial')], ['a'], resume) as folder:
                self.assertEqual((folder, os.listdir(folder)), (partial, left))
                raise KeyboardInterrupt

    def test_updates_add_a_light_once_and_stay_bounded(self):
        out, camera = self.path('map'), parse_camera(CAMERA)
        with redirect_stderr(io.StringIO()), mock.patch.object(update, 'KNOWN', .9):
            first = update.update_map(self.map, self.dark, camera, out)
            self.assertGreaterEqual(first['added'], 2)
            grown = read_map(out)
            self.check(Localizer(grown).localize(self.grey('a'), camera), 'a')
            old = Localizer(self.map, 400).localize(self.grey('a'), camera).inliers
            self.assertGreater(Localizer(grown, 400).localize(self.grey('a'), camera).inliers, 1.2 * old)
            self.assertEqual(update.update_map(out, self.dark, camera)['added'], 0)
            with mock.patch.object(update, 'LIGHTS', 2), mock.patch.object(update, 'KNOWN', 1.):
                for _ in range(2):
                    self.assertGreater(update.update_map(out, self.dark, camera)['added'], 0)
        again = read_map(out)
        self.assertEqual(again.updates, 4)
        self.assertLessEqual(len(again.codes), len(self.names) + 2 * first['added'])
        self.assertTrue({image.name for image in again.model.images.values()} > set(self.names))
        with redirect_stderr(io.StringIO()), mock.patch.object(update, 'KNOWN', 0.):
            self.assertEqual(update.update_map(out, self.dark, camera)['added'], 0)  # it knows this light

    def test_codes_that_nobody_finds_are_dropped(self):
        out, camera = self.path('map'), parse_camera(CAMERA)
        with redirect_stderr(io.StringIO()), mock.patch.object(update, 'PATIENCE', 2), mock.patch.object(update, 'KNOWN', 0.):
            self.assertEqual(update.update_map(self.map, self.dark, camera, out)['codes dropped'], 0)
            self.assertGreater(update.update_map(out, self.dark, camera)['codes dropped'], 0)
        before, after = read_map(self.map), read_map(out)
        self.assertLess(sum(map(len, after.codes.values())), sum(map(len, before.codes.values())))
        for name in self.truth:
            self.check(Localizer(after).localize(self.grey(name), camera), name)

    def test_compact_keeps_points_and_tracks(self):
        made = read_map(self.map)
        codes = dict(made.codes)
        before = {tuple(p.xyz): p.track.length() for p in made.model.points3D.values()}
        compact(made.model, codes)
        self.assertEqual({tuple(p.xyz): p.track.length() for p in made.model.points3D.values()}, before)
        self.assertTrue(all(np.array_equal(codes[i], made.codes[i]) for i in codes))

    def test_an_image_has_most_votes_of_its_own_codes(self):
        random = np.random.default_rng(5)
        codes = [random.integers(0, 256, (count, 128), np.uint8) for count in (300, 0, 300, 300)]
        votes = Votes(codes)
        for n in (0, 2, 3):
            noisy = codes[n] ^ (random.random(codes[n].shape) < .02).astype(np.uint8)
            self.assertEqual(np.argmax(votes(noisy)), n)
        self.assertEqual(votes(codes[1]).tolist(), [0, 0, 0, 0])


@unittest.skipIf(cv2 is None, 'no cv2')
@unittest.skipIf(pycolmap is not None, 'pycolmap is there')
class WithoutPycolmap(unittest.TestCase):

    def test_the_commands_say_what_to_install(self):
        status, errors = run('map', '--model', 'a', '--images', 'b', '--out', 'c')
        self.assertEqual((status, 'pip install opencv-iib[localization]' in errors), (1, True))


if __name__ == '__main__':
    unittest.main()
