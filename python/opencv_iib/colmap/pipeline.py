"""From a folder of images to a database for ``colmap mapper``."""
from __future__ import annotations

import dataclasses
import functools
import os
import posixpath
import socket
from typing import Any, Callable, Iterable, Iterator, Optional, Sequence

import numpy as np

import opencv_iib
from opencv_iib import _pairs as pair_lists
from opencv_iib._arguments import InvalidOption, Path, check_choice, check_count, number, sequence
from opencv_iib._camera import Camera
from opencv_iib._exif import exif_focal_length, gps_place
from opencv_iib._files import check_is_folder, check_outputs, only_writer, output_file
from opencv_iib._image_file import ImageFile, Masks, check_sizes
from opencv_iib._images import find_images, import_cv2, is_listable, is_utf8
from opencv_iib._parallel import Cluster, Threads, in_parallel, thread_count
from opencv_iib._progress import Progress
from opencv_iib._streams import note
from opencv_iib._two_views import magsac
from opencv_iib.colmap.database import CAMERA_MODELS, Database, SettingsChanged, check_settings, settings_of
from opencv_iib.colmap.search import search_pairs
from opencv_iib.colmap.verify import colmap_binary, matches_importer
from opencv_iib.features import FeatureOptions, Features, to_colmap
from opencv_iib.matcher import HierarchicalMatcher

PAIRS = ('exhaustive', 'sequential', 'retrieval', 'gps')
VERIFIERS = ('auto', 'colmap', 'magsac', 'none')


@dataclasses.dataclass(frozen=True)
class Options:
    """What build_database does; the values are those of the command line."""

    features: FeatureOptions = FeatureOptions()
    camera_model: str = 'SIMPLE_RADIAL'  #: one of database.CAMERA_MODELS
    focal: float = 0  #: pixels, of all images; 0: by EXIF, else 1.2 times the longer side without prior
    camera: Optional[str] = None  #: of all images, ``'MODEL,WIDTH,HEIGHT,PARAMS'`` with COLMAP's names and parameters, in place of these
    camera_of: Sequence[str] = ()  #: ``'FOLDER=MODEL,WIDTH,HEIGHT,PARAMS'``: of the images below a folder of the images'
    share_cameras: bool = False  #: one camera for all images of the same size and focal length
    pairs: Path = 'exhaustive'  #: one of PAIRS, or the name of a file with two names a line
    neighbours: int = 20  #: images that each is paired with (sequential, retrieval, gps)
    ratio: float = .92  #: ratio test, as HierarchicalMatcher.setMaxRatio; 1: none. Matches are always mutual.
    search: bool = True  #: search pairs at other zooms, rotations and tilts where images would stay unconnected; not if verify is none
    verify: str = 'auto'  #: one of VERIFIERS; auto: COLMAP's program if it is there, else MAGSAC

    def __post_init__(self) -> None:
        pairs = os.fspath(self.pairs)
        for field, name in (('camera_model', str(self.camera_model).upper()), ('verify', str(self.verify).lower()),
                            ('pairs', pairs.lower() if pairs.lower() in PAIRS else pairs)):  # in any case
            object.__setattr__(self, field, name)

    def camera_for(self, name: str) -> Optional[Camera]:
        """That of the longest folder that an image is in, or of all images; None if neither is known.

        :raises opencv_iib.error: for one that is none."""
        inside = [(len(folder), camera) for folder, camera in self._cameras() if name.startswith(folder)]
        return max(inside, key=lambda each: each[0])[1] if inside else None

    def _cameras(self) -> list[tuple[str, Camera]]:
        """With the folders that they are of; '' for all images."""
        texts = [(posixpath.normpath(folder).strip('/') + '/', camera) for folder, _, camera in (text.rpartition('=') for text in self.camera_of)]
        return [(folder, Camera.parse(camera)) for folder, camera in ([] if self.camera is None else [('', self.camera)]) + texts]

    def _settings(self) -> dict[str, Any]:
        """What a database depends on, with one text for each meaning. Masks are known by the files of the images."""
        return {**vars(self), **vars(self.features), 'features': None, 'mask': None, 'pairs': os.path.basename(self.pairs), 'camera': None,
                'camera_of': sorted(f'{folder}={camera}' for folder, camera in self._cameras())}

    def check(self) -> None:
        """:raises InvalidOption: naming what is wrong, and what there is."""
        self.features.check()
        if not 0 <= number(self.focal, 'focal') < float('inf'):
            raise InvalidOption(f'focal is {self.focal}: it must be a number of pixels, or 0')
        check_choice(self.camera_model, 'camera model', CAMERA_MODELS)
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
        if self.verify == 'colmap' and colmap_binary() is None:
            raise InvalidOption('verify is colmap, but there is no program colmap: install it, or take magsac')
        check_count(self.neighbours, 'neighbours')
        if not 0 < number(self.ratio, 'ratio') <= 1:
            raise InvalidOption(f'ratio is {self.ratio}: it must be in (0, 1]')
        import_cv2()


