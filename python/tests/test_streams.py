"""Standard output and error of the commands, and their exit statuses."""
import io
import os
import re
import shlex
import shutil
import signal
import subprocess
import sys
import time
import unittest
from contextlib import redirect_stdout, suppress
from pathlib import Path
from unittest import mock

from opencv_iib import _streams
from opencv_iib.__main__ import _parser
from opencv_iib._progress import Progress
from support import InFolder, cv2, run_command, texture


def command(*arguments, **options):
    """A separate program, with the streams of a shell or a desktop."""
    return subprocess.run([sys.executable, '-m', 'opencv_iib', *map(str, arguments)], capture_output='stdout' not in options, **options)


class Output(unittest.TestCase):

    def test_work_goes_on_where_nobody_can_read_of_it(self):
        closed = io.StringIO()
        closed.close()
        streams = [None, closed]
        if os.path.exists('/dev/full'):
            streams.append(open('/dev/full', 'w'))
        for stream in streams:
            with self.subTest(stream), mock.patch('sys.stderr', stream):
                progress = Progress('working', 2)
                progress.shown = -100
                progress.step()
                progress.close()
                _streams.note('a line')
        for stream in streams[2:]:
            with suppress(OSError):
                stream.close()

    def test_a_name_of_two_lines_is_printed_on_one(self):
        with mock.patch('sys.stderr', io.StringIO()) as stream:
            _streams.note('a\nb.png: what\r\nelse')
        self.assertEqual(stream.getvalue(), 'a\\nb.png: what\\nelse\n')

    def test_letters_that_an_encoding_lacks(self):
        stream = io.TextIOWrapper(io.BytesIO(), 'cp1252')
        _streams.put('caf\xe9 \u65e5 \udce9\n', stream)
        self.assertEqual(stream.buffer.getvalue(), b'caf\xe9 \\u65e5 \\udce9\n')


