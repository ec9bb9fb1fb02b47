"""Options of the command localize: an IMU, large images, names from a pipe."""
import csv
import io
import os
import shutil
import subprocess
import sys
import unittest
from unittest import mock

import numpy as np

from opencv_iib.localization import Localizer
from opencv_iib.localization.imu import parse_pose, read_imu, time_of
from support import InFolder, cv2, run_command
from wall import CAMERA, SIZE, WIDTH, HEIGHT, evening, mapped, photograph, pose, trajectory, wall

PLACE = (.3, .1)


@unittest.skipIf(cv2 is None, 'no cv2')
class Options(InFolder):

    def setUp(self):
        super().setUp()
        self.images, self.out, self.map = self.folder / 'images', self.folder / 'out', os.path.join(mapped(), 'map')
        self.command = 'localize', '--map', self.map, '--images', self.images, '--out', self.out
        self.images.mkdir()
        self.picture = photograph(wall(3), pose(*PLACE), evening)

    def image(self, name, picture=None):
        cv2.imwrite(str(self.images / name), self.picture if picture is None else picture)
        return str(self.images / name)

    def localize(self, *more):
        return run_command(*self.command, *more)

    def check(self, numbers):
        """Centre and quaternion x y z w."""
        truth = pose(*PLACE)
        self.assertLess(np.linalg.norm(numbers[:3] - np.array([*PLACE, 0])), .05)
        turn = parse_pose(','.join(['0'] * 3 + [str(v) for v in numbers[3:]]))[:3, :3]
        self.assertLess(np.linalg.norm(turn.T - truth[:3, :3]), .02)


class Imu(Options):

    def write(self, text):
        (self.folder / 'imu.csv').write_text(text)
        return self.folder / 'imu.csv'

    def test_poses_of_images_that_tell_nothing(self):
        for n in range(6):  # 8.5 to 13.5 seconds; as texts they sort differently. The camera stands still
            self.image(f'{8 + n}.500000.png', np.full((HEIGHT, WIDTH), 7, np.uint8) if n == 1 else None)
        felt = pose(*PLACE)[:3, :3] @ np.array([0, -9.81, 0])
        imu = self.write(''.join(f'{time},0,0,0,{felt[0]:.9f},{felt[1]:.9f},{felt[2]:.9f}\n'
                                 for time in range(8000000000, 14000000001, 5000000)))
        self.assertEqual(self.localize()[0], 4)
        status, out, _ = self.localize('--imu', imu)
        self.assertEqual((status, '6 of 6 images have a pose' in out), (0, True))
        found = trajectory(self.out)
        self.assertEqual(list(found), [f'{8 + n}.500000' for n in range(6)])
        self.check(found['9.500000'])
        rows = self.rows('out/frames.csv')
        self.assertEqual([(row['name'], row['found'], bool(row['x_x']), bool(row['tx'])) for row in rows][:2],
                         [('8.500000.png', '1', True, True), ('9.500000.png', '0', False, True)])
        contradicting = self.write(''.join(f'{time},0,0,0,0,{30 * felt[1]:.9f},0\n' for time in range(8000000000, 14000000001, 5000000)))
        status, out, errors = self.localize('--imu', contradicting)
        self.assertEqual((status, '5 of 6 images have a pose' in out), (4, True))
        self.assertRegex(errors, 'the readings of the IMU contradict the images, whose poses stay as they are')
        self.image('08.5.png')
        self.check_mistake('08.5.png and 8.500000.png have one time', *self.command, '--imu', imu)
        shutil.rmtree(self.images)
        self.images.mkdir()
        self.image('1500000000000000.png')  # microseconds
        self.check_mistake("are not those of the IMU's readings", *self.command, '--imu', imu)
        self.image('left.png')
        self.check_mistake('left.png: with --imu the images must be named by their times', *self.command, '--imu', imu)

    def test_readings(self):
        path = self.write('#timestamp [ns],w_x\n0,0.1,-0.2,0.3,1,2,9.81\r\n5000000,0,0,0,1e-3,0,0\n')
        np.testing.assert_array_equal(read_imu(str(path)), [[0, .1, -.2, .3, 1, 2, 9.81], [5000000, 0, 0, 0, 1e-3, 0, 0]])
        wrong = [('# of an IMU\n' + line + '\n', ':2: not a time and six numbers') for line in
                 ('5,0,0,,0,0,0', '5,0,0,0,0,0', '5,0,0,0,0,0,0,0', 'x,0,0,0,0,0,0', '5,0,0,nan,0,0,0')]
        wrong += [(f'{time},0,0,0,0,0,0\n', ':1: the time is not in nanoseconds') for time in ('9.3e18', '-9.3e18', '1e300')]
        wrong += [('5,0,0,0,0,0,0\n5,0,0,0,0,0,0\n', ':2: the time does not rise'), ('# a head\n', ' has no readings'), ('', ' has no readings')]
        for text, message in wrong:
            with self.assertRaisesRegex(ValueError, 'imu.csv' + message):
                read_imu(str(self.write(text)))
        for path in (self.folder / 'none.csv', self.folder):
            self.image('1.5.png')
            self.check_mistake('there is no file .*' + path.name, *self.command, '--imu', path)
        self.assertFalse(self.out.exists())

    def test_names_that_are_times(self):
        for name, time in (('01.500000', 1500000000), ('1403636579763555584', 1403636579763555584), ('0003', 3000000000),
                           ('1403636579.763555584', 1403636579763555584), ('1403636579.7635555849', 1403636579763555584)):
            self.assertEqual(time_of(name), time)
        # differences would overflow; milliseconds
        for name in ('left_0003', '9999999999999999999', '9223372036854775807', '1403636579763', '99999999999', '', '.5', '-1', '1e3'):
            self.assertIsNone(time_of(name))

    def test_where_the_camera_is(self):
        np.testing.assert_allclose(parse_pose('1,2,3,0,0,.70710678,.70710678'), [[0, -1, 0, 1], [1, 0, 0, 2], [0, 0, 1, 3], [0, 0, 0, 1]], atol=1e-7)
        self.image('1.5.png')
        for wrong in ('1e300,0,0,0,0,0,1', '0,0,0,1,1,1,1', '0,0,0,0,0,0', 'x,0,0,0,0,0,1', ''):
            self.check_mistake('is not tx,ty,tz,qx,qy,qz,qw with a quaternion of length 1 and metres', *self.command, '--imu-from-camera=' + wrong)


