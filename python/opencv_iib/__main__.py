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

import numpy as np

from opencv_iib import __version__, error, localization
from opencv_iib._arguments import InvalidOption, import_module
from opencv_iib._images import FORMATS
from opencv_iib._parallel import thread_count
from opencv_iib._streams import STANDARD_OUTPUT, is_quiet, note, put, quiet
from opencv_iib.align import INTERPOLATIONS, align
from opencv_iib.colmap import hloc
from opencv_iib.colmap.database import CAMERA_MODELS
from opencv_iib.colmap.pipeline import PAIRS, VERIFIERS, Options, build_database
from opencv_iib.demo import demo
from opencv_iib.enums import AlignmentModel
from opencv_iib.features import DETECTORS, FeatureOptions, preset_names
from opencv_iib.localization import Camera
from opencv_iib.localization.imu_file import parse_pose
from opencv_iib.match_list import match_list
from opencv_iib.measure import match_images

STATUS = ('status: 0; 1 for an error; 2 for a mistake in the command line; 3 where nothing was found (no match, no pose, no image aligned or '
          'localized), 4 where some images or pairs were, or map or colmap left some out; 130 after Ctrl-C')
CAMERA = 'MODEL,WIDTH,HEIGHT,PARAMS'


class _Parser(argparse.ArgumentParser):
    commands: Collection[str] = ()

    def error(self, message: str) -> NoReturn:
        """Instead of the usage: a line, as for other mistakes."""
        raise InvalidOption(f'{message} ({self.prog} --help tells more)')


def _typed(parse: Callable[[str], Any]) -> Callable[[str], Any]:
    """What argparse tells mistakes of."""
    def parsed(text: str) -> Any:
        try:
            return parse(text)
        except (error, ValueError) as e:
            raise argparse.ArgumentTypeError(str(e)) from None
    return parsed


def _choice(parser: argparse.ArgumentParser, option: str, names: Iterable[str], case: Callable[[str], str] = str.upper, **more: Any) -> None:
    """An option that is one of these names, in any case."""
    known = list(names)

    def chosen(text: str) -> str:
        if case(text) not in known:
            raise argparse.ArgumentTypeError(f'invalid choice: {text!r} (choose from {", ".join(known)})')
        return case(text)
    parser.add_argument(option, type=chosen, metavar=f'{{{",".join(known)}}}', **more)


def _features(parser: argparse.ArgumentParser, points: int) -> None:
    _choice(parser, '--detector', DETECTORS, default=FeatureOptions.detector, help='HessianDetector, or a detector of cv2 (%(default)s)')
    parser.add_argument('--points', type=int, default=points, metavar='N', help='at most so many an image (%(default)s)')
    _choice(parser, '--preset', sorted(preset_names()), default=FeatureOptions.preset, help='descriptor (%(default)s)')
    parser.add_argument('--orientation', action='store_true', help='turn what is described by its direction')
    _seen(parser)


def _seen(parser: argparse.ArgumentParser) -> None:
    """What of images is described, and how large."""
    parser.add_argument('--max-size', type=int, default=0, metavar='PIXELS',
                        help='reduce larger images to it; points stay in own pixels')
    parser.add_argument('--mask', metavar='PATH', help='describe nothing where it is 0; folder: NAME.jpg.png')
    parser.add_argument('--no-exif', dest='exif', action='store_false', help='for files whose EXIF data tell a wrong orientation')


def _take(kind: Any, arguments: argparse.Namespace, **more: Any) -> Any:
    """A dataclass of the options that are fields of it. They are taken away, so that no other call gets them."""
    known = [field.name for field in dataclasses.fields(kind)]
    return kind(**{name: vars(arguments).pop(name) for name in list(vars(arguments)) if name in known}, **more)


def _call(function: Callable[..., Any], arguments: argparse.Namespace, **more: Any) -> Any:
    """With every option that is left; one that is no parameter is a TypeError, and not forgotten."""
    return function(**vars(arguments), **more)


