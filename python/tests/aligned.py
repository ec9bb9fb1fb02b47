"""Test images for the command align."""
import unittest
from unittest import mock

import numpy as np

from opencv_iib._images import decode_all, write_picture
from opencv_iib.geometry import ImageAligner
from support import InFolder, cv2, run_command, texture


@unittest.skipIf(cv2 is None, 'no cv2')
class Aligned(InFolder):

    def pictures(self, *names):
        """One picture under several names, in folders."""
        picture = cv2.resize(texture(160, 120, seed=3), (640, 480), interpolation=cv2.INTER_CUBIC)
        for name in names:
            (self.folder / name).parent.mkdir(exist_ok=True)
        return [self.write(name, picture) for name in names]

    def align(self, *arguments, status=0, calls=None, stop=None):
        """Runs the command on one thread. :param stop: an exception to raise after `calls` images."""
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

    def shifted(self, *kinds, suffix='.tif'):
        """A picture, and a part of it 30 pixels right and 20 down, each converted by its function from values of 0 to 255."""
        picture = cv2.resize(texture(160, 120, seed=3), (640, 480), interpolation=cv2.INTER_CUBIC).astype(float)
        picture = np.rint((picture - picture.min()) * (255 / np.ptp(picture)))
        for n, kind in enumerate(kinds):
            pages = [part.astype(kind) if isinstance(kind, type) else kind(part) for part in (picture, picture[20:, 30:])]
            for name, page in zip((f'r{n}{suffix}', f'i{n}{suffix}'), pages):
                write_picture(self.folder / name, *(page if isinstance(page, list) else [page]))
            yield self.folder / f'r{n}{suffix}', self.folder / f'i{n}{suffix}', *(page if isinstance(page, list) else [page] for page in pages)

    def check_shifted(self, pair, *options):
        """Checks that the part is written unchanged, at its place in the picture. :return: its transform."""
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
