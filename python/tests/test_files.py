"""What is written and where: nothing of the user's is replaced or removed."""
import os
import unittest
from pathlib import Path
from unittest import mock

import numpy as np

from opencv_iib import _core
from opencv_iib._files import check_outputs, new_results, only_writer, replaced, write_whole
from support import InFolder, files_end_at


WITH_LINKS = unittest.skipIf(os.name == 'nt', 'links need rights there')


class Files(InFolder):

    def names(self):
        return sorted(path.relative_to(self.folder).as_posix() for path in self.folder.rglob('*') if not path.is_dir() or path.is_symlink())

    def write(self, *names):
        for name in names:
            (self.folder / name).parent.mkdir(parents=True, exist_ok=True)
            (self.folder / name).write_text('precious')

    def expect_precious(self, *names):
        for name in names:
            self.assertEqual((self.folder / name).read_text(), 'precious', name)

    def results(self, *names, out='out'):
        """Writes results called so, of which `index` tells the names."""
        def earlier(folder):
            return Path(folder, 'index').read_text().splitlines()
        with new_results(str(self.folder / out), 'index', earlier) as part:
            for name in names:
                Path(part, name).parent.mkdir(exist_ok=True)
                Path(part, name).write_text('result')
            Path(part, 'index').write_text('\n'.join(names))

    def test_a_file_takes_its_place_when_it_is_whole(self):
        path = self.folder / 'a'
        for text in (b'one', b'two'):
            write_whole(str(path), text)
            self.assertEqual(path.read_bytes(), text)
        with self.assertRaises(KeyboardInterrupt), replaced(str(path), str(self.folder / 'b')) as parts:
            for part in parts:
                Path(part).write_text('half')
            raise KeyboardInterrupt
        with files_end_at(1), self.assertRaisesRegex(OSError, 'a cannot be written'):
            write_whole(str(path), b'three')
        self.assertEqual((self.names(), path.read_bytes()), (['a'], b'two'))

    def test_names_beside_it_are_the_users_own(self):
        mine = [f'a{end}' for end in ('.new', '.tmp', '.partial', '.old')]
        self.write(*mine)
        write_whole(str(self.folder / 'a'), b'text')
        self.expect_precious(*mine)
        longest = 'x' * 255
        write_whole(str(self.folder / longest), b'text')
        self.assertEqual(self.names(), sorted(['a', longest, *mine]))

    @WITH_LINKS
    def test_rights_links_and_devices(self):
        target = self.folder / 'disk/a'
        self.write('disk/a')
        target.chmod(0o640)
        for name, to in (('there', 'disk/a'), ('new', 'disk/b')):
            (self.folder / name).symlink_to(to)
            write_whole(str(self.folder / name), b'text')
            self.assertEqual((os.readlink(self.folder / name), (self.folder / to).read_bytes()), (to, b'text'))
        self.assertEqual(target.stat().st_mode & 0o777, 0o640)
        write_whole('/dev/null', b'text')
        for path, told in ((self.folder, 'is a folder'), (self.folder / 'no/a', 'there is no folder')):
            with self.assertRaisesRegex(OSError, told):
                write_whole(str(path), b'text')

    @WITH_LINKS
    def test_outputs_are_no_inputs(self):
        self.write('a.jpg', 'b.jpg')
        (self.folder / 'link.jpg').symlink_to('a.jpg')
        os.link(self.folder / 'a.jpg', self.folder / 'hard.jpg')
        inputs = [str(self.folder / name) for name in ('a.jpg', 'b.jpg')]
        for name in ('a.jpg', 'link.jpg', 'hard.jpg', '../%s/b.jpg' % self.folder.name):
            with self.assertRaisesRegex(FileExistsError, 'an input too'):
                check_outputs([str(self.folder / name)], inputs)
        with self.assertRaisesRegex(FileExistsError, 'another output too'):
            check_outputs([str(self.folder / 'c.jpg')] * 2, inputs)
        check_outputs([str(self.folder / 'c.jpg'), str(self.folder / 'c.csv'), '/dev/null', '-'], inputs)
        self.assertEqual(self.names(), ['a.jpg', 'b.jpg', 'hard.jpg', 'link.jpg'])
        with self.assertRaisesRegex(OSError, 'x cannot be written'):
            check_outputs([str(self.folder / ('x' * 300))], [])
        with mock.patch.object(_core, 'WholeFile', side_effect=_core.error('check the folder and its rights')), self.assertRaises(OSError):
            check_outputs([str(self.folder / 'c.jpg')], [])

    @WITH_LINKS
    def test_results_replace_their_like(self):
        self.results('a', 'sub/b', 'more/c')
        self.results('a', 'sub/d')
        self.assertEqual(self.names(), ['out/a', 'out/index', 'out/sub/d'])
        self.assertFalse((self.folder / 'out/more').exists())
        with self.assertRaises(KeyboardInterrupt), new_results(str(self.folder / 'out'), 'index', lambda folder: ['a', 'sub/d']) as part:
            Path(part, 'index').write_text('half')
            raise KeyboardInterrupt
        with self.assertRaises(KeyboardInterrupt), new_results(str(self.folder / 'none'), 'index', lambda folder: []):
            raise KeyboardInterrupt
        self.assertEqual((self.names(), (self.folder / 'none').exists()), (['out/a', 'out/index', 'out/sub/d'], False))
        (self.folder / 'link').symlink_to('disk/new')  # nothing is there yet
        (self.folder / 'disk').mkdir()
        for _ in range(2):
            self.results('a', out='link')
            self.assertTrue((self.folder / 'disk/new/a').exists() and (self.folder / 'link').is_symlink())

    @WITH_LINKS
    def test_results_replace_nothing_else(self):
        mine = ['out.partial/thesis', 'out.partial.old/thesis', 'out.old/thesis', 'precious/thesis', 'bare/index.txt']
        self.write(*mine)
        self.results('sub/a')
        self.expect_precious(*mine)
        for name in ('out/a.png', 'out/sub/notes', 'out/.hidden', 'out/.iib-abcdefgh.txt', 'out/.iib-x/a', 'out/.iib-mybackup/a'):
            self.write(name)
            with self.assertRaisesRegex(FileExistsError, '.*out holds .*, which is of no earlier run'):
                self.results('sub/a')
            self.expect_precious(name)
            (self.folder / name).unlink()
        (self.folder / 'out/.iib-abcdefgh').symlink_to('../precious')
        with self.assertRaisesRegex(FileExistsError, 'holds .iib-abcdefgh'):
            self.results('sub/a')
        for out, told in (('bare', 'holds index.txt'), ('precious/thesis', 'cannot be written')):
            with self.assertRaisesRegex(FileExistsError, told):
                self.results('a', out=out)
        self.expect_precious(*mine)

    def test_what_comes_into_the_folder_meanwhile_stays(self):
        self.results('sub/a', 'b')
        with new_results(str(self.folder / 'out'), 'index', lambda folder: ['sub/a', 'b']) as part:
            self.write('out/mine', 'out/sub/mine')
            Path(part, 'index').touch()
        self.assertEqual(self.names(), ['out/index', 'out/mine', 'out/sub/mine'])
        with self.assertRaisesRegex(FileExistsError, 'new has come there'), new_results(str(self.folder / 'to'), 'index', lambda folder: []) as part:
            for name in ('new', 'index'):
                Path(part, name).touch()
            self.write('to/new')
        self.expect_precious('out/mine', 'out/sub/mine', 'to/new')

    def test_a_killed_run_leaves_nothing_in_the_way(self):
        with mock.patch('shutil.rmtree'), self.assertRaises(RuntimeError), new_results(str(self.folder / 'out'), 'index', lambda folder: []) as part:
            Path(part, 'sub').mkdir()
            Path(part, 'sub/a').touch()
            raise RuntimeError
        self.assertTrue(list(self.folder.glob('out/.iib-*/sub/a')))
        self.results('b')
        self.assertEqual(sorted(os.listdir(self.folder / 'out')), ['b', 'index'])

    @WITH_LINKS
    def test_one_writes_at_a_time_in_python_and_cpp(self):
        out = self.folder / 'out'
        told = 'is being written by another process'
        with new_results(str(out), 'index', lambda folder: []):
            with self.assertRaisesRegex(FileExistsError, told):
                self.results('a')
            with self.assertRaisesRegex(_core.error, told):
                _core.buildMap(str(self.folder), lambda name: np.zeros((0, 0), np.uint8), str(out), 10, False, False, lambda *step: None)
        with only_writer(str(self.folder / 'a')), self.assertRaisesRegex(BlockingIOError, told), only_writer(str(self.folder / 'a')):
            pass
        (self.folder / 'link').symlink_to('a')
        with self.assertRaisesRegex(FileExistsError, 'is a link'), only_writer(str(self.folder / 'link')):
            pass


if __name__ == '__main__':
    unittest.main()
