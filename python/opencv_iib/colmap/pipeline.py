"""Makes a database for ``colmap mapper`` of a folder of images."""
from __future__ import annotations

import dataclasses
import functools
import os
import posixpath
import shutil
import socket
import subprocess
import tempfile
from typing import Any, Callable, Iterable, Iterator, Optional, Sequence

import numpy as np

import opencv_iib
from opencv_iib._arguments import InvalidOption, Path, check_choice, check_count, number, sequence
from opencv_iib._camera import Camera
from opencv_iib._exif import exif_focal_length
from opencv_iib._files import check_is_folder, check_outputs, only_writer, output_file
from opencv_iib._image_file import ImageFile, Masks, check_sizes
from opencv_iib._image_names import find_images, is_listable, is_utf8
from opencv_iib._images import import_cv2
from opencv_iib._pair_list import BLOCK, Pair, check_list, tiles
from opencv_iib._parallel import Cluster, Threads, in_parallel, thread_count
from opencv_iib._progress import Progress, with_progress
from opencv_iib._streams import note
from opencv_iib._two_views import magsac
from opencv_iib.colmap.database import CAMERA_MODELS, Database, SettingsChanged, check_settings, settings_of
from opencv_iib.colmap.pairs import PAIRS, Pairs, gps_places, list_pairs
from opencv_iib.colmap.search import search_pairs
from opencv_iib.features import FeatureOptions, Features, to_colmap
from opencv_iib.matcher import HierarchicalMatcher

VERIFIERS = ('auto', 'colmap', 'magsac', 'none')


@dataclasses.dataclass(frozen=True)
class Options:
    """Options of build_database, with the names and values of the command line."""

    features: FeatureOptions = FeatureOptions()
    camera_model: str = 'SIMPLE_RADIAL'  #: one of database.CAMERA_MODELS
    focal: float = 0  #: pixels, of all images; 0: by EXIF, else 1.2 times the longer side without prior
    camera: Optional[str] = None  #: of all images, ``'MODEL,WIDTH,HEIGHT,PARAMS'`` with COLMAP's names and parameters, instead of camera_model and focal
    camera_of: Sequence[str] = ()  #: ``'FOLDER=MODEL,WIDTH,HEIGHT,PARAMS'``: of the images below a subfolder
    share_cameras: bool = False  #: one camera for all images of the same size and focal length
    pairs: Path = 'exhaustive'  #: one of PAIRS, or the name of a file with two names a line
    neighbours: int = 20  #: images that each is paired with (sequential, retrieval, gps)
    ratio: float = .92  #: ratio test, as HierarchicalMatcher.setMaxRatio; 1: none. Matches are always mutual.
    verify: str = 'auto'  #: one of VERIFIERS; auto: COLMAP's program if it is there, else MAGSAC
    search: bool = True  #: search pairs at other zooms, rotations and tilts where images would stay unconnected; not if verify is none

    def __post_init__(self) -> None:
        pairs = os.fspath(self.pairs)
        for field, name in (('camera_model', str(self.camera_model).upper()), ('verify', str(self.verify).lower()),
                            ('pairs', pairs.lower() if pairs.lower() in PAIRS else pairs)):  # in any case
            object.__setattr__(self, field, name)

    def camera_for(self, name: str) -> Optional[Camera]:
        """The camera of the innermost folder that an image is in, or of all images; None if neither is known. :raises opencv_iib.error: for an
        invalid camera."""
        inside = [(len(folder), camera) for folder, camera in self._cameras() if name.startswith(folder)]
        return max(inside, key=lambda each: each[0])[1] if inside else None

    def _cameras(self) -> list[tuple[str, Camera]]:
        """Folders, each with the camera of its images; '' is the folder of all images."""
        texts = [(posixpath.normpath(folder).strip('/') + '/', camera) for folder, _, camera in (text.rpartition('=') for text in self.camera_of)]
        return [(folder, Camera.parse(camera)) for folder, camera in ([] if self.camera is None else [('', self.camera)]) + texts]

    def _settings(self) -> dict[str, Any]:
        """The settings that a database depends on, equal for equal meaning. Masks are part of the images' stamps."""
        return {**vars(self), **vars(self.features), 'features': None, 'mask': None, 'pairs': os.path.basename(self.pairs), 'camera': None,
                'camera_of': None, 'cameras': sorted(f'{folder}={camera}'.lstrip('=') for folder, camera in self._cameras())}

    def check(self) -> None:
        """:raises InvalidOption: naming what is wrong, and what there is."""
        self.features.check()
        if not 0 <= number(self.focal, 'focal') < float('inf'):
            raise InvalidOption(f'focal is {self.focal}: it must be a number of pixels, or 0')
        check_choice(self.camera_model, 'camera model', CAMERA_MODELS)
        if self.camera is not None and (self.focal or self.camera_model != Options.camera_model):
            raise InvalidOption('camera has a model and a focal length: give it without focal and camera_model')
        for text in sequence(self.camera_of, 'camera_of', "'FOLDER=MODEL,WIDTH,HEIGHT,PARAMS'"):
            if '=' not in str(text):
                raise InvalidOption(f'camera_of is {text}: it must be FOLDER=MODEL,WIDTH,HEIGHT,PARAMS')
        try:
            folders = [folder for folder, _ in self._cameras()]
        except opencv_iib.error as e:
            raise InvalidOption(str(e)) from None
        for folder in folders:
            if folders.count(folder) > 1:
                raise InvalidOption(f'camera_of has two cameras of {folder}: give one')
        if self.pairs not in PAIRS and not os.path.isfile(self.pairs):
            raise InvalidOption(f'pairs: {self.pairs} is neither a file nor one of {", ".join(PAIRS)}')
        check_choice(self.verify, 'verify', VERIFIERS)
        if self.verify == 'colmap' and shutil.which('colmap') is None:
            raise InvalidOption('verify is colmap, but there is no program colmap: install it, or take magsac')
        check_count(self.neighbours, 'neighbours')
        if not 0 < number(self.ratio, 'ratio') <= 1:
            raise InvalidOption(f'ratio is {self.ratio}: it must be in (0, 1]')
        import_cv2()