@functools.lru_cache(maxsize=1)
def _features(options: FeatureOptions) -> Features:
    """Of this process, whichever client's jobs it does."""
    return Features(options)


def describe_image(folder: str, options: Options, name: str
                   ) -> tuple[np.ndarray, np.ndarray, int, int, str, Sequence[float], bool]:
    """COLMAP's keypoints, codes, width and height; model and parameters of the camera, and whether its focal length is known."""
    if not os.path.isdir(folder):
        raise FileNotFoundError(f'{folder} is not there on {socket.gethostname()}: all workers have to read the images '
                                'by the same name')
    if not is_utf8(name):
        raise ValueError('its name is not UTF-8')
    file = ImageFile(os.path.join(folder, name), options.features.exif)
    rows, codes = _features(options.features)(file.grey, file.orientation_of_camera, Masks(options.features.mask).of(name, file.grey))
    height, width = file.grey.shape
    camera = options.camera_for(name)
    if camera is not None and (camera.width, camera.height) != (width, height):
        raise ValueError(f'it has {width} x {height} pixels, its camera {camera.width} x {camera.height}')
    if camera is not None:
        return to_colmap(rows), codes, width, height, camera.model, camera.params, True
    focal = options.focal or exif_focal_length(file.data, width, height)
    focals, others = CAMERA_MODELS[options.camera_model]
    params = [focal or 1.2 * max(width, height)] * focals + [width / 2, height / 2] + [0] * others
    return to_colmap(rows), codes, width, height, options.camera_model, params, bool(focal)


def describe_images(database: Database, folder: str, names: Sequence[str], options: Options, crew: Threads,
                    log: Callable[[str], None]) -> int:
    """Describes the images that the database does not know or that were changed, and removes those that are gone or broken.

    :param names: of images in the folder.
    :return: how many are broken; each is a line in `log`.
    """
    masks = Masks(options.features.mask)
    stamps = {name: masks.stamp(os.path.join(folder, name), name) for name in names}
    done = database.stamps()
    missing = [name for name in stamps if done.get(name) != stamps[name]]
    if done and len(missing) == len(stamps) and not database.force:
        raise SettingsChanged(database.path, f'other images, none of which is in {folder}')
    for name in done.keys() - stamps.keys():
        database.forget(name)
    failed = 0
    progress = Progress('describing', len(stamps), len(stamps) - len(missing))
    describe = functools.partial(describe_image, os.path.abspath(folder), options)
    for name, result in in_parallel(describe, missing, crew, (Exception,)):
        if isinstance(result, (FileNotFoundError, ImportError)):
            raise result  # not the image is at fault, but where it is worked on
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
        progress.step()
    progress.close()
    return failed