@unittest.skipIf(cv2 is None, 'no cv2')
class Commands(InFolder):

    def setUp(self):
        super().setUp()
        picture = cv2.resize(texture(160, 120, seed=3), (320, 240), interpolation=cv2.INTER_CUBIC)
        self.a, self.b = (str(self.folder / name) for name in ('a.png', 'b.png'))
        cv2.imwrite(self.a, picture[:200, :300])
        cv2.imwrite(self.b, picture[20:220, 10:310])
        self.match = 'match', self.a, self.b, '--points', '200'
        self.out = self.folder / 'm.csv'
        self.assertEqual(run_command(*self.match, '--out', self.out)[0], 0)
        self.table = self.out.read_bytes()

    def test_a_name_that_the_terminal_cannot_show(self):
        out = self.folder / '\u65e5\u672c.csv'
        done = command(*self.match, '--out', out, env={**os.environ, 'PYTHONIOENCODING': 'cp1252'})
        self.assertEqual((done.returncode, done.stderr), (0, b''))
        self.assertIn(rb'\u65e5\u672c.csv', done.stdout)
        self.assertEqual(out.read_bytes(), self.table)

    def test_to_standard_output(self):
        for name in ('-', '/dev/stdout'):
            done = command(*self.match, '--out', name)
            self.assertEqual((done.returncode, done.stdout), (0, self.table))
            self.assertRegex(done.stderr.decode(), r'\d+ matches, \d+ refined')
            status, out, _ = run_command(*self.match, '--out', name)
            self.assertEqual((status, out), (0, self.table.decode()))
        for mode, before in (('wb', b''), ('ab', b'a line\n')):
            self.out.write_bytes(b'a line\n')
            with open(self.out, mode) as file:
                self.assertEqual(command(*self.match, '--out', '/dev/stdout', '--quiet', stdout=file).returncode, 0)
            self.assertEqual(self.out.read_bytes(), before + self.table)

    @unittest.skipIf(shutil.which('bash') is None, 'no bash')
    def test_to_the_shells_pipe(self):
        arguments = ' '.join([sys.executable, '-m', 'opencv_iib', *self.match])
        done = subprocess.run(['bash', '-c', f'{arguments} --out >(cat > {self.folder}/piped); wait $!'], capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stderr), (0, ''))
        self.assertEqual((self.folder / 'piped').read_bytes(), self.table)
        done = subprocess.run(['bash', '-c', f'{arguments} --out - | head -n 1; exit ${{PIPESTATUS[1]}}'], capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stdout), (0, self.table.decode().splitlines()[0] + '\n'))
        self.assertNotIn('Traceback', done.stderr)

    @unittest.skipUnless(os.path.exists('/dev/full'), 'no full device')
    def test_a_full_disk_behind_standard_output(self):
        with open('/dev/full', 'w') as full:
            done = command(*self.match, '--out', '-', stdout=full, stderr=subprocess.PIPE)
        self.assertEqual(done.returncode, 1)
        self.assertRegex(done.stderr.decode(), r'^match: - cannot be written: No space left[^\n]*\n$')

    @unittest.skipIf(shutil.which('bash') is None, 'no bash')
    def test_closed_streams_are_found_before_work(self):
        for out in ('-', '/dev/stdout'):
            done = subprocess.run(['bash', '-c', f'{sys.executable} -m opencv_iib match {self.a} {self.a} --out {out} >&-'], capture_output=True)
            self.assertEqual((done.returncode, done.stderr.decode()), (2, f'match: {out} cannot be written: it is not open\n'))
        done = subprocess.run(['bash', '-c', f'{sys.executable} -m opencv_iib localize --map {self.folder} --images - <&-'], capture_output=True)
        self.assertEqual((done.returncode, done.stderr), (2, b'localize: --images - needs standard input and output, and one is not open\n'))

    @unittest.skipIf(os.name == 'nt', 'no signals')
    def test_ctrl_c_once_and_once_more_at_once(self):
        # In the background of a shell, Ctrl-C is ignored, also by child processes.
        self.addCleanup(signal.signal, signal.SIGINT, signal.signal(signal.SIGINT, signal.default_int_handler))
        from wall import CAMERA, mapped
        shutil.rmtree(self.folder)
        images, out = self.folder / 'images', self.folder / 'out'
        for n in range(60):
            shutil.copytree(os.path.join(mapped(), 'dark'), images / str(n))
        localize = ['localize', '--map', os.path.join(mapped(), 'map'), '--images', images, '--out', out, '--camera', CAMERA]
        align = ['align', next(images.rglob('*.png')), images, '--out', out]
        for arguments, message in ((localize, b'interrupted\n'), (align, b'interrupted; the same command goes on from here\n')):
            for pause in (.05, None):
                begun = subprocess.Popen([sys.executable, '-m', 'opencv_iib', *map(str, arguments), '--workers', '4'], stderr=subprocess.PIPE)
                while not (out.exists() and any(out.iterdir())):
                    time.sleep(.01)
                time.sleep(.1)
                begun.send_signal(signal.SIGINT)
                if pause:
                    time.sleep(pause)
                    begun.send_signal(signal.SIGINT)
                errors = begun.communicate()[1]
                self.assertEqual((begun.returncode, errors[-len(message):]), (130, message))
                self.assertNotIn(b'terminate', errors)
                shutil.rmtree(out, ignore_errors=True)


class Help(unittest.TestCase):

    def test_it_fits_on_a_screen_and_has_an_example_that_can_be_run(self):
        for command in ('demo', 'match', 'align', 'colmap', 'hloc', 'map', 'localize', 'update'):
            with self.subTest(command), mock.patch.dict(os.environ, COLUMNS='80'), redirect_stdout(io.StringIO()) as out:
                self.assertRaises(SystemExit, _parser().parse_args, [command, '--help'])
            lines = out.getvalue().splitlines()
            self.assertLessEqual(len(lines), 40)
            self.assertRegex(lines[-1], f'^example: opencv-iib {command} ')
            self.assertEqual(_parser().parse_args(shlex.split(lines[-1])[2:]).command, command)

    def test_of_all_commands_together(self):
        with redirect_stdout(io.StringIO()) as out:
            self.assertRaises(SystemExit, _parser().parse_args, ['--help'])
        self.assertIn('example: opencv-iib demo ', out.getvalue())


