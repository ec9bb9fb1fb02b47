"""The command demo."""
import re
import unittest

import numpy as np

from collection import Collection
from opencv_iib.demo import demo, draw
from support import REPOSITORY, cv2, run_command


class Demo(Collection):

    def test_picture_and_line(self):
        a, b, out = self.images / 'a.png', self.images / 'b.png', self.folder / 'demo.png'
        status, text, _ = run_command('demo', a, b, '--points', '200', '--out', out, '--preset', 'small', '--detector', 'orb')
        self.assertEqual(status, 0)
        self.assertRegex(text, r'^IIB \d+ of \d+ consistent, ORB\b.*\npicture: .*demo.png\n$')
        self.assertEqual(cv2.imread(str(out)).shape, (2 * (44 + 640 * 300 // 400), 2 * 640, 3))
        noise = self.folder / 'noise.png'
        cv2.imwrite(str(noise), np.random.default_rng(1).integers(0, 256, (200, 200), np.uint8))
        status, text, hint = run_command('demo', a, noise, '--out', out)
        self.assertEqual(status, 3)
        self.assertRegex(text, r'^IIB: no homography found in \d+ matches, SIFT.*, ORB')
        self.assertIn('same place', hint)
        for size, detector in ((200, 'hessian'), (200, 'sift'), (1, 'hessian'), (1, 'orb')):
            cv2.imwrite(str(noise), np.full((size, size), 7, np.uint8))
            status, text, hint = run_command('demo', noise, b, '--out', out, '--detector', detector)
            self.assertEqual((status, hint.count('\n')), (3, 1))
            self.assertRegex(text, '^IIB: no homography found in 0 matches, (SIFT|ORB): no homography found in 0 matches')

    def test_a_strip_of_an_image_makes_no_picture_without_end(self):
        images = [np.zeros(shape, np.uint8) for shape in ((60000, 30, 3), (30, 60000, 3))]
        points = np.array([[15, 59999], [0, 0]], np.float32)
        for count in (1, 577):
            picture = draw(images, np.repeat(points[:1], count, 0), np.repeat(points[1:], count, 0), np.ones(count, bool), [])
            self.assertEqual(picture.shape, (44 + 1280, 2 * 640, 3))

    @unittest.skipUnless((REPOSITORY / 'tools/synthetic/day.png').exists(), 'the images are not beside these tests')
    def test_it_counts_as_that_of_cpp(self):
        pair = [str(REPOSITORY / f'tools/synthetic/demo_{light}.jpg') for light in ('noon', 'night')]
        iib, sift, orb = demo(*pair, str(self.folder / 'demo.png'))
        claim = re.search(r'`IIB \d+ of (\d+) correct, SIFT \d+ of \d+ correct, ORB \d+ of (\d+) correct`',
                          (REPOSITORY / 'README.md').read_text())
        self.assertEqual((iib.name, sift.name, orb.name), ('IIB', 'SIFT', 'ORB'))
        self.assertEqual([len(iib.good), len(orb.good)], [int(claim[1]), int(claim[2])])