class LargeImages(Options):

    def test_they_are_reduced(self):
        self.image('a.png')
        found, red = {}, {}
        for size in (0, 320, 250):
            self.assertEqual(self.localize('--pictures', '--max-size', size)[0], 0)
            found[size] = trajectory(self.out)['a']
            self.check(found[size])
            picture = cv2.imread(str(self.out / 'matches/a.png')).astype(int)
            self.assertEqual(picture.shape[1::-1], SIZE)
            red[size] = (picture[..., 2] - picture[..., :2].max(axis=2)).clip(0).sum()  # from the seen pixels to the projected points
        np.testing.assert_array_equal(found[0], found[320])
        self.assertFalse(np.array_equal(found[0], found[250]))
        self.assertLess(red[250], 3 * red[0])
        self.check_mistake('at least 32 pixels, or 0', *self.command, '--max-size', 31)


class Table(Options):

    def test_one_csv_has_verdicts_covariances_and_poses(self):
        self.image('a.png')
        self.image('b.png', np.zeros((HEIGHT, WIDTH), np.uint8))
        self.assertEqual(self.localize('--camera', CAMERA)[0], 4)
        expected = (self.out / 'frames.csv').read_bytes().decode()
        for out in ('-', self.folder / 'x.csv'):
            status, text, errors = run_command(*self.command[:-1], out, '--camera', CAMERA)
            written = text if out == '-' else out.read_bytes().decode()
            self.assertEqual((status, written), (4, expected))
            self.assertIn('1 of 2 images have a pose', errors if out == '-' else text)
        found, missing = csv.DictReader(io.StringIO(expected))
        self.check(np.array([found[name] for name in ('tx', 'ty', 'tz', 'qx', 'qy', 'qz', 'qw')], float))
        self.assertTrue(float(found['x_x']) > 0 and missing['reason'] and not missing['tx'])
        self.assertEqual(sorted(os.listdir(self.folder)), ['images', 'out', 'x.csv'])
        self.check_mistake('is no folder', *self.command[:-1], 'x.csv', '--pictures')


class Mistakes(Options):

    def test_masks_among_results_are_not_replaced(self):
        self.image('a.png')
        self.assertEqual(self.localize('--pictures')[0], 0)
        masks = self.out / 'matches'
        os.rename(masks / 'a.png', masks / 'a.png.png')
        self.check_mistake('is in .*, whose files', *self.command, '--mask', masks)

    def test_a_camera_or_mask_of_another_size_leaves_good_results(self):
        self.image('a.png')
        (self.images / 'broken.png').write_bytes(b'no image')
        self.localize()
        before = (self.out / 'frames.csv').read_bytes()
        with mock.patch.object(Localizer, 'localize', side_effect=AssertionError):
            self.check_mistake('a.png.*: its camera has 640 x 480 pixels, and the image 320 x 240', *self.command, '--camera', 'PINHOLE,640,480,500,500,320,240')
            cv2.imwrite(str(self.folder / 'mask.png'), np.ones((9, 9), np.uint8))
            self.check_mistake('a.png.*: its mask .* has 9 x 9 pixels, and the image 320 x 240', *self.command, '--mask', self.folder / 'mask.png')
            status, _, errors = run_command('update', '--map', self.map, '--images', self.images, '--mask', self.folder / 'mask.png', '--out', self.folder / 'new')
            self.assertEqual((status, errors.count('\n'), (self.folder / 'new').exists()), (2, 1, False))
        self.assertEqual((self.out / 'frames.csv').read_bytes(), before)