def _parser() -> _Parser:
    parser = _Parser(prog='opencv-iib', description=__doc__, epilog='example: opencv-iib demo day.jpg night.jpg; ' + STATUS)
    parser.add_argument('--version', action='version', version=f'opencv_iib {__version__}')
    commands = parser.add_subparsers(dest='command', required=True)

    def add(name: str, run: Callable[[argparse.Namespace], int], description: str, needed: str, example: str) -> argparse.ArgumentParser:
        added: argparse.ArgumentParser = commands.add_parser(
            name, help=description, description=f'{description[0].upper()}{description[1:]}.', usage=f'opencv-iib {name} {needed} [options]',
            epilog=f'example: opencv-iib {name} {example}', formatter_class=argparse.RawDescriptionHelpFormatter)
        added.set_defaults(run=run)
        added.add_argument('--quiet', action='store_true', help='say only what is wrong')
        return added

    command = add('demo', _demo, 'match two images and write a picture',
                  'IMAGE IMAGE', 'day.jpg night.jpg --out matches.png')
    command.add_argument('image_a')
    command.add_argument('image_b')
    command.add_argument('--out', default='opencv_iib_demo.png', help='picture to write (%(default)s)')
    _features(command, 1000)

    command = add('match', _match, 'match two images, or pairs of a list, to a fraction of a pixel',
                  'IMAGE IMAGE', 'day.jpg night.jpg --out matches.json --camera PINHOLE,640,480,500,500,320,240')
    command.add_argument('pair', nargs='*', metavar='image', help='two of them')
    command.add_argument('--pairs', metavar='LIST', help='instead, a file with two names a line: each pair is kept when it is done')
    command.add_argument('--images', metavar='FOLDER', help='that the names are of')
    command.add_argument('--workers', type=int, metavar='N', help='threads, of a list (one a core)')
    command.add_argument('--out', default='matches.csv', help='file to write, a line a match; also .json and .npz, and - for standard output '
                         '(%(default)s); of a list a folder, or a file in .h5 or .hdf5')
    command.add_argument('--picture', help='picture to write')
    command.add_argument('--camera', dest='cameras', action='append', default=[], metavar=CAMERA, type=_typed(Camera.parse),
                         help="find the pose too, with COLMAP's name and parameters of the camera; twice for two cameras")
    _features(command, FeatureOptions.points)

    command = add('align', _align, 'lay images onto a reference',
                  'REFERENCE IMAGES... --out FOLDER', 'noon.jpg webcam/ --out aligned --crop')
    command.add_argument('reference')
    command.add_argument('images', nargs='+', help='of a plane, or from the same place: files, folders, patterns; those that are done stay')
    command.add_argument('--out', required=True, help='folder to write; older results there are replaced')
    _choice(command, '--model', AlignmentModel.__members__, default='AUTO', help='AUTO takes the simplest one that is true (%(default)s)')
    command.add_argument('--chain', action='store_true', help='the images are a series: what has no transform with the reference is aligned '
                         'through its neighbours')
    _choice(command, '--format', FORMATS, help="of what is written (that of each image's file)")
    command.add_argument('--crop', action='store_true', help='write what all show, instead of what the reference shows')
    _choice(command, '--interpolation', INTERPOLATIONS, default='LINEAR', help='(%(default)s)')
    command.add_argument('--workers', type=int, metavar='N', help='threads (one a core)')
    _seen(command)

    command = add('colmap', _colmap, 'describe and match a folder, for colmap mapper',
                  'IMAGES DATABASE', 'photos/ database.db --pairs retrieval --camera-of drone=OPENCV,4000,3000,3100,3100,2000,1500,0,0,0,0')
    command.add_argument('images', help='folder of images')
    command.add_argument('database', help='file to write or to add to; goes on from NAME.partial')
    _features(command, FeatureOptions.points)
    _choice(command, '--camera-model', CAMERA_MODELS, default='SIMPLE_RADIAL', help='(%(default)s)')
    command.add_argument('--focal', type=float, default=0, help='focal length in pixels, instead of EXIF')
    command.add_argument('--camera', metavar=CAMERA, help="COLMAP's name and parameters of all images' camera")
    command.add_argument('--camera-of', action='append', default=[], metavar=f'FOLDER={CAMERA}', help='of the images below a folder; also several times')
    command.add_argument('--share-cameras', action='store_true', help='one camera for images of one size and focal')
    command.add_argument('--pairs', default='exhaustive',
                         help=f'{", ".join(PAIRS)}, or a file with two names a line (%(default)s)')
    command.add_argument('--neighbours', type=int, default=20, metavar='N', help='of sequential, retrieval and gps (%(default)s)')
    command.add_argument('--ratio', type=float, default=.92, help='ratio test beside the cross-check (%(default)s; 1: none)')
    command.add_argument('--no-search', action='store_false', dest='search',
                         help='match images as they are only')
    _choice(command, '--verify', VERIFIERS, str.lower, default='auto', help='two-view geometry (%(default)s)')
    command.add_argument('--workers', type=int, metavar='N', help='threads (one a core)')
    command.add_argument('--scheduler', metavar='ADDRESS', help="have the workers of Dask's scheduler there do it")
    command.add_argument('--force', action='store_true', help='replace a database that is there')

    command = add('hloc', _hloc, "write a database's keypoints and matches as hloc reads them",
                  'DATABASE FEATURES MATCHES PAIRS', 'database.db features.h5 matches.h5 pairs.txt')
    command.add_argument('database', help='what the command colmap wrote')
    command.add_argument('features', help='HDF5 file to write')
    command.add_argument('matches', help='HDF5 file to write')
    command.add_argument('pairs', help='list of pairs to write')
    command.add_argument('--force', action='store_true', help='replace files that are there')

    mapping = add('map', _map, 'make a map for localization of a COLMAP model',
                  '--model MODEL --images FOLDER --out MAP', '--model sparse/0 --images photos/ --out map')
    localizing = add('localize', _localize, 'find where images were taken',
                  '--map MAP --images FOLDER --out OUT', '--map map --images evening/ --out poses.csv --sequence')
    updating = add('update', _update, 'add the light of images to a map',
                  '--map MAP --images FOLDER', '--map map --images evening/')
    mapping.add_argument('--model', required=True, help='folder of a COLMAP model, binary or text')
    for each in (localizing, updating):
        each.add_argument('--map', required=True, help='folder that the command map wrote')
    for each in (mapping, localizing, updating):
        each.add_argument('--images', required=True, help='folder of images, also in folders below it' + (
            '; or -: paths from standard input, a line each, answered at once by a line on standard output' if each is localizing else ''))
        each.add_argument('--workers', type=int, metavar='N', help='threads (one a core)')
        _seen(each)
    for each in (localizing, updating):
        each.add_argument('--camera', metavar=CAMERA, type=_typed(Camera.parse),
                          help="COLMAP's name and parameters of the camera of all images, instead of the map's or EXIF's")
    mapping.add_argument('--out', required=True, help='folder to write')
    mapping.add_argument('--points', type=int, default=2000, metavar='N', help='at most so many an image (%(default)s)')
    mapping.add_argument('--orb-and-akaze', action='store_true', help="the paper's points and descriptor in place of the recommended ones")
    mapping.add_argument('--force', action='store_true', help='replace a map that is there')
    localizing.add_argument('--out', help='folder to write, older results there are replaced; or X.csv or - for a table alone')
    localizing.add_argument('--sequence', action='store_true', help='images follow each other: look for each where the last one was')
    localizing.add_argument('--pictures', action='store_true', help='write each image with the points that agree')
    localizing.add_argument('--imu', metavar='IMU.CSV', help="smooth poses by an IMU, EuRoC's file; images must be named by their times")
    localizing.add_argument('--imu-from-camera', type=_typed(parse_pose), metavar='TX,TY,TZ,QX,QY,QZ,QW', default=np.eye(4),
                            help="where the camera is in the IMU's axes (0,0,0,0,0,0,1)")
    updating.add_argument('--out', help='folder of the new map, instead of the old one')
    updating.add_argument('--force', action='store_true', help='replace a map that is in --out')
    for each, text in ((mapping, 'map lines too'), (localizing, 'refine poses by the lines of a map that was made with --lines')):
        each.add_argument('--lines', action='store_true', help=text + " (needs OpenCV's module line_descriptor)")
    parser.commands = commands.choices
    return parser


