#!/usr/bin/env python3
"""Tests of the experiments in Python; scripts/helpers/python_test.sh runs them with the package."""
import csv
import math
import pathlib
import sys
import tempfile
import types
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import cv2  # noqa: E402
import numpy as np  # noqa: E402
import opencv_iib  # noqa: E402

import alignment  # noqa: E402
import datasets  # noqa: E402
import methods  # noqa: E402
import poses  # noqa: E402
import uncertainty  # noqa: E402
import warped  # noqa: E402
import wxbs  # noqa: E402


def rows(file):
    with open(file, newline='') as opened:
        return list(csv.DictReader(opened))


def blocks(random, shape, count=900):
    image = np.full(shape, 90, np.uint8)
    for x, y, width, height, grey in random.integers((0, 0, 4, 4, 20), (shape[1], shape[0], 26, 26, 230), (count, 5)):
        image[y:y + height, x:x + width] = grey
    return image


class Folders(unittest.TestCase):
    """A folder for data, and one for results."""

    def setUp(self):
        self.kept = tempfile.TemporaryDirectory()
        self.addCleanup(self.kept.cleanup)
        self.folder = pathlib.Path(self.kept.name).resolve()
        self.options = types.SimpleNamespace(data=[self.folder / 'data'], out=self.folder, points=200, tolerance=3, detectors=())

    def write(self, name, content):
        path = self.folder / 'data' / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(content) if isinstance(content, str) else cv2.imwrite(str(path), content)

    def write_views(self, place, positions, images, camera='30 20 25 26 15 10'):
        """Views that look along z, with an image or none each."""
        self.write(place + '/cameras.txt', '# a comment\n1 PINHOLE %s\n' % camera)
        self.write(place + '/poses.txt', '# a comment\n' + ''.join('%s %s 0 0 0 0 0 1\n' % item for item in positions.items()))
        for name, image in images.items():
            self.write('%s/images/%s.png' % (place, name), image)


class Data(Folders):
    def test_neighbours_of_a_folder(self):
        image = np.full((20, 30), 9, np.uint8)
        self.write_views('set/walk', {str(k): k + (k > 0) for k in range(6)}, {name: image for name in '01235'})
        self.write('set/walk/poses.txt', (self.folder / 'data/set/walk/poses.txt').read_text().replace('1 2 0 0 0 0 0 1', '1 2 0 0 0 .70710678 0 .70710678'))
        pairs = datasets.view_pairs(self.options.data)
        self.assertEqual(3 + 3 + 2 + 1, len(pairs))  # without image 4
        self.assertEqual(('set', 'walk', '0-1'), pairs[0][:3])
        self.assertEqual((26, 9.5), tuple(pairs[0].cameras[1][1, 1:]))  # COLMAP's 10
        # The world's x axis is the second camera's z axis; the first stands two metres behind it.
        np.testing.assert_allclose(pairs[0].R @ (1, 0, 0), (0, 0, 1), atol=1e-6)
        np.testing.assert_allclose(pairs[0].t, (0, 0, -2), atol=1e-6)
        self.assertEqual([], datasets.image_pairs(self.options.data))

    def test_visits_are_paired_with_the_map(self):
        image = np.full((20, 30), 9, np.uint8)
        self.write_views('s/map', {'a': 0, 'b': 1, 'c': 9}, {name: image for name in 'abc'})
        self.write_views('s/night', {'x': .9, 'y': 8}, {name: image for name in 'xy'})
        self.write_views('alone/map', {'a': 0, 'b': 1}, {name: image for name in 'ab'})
        # b is too near to x; pairs within a map with visits would be in one light.
        self.assertEqual(['alone map a-b', 's night a-x', 's night c-y'], [' '.join(pair[:3]) for pair in datasets.view_pairs(self.options.data)])

    def test_sequences(self):
        image = np.full((20, 30), 9, np.uint8)
        for name in ('set/v_scene/1.png', 'set/v_scene/2.png', 'set/v_scene/10.png', 'room/1.png', 'room/2.png', 'room/depth/1.png', 'boat/img1.pgm', 'boat/img2.pgm'):
            self.write(name, image)
        for name in ('set/v_scene/H_1_2', 'set/v_scene/H_1_10', 'boat/H1to2p'):
            self.write(name, '1 0 5\n0 1 -2\n0 0 1\n')
        pairs = datasets.image_pairs(self.options.data)
        self.assertEqual([('data', 'boat', '2', False), ('data', 'room', '2', True), ('set', 'v_scene', '2', False), ('set', 'v_scene', '10', False)],
                         [(*pair[:3], pair.light) for pair in pairs])
        self.assertEqual([5, 0, 5, 5], [pair.H[0, 2] for pair in pairs])

    def test_broken_files_are_named(self):
        self.write_views('s/walk', {'a': 0}, {'a': np.full((20, 30), 9, np.uint8)})
        self.assertEqual([], datasets.view_pairs(self.options.data))
        for file, text, message in (('poses.txt', 'a 0 0 0 0 0 0 1\na 0 0 0 0 0 0 3\n', 'poses.txt, line 2'), ('poses.txt', 'a 0 0 0 0 0 0\n', 'poses.txt, line 1'),
                                    ('cameras.txt', '', 'exactly one camera')):
            self.write('s/walk/' + file, text)
            with self.assertRaisesRegex(RuntimeError, message):
                datasets.view_pairs(self.options.data)
        self.write('set/seq/1.png', np.full((20, 30), 9, np.uint8))
        self.write('set/seq/2.png', np.full((20, 30), 9, np.uint8))
        self.write('set/seq/H_1_2', '1 2 3\n')
        self.assertEqual([], datasets.image_pairs(self.options.data))

    def test_a_task_that_fails_is_left_out(self):
        self.assertEqual([], datasets.rows_of([(datasets.read_image, 'none.png')]))