class Stream(Options):

    def stream(self, text, *more):
        with mock.patch('sys.stdin', io.StringIO(text)):
            return run_command('localize', '--map', self.map, '--images', '-', *more)

    def test_a_path_and_a_pose_a_line(self):
        a, b, none = self.image('a b.png'), self.image('1 of 2, "left".png'), str(self.folder / 'none.png')
        (self.images / 'cut.png').write_bytes(b'nothing')
        status, out, errors = self.stream('\n'.join((a, none, b, b, '#a.png', '', str(self.images / 'cut.png'))), '--camera', CAMERA)
        self.assertEqual((status, errors), (4, ''))
        lines = out.splitlines()
        self.assertEqual(len(lines), 7)
        for n, path in ((0, a), (2, b), (3, b)):
            name, *numbers = lines[n].rsplit(' ', 7)
            self.assertEqual(name, path)
            self.check(np.array(numbers, float))
        self.assertEqual(lines[1], f'# {none}: there is no such file')
        self.assertEqual(lines[4], '# #a.png: a path must not begin with #: write ./ before it')
        self.assertRegex(lines[6], r'# .*cut.png: not an image')
        other = os.fsdecode(os.fsencode(self.images) + b'/caf\xe9.png')
        shutil.copy(a, other)
        status, out, _ = self.stream(other + '\n', '--camera', CAMERA)
        self.assertEqual((status, out.rsplit(' ', 7)[0]), (0, other))
        self.assertEqual(self.stream(a + '\r\n', '--camera', CAMERA, '--max-size', 250)[0], 0)
        nothing = self.folder / 'masks'
        nothing.mkdir()
        cv2.imwrite(str(nothing / (os.path.basename(a) + '.png')), np.zeros((HEIGHT, WIDTH), np.uint8))
        self.assertEqual(self.stream(a, '--camera', CAMERA, '--mask', nothing)[0], 3)
        self.assertEqual(self.stream(none)[0], 3)
        self.assertEqual(self.stream('')[0], 0)

    def test_names_are_bytes_whatever_the_encoding_of_the_pipes(self):
        name = os.path.join(os.fsencode(self.images), 'žluť.png'.encode())
        shutil.copy(self.image('a.png'), name)
        found = subprocess.run([sys.executable, '-m', 'opencv_iib', 'localize', '--map', self.map, '--images', '-', '--camera', CAMERA],
                               input=name + b'\n', capture_output=True, env={**os.environ, 'PYTHONIOENCODING': 'cp1252'})
        self.assertEqual((found.returncode, found.stdout.rsplit(b' ', 7)[0]), (0, name))

    def test_each_image_is_looked_for_where_the_last_one_was(self):
        priors, real = [], Localizer.localize
        paths = [self.image(name, np.zeros((HEIGHT, WIDTH), np.uint8) if name == '10.png' else None) for name in ('9.png', '10.png', '11.png', 'x.png')]

        def localize(localizer, image, camera, prior, *more):
            priors.append((int(image.any()), prior is not None))
            return real(localizer, image, camera, prior, *more)
        with mock.patch.object(Localizer, 'localize', localize):
            for run in (lambda: self.localize('--camera', CAMERA, '--sequence'), lambda: self.stream('\n'.join(paths), '--camera', CAMERA)):
                self.assertEqual(run()[0], 4)
                self.assertEqual(priors, [(1, False), (0, True), (1, False), (1, True)])
                priors.clear()
            self.check(trajectory(self.out)['x'])
            self.localize('--camera', CAMERA)
        self.assertFalse(any(prior for _, prior in priors))

    def test_mistakes(self):
        for option in (['--out', self.out], ['--pictures'], ['--imu', 'x.csv'], ['--imu-from-camera', '0,0,0,0,0,0,1'], ['--sequence']):
            status, _, errors = self.stream('', *option)
            self.assertEqual((status, errors), (2, f'localize: --images - goes without {option[0]}\n'))
        status, _, errors = run_command('localize', '--map', self.map, '--images', self.images)
        self.assertEqual((status, errors), (2, 'localize: --out is needed, but for --images -\n'))

    def test_a_full_disk_ends_it(self):
        with mock.patch('builtins.print', side_effect=OSError(28, 'No space left on device')):
            self.assertEqual(self.stream('none.png')[0], 1)