class Mistakes(InFolder):

    def test_in_options_end_with_2(self):
        place = ['--images', self.folder, '--out', self.folder / 'out']
        for message, *arguments in (
                ("opencv-iib: argument command: invalid choice: 'nothing'", 'nothing'), ("--model: invalid choice: 'x' (choose from TRANSLATION, ",
                 'align', 'a', 'b', '--out', 'c', '--model', 'x'), ('workers is 3000000000', 'map', '--model', 'm', *place, '--workers', '3000000000'),
                ('points is 3000000000', 'map', '--model', 'm', *place, '--points', '3000000000'),
                ('points is 0', 'map', '--model', 'm', *place, '--points', '0'), ("invalid int value: 'many'", 'match', 'a', 'b', '--points', 'many'),
                ('points is -1', 'match', 'a', 'b', '--points', '-1'), ('max_size is 5', 'demo', 'a', 'b', '--max-size', '5'),
                ('MODEL,WIDTH,HEIGHT', 'match', 'a', 'b', '--camera', 'x'), ('FISH is not one of', 'localize', '--map', 'm', *place, '--camera', 'FISH,1,2,3'),
                ('3 cameras', 'match', 'a', 'b', *['--camera', 'simple_pinhole,9,9,9,4,4'] * 3),
                ('invalid choice', 'match', 'a', 'b', '--detector', 'eyes'), ('ratio is 2', 'colmap', self.folder, 'x.db', '--ratio', '2'),
                ('focal is -1', 'colmap', self.folder, 'x.db', '--focal=-1'), ('neither a file nor one of', 'colmap', self.folder, 'x.db', '--pairs', 'none'),
                ('invalid choice', 'colmap', self.folder, 'x.db', '--verify', 'no'), ('workers is 0', 'colmap', self.folder, 'x.db', '--workers', '0'),
                ('workers is 0', 'localize', '--map', 'm', *place, '--workers', '0'),
                ('workers is 0', 'match', 'a', 'b', '--workers', '0'), ('workers is 0', 'localize', '--map', 'm', '--images', '-', '--workers', '0'),
                ('points is -1', 'map', '--model', 'm', *place, '--points', '-1', '--orb-and-akaze'), ('neighbours is -1', 'colmap', self.folder, 'x.db', '--neighbours', '-1'),
                ('focal is nan', 'colmap', self.folder, 'x.db', '--focal', 'nan'), ('two images are needed', 'match', 'a'),
                ('unrecognized arguments: --wrong', 'align', 'a', '--out', 'c', 'b', '--wrong'), ('unrecognized arguments: d', 'demo', 'a', 'b', 'd'), ('arguments are required', 'update')):
            with self.subTest(arguments):
                status, out, errors = run_command(*arguments)
                self.assertEqual((status, out), (2, ''))
                self.assertRegex(errors, rf'^(?=[^\n]*{re.escape(message)})(opencv-iib|{arguments[0]}): [^\n]*\n$')

    @unittest.skipIf(cv2 is None, 'no cv2')
    def test_files_that_cannot_be_meant_end_with_2_before_work(self):
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(self.folder)
        os.makedirs('images/c')
        os.makedirs('nothing')
        for name in ('a.png', 'images/a.png', 'images/b.png', 'images/c/a.png', 'images/c-a.png'):
            cv2.imwrite(name, texture(60, 60))
        for name, text in (('pairs', 'a.png b.png\n'), ('empty', ''), ('itself', 'a.png a.png\n'), ('unknown', 'no image\n'), ('alike', 'c/a.png b.png\nc-a.png b.png\n'), ('imu.csv', '1,0,0,0,0,0,9.81\n')):
            Path(name).write_text(text)
        files = set(self.folder.rglob('*'))
        pairs, localize = 'match --images images --pairs', 'localize --map images --images images --out'
        for message, commands in {
                'there is no file': f'match a.png gone, match gone a.png, demo gone a.png, align gone a.png --out out, align a.png gone --out out, '
                                    f'align a.png a.png gone --out out, {localize} out --imu gone',
                'no image is called': 'align a.png images/*.jpg --out out',
                'is a folder': 'match a.png images, match a.png a.png --out images, demo a.png images, align images a.png --out out, colmap images images',
                'there is no folder': f'match a.png a.png --out gone/x.csv, match a.png a.png --picture gone/x.png, match --pairs pairs --images gone --out out, '
                                      f'colmap gone x.db, colmap images gone/x.db, hloc a.png gone/f.h5 m.h5 p, map --model gone --images images --out out, '
                                      f'map --model images --images gone --out out, localize --map gone --images images --out out, '
                                      f'localize --map images --images gone --out out, {localize} gone/x.csv, localize --map gone --images -, '
                                      f'update --map gone --images images, update --map images --images gone',
                'is a file': f'align a.png images --out a.png, align a.png images --out a.png/x, {pairs} pairs --out pairs, map --model images --images images --out a.png, localize --map images --images a.png --out out, '
                             f'map --model images --images images --out a.png/x, {localize} a.png/x, update --map images --images images --out a.png',
                'an input too': f'demo a.png a.png --out a.png, match a.png a.png --out a.png, match images/a.png images/a.png --mask a.png --picture a.png, '
                                f'match images/a.png images/a.png --mask a.png --out a.png, demo images/a.png images/a.png --mask a.png --out a.png, '
                                f'colmap images images/a.png --force, colmap images a.png --force --mask a.png, hloc a.png a.png m.h5 p, {localize} imu.csv --imu imu.csv',
                'another output': 'match a.png a.png --out out --picture out',
                'would be replaced': f'align a.png images/a.png --out images, align a.png images --out images, align a.png images/* --out images, {localize} images',
                'cannot be written': f'demo a.png a.png --out {"m" * 300}.png',
                r'end its name in \.csv, \.json or \.npz': ', '.join(f'match a.png a.png --out {name}' for name in ('x.h5', 'x.png', 'x.npy', 'x.parquet', 'x')),
                r'in \.h5 or \.hdf5': ', '.join(f'{pairs} pairs --out {name}' for name in ('-', '/dev/stdout', 'x.json', 'x.csv', 'x.parquet')),
                'end its name in .png': ', '.join([f'match a.png a.png --picture {name}' for name in ('no.suffix', 'x.exr', 'x.pgm')]
                                                  + [f'demo a.png a.png --out {name}' for name in ('x.foo', 'x.exr')]),
                'known are a folder, X.csv and -; one with a suffix': f'{localize} poses.json',
                'known are a folder; one with a suffix': 'align a.png images --out x.zip, align a.png images --out -, map --model images --images images --out x.zip',
                'there is no database': 'hloc gone f.h5 m.h5 p',
                'there is no list|neither a file nor': f'{pairs} gone --out out, colmap images x.db --pairs gone',
                'has no pair': f'{pairs} empty --out out, colmap images x.db --pairs empty',
                'a.png is paired with itself': f'{pairs} itself --out out, colmap images x.db --pairs itself',
                'no image is called no or image': f'{pairs} unknown --out out, colmap images x.db --pairs unknown',
                '2 pairs would write c-a.png/b.png, since / becomes -: rename an image': f'{pairs} alike --out out',
                'needs --images FOLDER': 'match --pairs pairs, match --pairs pairs --out out',
                'needs --out, a folder or': f'{pairs} pairs',
                'takes no other images': f'{pairs} pairs --out out a.png',
                'takes one --camera': f'{pairs} pairs --out out --camera PINHOLE;9;9;5;5;4;4 --camera PINHOLE;9;9;5;5;4;4',
                'goes without --picture': f'{pairs} pairs --out out --picture x',
                'goes with imu alone': f'{localize} out --imu-from-camera 1;0;0;0;0;0;1',
                'without focal and camera_model': 'colmap images x.db --focal 5 --camera PINHOLE;9;9;5;5;4;4, '
                                                  'colmap images x.db --camera-model opencv --camera PINHOLE;9;9;5;5;4;4',
                'no images below': 'colmap nothing x.db, localize --map images --images nothing --out out, update --map images --images nothing',
                'but the reference': 'align a.png a.png nothing --out out',
                'a place by GPS': 'colmap images x.db --pairs gps',
                '60 x 60': 'match a.png a.png --camera PINHOLE;9;9;400;400;4;4',
                'its camera has 9 x 9': f'{pairs} pairs --out out --camera PINHOLE;9;9;5;5;4;4'}.items():
            for command in commands.split(', '):
                with self.subTest(command), mock.patch('opencv_iib.features.Features.__call__', side_effect=AssertionError):
                    status, out, errors = run_command(*command.replace(';', ',').split())
                    self.assertRegex(errors, rf'^{command.split()[0]}: [^\n]*(?:{message})[^\n]*\n$')
                    self.assertEqual((status, out), (2, ''))
                    self.assertEqual(set(self.folder.rglob('*')), files)
