import io
import os
import shutil
import threading
import unittest
from contextlib import redirect_stderr
from pathlib import Path
from unittest import mock

import numpy as np

import opencv_iib
from opencv_iib import _core, _orientation
from opencv_iib.localization import Camera, Localizer, build
from opencv_iib.localization import maps, run as runs
from support import cv2, files_end_at, run_command, seconds_until_interrupt
from wall import CAMERA, HEIGHT, OnWall, WIDTH, photograph, pose, rigid, trajectory, wall, write_model

STRECHA = os.path.join(os.environ.get('OPENCV_TEST_DATA_PATH', ''), 'strecha', 'Herz-Jesus-P8')


def dimmed(picture, seed):
    """Gamma 2.2, a ramp to a quarter across the image, half the light, and noise."""
    light = (picture / 255) ** 2.2 * np.linspace(.5, .125, picture.shape[1])[:, None] * 255
    return np.clip(light + np.random.default_rng(seed).normal(0, 2, picture.shape), 0, 255).astype(np.uint8)


class Maps(OnWall):

    def test_maps_of_photographs_that_are_stored_turned(self):
        from test_upright import png, stored
        model, images, out = self.path('model'), self.path('images'), self.path('map')
        posed, turns = [], dict(zip(self.poses, (1, 6, 8, 3, 6, 1)))
        for name, orientation in turns.items():
            image = stored(cv2.imread(os.path.join(self.images, name), cv2.IMREAD_GRAYSCALE), orientation)
            os.makedirs(os.path.dirname(os.path.join(images, name)), exist_ok=True)
            Path(images, name).write_bytes(png(image, orientation))
            turned = np.eye(4)
            turned[:2, :2] = _orientation.Turn(orientation, *image.shape[::-1]).matrix[:2, :2]
            camera = Camera.parse(CAMERA).upright({6: 8, 8: 6}.get(orientation, orientation))
            posed.append(_core.PosedImage(name, camera, turned @ self.poses[name], np.empty((0, 2))))
        Path(images, 'mirrored.png').write_bytes(png(image, 2))
        posed.append(_core.PosedImage('mirrored.png', Camera.parse(CAMERA), np.eye(4), np.empty((0, 2))))
        os.makedirs(model)
        _core.writeModel(model, posed)
        for more in ((), ('--no-exif',)):
            self.assertRegex(run_command('map', '--model', model, '--images', images, '--out', self.path('m'), '--points', '400', *more)[2],
                             r'(?m)^mirrored.png: .* stored mirrored \(orientation 2\).*: left out of the map$')
        status, _, _ = run_command('map', '--model', model, '--images', images, '--out', out, '--points', '400')
        self.assertEqual(status, 4)
        self.check(Localizer(out).localize(self.grey(), CAMERA))
        os.unlink(os.path.join(images, 'mirrored.png'))
        Path(images, 'query.png').write_bytes(png(stored(self.grey(), 6), 6))
        for name in turns:
            os.unlink(os.path.join(images, name))
        self.assertEqual(self.localize(self.path('out'), map=out, images=images)[0], 0)  # of the map's camera, rotated

    def test_masks(self):
        masks, out, found = self.path('masks'), self.path('map'), self.path('out')
        mask = np.full((HEIGHT, WIDTH), 255, np.uint8)
        mask[:, :WIDTH // 2] = 0
        for name in [*self.poses, 'c.png']:
            os.makedirs(os.path.dirname(os.path.join(masks, name)), exist_ok=True)
            cv2.imwrite(os.path.join(masks, name + '.png'), mask)
        status, text, _ = run_command('map', '--model', self.model, '--images', self.images, '--out', out, '--points', '400', '--mask', masks)
        self.assertEqual(status, 0)
        self.check(Localizer(out).localize(self.grey(), CAMERA))
        with self.assertRaisesRegex(opencv_iib.error, "a mask must be CV_8UC1"):
            Localizer(self.map).localize(self.grey(), CAMERA, mask=mask[1:])
        status, _ = self.localize(found, '--camera', CAMERA, '--mask', masks, '--max-size', '300')
        self.assertEqual(status, 0)
        self.assertEqual(run_command('update', '--map', self.map, '--images', self.dark, '--camera', CAMERA, '--mask', masks, '--max-size', '300',
                                     '--out', self.path('new'))[0], 0)

    def test_images_that_are_not_those_of_the_model_are_left_out(self):
        images, model, masks, out = (self.path(name) for name in ('images', 'model', 'masks', 'map'))
        shutil.copytree(self.images, images)
        os.makedirs(masks)
        write_model(model, {**self.poses, **dict.fromkeys(('gone.png', 'small.png', 'damaged.png', 'a folder.png', 'locked.png', 'masked.png'), np.eye(4))})
        for name in ('small.png', 'masked.png', 'locked.png'):
            shutil.copy(os.path.join(images, '0.png'), os.path.join(images, name))
        cv2.imwrite(os.path.join(images, 'small.png'), np.zeros((240, 200), np.uint8))
        cv2.imwrite(os.path.join(masks, 'masked.png.png'), np.ones((24, 20), np.uint8))
        Path(images, 'damaged.png').write_bytes(b'\x89PNG')
        os.makedirs(os.path.join(images, 'a folder.png'))

        def opened(path, *arguments, real=open, **more):
            if os.path.basename(path) == 'locked.png':
                raise PermissionError(13, 'Permission denied', path)
            return real(path, *arguments, **more)
        with mock.patch('opencv_iib._files.open', opened, create=True):
            status, message, lines = run_command('map', '--model', model, '--images', images, '--out', out, '--points', '300', '--mask', masks)
        self.assertEqual(status, 4, lines)
        self.assertRegex(message, r'6 images, \d+ points, 6 left out')
        for line in ('gone.png: there is no such file', 'small.png: the image has 200 x 240 pixels and its camera 320 x 240',
                     'damaged.png: the image is damaged or cut off', 'a folder.png: not a file', 'locked.png: Permission denied',
                     r'masked.png: its mask .* has 20 x 24 pixels, and the image 320 x 240'):
            self.assertRegex(lines, f'(?m)^{line}: left out of the map$')
        self.check(Localizer(out).localize(self.grey(), CAMERA))

    def test_larger_images_are_reduced_and_keep_their_cameras(self):
        out = self.path('map')
        arguments = 'map', '--model', self.model, '--images', self.images, '--out', out, '--points', '400', '--max-size'
        self.assertEqual(run_command(*arguments, WIDTH // 2)[0], 0)
        localizer = Localizer(out)
        self.assertEqual([(camera.width, camera.height) for camera in localizer.cameras], [(WIDTH, HEIGHT)])
        self.check(localizer.localize(self.grey(), CAMERA))
        self.assertLess(*(sum(os.path.getsize(os.path.join(folder, name)) for name in os.listdir(folder)) for folder in (out, self.map)))
        self.assertEqual(run_command(*arguments, '31')[0], 2)

    def test_maps_of_the_papers_points(self):
        made = self.path('paper')
        status, _, errors = run_command('map', '--model', self.model, '--images', self.images, '--out', made, '--orb-and-akaze')
        self.assertEqual(status, 0, errors)
        self.check(Localizer(made).localize(photograph(wall(3), pose(*self.truth['c'])), CAMERA))
        self.assertRegex(Localizer(made).localize(self.grey(), CAMERA).reason, 'too few')  # recommended points would be found

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
        read, seen = maps.ImageFile, []

        def slowly(*file):
            seen.append(file)
            threading.Event().wait(.2)
            return read(*file)
        with mock.patch.object(maps, 'ImageFile', slowly), redirect_stderr(io.StringIO()):
            seconds_until_interrupt(lambda: build(model, folder, out, workers=1), .5)
        self.assertLess(len(seen), count // 2)
        self.assertEqual(self.localize(self.path('out'), map=out)[0], 2)  # there is no map

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
        self.assertIn('SIMPLE_RADIAL,320,240,301,160,120,', errors)
        message = []
        list(runs.localize_stream(made, [os.path.join(self.dark, name) for name in os.listdir(self.dark)], log=message.append))
        self.assertRegex('|'.join(message), r'^[^|]*the middle one of 6 cameras of the map, which agree$')
        self.assertIn('which agree', run_command('update', '--map', made, '--images', self.dark, '--out', self.path('new'))[2])
        build_with((297, 298, 300, 301, 302, 330))
        status, errors = self.localize(out, map=made)
        self.assertEqual((status, errors.count('6 cameras of the map have its size, which differ: give --camera PINHOLE,320,240,F,F,160,120')),
                         (3, 3))

    def test_a_map_is_not_replaced_by_one_that_leaves_images_out(self):
        out, images, empty = self.path('map'), self.path('images'), self.path('empty')
        shutil.copytree(self.map, out)
        shutil.copytree(self.images, images)
        os.unlink(os.path.join(images, '0.png'))
        before = Path(out, 'map.iib').read_bytes()
        arguments = 'map', '--model', self.model, '--images', images, '--points', '300', '--out'
        self.check_error('0.png: there is no such file: left out of the map, so that of .*map is not replaced', *arguments, out, '--force')
        self.assertEqual(Path(out, 'map.iib').read_bytes(), before)
        self.assertEqual(run_command(*arguments, self.path('new'))[0], 4)
        os.makedirs(empty)
        for more in ((), ('--force',)):
            self.check_mistake("cannot use any of the model's 6 images in .*empty; the first: 0.png: there is no such file", 'map', '--model', self.model,
                               '--images', empty, '--out', self.path('none'), *more)
        self.assertFalse(os.path.exists(self.path('none')))

    def test_a_map_is_replaced_by_force_alone(self):
        other = self.path('other')
        shutil.copytree(self.map, other)
        Path(other, '.DS_Store').touch()  # of a desktop, not the user's
        for command in (('map', '--model', self.model, '--images', self.images, '--points', '300'), ('update', '--map', self.map, '--images', self.dark)):
            before = Path(other, 'map.iib').read_bytes()
            self.check_error('--force', *command, '--out', other)
            self.assertEqual(Path(other, 'map.iib').read_bytes(), before)
            self.assertEqual(run_command(*command, '--out', other, '--force')[0], 0)
            self.assertNotEqual(Path(other, 'map.iib').read_bytes(), before)

    @unittest.skipUnless(hasattr(os, 'getuid') and os.getuid(), 'root may write everywhere')
    def test_a_folder_without_rights_is_refused_before_work(self):
        closed = self.path('map')
        shutil.copytree(self.map, closed)
        os.chmod(closed, 0o500)
        with mock.patch.object(runs, 'ImageFile', side_effect=AssertionError):
            self.check_error('check the folder and its rights', 'update', '--map', closed, '--images', self.dark)

    def test_results_are_no_images_and_links_are_followed(self):
        images = self.path('images')
        shutil.copytree(self.dark, images)
        os.symlink(os.path.join(images, 'out'), images + '-out')  # dangling
        for _ in range(2):
            self.assertEqual(self.localize(images + '-out', '--pictures', images=images)[0], 0)
            self.assertEqual(len(trajectory(os.path.join(images, 'out'))), 3)

    def test_a_full_disk_leaves_the_old_results(self):
        out = self.path('out')
        self.assertEqual(self.localize(out, '--pictures')[0], 0)
        largest = max(os.path.getsize(os.path.join(out, name)) for name in os.listdir(out))
        before = trajectory(out), sorted(os.listdir(out))
        for size in (0, 50, 200, 600, largest - 1):
            with files_end_at(size):
                status, _ = self.localize(out)
            self.assertEqual((status, before[1]), (1, sorted(os.listdir(out))))
        self.assertEqual(trajectory(out).keys(), before[0].keys())

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
        status, text, _ = run_command(*arguments, '--force')
        self.assertEqual((status, '3 images, 1 localized' in text), (4, True))

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