class Poses(Folders):
    def test_neighbours_by_known_depth(self):
        """A wall 4 m away, seen from places half a metre apart."""
        shift = 24
        wall = cv2.resize(np.random.default_rng(5).integers(30, 220, (12, 20)).astype(np.uint8), (320 + shift, 192), interpolation=cv2.INTER_CUBIC)
        images = {'a': wall[:, :320], 'b': wall[:, shift:]}
        self.write_views('wall_2/map', {'a': 0, 'b': .5}, images, '320 192 %d %d 160.5 96.5' % (shift * 8, shift * 8))

        def counted(*depths):
            for name, depth in zip(images, depths):
                self.write('wall_2/map/depth/%s.png' % name, np.full((192, 320), depth, np.uint16))
            pair, = datasets.view_pairs(self.options.data)
            found = [methods.described(*methods.CHAIN, 200, file) for file in pair.files]
            return poses.neighbours(pair, *found, [poses.depth_of(file) for file in pair.files], 3)
        visible, repeated, right = counted(1000, 1000)
        self.assertGreater(visible, 20)
        self.assertGreater(repeated, .7 * visible)
        self.assertGreater(right, .7 * repeated)
        self.assertLessEqual(counted(300, 300)[2], .05 * visible + 1)  # a wrong depth
        self.assertEqual(0, counted(300, 1000)[0])  # a more distant wall hides every point

    def test_controls_have_every_method(self):
        image = blocks(np.random.default_rng(2), (120, 160), 400)
        self.write_views('wall_2/map', {'a': 0, 'b': .5}, {'a': image, 'b': image[:, ::-1]}, '160 120 99 99 80 60')
        for name in 'ab':
            self.write('wall_2/map/depth/%s.png' % name, np.full((120, 160), 1000, np.uint16))
        methods_ = [method for method in poses.METHODS if method[0] != 'AKAZE' or hasattr(cv2, 'AKAZE_create')]
        kept, poses.METHODS = poses.METHODS, methods_
        self.addCleanup(setattr, poses, 'METHODS', kept)
        (found, counts), = poses.controlled(*datasets.view_pairs(self.options.data), 50, 3)
        self.assertEqual(5 * (len(methods_) + 2 * 7), len(found))  # seven methods with each of two noises
        self.assertEqual(len(methods_) + 3 * 3, len(counts))  # three for other numbers of points
        self.assertEqual(12, len(kept))

    def test_pose_of_two_views(self):
        """Small textures at fixed points of space, the nearest in front."""
        R, position, size, focal = cv2.Rodrigues(np.array([.02, .08, 0]))[0], np.array([.9, .1, 0]), (360, 480), 400

        def rendered(R, position, brightness):
            random, image = np.random.default_rng(3), np.full(size, 100, np.uint8)
            for i in range(260):
                depth = 14 - 10 * i / 260
                point = np.array([*random.uniform((-.6, -.45), (.6, .45)) * depth, depth])
                x, y, z = R @ (point - position)
                texture = np.kron(random.integers(10, 245, (4, 4)), np.ones((7, 7))).astype(np.uint8)
                left, top = int(focal * x / z + 240) - 14, int(focal * y / z + 180) - 14
                x0, y0 = max(0, left), max(0, top)
                seen = image[y0:max(0, top + 28), x0:max(0, left + 28)]
                seen[:] = texture[y0 - top:, x0 - left:][:seen.shape[0], :seen.shape[1]]
            return cv2.convertScaleAbs(image, alpha=brightness, beta=20)
        self.write_views('walk', {'a': '0', 'b': '0'}, {'a': rendered(np.eye(3), np.zeros(3), .9), 'b': rendered(R, position, .6)}, '480 360 400 400 240.5 180.5')
        q = -np.sin(np.hypot(.02, .08) / 2) / np.hypot(.02, .08) * np.array([.02, .08, 0])  # of the inverse rotation

        def errors(pose):
            self.write('walk/poses.txt', 'a 0 0 0 0 0 0 1\nb %s\n' % pose)
            self.options.detectors, self.options.points = ['SIFT'], 600
            methods.picture.cache_clear(), methods.described.cache_clear()
            poses.estimators(self.options)
            found = {tuple(row.values())[:7]: float(row['error']) for row in rows(self.folder / 'estimators.csv')}
            self.assertEqual(2 * 2 * 3 * len(methods.estimators()), len(found))
            return found
        for key, error in errors('.9 .1 0 %.9f %.9f 0 %.9f' % (*q[:2], np.cos(np.hypot(.02, .08) / 2))).items():
            if key[6] == 'findRelativePose':
                self.assertLess(error, 15 if 'relit' in key[0] else 4, key)
        # A wrong truth gives a large error; without matches there is none.
        self.assertGreater(min(errors('0 .6 0 0 .3826834 0 .9238795').values()), 25)
        self.write('walk/images/b.png', np.full(size, 90, np.uint8))
        self.assertEqual({math.inf}, set(errors('.9 .1 0 0 0 0 1').values()))