def describe_again(database: Database, folder: str, names: Sequence[str], options: Options, level_sizes: tuple[int, ...], crew: Threads) -> None:
    """Gives the images of a finished database their codes again, if they are of a pair that it does not hold."""
    without = database.without_codes()
    if not without:
        return
    needed = set(without.values())
    if options.pairs != 'retrieval':
        pairs, _ = list_pairs(database, folder, names, options, level_sizes)
        needed &= {image for pair in pairs if not database.has_pair(*pair) for image in pair}
    missing = [name for name, image in without.items() if image in needed]
    progress = Progress('describing again', len(missing))
    for name, result in in_parallel(functools.partial(describe_image, os.path.abspath(folder), options), missing, crew):
        if not database.add_codes(without[name], *result[:2]):
            raise ValueError(f'{name} has other points than when the database was made, by another version of OpenCV perhaps: begin anew with '
                             'force (--force)')
        progress.step()
    progress.close()


def list_pairs(database: Database, folder: str, names: Iterable[str], options: Options, level_sizes: tuple[int, ...]
               ) -> tuple[Iterator[tuple[int, int]], Optional[int]]:
    """Pairs of image ids, and how many there are if that is known."""
    numbers = database.image_ids()
    ids = list(numbers.values())
    count = len(ids)
    if options.pairs == 'exhaustive':
        chosen, total = pair_lists.exhaustive(count), count * (count - 1) // 2
    elif options.pairs == 'sequential':
        chosen, total = pair_lists.sequential(count, options.neighbours), sum(
            min(options.neighbours, count - 1 - i) for i in range(count))
    elif options.pairs == 'retrieval':
        chosen, total = pair_lists.distinct(pair_lists.retrieval(
            count, lambda i: database.load_codes(ids[i]), level_sizes, options.neighbours)), None
    elif options.pairs == 'gps':
        places = [gps_place(os.path.join(folder, name)) for name in numbers]
        chosen, total = pair_lists.distinct(pair_lists.nearest(places, options.neighbours)), None
    else:
        return pair_lists.distinct(pair_lists.read_list(options.pairs, {**dict.fromkeys(names), **numbers})[0]), None
    return ((ids[a], ids[b]) for a, b in chosen), total


@functools.lru_cache(maxsize=1)
def _matcher(level_sizes: tuple[int, ...], ratio: float) -> HierarchicalMatcher:
    matcher = HierarchicalMatcher.create(level_sizes, crossCheck=True)
    matcher.setMaxRatio(ratio)
    return matcher


def match_pair(matcher: HierarchicalMatcher, verify: str, image_a: Any, image_b: Any) -> tuple[Any, ...]:
    """Arguments of Database.add_pair, from codes and points of both."""
    (codes_a, points_a), (codes_b, points_b) = image_a, image_b
    matches = opencv_iib.match(codes_a, codes_b, matcher).pairs
    if verify != 'magsac':
        return matches, None, None
    inliers, matrix = magsac(points_a[matches[:, 0]], points_b[matches[:, 1]])
    return matches, matches[inliers], matrix


def match_tile(level_sizes: tuple[int, ...], ratio: float, verify: str,
               tile: tuple[list[tuple[int, int]], dict[int, Any]]) -> list[tuple[Any, ...]]:
    """Of each pair of image ids; codes and points are by id."""
    pairs, images = tile
    return [match_pair(_matcher(level_sizes, ratio), verify, images[a], images[b]) for a, b in pairs]


def match_pairs(database: Database, listed: tuple[Iterable[tuple[int, int]], Optional[int]], ratio: float,
                level_sizes: tuple[int, ...], verify: str, crew: Threads) -> None:
    """Matches, and with magsac verifies, the pairs that the database does not hold.

    :param listed: pairs of image ids, each once, and how many there are if that is known.
    """
    images = functools.lru_cache(2 * pair_lists.BLOCK + 2)(
        lambda i: crew.hold(database.load_codes(i), database.load_keypoints(i)[:, :2]))
    pairs, total = listed
    progress = Progress('matching', total)

    def missing() -> Iterator[tuple[int, int]]:
        for a, b in pairs:
            if database.has_pair(a, b):
                progress.step()
            else:
                yield a, b

    def jobs() -> Iterator[tuple[list[tuple[int, int]], dict[int, Any]]]:
        for tile in pair_lists.tiles(missing(), crew.tile_side):
            yield tile, {image: images(image) for pair in tile for image in pair}

    match = functools.partial(match_tile, level_sizes, ratio, verify)
    for (tile, _), results in in_parallel(match, jobs(), crew):
        for pair, result in zip(tile, results):
            database.add_pair(*pair, *result)
            progress.step()
    progress.close()


