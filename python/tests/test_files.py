"""What is written and where: nothing of the user's is replaced or removed."""
import os
import unittest
from pathlib import Path
from unittest import mock

import numpy as np

from opencv_iib import _core
from opencv_iib._files import RECORD, check_outputs, new_results, only_writer, replaced, write_whole
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

    def results(self, *names, out='out', command='measure'):
        """Writes results called so."""
        with self.started(out, command) as part:
            for name in names:
                Path(part, name).parent.mkdir(exist_ok=True)
                Path(part, name).write_text('result')
                os.utime(os.path.join(part, name), (1e9, 1e9))  # what the user writes in the same moment is newer

    def press(self):
        raise KeyboardInterrupt

    def started(self, out='out', command='measure'):
        return new_results(str(self.folder / out), command)

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
        self.assertEqual(self.names(), [f'out/{RECORD}', 'out/a', 'out/sub/d'])
        self.assertFalse((self.folder / 'out/more').exists())
        with self.assertRaises(KeyboardInterrupt), self.started() as part:
            Path(part, 'a').write_text('half')
            raise KeyboardInterrupt
        with self.assertRaises(KeyboardInterrupt), self.started('none'):
            raise KeyboardInterrupt
        self.assertEqual((self.names(), (self.folder / 'none').exists()), ([f'out/{RECORD}', 'out/a', 'out/sub/d'], False))
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
        for name in ('out/a.png', 'out/sub/notes', 'out/.hidden', 'out/.iib-part.txt', 'out/.iib-x/a'):
            self.write(name)
            with self.assertRaisesRegex(FileExistsError, '.*out holds .*, which no earlier run wrote'):
                self.results('sub/a')
            self.expect_precious(name)
            (self.folder / name).unlink()
        (self.folder / 'out/.iib-part').symlink_to('../precious')
        with self.assertRaisesRegex(FileExistsError, 'holds .iib-part'):
            self.results('sub/a')
        for out, told in (('bare', 'holds index.txt'), ('precious/thesis', 'cannot be written')):
            with self.assertRaisesRegex(FileExistsError, told):
                self.results('a', out=out)
        self.expect_precious(*mine)

    @WITH_LINKS
    def test_a_name_that_results_may_have_is_not_yet_one_of_them(self):
        self.results('a', 'b')
        os.unlink(self.folder / 'out/b')
        for make in (lambda path: path.write_text('precious'), lambda path: path.symlink_to('a')):
            for name in ('b', 'c'):
                make(self.folder / 'out' / name)
                with self.assertRaisesRegex(FileExistsError, f'holds {name}'):
                    self.results('a', 'b', 'c')
                os.unlink(self.folder / 'out' / name)
        with self.assertRaisesRegex(FileExistsError, 'holds results of measure'):
            self.results('a', command='another')
        self.write('thesis')
        record = self.folder / 'out' / RECORD
        record.write_text(record.read_text().replace('["a"', '["../thesis", "a"'))
        self.results('b')
        self.expect_precious('thesis')

    def test_a_result_that_was_changed_to_one_of_its_size_is_the_users(self):
        self.results('a')
        (self.folder / 'out/a').write_text('MINE!!')
        with self.assertRaisesRegex(FileExistsError, 'holds a, which was changed'):
            self.results('a')
        self.assertEqual((self.folder / 'out/a').read_text(), 'MINE!!')

    def test_results_of_another_command_are_told_by_its_name(self):
        self.results('a', command='localize')
        with self.assertRaisesRegex(FileExistsError, 'out holds results of localize: choose another folder'):
            self.results('a', command='align')

    def test_what_comes_into_the_folder_meanwhile_stays(self):
        self.results('sub/a', 'b', 'c')
        with self.started() as part:
            self.write('out/mine', 'out/sub/mine', 'out/b')
            Path(part, 'c').touch()
        self.assertEqual(self.names(), [f'out/{RECORD}', 'out/b', 'out/c', 'out/mine', 'out/sub/mine'])
        for name, out in (('new', 'to'), ('c', 'again')):
            self.results('c', out=out)
            with self.assertRaisesRegex(FileExistsError, name + ' has come there'), self.started(out) as part:
                for each in ('new', 'c'):
                    Path(part, each).touch()
                self.write(f'{out}/{name}')
        self.expect_precious('out/mine', 'out/sub/mine', 'out/b', 'to/new', 'again/c')

    def test_a_killed_run_leaves_nothing_in_the_way(self):
        with mock.patch('opencv_iib._files._discard'), self.assertRaises(RuntimeError), self.started() as part:
            Path(part, 'sub').mkdir()
            for name in ('sub/a', 'c', 'd.12-3.tmp'):
                Path(part, name).touch()
            raise RuntimeError
        self.results('b')
        self.assertEqual(sorted(os.listdir(self.folder / 'out')), [RECORD, 'b'])
        self.write('out/.iib-part/mine')  # of no run, which would have a record there
        with self.assertRaisesRegex(FileExistsError, 'holds .iib-part/mine'):
            self.results('b')
        self.expect_precious('out/.iib-part/mine')

    def test_a_run_that_is_killed_while_results_take_their_places_is_gone_on_with(self):
        self.results('a', 'b', 'd')

        def stop(*names, real=os.replace, left=iter(range(3))):  # two records, and a
            real(*names) if next(left, None) is not None else self.press()
        with mock.patch('os.replace', stop), mock.patch('opencv_iib._files._discard'), \
                self.assertRaises(KeyboardInterrupt), self.started() as part:
            for name in ('a', 'b', 'c'):
                Path(part, name).write_text('other')
        self.results('a')
        self.assertEqual(self.names(), [f'out/{RECORD}', 'out/a'])

    @WITH_LINKS
    def test_one_writes_at_a_time_in_python_and_cpp(self):
        out = self.folder / 'out'
        told = 'is being written by another process'
        with new_results(str(out), 'measure'):
            with self.assertRaisesRegex(FileExistsError, told):
                self.results('a')
            with self.assertRaisesRegex(_core.error, told):
                _core.buildMap(str(self.folder), lambda name: np.zeros((0, 0), np.uint8), str(out), 10, False, False, 0, lambda *step: None)
        with only_writer(str(self.folder / 'a')), self.assertRaisesRegex(BlockingIOError, told), only_writer(str(self.folder / 'a')):
            pass
        with self.assertRaisesRegex(BlockingIOError, 'has removed .*gone meanwhile'), only_writer(str(self.folder / 'gone'), is_folder=True):
            pass
        self.assertFalse((self.folder / 'gone').exists(), 'no file is made in its place')
        (self.folder / 'link').symlink_to('a')
        with self.assertRaisesRegex(FileExistsError, 'is a link'), only_writer(str(self.folder / 'link')):
            pass


if __name__ == '__main__':
    unittest.main()
