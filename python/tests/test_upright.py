"""Images that are stored rotated, as telephones write them."""
import json
import struct
import unittest
import zlib

import numpy as np

import opencv_iib
from collection import Collection
from opencv_iib import _orientation
from opencv_iib.align import align
from opencv_iib.colmap import FeatureOptions
from opencv_iib._exif import MIRRORED, exif_orientation
from opencv_iib._image_file import ImageFile
from opencv_iib.features import Features
from opencv_iib.measure import match_images
from opencv_iib.localization import Camera
from support import cv2, optional, rows_of, run_command, texture

h5py = optional('h5py')

STORED = {1: 1, 2: 2, 3: 3, 4: 4, 5: 5, 6: 8, 7: 7, 8: 6}  # inverse orientations: from upright to stored images
ROTATIONS = 3, 6, 8
TURNED = [6, 3, 8, 2, 4, 5, 7]


def png(image, orientation):
    data = cv2.imencode('.png', image)[1].tobytes()
    exif = b'eXIf' + struct.pack('<4sIHHHIHHI', b'II*\0', 8, 1, 0x112, 3, 1, orientation, 0, 0)
    return data[:33] + struct.pack('>I', len(exif) - 4) + exif + struct.pack('>I', zlib.crc32(exif)) + data[33:]


def stored(image, orientation):
    return _orientation.upright(image, STORED[orientation])


class Pixels(unittest.TestCase):

    def test_of_files_and_of_upright_images(self):
        image = np.arange(20 * 30, dtype=np.uint16).reshape(20, 30)
        expected = {1: image, 2: np.fliplr(image), 3: np.rot90(image, 2), 4: np.flipud(image), 5: image.T, 6: np.rot90(image, -1),
                    7: np.rot90(image, 2).T, 8: np.rot90(image)}
        for orientation, turned in expected.items():
            np.testing.assert_array_equal(_orientation.upright(image, orientation), turned)
            np.testing.assert_array_equal(_orientation.upright(stored(image, orientation), orientation), image)
            turn = _orientation.Turn(orientation, 30, 20)
            y, x = np.mgrid[:turned.shape[0], :turned.shape[1]].reshape(2, -1)
            at = turn.points(np.column_stack([x, y]).astype(np.float32)).astype(int)
            np.testing.assert_array_equal(image[at[:, 1], at[:, 0]], turned.ravel())
            right, bottom = turned.shape[1] - 1, turned.shape[0] - 1
            corners = turned[[0, 0, bottom, bottom], [0, right, right, 0]]
            np.testing.assert_array_equal(turn.corners(corners), image[[0, 0, 19, 19], [0, 29, 29, 0]])
        for wrong in (0, 9):
            with self.assertRaisesRegex(ValueError, '1 to 8'):
                opencv_iib.detect_and_describe(image.astype(np.uint8), orientation=wrong)

    def test_cameras_of_upright_images(self):
        points = np.random.default_rng(1).uniform([-.5, -.4, .8], [.5, .4, 1.5], (50, 3))
        others = [.02, -.03, .004, -.006, .01, .02, .003, .004, .005, .006, .007, .008]
        for model, focals, more in (('SIMPLE_PINHOLE', 1, 0), ('PINHOLE', 2, 0), ('SIMPLE_RADIAL', 1, 1), ('RADIAL', 1, 2), ('OPENCV', 2, 4),
                                    ('OPENCV_FISHEYE', 2, 4), ('FULL_OPENCV', 2, 8), ('FOV', 2, 1), ('SIMPLE_RADIAL_FISHEYE', 1, 1),
                                    ('RADIAL_FISHEYE', 1, 2), ('THIN_PRISM_FISHEYE', 2, 8), ('RAD_TAN_THIN_PRISM_FISHEYE', 2, 12),
                                    ('SIMPLE_DIVISION', 1, 1), ('DIVISION', 2, 1), ('SIMPLE_FISHEYE', 1, 0), ('FISHEYE', 2, 0), ('EUCM', 2, 2)):
            camera = Camera(model, 640, 480, [300, 310][:focals] + [330, 230] + others[:more])
            for orientation in ROTATIONS:
                turn = _orientation.Turn(orientation, 640, 480)
                upright = camera.upright(orientation)
                np.testing.assert_allclose(upright.upright({3: 3, 6: 8, 8: 6}[orientation]).params, camera.params, atol=1e-12)
                self.assertEqual((upright.width, upright.height), (640, 480) if orientation == 3 else (480, 640))
                stored = np.column_stack([points[:, :2] @ turn.matrix[:2, :2].T, points[:, 2]])
                np.testing.assert_allclose(turn.points(upright.project(points)), camera.project(stored), atol=1e-9)

    def test_points_are_those_of_the_array_and_codes_those_of_the_upright_image(self):
        image = texture(200, 150)
        mask = np.zeros_like(image)
        mask[:, 60:] = 1
        expected = opencv_iib.detect_and_describe(image, 100, mask)
        for orientation in STORED:
            turned = stored(image, orientation)
            found = opencv_iib.detect_and_describe(turned, 100, stored(mask, orientation), orientation)
            np.testing.assert_array_equal(found.codes, expected.codes)
            at, whence = np.rint(found.points).astype(int), np.rint(expected.points).astype(int)
            np.testing.assert_array_equal(turned[at[:, 1], at[:, 0]], image[whence[:, 1], whence[:, 0]])


