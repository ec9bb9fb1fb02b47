"""The commands match and align."""
import csv
import itertools
import json
import os
import re
import shutil
import unittest
import zlib
from pathlib import Path
from unittest import mock

import numpy as np

import opencv_iib
from opencv_iib.align import align
from opencv_iib._files import RECORD, write_whole
from opencv_iib._images import decode_all, decode_first, write_picture
from opencv_iib.features import FeatureOptions
from opencv_iib.localization import Camera
from opencv_iib.measure import match_images
from opencv_iib.geometry import ImageAligner
from opencv_iib.refinement import prepared, propagateMatches
from support import REPOSITORY, InFolder, cv2, optional, run_command, texture

NEEDS_TIFFFILE = unittest.skipIf(optional('tifffile') is None, 'no tifffile')
SCENES = REPOSITORY / 'tools/synthetic'


@unittest.skipIf(cv2 is None, 'no cv2')
class Commands(InFolder):

    def write(self, name, image):
        cv2.imwrite(str(self.folder / name), image)
        return str(self.folder / name)

    def rows(self, name):
        with open(self.folder / name, newline='') as file:
            return list(csv.DictReader(file))


class Match(Commands):

    def world(self, depth, camera_x=0., yaw=0., focal=400., distortion=0.):
        """Two textured walls, and a lens."""
        big = cv2.resize(texture(200, 200, seed=5), (1600, 1600), interpolation=cv2.INTER_CUBIC)
        height, width = 360, 480
        y, x = np.mgrid[:height, :width].astype(float)
        rays = np.stack([(x - (width - 1) / 2) / focal, (y - (height - 1) / 2) / focal], 2)
        ideal = rays.copy()
        for _ in range(20):
            ideal = rays / (1 + distortion * (ideal ** 2).sum(2, keepdims=True))
        angle = np.radians(yaw)
        turn = np.array([[np.cos(angle), 0, np.sin(angle)], [0, 1, 0], [-np.sin(angle), 0, np.cos(angle)]])
        ray = np.concatenate([ideal, np.ones((height, width, 1))], 2) @ turn.T
        seen = np.zeros((height, width), np.uint8)
        for z, half in ((depth[1], ray[..., 0] > -9), (depth[0], ray[..., 0] / ray[..., 2] * depth[0] + camera_x < 0)):
            hit = ray / ray[..., 2:] * z
            u, v = ((hit[..., k] + (camera_x if k == 0 else 0)) * 130 + 800 for k in range(2))
            wall = cv2.remap(big, u.astype(np.float32), v.astype(np.float32), cv2.INTER_LINEAR)
            seen = np.where(half, wall, seen)
        return seen

    def test_matches_and_pose(self):
        lens = .08
        a = self.write('a.png', self.world((4, 8), distortion=lens))
        b = self.write('b.png', self.world((4, 8), .5, 3, distortion=lens) // 2 + 20)
        camera = f'SIMPLE_RADIAL,480,360,400,240,180,{lens}'
        status, out, err = run_command('match', a, b, '--out', self.folder / 'm.csv', '--picture', self.folder / 'm.png',
                                            '--camera', camera)
        self.assertEqual((status, err), (0, ''))
        rows = self.rows('m.csv')
        count, refined, agree = map(int, re.search(r'(\d+) matches, (\d+) refined.*\npose: (\d+) agree', out).groups())
        self.assertEqual((len(rows), sum(float(row['similarity']) >= 0 for row in rows), sum(int(row['agrees']) for row in rows)),
                         (count, refined, agree))
        self.assertGreater(agree, 100)
        towards, turned = (np.array(text.split(), float) for text in re.findall(r'\[([^]]*)\]', out))
        np.testing.assert_allclose(towards, [1, 0, 0], atol=.02)
        np.testing.assert_allclose(turned, [0, 3, 0], atol=.1)
        self.assertEqual(cv2.imread(str(self.folder / 'm.png')).shape, (44 + 480, 2 * 640, 3))
        # a camera of twice the focal length and no distortion gives another pose
        wrong = match_images(a, b, cameras=['PINHOLE,480,360,800,800,240,180'])
        turn = np.degrees(np.arccos((np.trace(wrong.pose.R) - 1) / 2))
        self.assertGreater(abs(turn - 3), .5)

    def test_the_pose_is_that_of_matches_that_agree_before_or_after_they_lead_to_others(self):
        a, b = self.write('a.png', self.world((4, 8))), self.write('b.png', self.world((4, 8), .5, 3))
        options = {'cameras': ['PINHOLE,480,360,400,400,240,180'], 'options': FeatureOptions(points=300)}
        with mock.patch('opencv_iib.measure.prepared', wraps=prepared) as preparations:
            best = match_images(a, b, **options).pose.inliers.sum()
        self.assertEqual(preparations.call_count, 2)
        random = np.random.default_rng(0)

        def shift(points, given):
            points[given // 2:] += random.uniform(5, 50, 2).astype(np.float32)

        def blur(points, given):  # the more exact one has fewer that agree
            points += random.normal(0, 1.5, points.shape).astype(np.float32)

        for spoil, misled in itertools.product((shift, blur), range(2)):
            calls = []

            def propagate(*arguments):
                calls.append(propagateMatches(*arguments))
                if len(calls) - 1 == misled:
                    spoil(calls[-1].points2, len(arguments[4]))
                elif spoil is blur:
                    calls[-1].points2[::8] += 20
                return calls[-1]

            with mock.patch('opencv_iib.measure.propagateMatches', propagate):
                found = match_images(a, b, **options)
            self.assertGreater(found.pose.inliers.sum(), (.9 if spoil is shift else .75) * best)
            np.testing.assert_array_equal(found.matches.points2, calls[1 - misled].points2)

    def test_without_cameras(self):
        picture = self.world((4, 4))
        a, b = self.write('a.png', picture[:300, :400]), self.write('b.png', picture[20:320, 30:430])
        status, out, _ = run_command('match', a, b, '--out', self.folder / 'm.csv')
        self.assertEqual((status, 'pose' in out), (0, False))
        moves = np.array([[float(row['x1']) - float(row['x2']), float(row['y1']) - float(row['y2'])] for row in self.rows('m.csv')
                          if float(row['similarity']) > 0])
        self.assertGreater(len(moves), 100)
        np.testing.assert_allclose(np.median(moves, 0), [30, 20], atol=.02)

    def test_the_verdict_is_sought_once(self):
        picture = self.world((4, 4))
        a, b = self.write('a.png', picture[:300, :400]), self.write('b.png', picture[20:320, 30:430])
        unseen = opencv_iib.matchViews(np.zeros((9, 9), np.uint8), np.zeros((9, 9), np.uint8))
        for expected in (True, False):
            with mock.patch('opencv_iib.measure.show_the_same', return_value=expected) as verdict, \
                    mock.patch('opencv_iib.measure.match_stored', return_value=unseen):
                status, out, _ = run_command('match', a, b, '--out', self.folder / 'm.json')
                found = match_images(a, b)
                for suffix in ('csv', 'npz'):
                    found.save(self.folder / f'm.{suffix}')
                self.assertEqual({json.loads((self.folder / 'm.json').read_text())['found'], bool(np.load(self.folder / 'm.npz')['found']),
                                  *(row['found'] == '1' for row in self.rows('m.csv'))}, {expected})
            self.assertEqual((verdict.call_count, 'may not show the same' in out, status), (2, not expected, 0 if expected else 3))

    def test_another_zoom_and_rotation(self):
        picture = self.world((4, 4))
        small = cv2.rotate(cv2.resize(picture, None, fx=.4, fy=.4, interpolation=cv2.INTER_AREA), cv2.ROTATE_90_CLOCKWISE)
        a, b = self.write('a.png', picture), self.write('b.png', small)
        status, out, _ = run_command('match', a, b, '--out', self.folder / 'm.json')
        self.assertEqual(status, 0)
        self.assertIn('scale 0.40 and is rotated by 90 degrees', out)
        found = json.loads((self.folder / 'm.json').read_text())
        expected = np.array([[0, -.4, small.shape[1] - .7], [.4, 0, -.3], [0, 0, 1]])
        np.testing.assert_allclose(found['view'], expected, atol=2)
        errors = [np.hypot(*(expected[:2] @ [match['x1'], match['y1'], 1] - [match['x2'], match['y2']])) for match in found['matches']]
        self.assertGreater(np.mean(np.array(errors) < 1), .9)
        self.assertEqual({match['bits'] for match in found['matches']}, {-1})
        status, out, _ = run_command('demo', a, b, '--out', self.folder / 'd.png')
        self.assertRegex(out, r'^IIB \d+ of \d+ consistent, scale 0.40, rotated by 90 degrees, SIFT')
        turned = self.write('c.png', cv2.rotate(picture, cv2.ROTATE_90_CLOCKWISE))
        of_orb = match_images(a, turned, options=FeatureOptions(points=1000, detector='ORB'))  # which views are not made of
        self.assertTrue(of_orb.found)
        self.assertGreaterEqual(of_orb.bits.min(), 0)
        self.assertAlmostEqual(of_orb.rotation, 90, delta=1)

    def test_nothing_found_and_mistakes(self):
        a, flat = self.write('a.png', self.world((4, 4))), self.write('flat.png', np.zeros((360, 480), np.uint8))
        out = self.folder / 'm.csv'
        self.assertEqual(run_command('match', a, flat, '--out', out)[0], 3)
        self.assertEqual(self.rows('m.csv'), [])
        status, text, _ = run_command('match', a, flat, '--out', out, '--camera', 'PINHOLE,480,360,400,400,240,180')
        self.assertEqual((status, text.splitlines()[-1]), (3, 'no pose agrees with five matches or more'))
        self.check_mistake('no folder', 'match', a, a, '--out', self.folder / 'none/m.csv')
        for arguments, told in ((['--camera', 'PINHOLE,480,360,400'], 'PINHOLE'), (['--camera', 'PINHOLE,9,9,400,400,240,180'], '480 x 360'),
                                (['--camera', 'simple_pinhole,480,360,400,240,180'] * 3, '3 cameras'),
                                *((['--picture', self.folder / name], 'end its name') for name in ('no.suffix', 'x.exr', 'x.pgm'))):
            self.check_mistake(told, 'match', a, a, '--out', out, *arguments)
        for name in ('x.h5', 'x.png', 'x.npy', 'x.parquet', 'x'):
            self.check_mistake('end its name in .csv, .json or .npz', 'match', a, a, '--out', self.folder / name)
            self.assertFalse((self.folder / name).exists())
        self.assertEqual(run_command('match', a, '--out', '/dev/null', a)[0], 0)

    def test_what_is_written_is_what_was_measured(self):
        picture = cv2.resize(texture(200, 150, seed=4), (6200, 300), interpolation=cv2.INTER_CUBIC)
        a, b = self.write('a.png', picture[:, :6100]), self.write('b.png', picture[:, 100:])
        camera = 'PINHOLE,6100,300,6000,6000,3050,150'
        for name in ('m.csv', 'm.JSON', 'n.json'):
            found = match_images(Path(a), Path(b), self.folder / name, cameras=[Camera.parse(camera)] * (name[0] == 'm'))
            points = np.column_stack([found.matches.points1, found.matches.points2])
            self.assertGreater(points.max(), 6000)
            if name == 'm.csv':
                written = np.array([[row[column] for column in ('x1', 'y1', 'x2', 'y2')] for row in self.rows(name)], float)
            else:
                content = json.loads((self.folder / name).read_text())
                written = np.array([[row[column] for column in ('x1', 'y1', 'x2', 'y2')] for row in content['matches']])
            np.testing.assert_allclose(written, points, rtol=5e-10)
        self.assertIsNone(content['pose'])

    def test_the_pose_in_files(self):
        a, b, flat = self.write('a.png', self.world((4, 8))), self.write('b.png', self.world((4, 8), .5, 3)), self.write('f.png', np.zeros((360, 480), np.uint8))
        for other in (b, flat):
            for suffix in ('json', 'npz'):
                out = self.folder / f'm.{suffix}'
                found = match_images(a, other, out, cameras=['PINHOLE,480,360,400,400,240,180'])
                if suffix == 'json':
                    content = json.loads(out.read_text())
                    pose, count = content['pose'], len(content['matches'])
                else:
                    pose = {'R': None, 't': None, 'covariance': None, **np.load(out)}
                    count = len(pose['points1'])
                    np.testing.assert_array_equal(pose['points2'], found.matches.points2)
                self.assertEqual((bool(pose['found']), str(pose['reason'])), (other == b, found.pose.reason))
                np.testing.assert_array_equal(pose['inliers'], found.agree)
                self.assertEqual(count, len(found.bits))
                for name in ('R', 't', 'covariance'):
                    value = getattr(found.pose, name)
                    self.assertEqual(value is None, pose[name] is None)
                    if value is not None:
                        np.testing.assert_array_equal(pose[name], np.squeeze(value))

    def test_numbers_that_are_not_finite_are_null_in_json(self):
        a, b = self.write('a.png', self.world((4, 8))), self.write('b.png', self.world((4, 8), .5, 3))
        found, out = match_images(a, b, cameras=['PINHOLE,480,360,400,400,240,180']), self.folder / 'm.json'
        found.matches.covariances[:2] = [[np.inf, np.nan, np.inf], [1, -np.inf, 2]]
        found.pose.covariance[1] = np.inf, np.nan, -np.inf, 1, 2
        found.save(out)
        content = json.loads(out.read_text(), parse_constant=self.fail)
        for row, expected in ((content['matches'][0], [None] * 3), (content['matches'][1], [1, None, 2])):
            self.assertEqual([row[name] for name in ('xx', 'xy', 'yy')], expected)
        self.assertEqual(content['pose']['covariance'][1], [None, None, None, 1, 2])

    def test_nothing_is_written_over_an_image(self):
        a, b = (self.write(f'{name}.png', self.world((4, 4))) for name in 'ab')
        before = Path(a).read_bytes()
        (self.folder / 'link.png').symlink_to('a.png')
        for arguments in (['--out', a], ['--out', self.folder / 'link.png'], ['--picture', a], ['--out', 'x.png', '--picture', 'x.png']):
            self.check_mistake('give what is written a name of its own', 'match', a, b, *arguments)
        self.check_mistake('give what is written a name of its own', 'demo', a, b, '--out', a)
        for command, option in (('match', '--picture'), ('match', '--out'), ('demo', '--out')):
            self.check_mistake('is an input too', command, b, b, '--mask', a, option, a)
        self.assertEqual(Path(a).read_bytes(), before)
        # and what cannot be written is told before work
        with mock.patch('opencv_iib.features.Features.__call__', side_effect=AssertionError):
            self.check_mistake('no folder', 'match', a, b, '--out', self.folder / 'none/m.csv')
            self.check_mistake('no folder', 'match', a, b, '--picture', self.folder / 'none/m.png')
            self.check_mistake('end its name in', 'match', a, b, '--picture', self.folder / 'm.foo')
            self.check_mistake('end its name in', 'demo', a, b, '--out', self.folder / 'm.foo')
            for out, told in (('none/m.png', 'no folder'), ('.', 'is a folder'), ('m' * 300 + '.png', 'm.png cannot be written')):
                self.check_mistake(told, 'demo', a, b, '--out', self.folder / out)

    def test_a_wide_lens_and_what_lies_beyond_it(self):
        wide = Camera('opencv_fisheye', 1280, 960, (400, 400, 640, 480, .02, -.01, 0, 0))
        angles = np.linspace(0, 1.4, 40)
        rays = np.column_stack([np.sin(angles), np.zeros(40), np.cos(angles)])
        seen = wide.undistorted(wide.project(rays))
        np.testing.assert_allclose((seen[:, 0] - wide.matrix[0, 2]) / wide.matrix[0, 0], np.tan(angles), rtol=1e-6)
        a, b = self.write('a.png', self.world((4, 8))), self.write('b.png', self.world((4, 8), .5, 3))
        every = match_images(a, b)
        narrow = 'SIMPLE_RADIAL,480,360,400,240,180,-.9'  # its image ends 163 pixels from the centre
        some = match_images(a, b, cameras=[narrow])
        self.assertTrue(0 < len(some.bits) < len(every.bits))
        self.assertLess(np.linalg.norm(some.matches.points1 - [239.5, 179.5], axis=1).max(), 170)


class Align(Commands):

    @unittest.skipUnless((SCENES / 'H_view_panned').exists(), 'the scenes are not beside these tests')
    def test_a_camera_that_was_turned_and_other_light(self):
        other = self.write('other.png', texture(640, 480, seed=8))
        (self.folder / 'text.png').write_text('no image')
        images = [SCENES / 'view_panned.jpg', SCENES / 'view_overcast.jpg', Path(other), self.folder / 'text.png']
        status, out, _ = run_command('align', SCENES / 'view_noon.jpg', *images, '--out', self.folder / 'out')
        self.assertEqual(status, 4)
        self.assertIn('2 of 4 images are aligned', out)
        rows = sorted(self.rows('out/transforms.csv'), key=lambda row: images.index(Path(row['image'])))
        self.assertEqual([Path(row['image']) for row in rows], images)
        self.assertEqual([row['verdict'] for row in rows][:2], ['aligned', 'aligned'])
        self.assertRegex(rows[2]['verdict'], 'the images (may not show the same|have too few matches)')
        status, out, _ = run_command('align', SCENES / 'view_noon.jpg', images[0], '--out', self.folder / 'wrong', '--model', 'translation')
        self.assertEqual((status, 'differ by more than a translation' in out), (3, True))
        true = np.linalg.inv(np.loadtxt(SCENES / 'H_view_panned'))
        for row, expected in zip(rows, (true, np.eye(3))):
            found = np.array([row[f't{r}{c}'] for r in '123' for c in '123'], float).reshape(3, 3)
            corners = np.array([[0, 0], [639, 0], [639, 479], [0, 479]], float)[:, None]
            away = np.linalg.norm(cv2.perspectiveTransform(corners, found) - cv2.perspectiveTransform(corners, expected), axis=2)
            self.assertLess(away.max(), 2)
            self.assertGreater(int(row['matches']), 50)
            self.assertLess(float(row['error_top_left']), 1.25)  # off by .52
            self.assertEqual(cv2.imread(str(self.folder / 'out' / row['file'])).shape,
                             cv2.imread(str(self.folder / 'out/reference.jpg')).shape)
        page = (self.folder / 'out/index.html').read_text()
        self.assertEqual((page.count('type="range"'), page.count('<p>')), (2, 2))

    def test_a_series_through_its_neighbours(self):
        """Darker from picture to picture, and moved: the last ones have no transform with the first one."""
        random = np.random.default_rng(4)
        scene = cv2.resize(texture(170, 130, seed=3), (680, 520), interpolation=cv2.INTER_CUBIC)
        moves = [(2 * k, k) for k in range(4)]
        paths = []
        for k, (x, y) in enumerate(moves):
            seen = scene[y:y + 480, x:x + 640].astype(float)
            # each exposure shows its own range of grey
            exposed = np.clip((seen - 55 * k) * 3, 0, 255) + random.normal(0, 1, seen.shape)
            paths.append(self.write(f'{k}.png', np.clip(exposed, 0, 255).astype(np.uint8)))
        direct = align(paths[0], paths[1:], self.folder / 'direct')
        self.assertFalse(direct[-1].transform)
        done = align(paths[0], paths[1:], self.folder / 'out', chain=True)
        self.assertEqual([each.verdict.split()[0] for each in done], ['aligned'] * 3)
        self.assertEqual(done[-1].verdict, 'aligned through 2.png')
        self.assertTrue(done[-1].file)
        for each, (x, y) in zip(done, moves[1:]):
            np.testing.assert_allclose(np.reshape(each.transform, (3, 3)) @ (320, 240, 1), (320 + x, 240 + y, 1), atol=2)
        self.assertGreater(min(done[-1].errors), max(done[-2].errors), 'errors add up')
        self.assertEqual(run_command('align', paths[0], *paths[1:], '--out', self.folder / 'out', '--chain')[0], 0)

    def pictures(self, *names):
        """One picture by several names, in folders."""
        picture = cv2.resize(texture(160, 120, seed=3), (640, 480), interpolation=cv2.INTER_CUBIC)
        for name in names:
            (self.folder / name).parent.mkdir(exist_ok=True)
        return [self.write(name, picture) for name in names]

    def test_names_and_folders(self):
        paths = self.pictures('reference.png', 'a&b.png', 'more/a&b.png', 'more/reference.png')
        out = self.folder / 'out'
        for _ in range(2):
            done = align(paths[0], paths, str(out), 0)
            self.assertEqual([each.name for each in done], paths[1:], 'the reference is not compared with itself')
            self.assertEqual([each.file for each in done], ['a&b.png', 'a&b_2.png', 'reference_2.png'])
        self.assertEqual(sorted(os.listdir(out)), [RECORD, 'a&b.png', 'a&b_2.png', 'align.json', 'index.html', 'reference.png', 'reference_2.png', 'transforms.csv'])
        page = (out / 'index.html').read_text()
        self.assertIn('a%26b_2.png', page)
        self.assertIn('more/a&amp;b.png, aligned', page)
        self.assertLess(page.index('name="viewport"'), page.index('loading="lazy"'))
        for gone in (['gone.png', paths[1]], [paths[0], 'gone.png'], [*paths[:2], 'gone.png']):
            with mock.patch('opencv_iib.align.ImageAligner', side_effect=AssertionError):
                self.check_mistake('there is no file gone.png', 'align', *gone, '--out', self.folder / 'none')
        self.assertFalse((self.folder / 'none').exists())
        self.check_error('but the reference', 'align', *paths[:1] * 2, '--out', out)
        self.check_mistake('would be replaced', 'align', paths[0], out / 'a&b.png', '--out', out)
        self.assertEqual(run_command('align', *paths[:2], '--out', self.folder / 'new', '--model', 'similarity')[0], 0)
        self.assertEqual(run_command('align', paths[0], self.write('t.png', texture(300, 200, seed=9)), '--out', self.folder / 'n')[0], 3)

    def test_the_page_is_in_the_order_of_people(self):
        paths = self.pictures('r.png', 'B1.png', 'B10.png', 'a.png', 'b2.png')  # as a shell orders a pattern
        align(paths[0], paths[1:], str(self.folder / 'out'))
        self.assertEqual(re.findall(r'src="(\w+\.png)"\nalt', (self.folder / 'out/index.html').read_text()), ['a.png', 'B1.png', 'b2.png', 'B10.png'])
        self.assertEqual([row['file'] for row in self.rows('out/transforms.csv')], ['a.png', 'B1.png', 'b2.png', 'B10.png'])
        for images in ([self.folder], [self.folder / '*.png']):
            self.assertEqual([Path(each.name).name for each in align(paths[0], images, str(self.folder / 'out'))], ['a.png', 'B1.png', 'b2.png', 'B10.png'])

    @unittest.skipIf(os.name == 'nt', 'such names cannot be had there')
    def test_one_image_ends_nothing(self):
        paths = self.pictures('r.png', 'a.png', 'b.png', 'x' * 251 + '.png')
        bytes_ = Path(paths[1]).read_bytes()
        paths.append(str(self.folder / 'caf\udce9.png'))
        paths.append(str(self.folder / ('\u00e9' * 127)))  # 254 bytes without a suffix
        for path in paths[-2:]:
            Path(path).write_bytes(bytes_)
        long = self.write('long.png', np.zeros((2, 32767), np.uint8))

        def opened(path, *arguments, real=open, **more):
            if path == paths[1]:
                raise PermissionError(13, 'Permission denied', path)
            return real(path, *arguments, **more)
        with mock.patch('opencv_iib._files.open', opened, create=True):
            status, out, _ = run_command('align', paths[0], *paths[1:], long, '--out', self.folder / 'out')
        self.assertEqual(status, 4)
        verdicts = [row['verdict'] for row in self.rows('out/transforms.csv')]
        self.assertEqual(verdicts[:3] + verdicts[4:], ['Permission denied', *['aligned'] * 4])
        self.assertRegex(verdicts[3], '32767 x 2 pixels.*32766')
        self.check_error('32767 x 2 pixels', 'align', long, *paths, '--out', self.folder / 'out')

    def align(self, *arguments, status=0, calls=None, stop=None):
        """Runs the command on one thread, of which so many images are looked at until something stops it."""
        seen = []

        def found(*more, real=ImageAligner.align):
            seen.append(more)
            if stop is not None and len(seen) > calls:
                raise stop
            return real(*more)
        with mock.patch('opencv_iib.align.ImageAligner.align', found):
            self.assertEqual(run_command('align', *arguments, '--out', self.folder / 'out', '--workers', 1)[0], status)
        self.assertTrue(stop is not None or calls in (None, len(seen)), len(seen))
        return self.rows('out/transforms.csv')

    def test_an_interruption_keeps_what_is_done_and_the_same_call_goes_on(self):
        paths = self.pictures('r.png', 'a.png', 'b.png', 'c.png', 'd.png')
        rows = self.align(*paths, calls=2, stop=KeyboardInterrupt, status=130)
        self.assertEqual([row['file'] for row in rows], ['a.png', 'b.png'])
        self.assertEqual(sorted(os.listdir(self.folder / 'out')), [RECORD, 'a.png', 'align.json', 'b.png', 'index.html', 'reference.png', 'transforms.csv'])
        first = (self.folder / 'out/a.png').stat().st_ino
        rows = self.align(*paths, calls=1, stop=OSError('the disk has gone'), status=1)
        self.assertEqual([row['file'] for row in rows], ['a.png', 'b.png', 'c.png'])
        rows = self.align(*paths, calls=1)
        self.assertEqual([row['file'] for row in rows], ['a.png', 'b.png', 'c.png', 'd.png'])
        self.assertEqual((self.folder / 'out/a.png').stat().st_ino, first)
        os.utime(paths[1], (1, 1))
        self.align(*paths, calls=0)
        with open(paths[1], 'ab') as file:
            file.write(b'more')
        self.align(*paths, calls=1)
        self.align(*paths, '--model', 'affine', calls=4)
        self.assertEqual(len(self.align(*paths[:2], '--model', 'affine', calls=0)), 1)
        self.assertEqual(sorted(os.listdir(self.folder / 'out')), [RECORD, 'a.png', 'align.json', 'index.html', 'reference.png', 'transforms.csv'])

    def test_a_call_that_is_killed_while_pictures_are_replaced_leaves_none_of_other_options(self):
        paths = self.pictures('r.png', 'a.png', 'b.png', 'c.png')[:3]
        cv2.imwrite(paths[2], cv2.warpAffine(cv2.imread(paths[1], 0), np.array([[1, .02, 20], [-.02, 1, 30.]]), (640, 480)))
        cv2.imwrite(paths[1], cv2.imread(paths[1], 0)[30:, 40:])
        pictures = ('a.png', 'b.png', 'reference.png')
        for options in (('--interpolation', 'nearest'), ('--crop',)):
            shutil.rmtree(self.folder / 'out', ignore_errors=True)
            self.align(*paths, *options)
            expected = [zlib.crc32((self.folder / 'out' / name).read_bytes()) for name in pictures]
            for writes in (0, 1, 2):
                shutil.rmtree(self.folder / 'out')
                self.align(*paths)

                def written(*content, real=write_whole, left=[writes]):
                    left[0] -= 1
                    if left[0] < 0:
                        raise GeneratorExit  # nothing is written after it, as after a kill
                    real(*content)
                with mock.patch('opencv_iib._images.write_whole', written), self.assertRaises(GeneratorExit):
                    run_command('align', *paths, *options, '--out', self.folder / 'out')
                for now in ((), options):
                    self.align(*paths, *now)
                self.assertEqual([zlib.crc32((self.folder / 'out' / name).read_bytes()) for name in pictures], expected, writes)

    def test_the_rotation_is_that_of_the_second_image_clockwise_as_match_tells_it(self):
        first = texture(640, 480, seed=3)
        paths = [self.write(name, image) for name, image in (('a.png', first), ('b.png', cv2.rotate(first, cv2.ROTATE_90_CLOCKWISE)))]
        measured = match_images(*paths)
        self.assertAlmostEqual(measured.rotation, 90, delta=2)
        self.assertIn('rotated by 90 degrees', str(measured))
        found, = align(*paths[:1], paths[1:], str(self.folder / 'out'))
        self.assertAlmostEqual(found.rotation, 90, delta=2)
        self.assertIn(', scale 1.00, rotated by 90 degrees', str(found))

    def test_folders_and_patterns(self):
        paths = self.pictures('r.png', 'f/1.png', 'f/2.png', 'f/more/1.png', '[x].png')
        for images, count in (([self.folder / 'f'], 3), ([self.folder / 'f/*.png', paths[1]], 2), ([paths[4], self.folder / '[f]/**/*.png'], 4)):
            self.assertEqual(len(self.align(paths[0], *images)), count)
        self.check_mistake('no image is called', 'align', paths[0], self.folder / '*.jpg', '--out', self.folder / 'out')
        self.assertEqual(run_command('align', paths[0], self.folder / 'f', '--out', self.folder / 'f/out')[0], 0)
        status, out, _ = run_command('align', paths[0], self.folder / 'f', '--out', self.folder / 'f/out')
        self.assertEqual((status, out.splitlines()[-1][-25:]), (0, '3 of 3 images are aligned'))
        for _ in range(2):  # a pattern leaves folders out, and what was written
            out = run_command('align', paths[0], self.folder / 'f/**', '--out', self.folder / 'f/out')[1]
            self.assertEqual(out.splitlines()[-1][-25:], '3 of 3 images are aligned')
        for reference, images in ((paths[1], self.folder / 'f'), (paths[0], self.folder / 'f'), (paths[0], self.folder / 'f/*')):
            self.check_mistake('would be replaced', 'align', reference, images, '--out', self.folder / 'f')

    def shifted(self, *kinds, suffix='.tif'):
        """A picture, and a part of it 30 right and 20 down, each as these make them of values from 0 to 255."""
        picture = cv2.resize(texture(160, 120, seed=3), (640, 480), interpolation=cv2.INTER_CUBIC).astype(float)
        picture = np.rint((picture - picture.min()) * (255 / np.ptp(picture)))
        for n, kind in enumerate(kinds):
            pages = [part.astype(kind) if isinstance(kind, type) else kind(part) for part in (picture, picture[20:, 30:])]
            for name, page in zip((f'r{n}{suffix}', f'i{n}{suffix}'), pages):
                write_picture(self.folder / name, *(page if isinstance(page, list) else [page]))
            yield self.folder / f'r{n}{suffix}', self.folder / f'i{n}{suffix}', *(page if isinstance(page, list) else [page] for page in pages)

    def check_shifted(self, pair, *options):
        """That the part is written as it is, where it is in the picture. Its transform."""
        reference, image, pages, parts = pair
        row, = self.align(reference, image, '--model', 'translation', *options)
        self.assertEqual(row['verdict'], 'aligned')
        written = decode_all((self.folder / 'out' / row['file']).read_bytes()).pages
        self.assertEqual([(page.dtype, page.shape) for page in written], [(page.dtype, page.shape) for page in pages])
        for page, part in zip(written, parts):
            inside = page[40:-10, 50:-10]
            expected = part[20:-10, 20:-10]
            self.assertLess(np.abs(inside.astype(float) - expected).max() / np.ptp(part.astype(float)), .1)
            self.assertFalse(np.nan_to_num(page[:15, :20]).any())
        return row, written

    @NEEDS_TIFFFILE
    def test_six_encodings_give_the_same_transform_and_are_written_as_they_were_read(self):
        kinds = (np.uint8, lambda a: a.astype(np.uint16) * 16, np.uint16, lambda a: a.astype(np.uint16) * 257,
                 lambda a: (a / 255).astype(np.float32), np.float32)
        rows = [self.check_shifted(pair)[0] for pair in self.shifted(*kinds)]
        transforms = np.array([[float(row[f't{r}{c}']) for r in '123' for c in '123'] for row in rows])
        np.testing.assert_allclose(transforms, transforms[:1].repeat(6, 0), atol=.001)  # a part has less than the range of all
        for pair in self.shifted(*kinds[:4], suffix='.png'):
            self.assertEqual(self.check_shifted(pair)[0]['file'][-4:], '.png')

    @NEEDS_TIFFFILE
    def test_channels_and_pages_are_written_as_they_were_read(self):
        def alpha(depth):
            return lambda a: np.dstack([a, a, a, np.full_like(a, 255)]).astype(depth)
        others = [alpha(np.uint8), alpha(np.uint16), lambda a: np.dstack([a, 255 - a, a / 2]).astype(np.float32), lambda a: a.astype(np.int16) - 100,
                  lambda a: [a.astype(np.uint16), (255 - a).astype(np.uint16), a.astype(np.uint16) * 100], float,
                  lambda a: a.astype(np.int32) * 100000]
        others += [lambda a: np.dstack([a, a, a, a, a]).astype(np.uint16), lambda a: np.dstack([a, np.full_like(a, 255)]).astype(np.uint8)]
        for n, pair in enumerate(self.shifted(*others)):
            with self.subTest(n):
                self.check_shifted(pair)
                self.assertTrue((self.folder / f'out/views/i{n}.tif.jpg').exists())
        pair, = self.shifted(alpha(np.uint8), suffix='.png')
        _, (written,) = self.check_shifted(pair)
        self.assertEqual((written[..., 3].min(), written[30:, 40:, 3].min()), (0, 255))

    @NEEDS_TIFFFILE
    def test_pixels_without_data_stay_without(self):
        pair, = self.shifted(np.float32)
        reference, image, (whole,), (part,) = pair
        for text, value in (('', np.nan), ('-9999', -9999)):
            part = part.copy()
            part[100:130, 100:150] = value
            write_picture(image, part, no_data=text)
            row, = self.align(reference, image, '--model', 'translation', '--interpolation', 'cubic')
            data = (self.folder / 'out' / row['file']).read_bytes()
            page = decode_first(data)
            self.assertEqual((decode_all(data).no_data, row['verdict']), (text, 'aligned'))
            np.testing.assert_array_equal(page[[125, 5], [150, 5]], [value, value])
            known = page[np.isfinite(page) & (page != -9999)]
            self.assertTrue(-40 < known.min() and known.max() < 300 and .8 < known.size / whole.size < .93)

    @NEEDS_TIFFFILE
    def test_colours_with_a_channel_that_equals_no_data_stay(self):
        pair, = self.shifted(lambda a: np.dstack([np.zeros_like(a), a // 2 + 100, np.full_like(a, 255)]).astype(np.uint8))
        reference, image, (whole,), (part,) = pair
        part[100:130, 100:150] = 0
        write_picture(image, part, no_data='0')
        row, = self.align(reference, image, '--model', 'translation', '--interpolation', 'nearest')
        page = decode_first((self.folder / 'out' / row['file']).read_bytes())
        shown = page[..., 2] > 0
        self.assertFalse(page[~shown].any())
        np.testing.assert_allclose(shown.mean(), (610 * 460 - 30 * 50) / (640 * 480), atol=.02)
        np.testing.assert_array_equal(page[shown][:, [0, 2]].T, [[0], [255]] * np.ones(shown.sum(), int))
        pair, = self.shifted(lambda a: np.dstack([a, a, a]).astype(np.int16))
        pair[3][0][100:130, 100:150, 1] = -9999  # one channel without data, whose others stay
        write_picture(pair[1], pair[3][0], no_data='-9999')
        row, = self.align(*pair[:2], '--model', 'translation', '--interpolation', 'cubic')
        page = decode_first((self.folder / 'out' / row['file']).read_bytes())
        self.assertEqual(page[130, 150, 1], -9999)
        self.assertTrue(page[130, 150, 0] >= -40 and ((page == -9999) | (page > -60)).all())

    @NEEDS_TIFFFILE
    def test_previews_are_scaled_by_what_has_data(self):
        for kind, value in ((np.float32, -9999), (np.float32, np.nan), (np.uint16, 65535)):
            pair, = self.shifted(kind)
            reference, image, (whole,), (part,) = pair
            part[:200] = value
            write_picture(image, part, no_data=str(value))
            row, = self.align(reference, image, '--model', 'translation')
            view = cv2.imread(str(self.folder / f"out/views/{row['file']}.jpg"), cv2.IMREAD_GRAYSCALE)
            self.assertGreater(view[240:470, 50:630].std(), 25)
        part[:] = 65535
        write_picture(image, part, no_data='65535')
        self.align(reference, image, status=3)

    @NEEDS_TIFFFILE
    def test_pages_of_another_size_are_left_out_with_a_word(self):
        pair, = self.shifted(np.uint16)
        write_picture(pair[1], *pair[3], texture(60, 40))
        for crop in ((), ('--crop',)):
            status, _, errors = run_command('align', *pair[:2], '--out', self.folder / 'out', '--model', 'translation', *crop)
            self.assertEqual((status, errors.count('i0.tif: 1 of its pages are left out')), (0, 1))

    @NEEDS_TIFFFILE
    def test_no_data_that_no_pixel_can_have_tells_nothing(self):
        for dtype, text in ((np.uint8, '-9999'), (np.uint8, 'nan'), (np.float32, '1e39'), (np.uint16, 'none')):
            pair, = self.shifted(dtype)
            reference, image, _, (part,) = pair
            write_picture(image, part, no_data=text)
            row, = self.align(reference, image, '--model', 'translation')
            self.assertEqual(row['verdict'], 'aligned')

    @NEEDS_TIFFFILE
    def test_pixels_keep_their_places_on_the_earth(self):
        keys = [(34735, 3, (1, 1, 0, 1, 3072, 34737, 5, 0)), (34737, 2, 'here|')]
        scale = [(33550, 12, (.5, .5, 0)), (33922, 12, (10, 20, 0, 4e5 + .25, 5e6, 0))]
        matrix = [(34264, 12, (.5, .1, 0, 4e5, .1, -.5, 0, 5e6, 0, 0, 0, 0, 0, 0, 0, 1))]
        pair, = self.shifted(np.uint16)
        reference, image, (whole,), (part,) = pair
        write_picture(image, part, geo=[(33550, 12, (9, 9, 0)), *keys])
        for own in (scale, matrix, []):
            write_picture(reference, whole, geo=[*own, *keys])
            for crop in ((), ('--crop',)):
                row, = self.align(reference, image, '--model', 'translation', *crop)
                written = [decode_all((self.folder / 'out' / name).read_bytes()).geo for name in (row['file'], 'reference.tif')]
                self.assertEqual(written[0], written[1])
                self.assertEqual(written[0][-2:], keys)
                x, y = json.loads((self.folder / 'out/align.json').read_text())['part'][:2]
                self.assertEqual(bool(crop), x > 20 and y > 10)
                if own == scale:
                    self.assertEqual(written[0][:-2], [scale[0], (33922, 12, (10. - x, 20. - y, 0, 4e5 + .25, 5e6, 0))])
                elif own:
                    at = np.reshape(written[0][0][2], (4, 4))
                    np.testing.assert_allclose(at @ [7, 8, 0, 1], np.reshape(matrix[0][2], (4, 4)) @ [7 + x, 8 + y, 0, 1])
        row, = self.align(reference, image, '--model', 'translation', '--format', 'png')
        self.assertEqual(row['file'], 'i0.png')
        data = reference.read_bytes()
        wrong = data.replace(bytes.fromhex('af87 0300'), bytes.fromhex('af87 0c00'))  # numbers of another type
        self.assertEqual((len(decode_all(data).geo), decode_all(wrong).geo), (2, ()))
        write_picture(image, part, geo=[(33550, 12, (np.inf, np.nan, 0))], no_data='inf')
        self.assertEqual(decode_all(image.read_bytes()).geo, ())
        self.align(reference, image, '--model', 'translation')

    @NEEDS_TIFFFILE
    def test_formats_and_interpolation(self):
        pair, = self.shifted(np.uint8, suffix='.jpg')
        self.assertEqual([self.check_shifted(pair, *options)[0]['file'] for options in ((), ('--format', 'png'), ('--format', 'TIFF'))],
                         ['i0.jpg', 'i0.png', 'i0.tif'])
        written = []
        cv2.imwrite(str(pair[1]), cv2.resize(pair[3][0], None, fx=.9, fy=.9, interpolation=cv2.INTER_AREA))
        for name in ('nearest', 'LINEAR', 'cubic', 'lanczos4'):
            row, = self.align(*pair[:2], '--interpolation', name, '--format', 'png')
            written.append((self.folder / 'out' / row['file']).read_bytes())
        self.assertEqual(len(set(written)), 4)
        for short in self.shifted(np.uint16):
            self.check_mistake('JPEG cannot hold all of it: take TIFF', 'align', *short[:2], '--out', self.folder / 'out', '--format', 'jpeg')
            row, = self.align(pair[0], short[1], '--format', 'jpeg', status=3)
            self.assertRegex(row['verdict'], 'JPG cannot hold 1 x .* of uint16')

    def test_crop_is_what_all_show(self):
        pairs = list(self.shifted(np.uint8, lambda a: np.rot90(a, 2).astype(np.uint8), suffix='.png'))  # the second one shows the other corner
        reference, image, (whole,), _ = pairs[0]
        cv2.imwrite(str(self.folder / 'left.png'), whole[:450, :600])
        rows = self.align(reference, image, self.folder / 'left.png', '--model', 'translation', '--crop')
        for name, at in ((rows[0]['file'], 1), (rows[1]['file'], 1), ('reference.png', 0)):
            picture = cv2.imread(str(self.folder / 'out' / name), -1)
            self.assertTrue(all(abs(size - expected) < 3 for size, expected in zip(picture.shape, (430, 570))), picture.shape)
            self.assertGreater(np.corrcoef(picture[2:-2, 2:-2].ravel(), whole[22:22 + picture.shape[0] - 4, 32:32 + picture.shape[1] - 4].ravel())[0, 1], .95)
        before = (self.folder / 'out' / rows[0]['file']).stat().st_ino
        self.align(reference, image, self.folder / 'left.png', '--model', 'translation', '--crop', calls=0)
        self.assertEqual((self.folder / 'out' / rows[0]['file']).stat().st_ino, before)
        self.align(reference, image, '--model', 'translation', '--crop', calls=0)  # all show more now
        self.assertGreater(cv2.imread(str(self.folder / 'out' / rows[0]['file'])).shape[1], 600)

    def test_masks_and_reduced_images(self):
        picture = cv2.resize(texture(160, 120, seed=3), (640, 480), interpolation=cv2.INTER_CUBIC)
        other, masks = picture[20:, 30:].copy(), self.folder / 'masks'
        banner = cv2.resize(texture(100, 70, seed=8), (400, 280), interpolation=cv2.INTER_CUBIC)
        first = picture.copy()
        for image in (first, other):  # which stays where it is
            image[:280, :400] = banner
        paths = [self.write(name, image) for name, image in (('r.png', first), ('i.png', other))]
        masks.mkdir()
        self.check_mistake('has no mask of any image: that of r.png would be r.png.png', 'align', *paths, '--out', self.folder / 'out', '--mask', masks)
        for name, image in (('r.png.png', first), ('i.png.png', other)):
            mask = np.full(image.shape, 255, np.uint8)
            mask[:300, :420] = 0
            cv2.imwrite(str(masks / name), mask)
        for options in ((), ('--max-size', '320')):
            row, = self.align(*paths, '--model', 'translation', '--mask', masks, *options)
            np.testing.assert_allclose([float(row['t13']), float(row['t23'])], [30, 20], atol=.3)
        found, = align(paths[0], paths[1:], self.folder / 'out')  # by the larger part
        np.testing.assert_allclose(found.transform[2:6:3], [30, 20], atol=.3)
        self.assertIn('moved otherwise', str(found))
        cv2.imwrite(str(masks / 'r.png.png'), mask)
        self.check_error('its mask .* has 610 x 460 pixels, and the image 640 x 480', 'align', *paths, '--out', self.folder / 'out', '--mask', masks)
        self.check_mistake('there is no mask', 'align', *paths, '--out', self.folder / 'out', '--mask', self.folder / 'gone')


if __name__ == '__main__':
    unittest.main()
