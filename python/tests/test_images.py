"""Reading image files and their EXIF data."""
import contextlib
import io
import os
import struct
import unittest
import warnings
import zlib
from pathlib import Path
from unittest import mock

import numpy as np

import opencv_iib
from collection import Collection
from opencv_iib.colmap import FeatureOptions
from opencv_iib._exif import exif_focal_length, exif_orientation, gps_place
from opencv_iib._image_file import ImageFile
from opencv_iib._image_names import find_images
from opencv_iib._images import decode, decode_all, decode_first, in_8_bits
from opencv_iib._tiff import tiff_bytes
from opencv_iib.features import DETECTORS, Features, to_colmap
from support import cv2, optional, texture

tifffile = optional('tifffile')
PLAIN = 259, 1  # TIFF's compression; cv2's default is lossy for floats


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
        for message in ('its name is not UTF-8', 'broken.jpg: not an image that cv2 reads', 'empty.jpg: the file is empty', 'half.jpg: the file is cut off',
                     'half.png: the image is damaged or cut off', 'huge.png: not an image that cv2 reads: of more than 2^30 pixels'):
            self.assertTrue(any(message in line for line in self.lines), message)

    def test_images_that_this_cv2_does_not_read_are_skipped_with_a_word(self):
        grey = texture(60, 40)
        for name in ('a.jpe', 'b.JFIF', 'c.pnm', 'd.avif', 'e.heic', 'f.HEIC', 'g.gif'):
            (self.images / name).write_bytes(encoded(grey, '.jpg') if name < 'd' else b'what no cv2 reads')
        cv2.imwrite(str(self.images / 'h.png'), grey)
        (self.images / 'h.png').rename(self.images / 'h.gif')  # in a format that every cv2 reads
        (self.images / 'notes.txt').touch()
        lines = []
        self.assertEqual(find_images(self.images, lines.append), ['a.jpe', 'a.png', 'b.JFIF', 'b.png', 'c.pnm', 'h.gif', 'more/c.png'])
        self.assertRegex(lines.pop(), r'images: 4 files are skipped, which the installed cv2 does not read \(1 .avif, 1 .gif, 2 .heic\): convert them$')
        self.assertEqual((self.build()['images'], len(self.lines)), (7, 1))

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
                    found = ImageFile(file).grey, ImageFile(str(file)).colour
                    expected = expected or found
                    for one, other, exact in zip(found, expected, (plain.ndim == 2, True)):  # grey of colours is rounded in two ways
                        self.assertEqual((one.dtype, one.shape), (np.uint8, other.shape))
                        np.testing.assert_allclose(one.astype(int), other, atol=0 if exact else 2)
        hot = grey.astype(np.uint16) * 9 + 300
        hot[5, 5:9] = 65535
        file.write_bytes(encoded(hot, '.tif'))
        np.testing.assert_allclose(np.delete(ImageFile(file).grey, 5, 0).astype(int), np.delete(grey, 5, 0), atol=2)
        holed = grey.astype(np.float32)
        holed[:9] = np.nan
        file.write_bytes(encoded(holed, '.tif'))
        self.assertEqual((ImageFile(file).grey[:9].max(), ImageFile(file).grey[9:].max()), (0, 255))
        for values in ((1e30, np.inf), (3e38, -3e38), (-np.inf, np.nan)):
            wild = grey.astype(np.float32)
            wild[5, 5:7] = values
            wild.view(np.uint32)[5, 5] |= 0x7F800001 if np.isnan(values).any() else 0  # a signalling NaN
            file.write_bytes(encoded(wild, '.tif'))
            wide = np.where(grey < 99, np.float32(values[0]), np.float32(values[1]))
            with warnings.catch_warnings():
                warnings.simplefilter('error')
                np.testing.assert_array_equal(np.delete(ImageFile(file).grey, 5, 0), np.delete(grey, 5, 0))
                if values[0] == 3e38:
                    np.testing.assert_array_equal(in_8_bits(wide, False), np.where(grey < 99, 255, 0))
        ramp = np.linspace(-1, 1, 256).reshape(16, 16)
        for kind in (np.float32, float):
            for size in (1, 3e38, np.finfo(kind).max):
                np.testing.assert_array_equal(in_8_bits((ramp * size).astype(kind), False).ravel(), np.arange(256))
        file.write_bytes(encoded(np.full((40, 40), np.nan, np.float32), '.tif'))
        with self.assertRaisesRegex(ValueError, 'the image holds no finite number'):
            ImageFile(file).colour

    @unittest.skipIf(tifffile is None, 'no tifffile')
    def test_pages_of_tiff(self):
        for pages in ([texture(60, 40, seed=seed) for seed in (1, 2, 3)], [np.dstack([texture(60, 40, np.uint16, seed)] * 3) for seed in (4, 5)]):
            for largest in (2**32, -1):  # offsets have 32 bits, or 64
                with mock.patch('opencv_iib._tiff.LARGEST', largest):
                    data = tiff_bytes([*pages, texture(20, 10)])  # of another size
                self.assertEqual(data[:4], b'II*\0' if largest > 0 else b'II+\0')
                for broken in (None, tifffile.TiffPage):  # cv2 reads compressions that tifffile does not
                    with mock.patch('builtins.open', side_effect=AssertionError), contextlib.ExitStack() as stack:
                        if broken:
                            stack.enter_context(mock.patch.object(broken, 'asarray', side_effect=ValueError))
                        read = decode_all(data)
                        np.testing.assert_array_equal(decode_first(data), pages[0])
                    np.testing.assert_array_equal(read.pages, pages)
                    self.assertEqual(read.left_out, 1)
        file, entry = io.BytesIO(), struct.Struct('<HHII')
        with tifffile.TiffWriter(file) as writer:
            for kind in (0, 1):
                writer.write(texture(60, 40), subfiletype=kind, metadata=None)
        for kind in (1, 4, 5):  # reduced, a mask, and both: no pages
            read = decode_all(file.getvalue().replace(entry.pack(254, 4, 1, 1), entry.pack(254, 4, 1, kind)))
            self.assertEqual((len(read.pages), read.left_out), (1, 0))
        with self.assertRaisesRegex(ValueError, 'damaged or cut off'):
            decode_all(data[:len(data) // 2])

    @unittest.skipIf(tifffile is None, 'no tifffile')
    def test_tiffs_that_cv2_alone_does_not_read_as_they_are(self):
        grey = texture(60, 40)
        plain = io.BytesIO()
        tifffile.imwrite(plain, grey, metadata=None)
        entry = struct.pack('<HHI', 0x0106, 3, 1)
        without = plain.getvalue().replace(entry, struct.pack('<HHI', 0xFDE8, 3, 1))  # no tag says what the numbers mean
        self.assertNotEqual(without, plain.getvalue())
        np.testing.assert_array_equal(decode_first(without), grey)
        np.testing.assert_array_equal(decode(without), grey)
        for channels in (2, 4, 5):  # with alpha that is not 255
            image = np.dstack([grey, grey[::-1], grey[:, ::-1], 255 - grey, grey][:channels])
            for largest in (2**32, -1):
                with mock.patch('opencv_iib._tiff.LARGEST', largest):
                    np.testing.assert_array_equal(decode_all(tiff_bytes([image])).pages, [image])
        five, width = tiff_bytes([image]), struct.Struct('<HHII')
        for wrong in (0, 1 << 24):
            with self.assertRaisesRegex(ValueError, f'it has {wrong} x 40 pixels'):
                decode(five.replace(width.pack(256, 4, 1, 60), width.pack(256, 4, 1, wrong)).replace(width.pack(256, 3, 1, 60), width.pack(256, 4, 1, wrong)))
        two = tiff_bytes([image[..., :2]])
        with mock.patch.dict('sys.modules', tifffile=None):
            np.testing.assert_array_equal(decode_first(plain.getvalue()), grey)
            for data in (without, two):
                with self.assertRaisesRegex(ValueError, r'pip install opencv-iib\[tiff\]'):
                    decode(data)

    def test_tiffs_that_are_stored_turned_are_read_as_they_are_stored(self):  # cv2 always rotates these
        image = np.arange(600, dtype=np.uint16).reshape(20, 30)
        entries = [(256, 3, 30), (257, 3, 20), (258, 3, 16), (259, 3, 1), (262, 3, 1), (273, 4, 8), (277, 3, 1), (278, 3, 20), (279, 4, 1200)]
        for orientation in range(1, 9):
            tags = sorted([*entries, (274, 3, orientation)])
            data = b'II*\0' + struct.pack('<I', 1208) + image.tobytes() + struct.pack('<H', len(tags))
            data += b''.join(struct.pack('<HHII', tag, kind, 1, value) for tag, kind, value in tags) + bytes(4)
            self.assertEqual(exif_orientation(data), orientation)
            np.testing.assert_array_equal(decode_first(data), image)
            if tifffile:
                np.testing.assert_array_equal(decode_all(data).pages, [image])

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

    def test_exif_of_tiffs_of_64_bits(self):
        for order, head in (('<', b'II+\0'), ('>', b'MM\0+')):
            data = head + struct.pack(order + 'HHQQHHQH6xQ', 8, 0, 16, 1, 0x112, 3, 1, 6, 0)
            self.assertEqual(exif_orientation(data), 6)
            for place in (8, 16, 24, 28):  # the directory's offset, its length, and entries that point beyond the file
                wild = data[:place] + b'\xff' * 8 + data[place + 8:]
                self.assertEqual((exif_orientation(wild), exif_focal_length(wild, 60, 40)), (1, None))
            self.assertEqual(exif_orientation(data[:26]), 1)

    def test_exif_of_wrong_types_is_ignored(self):
        for tag in (0x112, 0x8769, 0x8825):
            for kind, value in ((2, b'x\0\0\0'), (2, bytes(4)), (12, struct.pack('<d', np.nan))):  # a text, or numbers of 64 bits
                data = struct.pack('<4sIHHHI', b'II*\0', 8, 1, tag, kind, 4) + value + bytes(4)
                with self.subTest(tag=tag):
                    self.assertEqual((exif_orientation(data), exif_focal_length(data, 60, 40), gps_place(data)), (1, None, None))


class Found(Collection):

    def test_every_detector(self):
        image = ImageFile(self.images / 'a.png').grey
        for name in DETECTORS:
            with self.subTest(name):
                try:
                    features = Features(FeatureOptions(name, 100))
                except ValueError as e:  # OpenCV 5 no longer has three of them
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
        image = ImageFile(self.images / 'a.png').grey
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
