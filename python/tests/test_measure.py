"""The commands match and align."""
import csv
import json
import os
import re
import unittest
from pathlib import Path
from unittest import mock

import numpy as np

from opencv_iib.align import align
from opencv_iib.colmap.features import FeatureOptions
from opencv_iib.localization import Camera
from opencv_iib.measure import match_images
from opencv_iib.geometry import alignImages
from opencv_iib.refinement import propagateMatches
from support import REPOSITORY, InFolder, cv2, run_command, texture

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
        best = match_images(a, b, **options).pose.inliers.sum()
        for misled in range(2):
            calls = []

            def propagate(*arguments):
                calls.append(propagateMatches(*arguments))
                if len(calls) - 1 == misled:
                    calls[-1].points2[len(arguments[4]) // 2:] += np.random.default_rng(0).uniform(5, 50, 2).astype(np.float32)
                return calls[-1]

            with mock.patch('opencv_iib.measure.propagateMatches', propagate):
                found = match_images(a, b, **options)
            self.assertGreater(found.pose.inliers.sum(), .9 * best)
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

    def test_nothing_found_and_mistakes(self):
        a, flat = self.write('a.png', self.world((4, 4))), self.write('flat.png', np.zeros((360, 480), np.uint8))
        out = self.folder / 'm.csv'
        self.assertEqual(run_command('match', a, flat, '--out', out)[0], 3)
        self.assertEqual(self.rows('m.csv'), [])
        status, text, _ = run_command('match', a, flat, '--out', out, '--camera', 'PINHOLE,480,360,400,400,240,180')
        self.assertEqual((status, text.splitlines()[-1]), (3, 'no pose agrees with five matches or more'))
        self.check_error('no folder', 'match', a, a, '--out', self.folder / 'none/m.csv')
        for arguments, told in ((['--camera', 'PINHOLE,480,360,400'], 'PINHOLE'), (['--camera', 'PINHOLE,9,9,400,400,240,180'], '480 x 360'),
                                (['--camera', 'simple_pinhole,480,360,400,240,180'] * 3, '3 cameras'),
                                (['--picture', self.folder / 'no.suffix'], 'end its name')):
            self.check_mistake(told, 'match', a, a, '--out', out, *arguments)

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
            self.check_error('give what is written a name of its own', 'match', a, b, *arguments)
        self.check_error('give what is written a name of its own', 'demo', a, b, '--out', a)
        self.assertEqual(Path(a).read_bytes(), before)
        # and what cannot be written is told before work
        with mock.patch('opencv_iib.colmap.features.Features.__call__', side_effect=AssertionError):
            self.check_error('no folder', 'match', a, b, '--out', self.folder / 'none/m.csv')
            self.check_error('no folder', 'match', a, b, '--picture', self.folder / 'none/m.png')
            self.check_mistake('end its name in', 'match', a, b, '--picture', self.folder / 'm.foo')
            self.check_mistake('end its name in', 'demo', a, b, '--out', self.folder / 'm.foo')
            for out, told in (('none/m.png', 'no folder'), ('.', 'is a folder')):
                self.check_error(told, 'demo', a, b, '--out', self.folder / out)

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
        images = [SCENES / 'view_panned.jpg', SCENES / 'view_overcast.jpg', other, self.folder / 'text.png']
        status, out, _ = run_command('align', SCENES / 'view_noon.jpg', *images, '--out', self.folder / 'out')
        self.assertEqual(status, 4)
        self.assertIn('2 of 4 images are aligned', out)
        rows = self.rows('out/transforms.csv')
        self.assertEqual([row['image'] for row in rows], list(map(str, images)))
        self.assertEqual([row['verdict'] for row in rows][:2], ['aligned', 'aligned'])
        self.assertRegex(rows[2]['verdict'], '^the images ')
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
                             cv2.imread(str(self.folder / 'out/reference.png')).shape)
        page = (self.folder / 'out/index.html').read_text()
        self.assertEqual((page.count('type="range"'), page.count('<p>')), (2, 2))

    def pictures(self, *names):
        """One picture by several names, in folders."""
        picture = cv2.resize(texture(160, 120, seed=3), (640, 480), interpolation=cv2.INTER_CUBIC)
        for name in names:
            (self.folder / name).parent.mkdir(exist_ok=True)
        return [self.write(name, picture) for name in names]

    def test_names_and_folders(self):
        paths = self.pictures('reference.png', 'a&b.png', 'more/a&b.jpg', 'more/reference.png')
        out = self.folder / 'out'
        for _ in range(2):
            done = align(paths[0], paths, str(out), 0)
            self.assertEqual([each.name for each in done], paths[1:], 'the reference is not compared with itself')
            self.assertEqual([each.file for each in done], ['a&b.png', 'a&b_2.png', 'reference_2.png'])
        self.assertEqual(sorted(os.listdir(out)), ['a&b.png', 'a&b_2.png', 'index.html', 'reference.png', 'reference_2.png', 'transforms.csv'])
        page = (out / 'index.html').read_text()
        self.assertIn('a%26b_2.png', page)
        self.assertIn('more/a&amp;b.jpg, aligned', page)
        self.assertLess(page.index('name="viewport"'), page.index('loading="lazy"'))
        mine = out / 'mine.png'
        mine.write_text('precious')
        with self.assertRaises(FileExistsError):
            align(paths[0], paths, str(out))
        for arguments, told in ((['gone.png', paths[1]], 'gone.png'), ([paths[0], paths[1]], 'holds mine.png'), (paths[:1] * 2, 'but the reference')):
            self.check_error(told, 'align', *arguments, '--out', out)
        self.assertEqual(mine.read_text(), 'precious')
        mine.unlink()
        foreign = self.folder / 'foreign'
        foreign.mkdir()
        (foreign / 'transforms.csv').write_text('image,verdict\n')
        self.check_error('holds transforms.csv', 'align', *paths[:2], '--out', foreign)
        self.check_error('would be replaced', 'align', paths[0], out / 'a&b.png', '--out', out)
        self.assertEqual(run_command('align', *paths[:2], '--out', self.folder / 'new', '--model', 'similarity')[0], 0)
        self.assertEqual(run_command('align', paths[0], self.write('t.png', texture(300, 200, seed=9)), '--out', self.folder / 'n')[0], 3)

    def test_the_page_is_in_the_order_of_people(self):
        paths = self.pictures('r.png', '1.png', '10.png', '2.png')
        align(paths[0], paths[1:], str(self.folder / 'out'))
        self.assertEqual(re.findall(r'src="(\d+\.png)', (self.folder / 'out/index.html').read_text()), ['1.png', '2.png', '10.png'])
        self.assertEqual([row['file'] for row in self.rows('out/transforms.csv')], ['1.png', '10.png', '2.png'])

    @unittest.skipIf(os.name == 'nt', 'such names cannot be had there')
    def test_one_image_ends_nothing(self):
        paths = self.pictures('r.png', 'a.png', 'b.png', 'x' * 251 + '.png')
        bytes_ = Path(paths[1]).read_bytes()
        paths.append(str(self.folder / 'caf\udce9.png'))
        paths.append(str(self.folder / ('\u00e9' * 127)))  # 254 bytes without a suffix
        for path in paths[-2:]:
            Path(path).write_bytes(bytes_)
        long = self.write('long.png', np.zeros((2, 32767), np.uint8))

        def opened(path, *arguments, real=open):
            if path == paths[1]:
                raise PermissionError(13, 'Permission denied', path)
            return real(path, *arguments)
        with mock.patch('opencv_iib.colmap.images.open', opened, create=True):
            status, out, _ = run_command('align', paths[0], *paths[1:], long, '--out', self.folder / 'out')
        self.assertEqual(status, 4)
        verdicts = [row['verdict'] for row in self.rows('out/transforms.csv')]
        self.assertEqual(verdicts[:5], ['Permission denied', *['aligned'] * 4])
        self.assertRegex(verdicts[5], '32767 x 2 pixels.*32766')
        self.check_error('32767 x 2 pixels', 'align', long, *paths, '--out', self.folder / 'out')

    def test_an_interruption_keeps_what_is_done(self):
        paths = self.pictures('r.png', 'a.png', 'b.png', 'c.png')
        for stop, status in ((KeyboardInterrupt, 130), (OSError('the disk has gone'), 1)):
            calls = []

            def found(*arguments):
                calls.append(arguments)
                if len(calls) == 3:
                    raise stop
                return alignImages(*arguments)
            with mock.patch('opencv_iib.align.alignImages', found):
                self.assertEqual(run_command('align', *paths, '--out', self.folder / 'out')[0], status)
            self.assertEqual([row['file'] for row in self.rows('out/transforms.csv')], ['a.png', 'b.png'])
            self.assertEqual(sorted(os.listdir(self.folder / 'out')), ['a.png', 'b.png', 'index.html', 'reference.png', 'transforms.csv'])
        with mock.patch('opencv_iib.align.alignImages', side_effect=KeyboardInterrupt):
            self.assertEqual(run_command('align', *paths, '--out', self.folder / 'out')[0], 130)
        self.assertEqual(len(self.rows('out/transforms.csv')), 2)