def verify_pairs(database: Database, binary: Optional[str], log: Callable[[str], None]) -> None:
    """Has COLMAP's program, if there is one to be asked, verify the pairs that have no two-view geometry."""
    if binary is not None:
        log('verifying with colmap matches_importer')
        names = {number: name for name, number in database.image_ids().items()}
        matches_importer(binary, database.partial, ((names[a], names[b]) for a, b in database.pairs()))


def build_database(images: Path, database: Path, options: Options = Options(), force: bool = False,
                   workers: Optional[int] = None, log: Callable[[str], None] = note, client: Any = None) -> dict[str, int]:
    """Describes and matches the images below a folder and writes COLMAP's database.

    :param images: folder; names in the database are relative to it.
    :param database: file to write. Until all is done it is ``database.partial``; a call after an interrupted one
        goes on from there, if the options are the same. One that an earlier call has finished grows: new images and their pairs are added,
        those that were changed or are gone are described anew or left out, and all others stay, with their numbers.
    :param force: replace a database that is there, and begin anew if an unfinished one had other options.
    :param workers: threads; None for one a core.
    :param client: a ``distributed.Client`` whose workers describe and match instead. They read the images by the same
        name; the database is written here, and is the same row for row.
    :return: counts of images, keypoints, pairs, matches, and of images that failed; see Database.counts.
    :raises FileExistsError: if there is a file that is no database of this function, and force is not set.
    :raises ValueError: for options that are none, and for a folder without images.
    :raises SettingsChanged: if the database had other options and force is not set.
    :raises FileExistsError: if what is at ``database.partial`` is of no unfinished run.
    :raises BlockingIOError: if another process is writing the database.
    """
    crew = Threads(thread_count(workers)) if client is None else Cluster(client)
    options.check()
    images, database = os.fspath(images), output_file(os.fspath(database))
    check_is_folder(images)
    names = find_images(images, log)
    if not names:
        raise ValueError(f'no images below {images}')
    left_out = 0  # lines
    if options.pairs not in PAIRS:
        left_out = pair_lists.check_list(options.pairs, {name: number for number, name in enumerate(names)}, log)[1]
    if options.pairs == 'gps' and all(gps_place(os.path.join(images, name)) is None for name in names):
        raise ValueError(f'no image below {images} has a place by GPS in its EXIF data')
    verify = options.verify
    if verify == 'auto':
        verify = 'colmap' if colmap_binary() and all(map(is_listable, names)) else 'magsac'
    binary = colmap_binary() if verify == 'colmap' else None
    unlistable = [name for name in names if binary and not is_listable(name)]
    if unlistable:
        raise ValueError(f'{unlistable[0]}: matches_importer reads no names with blanks or a leading #; rename it, or '
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
    sizes = _features(options.features).level_sizes()  # raises for a detector that cv2 lacks
    with only_writer(database + '.partial'), Database(database, settings, force) as target:
        failed = describe_images(target, images, names, options, crew, log)
        if failed == len(names):
            raise ValueError(f'none of the {failed} images below {images} can be described')
        describe_again(target, images, names, options, sizes, crew)
        match_pairs(target, list_pairs(target, images, names, options, sizes), options.ratio, sizes, verify, crew)
        verify_pairs(target, binary, log)
        if options.search and verify != 'none' and target.changed:
            search_pairs(target, images, options.features, options.pairs == 'retrieval', crew)
        counts = {**target.counts(), 'failed': failed, **({'lines left out': left_out} if left_out else {})}
        target.finish()
    return counts
