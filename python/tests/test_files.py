"""Outputs of commands: no file of the user is replaced or removed."""
import os
import unittest
from pathlib import Path
from unittest import mock

import numpy as np

from opencv_iib import _core
from opencv_iib._files import RECORD, Results, check_outputs, only_writer, replaced, write_whole
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
        """Writes results under these names."""
        with Results(str(self.folder / out), command) as results:
            for name in names:
                Path(results.place(name)).write_text('result')

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
        for out in ('out', 'none'):
            with self.assertRaises(KeyboardInterrupt), Results(str(self.folder / out), 'measure'):
                raise KeyboardInterrupt
        self.assertEqual((self.names(), (self.folder / 'none').exists()), ([f'out/{RECORD}', 'out/a', 'out/sub/d'], False))
        (self.folder / 'link').symlink_to('disk/new')  # the folder is empty
        (self.folder / 'disk').mkdir()
        for _ in range(2):
            self.results('a', out='link')
            self.assertTrue((self.folder / 'disk/new/a').exists() and (self.folder / 'link').is_symlink())

    @WITH_LINKS
    def test_results_replace_nothing_else(self):
        mine = ['out.partial/thesis', 'out.old/thesis', 'precious/thesis', 'bare/index.txt', 'thesis']
        self.write(*mine)
        self.results('sub/a', 'b')
        record = self.folder / 'out' / RECORD
        record.write_text(record.read_text() + '"../thesis"\n"cut o')
        for name in ('out/a.png', 'out/sub/notes', 'out/.hidden', 'out/sub/a.tmp', 'out/c'):
            self.write(name)
            with self.assertRaisesRegex(FileExistsError, '.*out holds .*, which no earlier run wrote'):
                self.results('sub/a', 'c')
            self.expect_precious(name)
            (self.folder / name).unlink()
        os.unlink(self.folder / 'out/b')
        (self.folder / 'out/b').symlink_to('../precious/thesis')
        for out, message in (('out', 'holds b'), ('bare', 'holds index.txt'), ('precious/thesis', 'cannot be written')):
            with self.assertRaisesRegex(FileExistsError, message):
                self.results('b', out=out)
        os.unlink(self.folder / 'out/b')
        with Results(str(self.folder / 'out'), 'measure') as results:
            self.write('out/mine', 'out/sub/mine')
            Path(results.place('c')).touch()
        self.assertEqual([name for name in self.names() if name.startswith('out/')], [f'out/{RECORD}', 'out/c', 'out/mine', 'out/sub/mine'])
        self.expect_precious(*mine, 'out/mine', 'out/sub/mine')
        with self.assertRaisesRegex(FileExistsError, 'out holds results of measure: choose another folder'):
            self.results('c', command='align')
        (self.folder / 'out' / RECORD).write_text('"measure"\n["c", "4-1700000000"]\n')  # as version 0.3 wrote it
        with self.assertRaisesRegex(FileExistsError, 'out holds results of measure of an earlier version: choose another folder'):
            self.results('c')

    def test_a_killed_run_leaves_nothing_in_the_way(self):
        self.results('a')
        with self.assertRaises(KeyboardInterrupt), Results(str(self.folder / 'out'), 'measure') as results:
            for name in ('sub/b', 'c'):
                Path(results.place(name) + '.12-3.tmp' * (name == 'c')).touch()
            raise KeyboardInterrupt
        self.assertEqual(self.names(), [f'out/{RECORD}', 'out/a', 'out/c.12-3.tmp', 'out/sub/b'])
        self.results('d')
        self.assertEqual(self.names(), [f'out/{RECORD}', 'out/d'])

    @WITH_LINKS
    def test_one_writes_at_a_time_in_python_and_cpp(self):
        out = self.folder / 'out'
        message = 'is being written by another process'
        with Results(str(out), 'measure'):
            with self.assertRaisesRegex(FileExistsError, message):
                self.results('a')
            with self.assertRaisesRegex(_core.error, message):
                _core.buildMap(str(self.folder), lambda name: np.zeros((0, 0), np.uint8), str(out), 10, False, False, 0, lambda *step: None)
        with only_writer(str(self.folder / 'a')), self.assertRaisesRegex(BlockingIOError, message), only_writer(str(self.folder / 'a')):
            pass
        with self.assertRaisesRegex(BlockingIOError, 'has removed .*gone meanwhile'), only_writer(str(self.folder / 'gone'), is_folder=True):
            pass
        self.assertFalse((self.folder / 'gone').exists(), 'no file is made in its place')
        (self.folder / 'link').symlink_to('a')
        for name, what in (('link', 'a link'), ('out', 'a folder')):
            with self.assertRaisesRegex(FileExistsError, f'is {what}: remove it'), only_writer(str(self.folder / name)):
                pass