class Aligned(Folders):
    def setUp(self):
        super().setUp()
        random = np.random.default_rng(7)
        scene = blocks(random, (240, 320))
        self.write('set/still/1.png', scene)
        self.write('set/still/2.png', np.uint8(scene * .1 + 10) + random.integers(0, 12, scene.shape).astype(np.uint8))
        for name in ('one', 'two'):
            noise = cv2.normalize(cv2.GaussianBlur(random.integers(0, 256, (120, 140)).astype(np.uint8), (0, 0), 2), None, 0, 255, cv2.NORM_MINMAX)
            for k in (1, 2):
                self.write('%s/noise/%d.png' % (name, k), noise)

    def test_models_that_are_true_are_found(self):
        alignment.alignment(self.options)
        found = {(row['set'], row['image'], row['model']): row for row in rows(self.folder / 'alignment.csv')}
        self.assertLess(float(found['set', 'moved by a HOMOGRAPHY', 'HOMOGRAPHY']['error']), 1)
        for image, model, yes in (('moved by a TRANSLATION', 'TRANSLATION', '1'), ('moved by a SIMILARITY', 'AFFINE', '1'), ('moved by a HOMOGRAPHY', 'TRANSLATION', '0'),
                                  ('with noise', 'SIMILARITY', '1')):
            self.assertEqual(yes, found['set', image, model]['found'], (image, model))
        self.assertEqual('0', found['one', 'two/noise/2', 'HOMOGRAPHY']['found'])
        self.assertIn(('one', 'logo two/noise/2', 'HOMOGRAPHY'), found)

    def test_warped_views(self):
        kept, warped.WARPS = warped.WARPS, [warp for warp in warped.WARPS if warp[:2] in (('rotation', '180'), ('rotation', '90'), ('zoom', '1'), ('tilt', '1.5'))]
        self.addCleanup(setattr, warped, 'WARPS', kept)
        self.assertEqual(25, len(kept))
        warped.views(self.options)
        right = {tuple(row.values())[:5]: int(row['right']) for row in rows(self.folder / 'views.csv')}
        for kind, amount in (('rotation', '90'), ('rotation', '180'), ('tilt', '1.5')):
            self.assertGreater(right['set', 'still', kind, amount, 'matchViews'], 50, (kind, amount))
        self.assertGreater(right['set', 'still', 'zoom', '1', 'upright chain'], 50)
        self.assertLess(right['set', 'still', 'rotation', '90', 'upright chain'], 10)
        self.assertEqual(0, right['one', 'noise/2 and two/noise/2', 'unrelated', '', 'matchViews'])
        self.assertEqual({'one'}, {key[0] for key in right if key[4] == 'AffineFeature'})  # one photograph in six


