"""opencv-iib, or python -m opencv_iib: matches, poses and alignment of images, databases for COLMAP, files for hloc, maps and poses in them."""
from __future__ import annotations

import argparse
import contextlib
import dataclasses
import io
import logging
import os
import signal
import sqlite3
import sys
import threading
import time
from typing import Any, Callable, Collection, Iterable, Iterator, NoReturn, Optional, Sequence

from opencv_iib import __version__, error, localization
from opencv_iib._arguments import InvalidOption, import_module
from opencv_iib._images import FORMATS
from opencv_iib._parallel import thread_count
from opencv_iib._streams import STANDARD_OUTPUT, is_quiet, note, put, quiet
from opencv_iib.align import INTERPOLATIONS, align
from opencv_iib.colmap import hloc
from opencv_iib.colmap.database import CAMERA_MODELS
from opencv_iib.colmap.pairs import PAIRS
from opencv_iib.colmap.pipeline import VERIFIERS, Options, build_database
from opencv_iib.demo import demo
from opencv_iib.enums import AlignmentModel
from opencv_iib.features import DETECTORS, FeatureOptions, preset_names
from opencv_iib.localization import Camera
from opencv_iib.localization.imu import parse_pose
from opencv_iib.match_list import match_list
from opencv_iib.measure import match_images

STATUS = ('status: 0; 1 for an error, such as a damaged file or an output that exists; 2 for a mistake in the command line, such as a folder without '
          'images; 3 where nothing was found (no match, no pose, no image aligned or localized); 4 where only some images or pairs were found, or map or '
          'colmap left some out; 130 after Ctrl-C')
SOME_FOUND, NONE_FOUND, MISTAKE = 4, 3, 2
CAMERA = 'MODEL,WIDTH,HEIGHT,PARAMS'
Add = Callable[..., Callable[..., Any]]  #: adds a command, see _parser


class _Parser(argparse.ArgumentParser):
    commands: Collection[str] = ()

    def error(self, message: str) -> NoReturn:
        """Reports a mistake in one line, without argparse's usage."""
        raise InvalidOption(f'{message} (see {self.prog} --help)')


def _value(parse: Callable[[str], Any]) -> Callable[[str], Any]:
    """A type for argparse, whose messages for mistakes are those of `parse`."""
    def parsed(text: str) -> Any:
        try:
            return parse(text)
        except (error, ValueError) as e:
            raise argparse.ArgumentTypeError(str(e)) from None
    return parsed


def _choice(names: Iterable[str], case: Callable[[str], str] = str.upper) -> dict[str, Any]:
    """Arguments for an option whose value is one of these names, in any case."""
    known = list(names)

    def chosen(text: str) -> str:
        if case(text) not in known:
            raise argparse.ArgumentTypeError(f'invalid choice: {text!r} (choose from {", ".join(known)})')
        return case(text)
    return {'type': chosen, 'metavar': f'{{{",".join(known)}}}'}


#: Options of several commands.
SHARED: dict[str, dict[str, Any]] = {
    '--max-size': {'type': int, 'default': 0, 'metavar': 'PIXELS', 'help': 'reduce larger images; points stay in own pixels'},
    '--mask': {'metavar': 'PATH', 'help': 'describe nothing where it is 0; folder: NAME.jpg.png'},
    '--no-exif': {'dest': 'exif', 'action': 'store_false', 'help': 'ignore wrong orientations in EXIF data'},
    '--detector': {**_choice(DETECTORS), 'default': FeatureOptions.detector, 'help': 'HessianDetector, or a detector of cv2 (%(default)s)'},
    '--points': {'type': int, 'default': FeatureOptions.points, 'metavar': 'N', 'help': 'at most so many an image (%(default)s)'},
    '--preset': {**_choice(sorted(preset_names())), 'default': FeatureOptions.preset, 'help': 'descriptor (%(default)s)'},
    '--orientation': {'action': 'store_true', 'help': 'rotate each described region by its direction'},
    '--workers': {'type': int, 'metavar': 'N', 'help': 'threads (one a core)'},
    '--force': {'action': 'store_true', 'help': 'replace files that exist'},
    '--images': {'required': True, 'help': 'folder of images, also in folders below it'},
    '--map': {'required': True, 'help': 'folder that the command map wrote'},
    '--camera': {'metavar': CAMERA, 'type': _value(Camera.parse),
                 'help': "COLMAP's name and parameters of the camera of all images, instead of the map's or EXIF's"},
    '--lines': {'action': 'store_true', 'help': "map lines too, or refine poses by those of the map (needs OpenCV's module line_descriptor)"}}