def describe_image(folder: str, options: Options, name: str) -> tuple[np.ndarray, np.ndarray, int, int, str, Sequence[float], bool]:
    """COLMAP's keypoints, codes, width, height, the camera's model and parameters, and whether its focal length is known."""
    if not os.path.isdir(folder):
        raise FileNotFoundError(f'{folder} is not there on {socket.gethostname()}: all workers have to read the images by the same name')
    if not is_utf8(name):
        raise ValueError('its name is not UTF-8')
    file = ImageFile(os.path.join(folder, name), options.features.exif)
    rows, codes = Features(options.features)(file.grey, file.orientation_of_camera, Masks(options.features.mask).of(name, file.grey))
    height, width = file.grey.shape
    camera = options.camera_for(name)
    if camera is not None:
        if (camera.width, camera.height) != (width, height):
            raise ValueError(f'it has {width} x {height} pixels, its camera {camera.width} x {camera.height}')
        return to_colmap(rows), codes, width, height, camera.model, camera.params, True
    focal = options.focal or exif_focal_length(file.data, width, height)
    focals, others = CAMERA_MODELS[options.camera_model]
    params = [focal or 1.2 * max(width, height)] * focals + [width / 2, height / 2] + [0] * others
    return to_colmap(rows), codes, width, height, options.camera_model, params, bool(focal)


def describe_images(database: Database, folder: str, names: Sequence[str], options: Options, pool: Threads,
                    log: Callable[[str], None]) -> int:
    """Describes new and changed images, and removes from the database those that are gone or cannot be read.

    :param names: of images in the folder.
    :return: how many cannot be read; each is a line in `log`."""
    masks = Masks(options.features.mask)
    stamps = {name: masks.stamp(os.path.join(folder, name), name) for name in names}
    done = database.stamps()
    missing = [name for name in stamps if done.get(name) != stamps[name]]
    if done and len(missing) == len(stamps) and not database.force:
        raise SettingsChanged(database.path, f'other images, none of which is in {folder}')
    for name in done.keys() - stamps.keys():
        database.forget(name)
    failed = 0
    described = in_parallel(functools.partial(describe_image, os.path.abspath(folder), options), missing, pool, (Exception,))
    for name, result in with_progress(described, 'describing', len(stamps), len(stamps) - len(missing)):
        if isinstance(result, (FileNotFoundError, ImportError)):
            raise result  # a fault of the worker, not of the image
        if isinstance(result, Exception):
            reason = str(result).splitlines()[0] if str(result) else type(result).__name__
            failed += 1
            log(f'{name}: {reason}')
            if name in done:
                database.forget(name)
        else:
            keypoints, codes, width, height, model, params, prior = result
            shared = options.share_cameras or options.camera_for(name) is not None
            database.add_image(name, stamps[name], width, height, model, params, prior, shared, keypoints, codes)
    return failed


