#!/usr/bin/python3
"""Tests of pair_list.py."""
import pathlib
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import cv2  # noqa: E402
import numpy as np  # noqa: E402

import pair_list  # noqa: E402

CAMERAS = np.array([[[50, 0, 31], [0, 52, 19], [0, 0, 1]], [[60, 0, 23], [0, 61, 34], [0, 0, 1]]], float)
R, T = np.array([[.8, 0, .6], [0, 1, 0], [-.6, 0, .8]]), np.array([-2, .4, 1.5])
SIZES, POINT = ((60, 40), (50, 70)), np.array([-.1, .2, 4])


def line(names='a b', turns='0 0', cameras=CAMERAS, rotation=R, t=T, last=(0, 0, 0, 1)):
    return ' '.join([names, turns, *('%.12g' % number for number in (*np.ravel(cameras), *np.vstack([np.column_stack([rotation, t]), last]).ravel()))])


class PairList(unittest.TestCase):
    def test_other_lines_are_refused(self):
        self.assertIsNotNone(pair_list.parsed(line() + '\r'))
        skew, none = CAMERAS.copy(), np.zeros((2, 3, 3))
        skew[0, 0, 1] = 1
        for bad in ('', 'a b', line() + ' 1', line(turns='4 0'), line(turns='0 -1'), line('a,b c'), line(cameras=skew), line(cameras=none),
                    line(rotation=np.diag([1, 1, -1])), line(rotation=2 * R), line(t=np.zeros(3)), line(last=(0, 0, 0, 2))):
            self.assertIsNone(pair_list.parsed(bad), bad)

    def test_turned_images_see_what_they_saw(self):
        """A scene point in both images, before and after they are rotated upright."""
        for first, second in np.ndindex(4, 4):
            with tempfile.TemporaryDirectory() as name:
                folder = pathlib.Path(name)
                for file, K, size, at in zip(('x/a.png', 'b.png'), CAMERAS, SIZES, (POINT, R @ POINT + T)):
                    image, (x, y, z) = np.zeros(size[::-1], np.uint8), K @ at
                    image[round(y / z), round(x / z)] = 255
                    (folder / file).parent.mkdir(exist_ok=True)
                    cv2.imwrite(str(folder / file), image)
                pair_list.write_pair(pair_list.parsed(line('x/a.png b.png', '%d %d' % (first, second))), folder, folder / 'out')
                for place, at in (('map', np.linalg.matrix_power(pair_list.QUARTER, first) @ POINT / np.linalg.norm(T)), ('of x', None)):
                    seen = cv2.imread(str(folder / 'out' / place / 'images/a.png'), cv2.IMREAD_GRAYSCALE)
                    fx, fy, cx, cy = map(float, (folder / 'out' / place / 'cameras.txt').read_text().split()[4:])
                    x, y, z, *q = map(float, (folder / 'out' / place / 'poses.txt').read_text().split()[1:])
                    if at is None:  # from the map's axes to those of the other camera
                        sine = np.linalg.norm(q[:3])
                        turn = cv2.Rodrigues(np.array(q[:3]) * (2 * np.arctan2(sine, q[3]) / sine if sine else 2))[0].T
                        at = turn @ (before - (x, y, z))
                    before = at
                    self.assertEqual(255, seen[round(fy * at[1] / at[2] + cy - .5), round(fx * at[0] / at[2] + cx - .5)], (first, second, place))


if __name__ == '__main__':
    unittest.main()