IMAGE = '--max-size', '--mask', '--no-exif'
FEATURES = '--detector', '--points', '--preset', '--orientation', *IMAGE


def _options_of(kind: Any, arguments: argparse.Namespace, **more: Any) -> Any:
    """A dataclass made of the arguments that are its fields, which are removed from the arguments."""
    known = [field.name for field in dataclasses.fields(kind)]
    return kind(**{name: vars(arguments).pop(name) for name in list(vars(arguments)) if name in known}, **more)


def _call(function: Callable[..., Any], arguments: argparse.Namespace, **more: Any) -> Any:
    """Calls a function with all arguments; one that is no parameter of it is a TypeError."""
    return function(**vars(arguments), **more)


def _add_demo(add: Add) -> None:
    option = add('demo', _demo, 'match two images and write a picture', 'IMAGE IMAGE', 'day.jpg night.jpg --out matches.png', *FEATURES, points=1000)
    option('image_a')
    option('image_b')
    option('--out', default='opencv_iib_demo.png', help='picture to write (%(default)s)')


def _demo(arguments: argparse.Namespace) -> int:
    results = _call(demo, arguments, options=_options_of(FeatureOptions, arguments))
    _say(f'{", ".join(map(str, results))}\npicture: {arguments.out}')
    if results[0].good.any():
        return 0
    note('demo: nothing agrees; do both images show the same place? Try --max-size 1000 if they are large, more --points, '
         'or --orientation if one of them is turned')
    return NONE_FOUND


def _add_match(add: Add) -> None:
    option = add('match', _match, 'match two images, or pairs of a list, to a fraction of a pixel', 'IMAGE IMAGE',
                 'day.jpg night.jpg --out matches.json --camera PINHOLE,640,480,500,500,320,240', *FEATURES, '--workers')
    option('pair', nargs='*', metavar='image', help='two images')
    option('--pairs', metavar='LIST', help='instead, a file with two names a line: each pair is kept when it is done')
    option('--images', metavar='FOLDER', help='folder that the names are relative to')
    option('--out', default='matches.csv', help='file to write, a line a match; also .json and .npz, and - for standard output '
           '(%(default)s); of a list a folder, or a file in .h5 or .hdf5')
    option('--picture', help='picture to write')
    option('--camera', dest='cameras', action='append', default=[], metavar=CAMERA, type=_value(Camera.parse),
           help="find the pose too, with COLMAP's name and parameters of the camera; twice for two cameras")


def _match(arguments: argparse.Namespace) -> int:
    pair, options = vars(arguments).pop('pair'), _options_of(FeatureOptions, arguments)
    if arguments.pairs is not None:
        cameras, picture = vars(arguments).pop('cameras'), vars(arguments).pop('picture')
        for wrong, rule in ((arguments.images is None, 'needs --images FOLDER'), (arguments.out == 'matches.csv', 'needs --out, a folder or a file in .h5 or .hdf5'),
                            (pair, 'takes no other images'), (picture is not None, 'goes without --picture'),
                            (len(cameras) > 1, 'takes one --camera')):
            if wrong:
                raise InvalidOption(f'--pairs LIST {rule}')
        found, count = _call(match_list, arguments, camera=cameras[0] if cameras else None, options=options)
        _say(f'{arguments.out}: {found} of {count} pairs show the same')
        return _share(found, count)
    if len(pair) != 2 or arguments.images is not None:
        raise InvalidOption('two images are needed, or --pairs LIST --images FOLDER')
    for name in ('pairs', 'images', 'workers'):
        del vars(arguments)[name]
    measured = _call(match_images, arguments, image_a=pair[0], image_b=pair[1], options=options)
    _say(f'{arguments.out}: {measured}', arguments.out)
    return 0 if measured.found else NONE_FOUND