def describe_again(database: Database, folder: str, names: Sequence[str], options: Options, level_sizes: tuple[int, ...], pool: Threads) -> None:
    """Describes images of a finished database again, which has no codes, if they are in pairs that it does not hold."""
    without = database.image_ids(without_codes=True)
    if not without:
        return
    needed = set(without.values())
    if options.pairs != 'retrieval':
        pairs, _ = list_pairs(database, folder, names, options.pairs, options.neighbours, level_sizes)
        needed &= {image for pair in pairs if not database.has_pair(*pair) for image in pair}
    missing = [name for name, image in without.items() if image in needed]
    described = in_parallel(functools.partial(describe_image, os.path.abspath(folder), options), missing, pool)
    for name, result in with_progress(described, 'describing again', len(missing)):
        if not database.add_codes(without[name], *result[:2]):
            raise ValueError(f'{name} has other points than when the database was made, by another version of OpenCV perhaps: start a new '
                             'database with force (--force)')


def match_tile(level_sizes: tuple[int, ...], ratio: float, verify: str,
               tile: tuple[list[Pair], dict[int, Any]]) -> list[tuple[Any, ...]]:
    """Arguments of Database.add_pair for each pair of image ids, from the codes and points of images by their ids."""
    found, matcher = [], HierarchicalMatcher.create(level_sizes, crossCheck=True)
    matcher.setMaxRatio(ratio)
    for a, b in tile[0]:
        (codes_a, points_a), (codes_b, points_b) = tile[1][a], tile[1][b]
        matches = opencv_iib.match(codes_a, codes_b, matcher).pairs
        if verify == 'magsac':
            inliers, matrix = magsac(points_a[matches[:, 0]], points_b[matches[:, 1]])
            found.append((matches, matches[inliers], matrix))
        else:
            found.append((matches, None, None))
    return found


def match_pairs(database: Database, listed: Pairs, ratio: float, level_sizes: tuple[int, ...], verify: str, pool: Threads) -> None:
    """Matches, and with magsac verifies, the pairs that the database does not hold.

    :param listed: pairs of image ids, each once, and their number if it is known."""
    images = functools.lru_cache(2 * BLOCK + 2)(lambda i: pool.hold(database.load_codes(i), database.load_keypoints(i)[:, :2]))
    pairs, total = listed
    progress = Progress('matching', total)

    def missing() -> Iterator[Pair]:
        for a, b in pairs:
            if database.has_pair(a, b):
                progress.step()
            else:
                yield a, b

    def jobs() -> Iterator[tuple[list[Pair], dict[int, Any]]]:
        for tile in tiles(missing(), pool.tile_side):
            yield tile, {image: images(image) for pair in tile for image in pair}

    match = functools.partial(match_tile, level_sizes, ratio, verify)
    for (tile, _), results in in_parallel(match, jobs(), pool):
        for pair, result in zip(tile, results):
            database.add_pair(*pair, *result)
            progress.step()
    progress.close()


def matches_importer(database: str, pairs: Iterable[tuple[str, str]]) -> None:
    """Has COLMAP verify the matches of a database. :raises RuntimeError: with the program's last lines, if it fails."""
    with tempfile.NamedTemporaryFile('w', suffix='.txt', encoding='utf-8', delete=False) as file:
        for a, b in pairs:
            file.write(f'{a} {b}\n')
    try:
        def run(*arguments: str) -> subprocess.CompletedProcess[str]:
            return subprocess.run([str(shutil.which('colmap')), 'matches_importer', *arguments], capture_output=True, text=True,
                                  env={**os.environ, 'QT_QPA_PLATFORM': 'offscreen'})
        gpu = 'FeatureMatching' if '--FeatureMatching.use_gpu' in run('--help').stdout else 'SiftMatching'
        done = run('--database_path', database, '--match_list_path', file.name, '--match_type', 'pairs', f'--{gpu}.use_gpu', '0')
        if done.returncode:
            tail = '\n'.join((done.stdout + done.stderr).splitlines()[-5:])
            raise RuntimeError(f'colmap matches_importer failed:\n{tail}')
    finally:
        os.unlink(file.name)


