"""The command align."""
import os
import re
import shutil
import unittest
import zlib
from pathlib import Path
from unittest import mock

import numpy as np

from aligned import Aligned
from opencv_iib._files import RECORD, write_whole
from opencv_iib.align import align
from support import REPOSITORY, cv2, run_command, texture

SCENES = REPOSITORY / 'tools/synthetic'


class Align(Aligned):

    @unittest.skipUnless((SCENES / 'H_view_panned').exists(), 'the scenes are not beside these tests')
    def test_a_camera_that_was_turned_and_other_light(self):
        other = self.write('other.png', texture(640, 480, seed=8))
        (self.folder / 'text.png').write_text('no image')
        images = [SCENES / 'view_panned.jpg', SCENES / 'view_overcast.jpg', Path(other), self.folder / 'text.png']
        status, out, _ = run_command('align', SCENES / 'view_noon.jpg', *images, '--out', self.folder / 'out')
        self.assertEqual(status, 4)
        self.assertIn('2 of 4 images are aligned', out)
        rows = sorted(self.rows('out/transforms.csv'), key=lambda row: images.index(Path(row['image'])))
        self.assertEqual([Path(row['image']) for row in rows], images)
        self.assertEqual([row['verdict'] for row in rows][:2], ['aligned', 'aligned'])
        self.assertRegex(rows[2]['verdict'], 'the images (may not show the same|have too few matches)')
        status, out, _ = run_command('align', SCENES / 'view_noon.jpg', images[0], '--out', self.folder / 'wrong', '--model', 'translation')
        self.assertEqual((status, 'differ by more than a translation' in out), (3, True))
        true = np.linalg.inv(np.loadtxt(SCENES / 'H_view_panned'))
        for row, expected in zip(rows, (true, np.eye(3))):
            found = np.array([row[f't{r}{c}'] for r in '123' for c in '123'], float).reshape(3, 3)
            corners = np.array([[0, 0], [639, 0], [639, 479], [0, 479]], float)[:, None]
            away = np.linalg.norm(cv2.perspectiveTransform(corners, found) - cv2.perspectiveTransform(corners, expected), axis=2)
            self.assertLess(away.max(), 2)
            self.assertGreater(int(row['matches']), 50)
            self.assertLess(float(row['error_top_left']), 1.25)  # off by .52
            self.assertEqual(cv2.imread(str(self.folder / 'out' / row['file'])).shape,
                             cv2.imread(str(self.folder / 'out/reference.jpg')).shape)
        page = (self.folder / 'out/index.html').read_text()
        self.assertEqual((page.count('type="range"'), page.count('<p>')), (2, 2))

    def test_a_series_through_its_neighbours(self):
        """Pictures that get darker and move: the last ones have no transform to the first one."""
        random = np.random.default_rng(4)
        scene = cv2.resize(texture(170, 130, seed=3), (680, 520), interpolation=cv2.INTER_CUBIC)
        moves = [(2 * k, k) for k in range(4)]
        paths = []
        for k, (x, y) in enumerate(moves):
            seen = scene[y:y + 480, x:x + 640].astype(float)
            # each exposure shows its own range of grey
            exposed = np.clip((seen - 55 * k) * 3, 0, 255) + random.normal(0, 1, seen.shape)
            paths.append(self.write(f'{k}.png', np.clip(exposed, 0, 255).astype(np.uint8)))
        direct = align(paths[0], paths[1:], self.folder / 'direct')
        self.assertFalse(direct[-1].transform)
        done = align(paths[0], paths[1:], self.folder / 'out', chain=True)
        self.assertEqual([each.verdict.split()[0] for each in done], ['aligned'] * 3)
        self.assertEqual(done[-1].verdict, 'aligned through 2.png')
        self.assertTrue(done[-1].file)
        for each, (x, y) in zip(done, moves[1:]):
            np.testing.assert_allclose(np.reshape(each.transform, (3, 3)) @ (320, 240, 1), (320 + x, 240 + y, 1), atol=2)
        self.assertGreater(min(done[-1].errors), max(done[-2].errors), 'errors add up')
        self.assertEqual(run_command('align', paths[0], *paths[1:], '--out', self.folder / 'out', '--chain')[0], 0)

    def test_names_and_folders(self):
        paths = self.pictures('reference.png', 'a&b.png', 'more/a&b.png', 'more/reference.png')
        out = self.folder / 'out'
        for _ in range(2):
            done = align(paths[0], paths, str(out), 0)
            self.assertEqual([each.name for each in done], paths[1:], 'the reference is not compared with itself')
            self.assertEqual([each.file for each in done], ['a&b.png', 'a&b_2.png', 'reference_2.png'])
        self.assertEqual(sorted(os.listdir(out)), [RECORD, 'a&b.png', 'a&b_2.png', 'align.json', 'index.html', 'reference.png', 'reference_2.png', 'transforms.csv'])
        page = (out / 'index.html').read_text()
        self.assertIn('a%26b_2.png', page)
        self.assertIn('more/a&amp;b.png, aligned', page)
        self.assertLess(page.index('name="viewport"'), page.index('loading="lazy"'))
        self.check_mistake('but the reference', 'align', *paths[:1] * 2, '--out', out)
        self.assertEqual(run_command('align', *paths[:2], '--out', self.folder / 'new', '--model', 'similarity')[0], 0)
        self.assertEqual(run_command('align', paths[0], self.write('t.png', texture(300, 200, seed=9)), '--out', self.folder / 'n')[0], 3)

    def test_the_page_is_in_the_order_of_people(self):
        paths = self.pictures('r.png', 'B1.png', 'B10.png', 'a.png', 'b2.png')  # a shell's order of a pattern
        align(paths[0], paths[1:], str(self.folder / 'out'))
        self.assertEqual(re.findall(r'src="(\w+\.png)"\nalt', (self.folder / 'out/index.html').read_text()), ['a.png', 'B1.png', 'b2.png', 'B10.png'])
        self.assertEqual([row['file'] for row in self.rows('out/transforms.csv')], ['a.png', 'B1.png', 'b2.png', 'B10.png'])
        for images in ([self.folder], [self.folder / '*.png']):
            self.assertEqual([Path(each.name).name for each in align(paths[0], images, str(self.folder / 'out'))], ['a.png', 'B1.png', 'b2.png', 'B10.png'])

    @unittest.skipIf(os.name == 'nt', 'such names cannot be had there')
    def test_one_image_ends_nothing(self):
        paths = self.pictures('r.png', 'a.png', 'b.png', 'x' * 251 + '.png')
        bytes_ = Path(paths[1]).read_bytes()
        paths.append(str(self.folder / 'caf\udce9.png'))
        paths.append(str(self.folder / ('\u00e9' * 127)))  # 254 bytes without a suffix
        for path in paths[-2:]:
            Path(path).write_bytes(bytes_)
        long = self.write('long.png', np.zeros((2, 32767), np.uint8))

        def opened(path, *arguments, real=open, **more):
            if path == paths[1]:
                raise PermissionError(13, 'Permission denied', path)
            return real(path, *arguments, **more)
        with mock.patch('opencv_iib._files.open', opened, create=True):
            status, out, _ = run_command('align', paths[0], *paths[1:], long, '--out', self.folder / 'out')
        self.assertEqual(status, 4)
        verdicts = [row['verdict'] for row in self.rows('out/transforms.csv')]
        self.assertEqual(verdicts[:3] + verdicts[4:], ['Permission denied', *['aligned'] * 4])
        self.assertRegex(verdicts[3], '32767 x 2 pixels.*32766')
        self.check_error('32767 x 2 pixels', 'align', long, *paths, '--out', self.folder / 'out')

    def test_an_interruption_keeps_what_is_done_and_the_same_call_goes_on(self):
        paths = self.pictures('r.png', 'a.png', 'b.png', 'c.png', 'd.png')
        rows = self.align(*paths, calls=2, stop=KeyboardInterrupt, status=130)
        self.assertEqual([row['file'] for row in rows], ['a.png', 'b.png'])
        self.assertEqual(sorted(os.listdir(self.folder / 'out')), [RECORD, 'a.png', 'align.json', 'b.png', 'index.html', 'reference.png', 'transforms.csv'])
        first = (self.folder / 'out/a.png').stat().st_ino
        rows = self.align(*paths, calls=1, stop=OSError('the disk has gone'), status=1)
        self.assertEqual([row['file'] for row in rows], ['a.png', 'b.png', 'c.png'])
        rows = self.align(*paths, calls=1)
        self.assertEqual([row['file'] for row in rows], ['a.png', 'b.png', 'c.png', 'd.png'])
        self.assertEqual((self.folder / 'out/a.png').stat().st_ino, first)
        os.utime(paths[1], (1, 1))
        self.align(*paths, calls=0)
        with open(paths[1], 'ab') as file:
            file.write(b'more')
        self.align(*paths, calls=1)
        self.align(*paths, '--model', 'affine', calls=4)
        self.assertEqual(len(self.align(*paths[:2], '--model', 'affine', calls=0)), 1)
        self.assertEqual(sorted(os.listdir(self.folder / 'out')), [RECORD, 'a.png', 'align.json', 'index.html', 'reference.png', 'transforms.csv'])

    def test_a_call_that_is_killed_while_pictures_are_replaced_leaves_none_of_other_options(self):
        paths = self.pictures('r.png', 'a.png', 'b.png', 'c.png')[:3]
        cv2.imwrite(paths[2], cv2.warpAffine(cv2.imread(paths[1], 0), np.array([[1, .02, 20], [-.02, 1, 30.]]), (640, 480)))
        cv2.imwrite(paths[1], cv2.imread(paths[1], 0)[30:, 40:])
        pictures = ('a.png', 'b.png', 'reference.png')
        for options in (('--interpolation', 'nearest'), ('--crop',)):
            shutil.rmtree(self.folder / 'out', ignore_errors=True)
            self.align(*paths, *options)
            expected = [zlib.crc32((self.folder / 'out' / name).read_bytes()) for name in pictures]
            for writes in (0, 1, 2):
                shutil.rmtree(self.folder / 'out')
                self.align(*paths)

                def written(*content, real=write_whole, left=[writes]):
                    left[0] -= 1
                    if left[0] < 0:
                        raise GeneratorExit  # as after a kill, nothing is written after it
                    real(*content)
                with mock.patch('opencv_iib._images.write_whole', written), self.assertRaises(GeneratorExit):
                    run_command('align', *paths, *options, '--out', self.folder / 'out')
                for now in ((), options):
                    self.align(*paths, *now)
                self.assertEqual([zlib.crc32((self.folder / 'out' / name).read_bytes()) for name in pictures], expected, writes)

    def test_folders_and_patterns(self):
        paths = self.pictures('r.png', 'f/1.png', 'f/2.png', 'f/more/1.png', '[x].png')
        for images, count in (([self.folder / 'f'], 3), ([self.folder / 'f/*.png', paths[1]], 2), ([paths[4], self.folder / '[f]/**/*.png'], 4)):
            self.assertEqual(len(self.align(paths[0], *images)), count)
        self.assertEqual(run_command('align', paths[0], self.folder / 'f', '--out', self.folder / 'f/out')[0], 0)
        status, out, _ = run_command('align', paths[0], self.folder / 'f', '--out', self.folder / 'f/out')
        self.assertEqual((status, out.splitlines()[-1][-25:]), (0, '3 of 3 images are aligned'))
        for _ in range(2):  # a pattern excludes folders and earlier results
            out = run_command('align', paths[0], self.folder / 'f/**', '--out', self.folder / 'f/out')[1]
            self.assertEqual(out.splitlines()[-1][-25:], '3 of 3 images are aligned')

    def test_crop_is_what_all_show(self):
        pairs = list(self.shifted(np.uint8, lambda a: np.rot90(a, 2).astype(np.uint8), suffix='.png'))  # the second image shows the other corner
        reference, image, (whole,), _ = pairs[0]
        cv2.imwrite(str(self.folder / 'left.png'), whole[:450, :600])
        rows = self.align(reference, image, self.folder / 'left.png', '--model', 'translation', '--crop')
        for name, at in ((rows[0]['file'], 1), (rows[1]['file'], 1), ('reference.png', 0)):
            picture = cv2.imread(str(self.folder / 'out' / name), -1)
            self.assertTrue(all(abs(size - expected) < 3 for size, expected in zip(picture.shape, (430, 570))), picture.shape)
            self.assertGreater(np.corrcoef(picture[2:-2, 2:-2].ravel(), whole[22:22 + picture.shape[0] - 4, 32:32 + picture.shape[1] - 4].ravel())[0, 1], .95)
        before = (self.folder / 'out' / rows[0]['file']).stat().st_ino
        self.align(reference, image, self.folder / 'left.png', '--model', 'translation', '--crop', calls=0)
        self.assertEqual((self.folder / 'out' / rows[0]['file']).stat().st_ino, before)
        self.align(reference, image, '--model', 'translation', '--crop', calls=0)  # all images show more now
        self.assertGreater(cv2.imread(str(self.folder / 'out' / rows[0]['file'])).shape[1], 600)

    def test_masks_and_reduced_images(self):
        picture = cv2.resize(texture(160, 120, seed=3), (640, 480), interpolation=cv2.INTER_CUBIC)
        other, masks = picture[20:, 30:].copy(), self.folder / 'masks'
        banner = cv2.resize(texture(100, 70, seed=8), (400, 280), interpolation=cv2.INTER_CUBIC)
        first = picture.copy()
        for image in (first, other):  # does not move
            image[:280, :400] = banner
        paths = [self.write(name, image) for name, image in (('r.png', first), ('i.png', other))]
        masks.mkdir()
        self.check_mistake('has no mask of any image: that of r.png would be r.png.png', 'align', *paths, '--out', self.folder / 'out', '--mask', masks)
        for name, image in (('r.png.png', first), ('i.png.png', other)):
            mask = np.full(image.shape, 255, np.uint8)
            mask[:300, :420] = 0
            cv2.imwrite(str(masks / name), mask)
        for options in ((), ('--max-size', '320')):
            row, = self.align(*paths, '--model', 'translation', '--mask', masks, *options)
            np.testing.assert_allclose([float(row['t13']), float(row['t23'])], [30, 20], atol=.3)
        found, = align(paths[0], paths[1:], self.folder / 'out')  # the transform of the larger part
        np.testing.assert_allclose(found.transform[2:6:3], [30, 20], atol=.3)
        self.assertIn('moved otherwise', str(found))
        cv2.imwrite(str(masks / 'r.png.png'), mask)
        self.check_error('its mask .* has 610 x 460 pixels, and the image 640 x 480', 'align', *paths, '--out', self.folder / 'out', '--mask', masks)
        self.check_mistake('there is no mask', 'align', *paths, '--out', self.folder / 'out', '--mask', self.folder / 'gone')