def _add_align(add: Add) -> None:
    option = add('align', _align, 'lay images onto a reference', 'REFERENCE IMAGES... --out FOLDER', 'noon.jpg webcam/ --out aligned --crop',
                 *IMAGE, '--workers')
    option('reference')
    option('images', nargs='+', help='images of a plane, or from the same place: files, folders, patterns; finished ones are kept')
    option('--out', required=True, help='folder to write; older results there are replaced')
    option('--model', **_choice(AlignmentModel.__members__), default='AUTO', help='AUTO chooses the simplest true one (%(default)s)')
    option('--chain', action='store_true', help='the images are a series: align those that do not match the reference through their neighbours')
    option('--format', **_choice(FORMATS), help="of the files written (that of each image's file)")
    option('--crop', action='store_true', help='write the part that all images show, instead of all that the reference shows')
    option('--interpolation', **_choice(INTERPOLATIONS), default='LINEAR', help='(%(default)s)')


def _align(arguments: argparse.Namespace) -> int:
    done = _call(align, arguments, model=AlignmentModel[vars(arguments).pop('model')])
    count = sum(bool(each.file) for each in done)
    for each in done:
        _say(f'{each.name}: {each}')
    _say(f'{arguments.out}/index.html: {count} of {len(done)} images are aligned')
    return _share(count, len(done))


def _share(count: int, total: int) -> int:
    """The status for so many of all that were found."""
    return 0 if count == total else SOME_FOUND if count else NONE_FOUND


def _add_colmap(add: Add) -> None:
    option = add('colmap', _colmap, 'describe and match a folder, for colmap mapper', 'IMAGES DATABASE',
                 'photos/ database.db --pairs retrieval --camera-of drone=OPENCV,4000,3000,3100,3100,2000,1500,0,0,0,0',
                 *FEATURES, '--workers', '--force')
    option('images', help='folder of images')
    option('database', help='file to write, or to update')
    option('--camera-model', **_choice(CAMERA_MODELS), default='SIMPLE_RADIAL', help='(%(default)s)')
    option('--focal', type=float, default=0, help='focal length in pixels, instead of EXIF')
    option('--camera', metavar=CAMERA, help="COLMAP's name and parameters of all images' camera")
    option('--camera-of', action='append', default=[], metavar=f'FOLDER={CAMERA}', help='camera of the images below a folder; may be repeated')
    option('--share-cameras', action='store_true', help='one camera for images of one size and focal length')
    option('--pairs', default='exhaustive', help=f'{", ".join(PAIRS)}, or a file with two names a line (%(default)s)')
    option('--neighbours', type=int, default=20, metavar='N', help='of sequential, retrieval and gps (%(default)s)')
    option('--ratio', type=float, default=.92, help='ratio test beside the cross-check (%(default)s; 1: none)')
    option('--no-search', action='store_false', dest='search', help='do not search other zooms, rotations and tilts')
    option('--verify', **_choice(VERIFIERS, str.lower), default='auto', help='two-view geometry (%(default)s)')
    option('--scheduler', metavar='ADDRESS', help="use the workers of Dask's scheduler there")


def _colmap(arguments: argparse.Namespace) -> int:
    with _client(vars(arguments).pop('scheduler')) as client:
        options = _options_of(Options, arguments, features=_options_of(FeatureOptions, arguments))
        counts = _call(build_database, arguments, options=options, client=client)
        _say_counts(arguments.database, counts)
        return SOME_FOUND if counts['failed'] or 'lines left out' in counts else 0


def _add_hloc(add: Add) -> None:
    option = add('hloc', _hloc, "write a database's keypoints and matches as hloc reads them", 'DATABASE FEATURES MATCHES PAIRS',
                 'database.db features.h5 matches.h5 pairs.txt', '--force')
    for name, text in (('database', 'what the command colmap wrote'), ('features', 'HDF5 file to write'), ('matches', 'HDF5 file to write'),
                       ('pairs', 'list of pairs to write')):
        option(name, help=text)


def _hloc(arguments: argparse.Namespace) -> int:
    _say_counts(arguments.matches, {'pairs': _call(hloc.export, arguments)})
    return 0