class Commands(Collection):

    def setUp(self):
        super().setUp()
        world = cv2.resize(texture(160, 120, seed=8), (640, 480), interpolation=cv2.INTER_CUBIC)
        self.a, self.b = world[:300, :400], world[20:320, 30:430]
        self.first = self.write(self.a, 1).rename(self.folder / 'first.png')

    def write(self, image, orientation):
        path = self.folder / f'{orientation}.png'
        path.write_bytes(png(stored(image, orientation), orientation))
        return path

    def test_keypoints(self):
        features = Features(FeatureOptions(points=200))
        rows, codes = features(self.a)
        for orientation in STORED:
            file = ImageFile(self.write(self.a, orientation))
            self.assertEqual((file.orientation, ImageFile(self.folder / f'{orientation}.png', False).orientation), (orientation, 1))
            turned, same = features(file.colour, file.orientation)
            np.testing.assert_array_equal(same, codes)
            np.testing.assert_array_equal(turned[:, 2], rows[:, 2])
        self.assertEqual([Features(FeatureOptions(points=9))(stored(self.a, o), o)[0][0, 3] for o in (1, 3, 6, 8)], [-1, 180, 270, 90])
        for broken in (b'', png(self.a, 9), png(self.a, 1)[:60]):
            self.assertEqual(exif_orientation(broken), 1)

    def test_match(self):
        expected = match_images(self.first, self.write(self.b, 1), options=FeatureOptions(points=300))
        for orientation in TURNED:
            path = self.write(self.b, orientation)
            found = match_images(self.first, path, options=FeatureOptions(points=300))
            at = _orientation.Turn(orientation, *stored(self.b, orientation).shape[1::-1]).points(expected.matches.points2)
            np.testing.assert_allclose(found.matches.points2, at, atol=1e-3)
            np.testing.assert_array_equal(found.matches.points1, expected.matches.points1)
            swapped = expected.matches.covariances[:, [2, 1, 0] if orientation > 4 else [0, 1, 2]]
            np.testing.assert_allclose(np.abs(found.matches.covariances), np.abs(swapped), rtol=1e-5)
            arguments = 'match', self.first, path, '--points', '300', '--out', self.folder / 'm.csv'
            right, wrong = (run_command(*arguments, *more)[1] for more in ((), ('--no-exif',)))
            self.assertNotIn('turned', right)
            if orientation in ROTATIONS:  # the images themselves show these
                self.assertRegex(wrong, rf'is rotated by {dict(zip(ROTATIONS, (180, 270, 90)))[orientation]} degrees')
                self.assertGreater(int(wrong.split()[1]), .7 * int(right.split()[1]))
            else:
                self.assertRegex(wrong, 'may not show the same')  # mirrored blobs fit an epipolar geometry too: not so in every picture

    def test_a_pose_of_mirrored_images_is_refused(self):
        for orientation in MIRRORED:
            path = self.write(self.b, orientation)
            height, width = stored(self.b, orientation).shape
            cameras = ['SIMPLE_PINHOLE,400,300,500,200,150', f'SIMPLE_PINHOLE,{width},{height},500,{width / 2},{height / 2}']
            for exif in (True, False):
                with self.assertRaisesRegex(ValueError, rf'{orientation}.png: .* stored mirrored \(orientation {orientation}\)'):
                    match_images(self.first, path, cameras=cameras, options=FeatureOptions(points=300, exif=exif))

    def test_a_pose_of_turned_images_without_exif(self):
        a, b = self.folder / 'a.png', self.folder / 'b.png'
        cv2.imwrite(str(a), self.a)
        cv2.imwrite(str(b), stored(self.b, 6))
        turned = match_images(a, b, cameras=['SIMPLE_PINHOLE,400,300,500,200,150', 'SIMPLE_PINHOLE,300,400,500,150,200'],
                              options=FeatureOptions(points=300))
        self.assertAlmostEqual(turned.rotation % 360, 270, delta=10)
        self.assertGreater(turned.agree.sum(), 100)
        turned.save(self.folder / 'm.json')
        turned.save(self.folder / 'm.npz')
        (self.folder / 'pairs.txt').write_text('a.png b.png\n')
        outs = [self.folder / 'out', *([self.folder / 'x.h5'] if h5py else [])]
        for out in outs:
            self.assertEqual(run_command('match', '--pairs', self.folder / 'pairs.txt', '--images', self.folder, '--out', out, '--points', 300)[0], 0)
        reported = [json.loads((self.folder / 'm.json').read_text())['rotation'], float(np.load(self.folder / 'm.npz')['rotation'])]
        reported.append(float(rows_of(outs[0], 'pairs.csv')[0]['rotation']))
        if h5py:
            with h5py.File(outs[1]) as file:
                reported.append(float(file['a.png/b.png'].attrs['rotation']))
        np.testing.assert_allclose(reported, turned.rotation, rtol=1e-9)
        noise = np.random.default_rng(1).integers(0, 256, self.a.shape, np.uint8)
        cv2.imwrite(str(b), noise)
        self.assertEqual(match_images(a, b).rotation, 0)

    def test_align(self):
        done = align(self.first, [self.write(self.b, orientation) for orientation in TURNED], self.folder / 'out', 1)
        for orientation, each in zip(TURNED, done):
            turn = _orientation.Turn(orientation, *stored(self.b, orientation).shape[1::-1])
            back = np.reshape(each.transform, (3, 3)) @ turn.matrix  # of the upright image
            np.testing.assert_allclose(back, [[1, 0, 30], [0, 1, 20], [0, 0, 1]], atol=.1)
            self.assertAlmostEqual((each.rotation + 180) % 360, 180, delta=.1)
            self.assertNotIn('turned', str(each))
            picture = cv2.imread(str(self.folder / 'out' / each.file), cv2.IMREAD_GRAYSCALE)
            self.assertLess(np.abs(picture[25:295, 35:395].astype(int) - self.a[25:295, 35:395]).mean(), 1)
        done = align(self.write(self.b, 6), [self.first], self.folder / 'other', 1)
        self.assertEqual(cv2.imread(str(self.folder / 'other' / done[0].file)).shape, (400, 300, 3))
        np.testing.assert_allclose(np.reshape(done[0].transform, (3, 3)) @ [130, 70, 1],
                                   _orientation.Turn(6, 300, 400).matrix @ [100, 50, 1], atol=.2)

    def test_align_says_what_it_turned(self):
        picture = cv2.resize(cv2.GaussianBlur(np.random.default_rng(2).integers(0, 256, (120, 160), np.uint8), (0, 0), 1), (640, 480))
        first = self.folder / 'a.png'
        cv2.imwrite(str(first), picture)
        images = [self.write(picture[20:320, 30:430], orientation) for orientation in ROTATIONS]
        for _ in range(2):  # also for results of an earlier call
            done = align(first, images, self.folder / 'turned', exif=False)
            self.assertEqual([str(each).split(', ')[-1] for each in done], [f'rotated by {angle} degrees' for angle in (180, 270, 90)])
        self.assertNotIn('turned', ''.join(map(str, align(first, images, self.folder / 'turned'))))

    def test_colmap(self):
        for name, orientation in (('b.png', 6), ('more/c.png', 3)):
            image = cv2.imread(str(self.images / name))
            (self.images / name).write_bytes(png(stored(image, orientation), orientation))
        for orientation in MIRRORED:
            (self.images / f'{orientation}.png').write_bytes(png(stored(image, orientation), orientation))
        counts = self.build()
        self.assertEqual((counts['verified pairs'], counts['failed']), (3, 4))
        self.assertEqual([line.split(' (')[0] for line in self.lines], [f'{orientation}.png: its EXIF data say that it is stored mirrored' for orientation in MIRRORED])
        size = dict(self.query('SELECT name, width FROM images NATURAL JOIN cameras'))
        self.assertEqual(size, {'a.png': 400, 'b.png': 300, 'more/c.png': 400})
