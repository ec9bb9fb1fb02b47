"""A whole run of tools/localization on pictures of a wall."""
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
from wall import CAMERA, PLACES, evening, photograph, pose, wall

MISSING = [name for name in ('cv2', 'pycolmap') if importlib.util.find_spec(name) is None]
if not MISSING:
    sys.path.insert(0, str(REPOSITORY / 'tools/localization'))
    import measure
    import setups
    import uncertainty  # of tools/evaluation, where measure looks, too


@unittest.skipIf(MISSING, '%s is not installed' % ', '.join(MISSING))
class Measured(unittest.TestCase):

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
            with mock.patch.object(sys, 'argv', ['measure.py', str(data), str(out)]), redirect_stderr(StringIO()), \
                    redirect_stdout(StringIO()), mock.patch.dict(os.environ), mock.patch.object(measure, 'POINTS', 400):
                os.environ.pop('OPENCV_TEST_DATA_PATH', None)
                measure.main()
            with mock.patch.object(sys, 'argv', ['setups.py', str(out / 'setups.csv'), str(data)]), mock.patch.object(setups, 'SETUPS', ('',)), \
                    redirect_stderr(StringIO()):
                setups.main()
            self.assertEqual([line.split(',')[:6] for line in (out / 'setups.csv').read_text().splitlines()[1:2]],
                             [['1.4 m apart', '', 'night', '2', '2', '2']])
            with mock.patch.object(uncertainty, 'MAPPED', 400), redirect_stderr(StringIO()):
                rows = uncertainty.judge_locations(data / 'night', *uncertainty.searches(data / 'night')[0])
            self.assertEqual([row[1:5] for row in rows], [['night', f'{n}.png, map', f'{what} of Localizer', 1] for n in range(2) for what in ('centre', 'rotation')])
            self.assertTrue(all(row[-3] == 1 for row in rows), 'an error is outside the limit of 99 %')
            results, world = json.loads((out / 'results.json').read_text()), (out / 'world.js').read_text()
            video = cv2.VideoCapture(str(out / 'night.webm'))
            self.assertGreater(np.std(video.read()[1]), 10)
            self.assertEqual(cv2.imread(str(out / 'night.jpg')).shape, (300, 800, 3))
        rows = [r for r in results['rows'] if r['place'] == 'street']
        self.assertEqual([r['method'] for r in rows], [*measure.METHODS, 'opencv-iib localize'])
        self.assertEqual([r['within_5'] for r in rows if r['method'] == 'recommended chain'], [2])
        for r in rows[len(measure.METHODS):]:
            np.testing.assert_allclose(r['errors'], rows[0]['errors'], atol=1e-4, err_msg='the command finds the same')
        self.assertEqual(len(results['seasons']), 1)
        self.assertIn('"text":"0.png, night: ', world)