def _add_map(add: Add) -> None:
    option = add('map', _map, 'make a map for localization of a COLMAP model', '--model MODEL --images FOLDER --out MAP',
                 '--model sparse/0 --images photos/ --out map', '--images', '--points', '--lines', *IMAGE, '--workers', '--force', points=2000)
    option('--model', required=True, help='folder of a COLMAP model, binary or text')
    option('--out', required=True, help='folder to write')
    option('--orb-and-akaze', action='store_true', help="the paper's points and descriptor instead of the recommended ones")


def _map(arguments: argparse.Namespace) -> int:
    counts = _call(localization.build, arguments)
    _say_counts(arguments.out, counts)
    return SOME_FOUND if counts['left out'] else 0


def _add_localize(add: Add) -> None:
    option = add('localize', _localize, 'find where images were taken', '--map MAP --images FOLDER --out OUT',
                 '--map map --images evening/ --out poses.csv --sequence', '--map', '--camera', '--lines', *IMAGE, '--workers')
    option('--images', required=True, help='folder of images, also in folders below it; or -: paths from standard input, a line each, answered at once '
           'by a line on standard output')
    option('--out', help='folder to write, older results there are replaced; or X.csv or - for a table alone')
    option('--sequence', action='store_true', help='images follow each other: look for each near the previous one')
    option('--pictures', action='store_true', help='write each image with the points that agree')
    option('--imu', metavar='IMU.CSV', help="smooth poses by an IMU, EuRoC's file; images must be named by their times")
    option('--imu-from-camera', type=_value(parse_pose), metavar='TX,TY,TZ,QX,QY,QZ,QW', default=argparse.SUPPRESS,
           help="pose of the camera in the IMU's axes (0,0,0,0,0,0,1)")


def _localize(arguments: argparse.Namespace) -> int:
    if arguments.images == '-':
        return _localize_stream(arguments)
    if arguments.out is None:
        raise InvalidOption('--out is needed, but for --images -')
    found, count = _call(localization.localize_images, arguments)
    _say(f'{arguments.out}: {found} of {count} images have a pose', arguments.out)
    return _share(found, count)


def _localize_stream(arguments: argparse.Namespace) -> int:
    for option in ('out', 'imu', 'imu-from-camera', 'pictures', 'sequence'):
        given = getattr(arguments, option.replace('-', '_'), None)
        if given is not None and given is not False:
            raise InvalidOption(f'--images - goes without --{option}')
    if sys.stdin is None or sys.stdout is None:
        raise InvalidOption('--images - needs standard input and output, and one is not open')
    for stream in (sys.stdin, sys.stdout):
        if isinstance(stream, io.TextIOWrapper):
            encoding = sys.getfilesystemencoding()
            if stream is sys.stdin and encoding == 'utf-8':
                encoding = 'utf-8-sig'  # Windows' shells begin with a byte-order mark
            stream.reconfigure(encoding=encoding, errors=sys.getfilesystemencodeerrors())  # a path may be any bytes
    count = total = 0
    for line, found in localization.localize_stream(
            arguments.map, sys.stdin, arguments.camera, arguments.lines, arguments.max_size, arguments.exif, arguments.mask):
        print(line, flush=True)
        count, total = count + found, total + 1
    return _share(count, total)


def _add_update(add: Add) -> None:
    option = add('update', _update, 'add the light of images to a map', '--map MAP --images FOLDER', '--map map --images evening/',
                 '--map', '--images', '--camera', *IMAGE, '--workers', '--force')
    option('--out', help='folder of the new map, instead of the old one')


def _update(arguments: argparse.Namespace) -> int:
    counts = _call(localization.update, arguments)
    _say_counts(arguments.out or arguments.map, counts)
    return _share(counts['localized'], counts['images'])


def _say_counts(file: str, counts: dict[str, int]) -> None:
    _say(f'{file}: ' + ', '.join(f'{count} {name}' for name, count in counts.items()))


def _client(scheduler: Optional[str]) -> contextlib.AbstractContextManager[Any]:
    if scheduler is None:
        return contextlib.nullcontext()
    distributed = import_module('distributed', '--scheduler needs pip install opencv-iib[distributed]')
    logging.getLogger('distributed.client').setLevel(logging.CRITICAL)  # errors that matter are exceptions
    client: contextlib.AbstractContextManager[Any] = distributed.Client(scheduler)
    return client


