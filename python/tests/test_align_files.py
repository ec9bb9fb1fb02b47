"""The command align keeps depths, channels, pages, pixels without data, and places on the Earth."""
import json
import unittest

import numpy as np

from aligned import Aligned
from opencv_iib._images import decode_all, decode_first, write_picture
from support import cv2, optional, run_command, texture


@unittest.skipIf(optional('tifffile') is None, 'no tifffile')
class Files(Aligned):

    def test_six_encodings_give_the_same_transform_and_are_written_as_they_were_read(self):
        kinds = (np.uint8, lambda a: a.astype(np.uint16) * 16, np.uint16, lambda a: a.astype(np.uint16) * 257,
                 lambda a: (a / 255).astype(np.float32), np.float32)
        rows = [self.check_shifted(pair)[0] for pair in self.shifted(*kinds)]
        transforms = np.array([[float(row[f't{r}{c}']) for r in '123' for c in '123'] for row in rows])
        np.testing.assert_allclose(transforms, transforms[:1].repeat(6, 0), atol=.001)  # a part has a smaller range than the whole
        for pair in self.shifted(*kinds[:4], suffix='.png'):
            self.assertEqual(self.check_shifted(pair)[0]['file'][-4:], '.png')

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
        pair[3][0][100:130, 100:150, 1] = -9999  # one channel without data; the others stay
        write_picture(pair[1], pair[3][0], no_data='-9999')
        row, = self.align(*pair[:2], '--model', 'translation', '--interpolation', 'cubic')
        page = decode_first((self.folder / 'out' / row['file']).read_bytes())
        self.assertEqual(page[130, 150, 1], -9999)
        self.assertTrue(page[130, 150, 0] >= -40 and ((page == -9999) | (page > -60)).all())

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

    def test_pages_of_another_size_are_left_out_with_a_word(self):
        pair, = self.shifted(np.uint16)
        write_picture(pair[1], *pair[3], texture(60, 40))
        for crop in ((), ('--crop',)):
            status, _, errors = run_command('align', *pair[:2], '--out', self.folder / 'out', '--model', 'translation', *crop)
            self.assertEqual((status, errors.count('i0.tif: 1 of its pages are left out')), (0, 1))

    def test_no_data_values_that_no_pixel_can_have_are_ignored(self):
        for dtype, text in ((np.uint8, '-9999'), (np.uint8, 'nan'), (np.float32, '1e39'), (np.uint16, 'none')):
            pair, = self.shifted(dtype)
            reference, image, _, (part,) = pair
            write_picture(image, part, no_data=text)
            row, = self.align(reference, image, '--model', 'translation')
            self.assertEqual(row['verdict'], 'aligned')

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
        wrong = data.replace(bytes.fromhex('af87 0300'), bytes.fromhex('af87 0c00'))  # of another type
        self.assertEqual((len(decode_all(data).geo), decode_all(wrong).geo), (2, ()))
        write_picture(image, part, geo=[(33550, 12, (np.inf, np.nan, 0))], no_data='inf')
        self.assertEqual(decode_all(image.read_bytes()).geo, ())
        self.align(reference, image, '--model', 'translation')

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