class Uncertainty(unittest.TestCase):
    def test_errors_are_judged_by_their_covariance(self):
        spread, drawn = np.array([[2, 0, 0], [1, .5, 0], [-3, 1, .1]]), np.array([1, -2, 3])
        row = uncertainty.judged('q', (spread @ drawn)[None], (spread @ spread.T)[None])
        self.assertEqual(['q', 1, *(14 < opencv_iib.confidenceLimit(level, 3) for level in uncertainty.LEVELS)], row[:9])  # 14: of the drawn ones
        self.assertAlmostEqual(math.log(2) / 2, uncertainty.judged('q', np.array([[3., -4]]), np.diag([1., 4])[None])[-2])

    def test_scores_are_logarithms_of_a_density(self):
        radii = np.arange(.005, 300, .01)  # of a unit covariance, over rings
        rings = [math.exp(uncertainty.judged('q', np.array([[r, 0]]), np.eye(2)[None])[-1]) * 2 * math.pi * r * .01 for r in radii]
        self.assertAlmostEqual(1, sum(rings), delta=2e-3)

    def test_directions_err_along_documented_axes(self):
        random = np.random.default_rng(3)
        for _ in range(100):
            t = random.normal(size=3)
            t /= np.linalg.norm(t)
            b = np.cross(t, np.eye(3)[np.abs(t).argmin()])
            b /= np.linalg.norm(b)
            angle, heading = random.uniform(0, (math.pi, 2 * math.pi))
            truth = math.cos(angle) * t + math.sin(angle) * (math.cos(heading) * b + math.sin(heading) * np.cross(t, b))
            np.testing.assert_allclose(uncertainty.along_tangents(t, truth), angle * np.array([math.cos(heading), math.sin(heading)]), atol=1e-9)
            self.assertLess(np.linalg.norm(uncertainty.along_tangents(t, t)), 1e-12)
            self.assertAlmostEqual(math.pi, np.linalg.norm(uncertainty.along_tangents(t, -t)), delta=1e-6)

    def test_rectified_cameras_see_points_in_one_row(self):
        random = np.random.default_rng(4)
        for side in (-1, 1) * 20:
            R, X = cv2.Rodrigues(random.uniform(-.3, .3, 3))[0], random.uniform(4, 8, 3)
            t = np.array([side, *random.uniform(-.4, .4, 2)])
            first, second, moved = uncertainty.rectification(R, t)
            for turn in (first, second):
                np.testing.assert_allclose(turn @ turn.T, np.eye(3), atol=1e-12)
                self.assertGreater(np.linalg.det(turn), 0)
            np.testing.assert_allclose(first @ X + np.linalg.norm(t) * moved, second @ (R @ X + t), atol=1e-12)
            self.assertEqual([side, 0, 0], moved.tolist())
            self.assertGreater(first[2, 2], .8)  # still ahead


class Marked(unittest.TestCase):
    def test_correspondences_are_judged_by_epipolar_lines(self):
        """The camera steps to the side, so epipolar lines are rows."""
        first = np.random.default_rng(3).uniform(0, 200, (50, 2))
        second = first - np.column_stack([np.random.default_rng(4).uniform(4, 14, 50), np.zeros(50)])
        truth = np.array([[100, 60, 90, 60], [200, 150, 196, 150], [100, 60, 90, 160], [200, 150, 190, 90]], float)
        within, share = wxbs.shares(first, second, truth)
        self.assertEqual(within, .5)
        self.assertTrue(.42 <= share <= .5, share)
        self.assertEqual(wxbs.shares(first[:7], second[:7], truth), (0, 0))

if __name__ == '__main__':
    unittest.main()