def _cv2_error() -> type[Exception]:
    try:
        import cv2
    except ImportError:
        return ImportError
    return cv2.error


def _say(text: str, out: str = '') -> None:
    """Prints a result: on standard error if standard output has the results themselves, nothing with --quiet."""
    if not is_quiet():
        note(text) if out in STANDARD_OUTPUT else put(text + '\n', sys.stdout)


def _parser() -> _Parser:
    parser = _Parser(prog='opencv-iib', description=__doc__, epilog='example: opencv-iib demo day.jpg night.jpg; ' + STATUS)
    parser.add_argument('--version', action='version', version=f'opencv_iib {__version__}')
    commands = parser.add_subparsers(dest='command', required=True)

    def add(name: str, run: Callable[[argparse.Namespace], int], description: str, needed: str, example: str, *shared: str,
            **defaults: Any) -> Callable[..., Any]:
        """Adds a command with options of SHARED, and returns what adds its others. :param defaults: of these options."""
        command: argparse.ArgumentParser = commands.add_parser(
            name, help=description, description=f'{description[0].upper()}{description[1:]}.', usage=f'opencv-iib {name} {needed} [options]',
            epilog=f'example: opencv-iib {name} {example}', formatter_class=argparse.RawDescriptionHelpFormatter)
        command.add_argument('--quiet', action='store_true', help='print only errors')
        for option in shared:
            command.add_argument(option, **SHARED[option])
        command.set_defaults(run=run, **defaults)
        return command.add_argument

    for add_command in (_add_demo, _add_match, _add_align, _add_colmap, _add_hloc, _add_map, _add_localize, _add_update):
        add_command(add)
    parser.commands = commands.choices
    return parser


def _parsed(parser: _Parser, words: Sequence[str]) -> argparse.Namespace:
    """Parses the command line, in which images may also follow options."""
    arguments, rest = parser.parse_known_args(words)
    images: Any = vars(arguments).get('pair', vars(arguments).get('images'))
    if rest and (not isinstance(images, list) or any(word.startswith('-') for word in rest)):
        parser.error(f'unrecognized arguments: {" ".join(rest)}')
    if rest:
        images += rest
    return arguments


@contextlib.contextmanager
def _ctrl_c() -> Iterator[None]:
    """Lets Ctrl-C end a command in order. A second one is ignored for half a second, and then ends it at once."""
    pressed: list[float] = []

    def end(*_: Any) -> None:
        pressed.append(time.monotonic())
        if len(pressed) == 1:
            raise KeyboardInterrupt
        if pressed[-1] - pressed[0] > .5:
            os._exit(130)
    ours = threading.current_thread() is threading.main_thread() and signal.getsignal(signal.SIGINT) is signal.default_int_handler
    if ours:
        signal.signal(signal.SIGINT, end)
    try:
        yield
    finally:
        if ours:  # after Ctrl-C only Python itself is left to end
            signal.signal(signal.SIGINT, signal.SIG_IGN if pressed else signal.default_int_handler)


def main(argv: Optional[Sequence[str]] = None) -> int:
    """Runs a command and returns its exit status."""
    words = sys.argv[1:] if argv is None else argv
    command, resumable = 'opencv-iib', False
    try:
        parser = _parser()
        command = next((word for word in words[:1] if word in parser.commands), command)
        arguments = _parsed(parser, words)
        _cv2_error()  # the import of cv2 swallows Ctrl-C
        command, run, silent = (vars(arguments).pop(name) for name in ('command', 'run', 'quiet'))
        resumable = command in ('align', 'colmap') or command == 'match' and arguments.pairs is not None
        thread_count(getattr(arguments, 'workers', None))
        with _ctrl_c(), quiet(silent):
            return int(run(arguments))
    except KeyboardInterrupt:
        note('interrupted' + '; the same command goes on from here' * resumable)
        return 130
    except BrokenPipeError:  # the reader, such as head, has ended
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())  # for what Python flushes at its end
        return 1
    except Exception as e:
        if not isinstance(e, (OSError, ValueError, RuntimeError, ImportError, sqlite3.Error, error, _cv2_error())):
            raise
        note(f'{command}: {" ".join(str(e).split())}')
        return MISTAKE if isinstance(e, InvalidOption) else 1


if __name__ == '__main__':
    sys.exit(main())