SOME_FOUND, NONE_FOUND = 4, 3  # status of localize, update and align; NONE_FOUND of demo and match too
MISTAKE = 2


def _demo(arguments: argparse.Namespace) -> int:
    results = _call(demo, arguments, options=_take(FeatureOptions, arguments))
    _say(f'{", ".join(map(str, results))}\npicture: {arguments.out}')
    if results[0].good.any():
        return 0
    note('demo: nothing agrees; do both images show the same place? Try --max-size 1000 if they are large, more --points, '
         'or --orientation if one of them is turned')
    return NONE_FOUND


def _match(arguments: argparse.Namespace) -> int:
    pair, options = vars(arguments).pop('pair'), _take(FeatureOptions, arguments)
    if arguments.pairs is not None:
        cameras, picture = vars(arguments).pop('cameras'), vars(arguments).pop('picture')
        if pair or picture is not None or len(cameras) > 1 or arguments.images is None or arguments.out == 'matches.csv':
            raise InvalidOption('--pairs LIST goes with --images FOLDER, --out and one --camera, and without images and --picture')
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


def _align(arguments: argparse.Namespace) -> int:
    done = _call(align, arguments, model=AlignmentModel[vars(arguments).pop('model')])
    count = sum(bool(each.file) for each in done)
    for each in done:
        _say(f'{each.name}: {each}')
    _say(f'{arguments.out}/index.html: {count} of {len(done)} images are aligned')
    return _share(count, len(done))


