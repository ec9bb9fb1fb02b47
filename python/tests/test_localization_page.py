"""The page of tools/pages/localization: what it counts, and a whole run on pictures of a wall."""
import importlib.util
import json
import os
import pathlib
import sys
import tempfile
import unittest
from contextlib import redirect_stderr, redirect_stdout
from io import StringIO
from unittest import mock

import numpy as np

from support import REPOSITORY, cv2
from test_localization import CAMERA, PLACES, evening, photograph, pose, wall

MISSING = [name for name in ('cv2', 'jinja2', 'pycolmap') if importlib.util.find_spec(name) is None]
if not MISSING:
    sys.path.insert(0, str(REPOSITORY / 'tools/pages/localization'))
    import measure
    import page
    import setups
    from sift import Found


def row(place, light, errors, images, method='recommended chain'):
    located = [('', Found(inliers=20), error, 5.) for error in errors] + [('', Found(), None, 5.)] * (images - len(errors))
    return {'place': place, 'method': method, 'light': light, **measure.summary(located)}


@unittest.skipIf(MISSING, '%s is not installed' % ', '.join(MISSING))
class Page(unittest.TestCase):

    def test_images_without_a_pose_count(self):
        sums = row('street', 'night', [(4., .1), (4., .6), (20., 1.9)], 4)
        self.assertEqual([sums[name] for name in ('images', 'found', 'within_5', 'within_25', 'median')], [4, 3, 1, 3, 4])
        self.assertIsNone(row('street', 'night', [], 4)['median'])
        self.assertEqual(page.share(20, 20), '100 % (84 to 100)')
        self.assertEqual(page.share(0, 10), '0 % (0 to 28)')

    def test_charts_are_scaled_to_the_data(self):
        chart = page.chart([row('street', 'night', [(.2, 0.), (.8, 0.)], 4)])
        self.assertEqual([text for text, _ in chart['marks']], ['0.1', '1'])
        self.assertTrue(chart['lines']['recommended chain'].endswith('%.1f,%.1f' % (page.CHART[0], page.CHART[1] / 2)))
        self.assertIsNone(page.chart([row('street', 'night', [], 4)]))

    def test_the_worst_light_counts(self):
        rows = [row(place, light, [(1., .1)] * 20, 20) for place in ('street', 'every 2', 'every 4') for light in ('night', 'fog')]
        results = {'rows': rows, 'unknown': (2, 200)}
        self.assertEqual({measured for _, measured in page.worst(results)}, {'100 %', page.share(2, 200)})
        rows[3], results['unknown'] = row('every 2', 'fog', [(1., .1)] * 17, 20), (3, 200)
        self.assertEqual([measured for _, measured in page.worst(results)], ['100 %', '100 %', '85 %', '100 %', page.share(3, 200)])

    def test_a_run(self):
        with tempfile.TemporaryDirectory() as folder:
            data, out = pathlib.Path(folder, 'data'), pathlib.Path(folder, 'out')
            for light, places, lit in (('map', PLACES, lambda grey: grey), ('night', [(-1.2, .1), (.2, .2)], evening)):
                (data / light / 'images').mkdir(parents=True)
                (data / light / 'cameras.txt').write_text('# CAMERA\n1 ' + CAMERA.replace(',', ' '))
                lines = ['# name']
                for n, place in enumerate(places):
                    cv2.imwrite(str(data / light / 'images' / ('%d.png' % n)), photograph(wall(3), pose(*place), lit))
                    half = cv2.Rodrigues(pose(*place)[:3, :3].T)[0].ravel() / 2
                    lines.append(' '.join(map(str, [n, *place, 0, *half, (1 - half @ half) ** .5])))  # of a small angle
                (data / light / 'poses.txt').write_text('\n'.join(lines))
            with mock.patch.object(sys, 'argv', ['page.py', str(data), str(out)]), redirect_stderr(StringIO()), \
                    redirect_stdout(StringIO()), mock.patch.dict(os.environ), mock.patch.object(measure, 'POINTS', 400):
                os.environ.pop('OPENCV_TEST_DATA_PATH', None)
                page.main()
            with mock.patch.object(sys, 'argv', ['setups.py', str(out / 'setups.csv'), str(data)]), mock.patch.object(setups, 'SETUPS', ('',)), \
                    redirect_stderr(StringIO()):
                setups.main()
            self.assertEqual([line.split(',')[:6] for line in (out / 'setups.csv').read_text().splitlines()[1:2]],
                             [['1.4 m apart', '', 'night', '2', '2', '2']])
            results, text = json.loads((out / 'results.json').read_text()), (out / 'index.html').read_text()
            video = cv2.VideoCapture(str(out / 'night.webm'))
            self.assertGreater(np.std(video.read()[1]), 10)
            self.assertEqual(cv2.imread(str(out / 'night.jpg')).shape, (300, 800, 3))
        rows = [r for r in results['rows'] if r['place'] == 'street']
        self.assertEqual([r['method'] for r in rows], [*measure.METHODS, 'opencv-iib localize'])
        self.assertEqual([r['within_5'] for r in rows if r['method'] == 'recommended chain'], [2])
        for r in rows[len(measure.METHODS):]:
            np.testing.assert_allclose(r['errors'], rows[0]['errors'], atol=1e-4, err_msg='the command finds the same')
        self.assertEqual(len(results['seasons']), 1)
        self.assertIn('<b>100 %</b> of 2 images taken at night', text)
        self.assertIn('"told": "0.png, night: ', text)


if __name__ == '__main__':
    unittest.main()