def build_database(images: Path, database: Path, options: Options = Options(), force: bool = False,
                   workers: Optional[int] = None, log: Callable[[str], None] = note, client: Any = None) -> dict[str, int]:
    """Describes and matches the images below a folder and writes COLMAP's database.

    :param images: folder; names in the database are relative to it.
    :param database: file to write, called ``database.partial`` until it is complete. A call after an interrupted one continues from there, with
        the same options. A finished database is updated: new images and their pairs are added, changed ones described again, missing ones
        removed. All others keep their numbers.
    :param force: replace an existing database, also an unfinished one with other options.
    :param workers: threads; None for one a core.
    :param client: a ``distributed.Client`` whose workers describe and match instead. They read the images by the same
        name; the database is written here, and is the same row for row.
    :return: counts of images, keypoints, pairs, matches, and of images that failed; see Database.counts.
    :raises FileExistsError: for another file at `database` without force, or at ``database.partial``.
    :raises ValueError: for invalid options, and for a folder without images.
    :raises SettingsChanged: if the database had other options and force is not set.
    :raises BlockingIOError: if another process is writing the database."""
    pool = Threads(thread_count(workers)) if client is None else Cluster(client)
    options.check()
    images, database = os.fspath(images), output_file(os.fspath(database))
    check_is_folder(images)
    names = find_images(images, log)
    if not names:
        raise InvalidOption(f'no images below {images}')
    left_out = 0  # lines of the list of pairs
    if options.pairs not in PAIRS:
        left_out = check_list(options.pairs, {name: number for number, name in enumerate(names)}, log)[1]
    if options.pairs == 'gps' and all(place is None for place in gps_places(images, names)):
        raise InvalidOption(f'no image below {images} has a place by GPS in its EXIF data')
    unlistable, verify = [name for name in names if not is_listable(name)], options.verify
    if verify == 'auto':
        verify = 'magsac' if unlistable or shutil.which('colmap') is None else 'colmap'
    if verify == 'colmap' and unlistable:
        raise InvalidOption(f'{unlistable[0]}: matches_importer reads no names with blanks or a leading #; rename it, or '
                            'verify by magsac (--verify)')
    for folder, _ in options._cameras():
        if not any(name.startswith(folder) for name in names):
            raise InvalidOption(f'camera_of is {folder}: no image is below {os.path.join(images, folder)}')
    lists, masks = [] if options.pairs in PAIRS else [options.pairs], Masks(options.features.mask)
    check_outputs([database], [*lists, *(os.path.join(images, name) for name in names), *masks.check(names)])
    check_sizes(images, names, masks, None)
    cameras = {name: options.camera_for(name) for name in names}
    for camera in dict.fromkeys(filter(None, cameras.values())):
        check_sizes(images, [name for name in names if cameras[name] == camera], Masks(None), camera)
    settings = {**options._settings(), 'verify': verify, 'version': opencv_iib.__version__}
    if os.path.exists(database) and not force:
        made = settings_of(database)
        if made is None:
            raise FileExistsError(f'{database} is there already, and not of this command: remove it, or pass force (--force)')
        check_settings(database, made, settings)
    sizes = Features(options.features).level_sizes()  # raises for a detector that cv2 lacks
    with only_writer(database + '.partial'), Database(database, settings, force) as target:
        failed = describe_images(target, images, names, options, pool, log)
        if failed == len(names):
            raise ValueError(f'none of the {failed} images below {images} can be described')
        describe_again(target, images, names, options, sizes, pool)
        pairs = list_pairs(target, images, names, options.pairs, options.neighbours, sizes)
        match_pairs(target, pairs, options.ratio, sizes, verify, pool)
        if verify == 'colmap':
            log('verifying with colmap matches_importer')
            by_number = {number: name for name, number in target.image_ids().items()}
            matches_importer(target.partial, ((by_number[a], by_number[b]) for a, b in target.pairs()))
        if options.search and verify != 'none' and target.changed:
            search_pairs(target, images, options.features, options.pairs == 'retrieval', pool)
        counts = {**target.counts(), 'failed': failed, **({'lines left out': left_out} if left_out else {})}
        target.finish()
    return counts