def _share(count: int, total: int) -> int:
    return 0 if count == total else SOME_FOUND if count else NONE_FOUND


def _colmap(arguments: argparse.Namespace) -> int:
    with _client(vars(arguments).pop('scheduler')) as client:
        options = _take(Options, arguments, features=_take(FeatureOptions, arguments))
        counts = _call(build_database, arguments, options=options, client=client)
        _told(arguments.database, counts)
        return SOME_FOUND if counts['failed'] or 'lines left out' in counts else 0


def _hloc(arguments: argparse.Namespace) -> int:
    return _told(arguments.matches, {'pairs': _call(hloc.export, arguments)})


def _map(arguments: argparse.Namespace) -> int:
    counts = _call(localization.build, arguments)
    _told(arguments.out, counts)
    return SOME_FOUND if counts['left out'] else 0


def _localize(arguments: argparse.Namespace) -> int:
    if arguments.images == '-':
        return _localize_stream(arguments)
    if arguments.out is None:
        raise InvalidOption('--out is needed, but for --images -')
    found, count = _call(localization.localize_images, arguments)
    _say(f'{arguments.out}: {found} of {count} images have a pose', arguments.out)
    return _share(found, count)


def _localize_stream(arguments: argparse.Namespace) -> int:
    for option in ('out', 'imu', 'pictures', 'sequence'):
        if getattr(arguments, option):
            raise InvalidOption(f'--images - goes without --{option}')
    if sys.stdin is None or sys.stdout is None:
        raise InvalidOption('--images - needs standard input and output, and one is not open')
    for stream in (sys.stdin, sys.stdout):
        if isinstance(stream, io.TextIOWrapper):
            encoding = sys.getfilesystemencoding()
            if stream is sys.stdin and encoding == 'utf-8':
                encoding = 'utf-8-sig'  # what Windows' shells write begins with a mark
            stream.reconfigure(encoding=encoding, errors=sys.getfilesystemencodeerrors())  # a path may be any bytes
    count = total = 0
    for line, found in localization.localize_stream(
            arguments.map, sys.stdin, arguments.camera, arguments.lines, arguments.max_size, arguments.exif, arguments.mask):
        print(line, flush=True)
        count, total = count + found, total + 1
    return _share(count, total)


