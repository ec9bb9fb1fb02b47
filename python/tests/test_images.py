"""What is read of image files, and what is found in them."""
import os
import struct
import tempfile
import warnings
import zlib
from pathlib import Path
from unittest import mock

import numpy as np

import opencv_iib
from collection import Collection
from opencv_iib.colmap import FeatureOptions
from opencv_iib._exif import SAMPLES, exif_focal_length, exif_orientation, geo_entries, gps_place, no_data, pages_of_tiff
from opencv_iib._images import decode_grey, decode_pages, in_8_bits, read_colour, read_grey, write_picture
from opencv_iib.features import DETECTORS, Features, to_colmap
from support import cv2, texture


PLAIN = 259, 1  # TIFF's compression: cv2's own loses some of floats


def encoded(image, suffix, *options):
    return cv2.imencode(suffix, image, options)[1].tobytes()


class Files(Collection):

    def test_those_that_are_no_images_are_left_out(self):
        image = cv2.imread(str(self.images / 'a.png'))
        whole, huge = encoded(image, '.jpg'), bytearray(encoded(np.zeros((9, 9), np.uint8), '.png'))
        huge[16:24] = struct.pack('>II', 100000, 100000)
        huge[29:33] = struct.pack('>I', zlib.crc32(huge[12:29]))
        thumbnail = b'\xff\xe1' + struct.pack('>H', 2 + len(whole)) + whole  # in a segment of its own
        for name, data in (('half.jpg', whole[:len(whole) // 2]), ('header.jpg', whole[:300]), ('empty.jpg', b''),
                           ('thumbnail.jpg', whole[:2] + thumbnail + whole[2:len(whole) // 2]),
                           ('half.png', encoded(image, '.png')[:5000]), ('huge.png', huge), ('broken.jpg', b'no image')):
            (self.images / name).write_bytes(data)
        os.mkfifo(self.images / 'fifo.jpg')
        Path(os.fsdecode(os.fsencode(self.images) + b'/latin\xe9.png')).touch()
        (self.images / 'link.png').symlink_to('nothing.png')
        (self.images / 'good.jpg').write_bytes(whole[:2] + b'\xff' + thumbnail + whole[2:] + b'trailer \xff\xda')
        counts = self.build()
        self.assertEqual((counts['images'], counts['failed'], len(self.lines)), (4, 10, 10))
        for told in ('its name is not UTF-8', 'broken.jpg: not an image that cv2 reads', 'empty.jpg: the file is empty', 'half.jpg: the file is cut off',
                     'half.png: the image is damaged or cut off', 'huge.png: not an image that cv2 reads: of more than 2^30 pixels'):
            self.assertTrue(any(told in line for line in self.lines), told)

    def test_other_depths_are_scaled_by_their_own_range(self):
        grey = cv2.resize(texture(160, 120, seed=3), (640, 480), interpolation=cv2.INTER_CUBIC)
        grey = ((grey - grey.min()) * (255 / np.ptp(grey))).astype(np.uint8)
        for plain in (grey, np.dstack([grey, grey[::-1], grey[:, ::-1]])):
            others = [np.dstack([plain, np.full_like(grey, 255)]).astype(np.uint16) * 257] if plain.ndim == 3 else [plain.astype(float)]
            short, file = plain.astype(np.uint16), self.folder / 'other'
            expected = []
            for image in (plain, short, short * 16, short * 257, short * 9 + 300, plain / np.float32(255), plain.astype(np.float32), *others):
                for suffix in ('.tif', '.png') if image.dtype == np.uint16 else ('.tif',):
                    file.write_bytes(encoded(image, suffix, *PLAIN * (suffix == '.tif')))
                    found = read_grey(file), read_colour(str(file))
                    expected = expected or found
                    for one, other, exact in zip(found, expected, (plain.ndim == 2, True)):  # grey of colours is rounded in two ways
                        self.assertEqual((one.dtype, one.shape), (np.uint8, other.shape))
                        np.testing.assert_allclose(one.astype(int), other, atol=0 if exact else 2)
        hot = grey.astype(np.uint16) * 9 + 300
        hot[5, 5:9] = 65535
        file.write_bytes(encoded(hot, '.tif'))
        np.testing.assert_allclose(np.delete(read_grey(file), 5, 0).astype(int), np.delete(grey, 5, 0), atol=2)
        holed = grey.astype(np.float32)
        holed[:9] = np.nan
        file.write_bytes(encoded(holed, '.tif'))
        self.assertEqual((read_grey(file)[:9].max(), read_grey(file)[9:].max()), (0, 255))
        for values in ((1e30, np.inf), (3e38, -3e38), (-np.inf, np.nan)):
            wild = grey.astype(np.float32)
            wild[5, 5:7] = values
            file.write_bytes(encoded(wild, '.tif'))
            wide = np.where(grey < 99, np.float32(values[0]), np.float32(values[1]))
            with warnings.catch_warnings():
                warnings.simplefilter('error')
                np.testing.assert_array_equal(np.delete(read_grey(file), 5, 0), np.delete(grey, 5, 0))
                if values[0] == 3e38:
                    np.testing.assert_array_equal(in_8_bits(wide, False), np.where(grey < 99, 255, 0))
        ramp = np.linspace(-1, 1, 256).reshape(16, 16)
        for kind in (np.float32, float):
            for size in (1, 3e38, np.finfo(kind).max):
                np.testing.assert_array_equal(in_8_bits((ramp * size).astype(kind), False).ravel(), np.arange(256))
        file.write_bytes(encoded(np.full((40, 40), np.nan, np.float32), '.tif'))
        with self.assertRaisesRegex(ValueError, 'other: the image holds no finite number'):
            read_colour(file)

    def test_masks_and_reduced_pages_are_no_pages(self):
        path, page = self.folder / 'masked.tif', texture(60, 40)
        write_picture(path, page, page)
        data = bytearray(path.read_bytes())
        at = pages_of_tiff(data)[0][1]
        entries = {struct.unpack_from('<H', data, at + 2 + 12 * k)[0]: at + 2 + 12 * k for k in range(struct.unpack_from('<H', data, at)[0])}
        struct.pack_into('<H', data, entries[0x0106] + 8, 4)  # a mask's pixels, which cv2 does not read
        for kind in (1, 4, 5):
            struct.pack_into('<HHII', data, entries[0x0153], 0x00FE, 4, 1, kind)  # in place of the kind of numbers
            np.testing.assert_array_equal(decode_pages(bytes(data)), [page])

    def test_pages_are_read_without_a_file(self):
        path = self.folder / 'pages.tif'
        for pages in ([texture(60, 40, seed=seed) for seed in (1, 2, 3)], [np.dstack([texture(60, 40, np.uint16, seed)] * 3) for seed in (4, 5)]):
            write_picture(path, *pages, texture(20, 10))  # and a thumbnail
            data = path.read_bytes()
            with mock.patch('builtins.open', side_effect=AssertionError), mock.patch.object(cv2, 'imreadmulti', side_effect=AssertionError):
                np.testing.assert_array_equal(decode_pages(data), pages)
                np.testing.assert_array_equal(decode_pages(data, first_alone=True), pages[:1])
            ok, written = cv2.imreadmulti(str(path), flags=cv2.IMREAD_UNCHANGED)
            np.testing.assert_array_equal(written[:len(pages)], pages)
            places, samples = pages_of_tiff(data)
            self.assertEqual((len(places), samples), (len(pages) + 1, 1 if pages[0].ndim == 2 else 3))
            with self.assertRaisesRegex(ValueError, 'damaged or cut off'):
                decode_pages(data[:places[1]] + b'\xff' * 40 + data[places[1] + 40:])
            np.testing.assert_array_equal(decode_grey(data), decode_grey(data[:places[1]] + b'\xff' * 40 + data[places[1] + 40:]))
        swapped = struct.pack('>2sHIHHHII', b'MM', 42, 8, 1, SAMPLES, 3, 1, 1 << 16) + bytes(4)
        self.assertEqual(pages_of_tiff(swapped), ([8], 1))

    def test_exif(self):
        # little-endian TIFF: one entry that points to the EXIF directory, and there a focal length of 28 mm
        tiff = struct.pack('<4sIHHHIIIHHHIHHI', b'II*\0', 8, 1, 0x8769, 4, 1, 26, 0, 1, 0xA405, 3, 1, 28, 0, 0)
        # big-endian, and there 8 mm and 1200 pixels a centimetre of the sensor, both as fractions
        big = struct.pack('>4sIHHHIIIHHHIIHHIIHHIHH8xIIII', b'MM\0*', 8, 1, 0x8769, 4, 1, 26, 0, 3, 0x920A, 5, 1, 72,
                          0xA20E, 5, 1, 80, 0xA210, 3, 1, 3, 0, 16, 2, 1200, 1)
        png, jpeg, webp = (encoded(np.zeros((40, 60), np.uint8), suffix) for suffix in ('.png', '.jpg', '.webp'))
        for exif, focal in ((tiff, 28 / 35 * 600), (big, 8 * 1200 / 10)):
            for name, data in (('JPEG', jpeg[:2] + b'\xff\xe1' + struct.pack('>H', len(exif) + 8) + b'Exif\0\0' + exif + jpeg[2:]),
                               ('PNG', png[:33] + struct.pack('>I', len(exif)) + b'eXIf' + exif + bytes(4) + png[33:]),
                               ('WebP', webp + b'EXIF' + struct.pack('<I', len(exif)) + exif), ('TIFF', exif)):
                with self.subTest(name):
                    self.assertAlmostEqual(exif_focal_length(data, 600, 400), focal)
        for data in (png, jpeg, webp, b'', tiff[:-9], big[:-1], b'II*\0' + b'\xff' * 90, jpeg[:2] + b'\xff\xe1\0\x08Exif\0\0'):
            self.assertIsNone(exif_focal_length(data, 600, 400))

    def test_tiffs_of_64_bits_tell_what_those_of_32_do(self):
        for order, head in (('<', b'II+\0'), ('>', b'MM\0+')):
            values = struct.pack(order + '9d', .5, .5, 0, 0, 0, 0, 5e5, 4e6, 0)
            entries = [(0x112, 3, 1, struct.pack(order + 'H6x', 6)), (33550, 12, 3, struct.pack(order + 'Q', 16)),
                       (33922, 12, 6, struct.pack(order + 'Q', 40)), (0xA481, 2, 6, b'-9999\0\0\0')]
            data = head + struct.pack(order + 'HHQ', 8, 0, 88) + values + struct.pack(order + 'Q', len(entries))
            data += b''.join(struct.pack(order + 'HHQ', tag, kind, count) + value for tag, kind, count, value in entries) + bytes(8)
            self.assertEqual((exif_orientation(data), no_data(data), geo_entries(data)),
                             (6, '-9999', [(33550, 12, (.5, .5, 0)), (33922, 12, (0, 0, 0, 5e5, 4e6, 0))]))
            for place in (8, 88, 104, 108, 124, 128):  # of the directory, its length, and entries that lead nowhere
                wild = data[:place] + b'\xff' * 8 + data[place + 8:]
                self.assertIn(exif_orientation(wild), (1, 6))
                self.assertTrue(len(geo_entries(wild)) < 3 and exif_focal_length(wild, 60, 40) is None)
            self.assertEqual((exif_orientation(data[:90]), no_data(data[:90]), geo_entries(data[:90])), (1, '', []))

    def test_exif_of_wrong_types_tells_nothing(self):
        for tag in (0x112, 0x8769, 0x8825):
            for text in (b'x\0\0\0', bytes(4)):  # a text, where numbers belong
                data = struct.pack('<4sIHHHI', b'II*\0', 8, 1, tag, 2, 4) + text + bytes(4)
                with self.subTest(tag=tag), tempfile.TemporaryDirectory() as folder:
                    self.assertEqual((exif_orientation(data), exif_focal_length(data, 60, 40)), (1, None))
                    Path(folder, 'a.tif').write_bytes(data)
                    self.assertIsNone(gps_place(f'{folder}/a.tif'))


class Found(Collection):

    def test_every_detector(self):
        image = read_grey(self.images / 'a.png')
        for name in DETECTORS:
            with self.subTest(name):
                try:
                    features = Features(FeatureOptions(name, 100))
                except ValueError as e:  # OpenCV 5 has three of them no more
                    self.assertIn(name, ('AKAZE', 'BRISK', 'KAZE'))
                    self.assertRegex(str(e), f'^cv2 5.* has no {name}')
                    continue
                rows, codes = features(image)
                self.assertTrue(20 < len(rows) <= 100)
                turned = Features(FeatureOptions(name, 100, orientation=True))(image)
                np.testing.assert_array_equal(turned[0], rows)
                self.assertGreater((turned[1] != codes).any(1).mean(), .8)

    def test_the_recommended_chain_is_the_default(self):
        features, iib = Features(FeatureOptions(points=150)), opencv_iib.IIB.createRecommended(150)
        image = read_grey(self.images / 'a.png')
        keypoints, codes = iib.detectAndCompute(image)
        for found, expected in zip(features(image), (opencv_iib.keypoints_to_array(keypoints), codes)):
            np.testing.assert_array_equal(found, expected)
        self.assertEqual((features.extractor.getScaleFactor(), features.level_sizes()),
                         (iib.getScaleFactor(), iib.levelSizes()))

    def test_larger_images_are_reduced_and_points_stay_in_their_pixels(self):
        image = cv2.resize(texture(160, 120, seed=4), (641, 480), interpolation=cv2.INTER_CUBIC)
        rows, codes = Features(FeatureOptions(points=200, max_size=320))(image)
        small, plain = Features(FeatureOptions(points=200))(cv2.resize(image, (320, 240), interpolation=cv2.INTER_AREA))
        np.testing.assert_array_equal(codes, plain)
        np.testing.assert_allclose(rows[:, :2] + .5, (small[:, :2] + .5) * (641 / 320, 2), rtol=1e-6)
        np.testing.assert_allclose(rows[:, 2], small[:, 2] * 641 / 320, rtol=1e-6)
        np.testing.assert_array_equal(Features(FeatureOptions(points=200, max_size=641))(image)[0],
                                      Features(FeatureOptions(points=200))(image)[0])

    def test_coordinates_of_colmap(self):
        rows = np.array([[10, 20, 31, 90, 1, 0, -1], [0, 0, 2, -1, 1, 0, -1]], np.float32)
        np.testing.assert_allclose(to_colmap(rows), [[10.5, 20.5, 15.5, np.pi / 2], [.5, .5, 1, 0]], rtol=1e-6)

    def test_names_in_any_case(self):
        self.assertEqual(FeatureOptions('orb', preset=opencv_iib.Preset.SMALL), FeatureOptions('ORB', preset='small'))
        with self.assertRaisesRegex(ValueError, 'no preset LARGE: there are DEFAULT, .*UNIVERSAL'):
            FeatureOptions(preset='large').check()
