"""The command match, of two images."""
import itertools
import json
import re
import unittest
from pathlib import Path
from unittest import mock

import numpy as np

import opencv_iib
from opencv_iib.features import FeatureOptions
from opencv_iib.localization import Camera
from opencv_iib.measure import match_images
from opencv_iib.refinement import prepared, propagateMatches
from support import InFolder, cv2, run_command, texture


@unittest.skipIf(cv2 is None, 'no cv2')
class Match(InFolder):

    def two(self):
        """Files of two views of the walls."""
        return self.write('a.png', self.world((4, 8))), self.write('b.png', self.world((4, 8), .5, 3))

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
        still = self.write('still.png', self.world((4, 8), 0, 3, distortion=lens) // 2 + 20)
        self.assertIn('the second camera hardly moved, so its direction is unknown, and is turned by', run_command('match', a, still, '--out', '-', '--camera', camera)[2])
        # twice the focal length without distortion gives another pose
        wrong = match_images(a, b, cameras=['PINHOLE,480,360,800,800,240,180'])
        turn = np.degrees(np.arccos((np.trace(wrong.pose.R) - 1) / 2))
        self.assertGreater(abs(turn - 3), .5)

    def test_the_pose_is_that_of_matches_that_agree_before_or_after_they_lead_to_others(self):
        a, b = self.two()
        options = {'cameras': ['PINHOLE,480,360,400,400,240,180'], 'options': FeatureOptions(points=800)}
        with mock.patch('opencv_iib.measure.prepared', wraps=prepared) as preparations:
            best = match_images(a, b, **options).pose.inliers.sum()
        self.assertEqual(preparations.call_count, 2)
        random = np.random.default_rng(0)

        def shift(points, given):
            points[given // 2:] += random.uniform(5, 50, 2).astype(np.float32)

        def blur(points, given):  # the more exact pose has fewer inliers
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
        of_orb = match_images(a, turned, options=FeatureOptions(points=1000, detector='ORB'))  # matchViews does not make views of it
        self.assertTrue(of_orb.found)
        self.assertGreaterEqual(of_orb.bits.min(), 0)
        self.assertAlmostEqual(of_orb.rotation, 90, delta=1)

    def test_nothing_found(self):
        a, flat = self.write('a.png', self.world((4, 4))), self.write('flat.png', np.zeros((360, 480), np.uint8))
        out = self.folder / 'm.csv'
        self.assertEqual(run_command('match', a, flat, '--out', out)[0], 3)
        self.assertEqual(self.rows('m.csv'), [])
        status, text, _ = run_command('match', a, flat, '--out', out, '--camera', 'PINHOLE,480,360,400,400,240,180')
        self.assertEqual((status, text.splitlines()[-1]), (3, 'no pose agrees with five matches or more'))
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
        (a, b), flat = self.two(), self.write('f.png', np.zeros((360, 480), np.uint8))
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
        found, out = match_images(a, b, cameras=['PINHOLE,480,360,400,400,240,180']), self.folder / 'm.json'
        found.matches.covariances[0] = np.inf, np.nan, -np.inf
        found.pose.covariance[1] = np.inf, np.nan, -np.inf, 1, 2
        found.save(out)
        content = json.loads(out.read_text(), parse_constant=self.fail)  # which lacks numbers that are not finite
        self.assertEqual([content['matches'][0][name] for name in ('xx', 'xy', 'yy')], [None] * 3)
        self.assertEqual(content['pose']['covariance'][1], [None, None, None, 1, 2])

    def test_a_wide_lens_and_what_lies_beyond_it(self):
        wide = Camera('opencv_fisheye', 1280, 960, (400, 400, 640, 480, .02, -.01, 0, 0))
        angles = np.linspace(0, 1.4, 40)
        rays = np.column_stack([np.sin(angles), np.zeros(40), np.cos(angles)])
        seen = wide.undistorted(wide.project(rays))
        np.testing.assert_allclose((seen[:, 0] - wide.matrix[0, 2]) / wide.matrix[0, 0], np.tan(angles), rtol=1e-6)
        a, b = self.two()
        every = match_images(a, b)
        narrow = 'SIMPLE_RADIAL,480,360,400,240,180,-.9'  # its image ends 163 pixels from the centre
        some = match_images(a, b, cameras=[narrow])
        self.assertTrue(0 < len(some.bits) < len(every.bits))
        self.assertLess(np.linalg.norm(some.matches.points1 - [239.5, 179.5], axis=1).max(), 170)