def _update(arguments: argparse.Namespace) -> int:
    counts = _call(localization.update, arguments)
    _told(arguments.out or arguments.map, counts)
    return _share(counts['localized'], counts['images'])


def _told(file: str, counts: dict[str, int]) -> int:
    _say(f'{file}: ' + ', '.join(f'{count} {name}' for name, count in counts.items()))
    return 0


def _client(scheduler: Optional[str]) -> contextlib.AbstractContextManager[Any]:
    """Of Dask, or None without a scheduler."""
    if scheduler is None:
        return contextlib.nullcontext()
    distributed = import_module('distributed', '--scheduler needs pip install opencv-iib[distributed]')
    logging.getLogger('distributed.client').setLevel(logging.CRITICAL)  # what matters of it comes as an exception
    client: contextlib.AbstractContextManager[Any] = distributed.Client(scheduler)
    return client


def _cv2_error() -> type[Exception]:
    try:
        import cv2
    except ImportError:
        return ImportError
    return cv2.error


def _say(text: str, out: str = '') -> None:
    """A line about what was done, beside standard output if that is what was written; nothing with --quiet."""
    if not is_quiet():
        note(text) if out in STANDARD_OUTPUT else put(text + '\n', sys.stdout)


def _parsed(parser: _Parser, words: Sequence[str]) -> argparse.Namespace:
    """Images may also stand behind options."""
    arguments, rest = parser.parse_known_args(words)
    images: Any = vars(arguments).get('pair', vars(arguments).get('images'))
    if rest and (not isinstance(images, list) or any(word.startswith('-') for word in rest)):
        parser.error(f'unrecognized arguments: {" ".join(rest)}')
    if rest:
        images += rest
    return arguments


@contextlib.contextmanager
def _ctrl_c() -> Iterator[None]:
    """Within it, Ctrl-C ends a command in order. One more does nothing for half a second, and then ends it at once."""
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
        if ours:  # after Ctrl-C nothing is left to be ended but Python
            signal.signal(signal.SIGINT, signal.SIG_IGN if pressed else signal.default_int_handler)


def main(argv: Optional[Sequence[str]] = None) -> int:
    """Runs a command; the exit status."""
    words = sys.argv[1:] if argv is None else argv
    command, goes_on = 'opencv-iib', False
    try:
        parser = _parser()
        command = next((word for word in words[:1] if word in parser.commands), command)
        arguments = _parsed(parser, words)
        _cv2_error()  # the import of cv2 swallows Ctrl-C
        command, run, silent = (vars(arguments).pop(name) for name in ('command', 'run', 'quiet'))
        goes_on = command == 'align' or getattr(arguments, 'pairs', None) is not None  # colmap, and match of a list
        thread_count(getattr(arguments, 'workers', None))
        with _ctrl_c(), quiet(silent):
            return int(run(arguments))
    except KeyboardInterrupt:
        note('interrupted' + '; the same command goes on from here' * goes_on)
        return 130
    except BrokenPipeError:  # such as head's, which has what it wants
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())  # of what is flushed at the end
        return 1
    except Exception as e:
        if not isinstance(e, (OSError, ValueError, RuntimeError, ImportError, sqlite3.Error, error, _cv2_error())):
            raise
        note(f'{command}: {" ".join(str(e).split())}')
        return MISTAKE if isinstance(e, InvalidOption) else 1


if __name__ == '__main__':
    sys.exit(main())
