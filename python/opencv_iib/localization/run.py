"""Localizes a folder of images in a map, and writes the results."""
from __future__ import annotations

import collections
import contextlib
import functools
import os
import re
from typing import Any, Callable, Iterable, Iterator, Optional, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from opencv_iib import _core, error
from opencv_iib._arguments import InvalidOption, Path
from opencv_iib._camera import AnyCamera, Camera, as_camera
from opencv_iib._exif import exif_focal_length
from opencv_iib._files import Results, check_folder, check_is_folder, check_outputs, csv_bytes, write_whole
from opencv_iib._image_file import ImageFile, Masks, check_sizes
from opencv_iib._image_names import find_images, is_utf8
from opencv_iib._images import import_cv2, write_picture
from opencv_iib._parallel import Threads, in_parallel, thread_count
from opencv_iib._progress import with_progress
from opencv_iib._streams import is_open_file, note
from opencv_iib._orientation import BACK
from opencv_iib.features import check_max_size
from opencv_iib.localization.imu import by_time, read_imu, smooth_poses
from opencv_iib.localization.localizer import Localizer, Location

SAME_FOCAL = .05  #: relative difference of equal focal lengths: EXIF's are rough, and COLMAP may estimate one an image
POSE = ('tx', 'ty', 'tz', 'qx', 'qy', 'qz', 'qw')  # the camera's centre, and camera to world
FRAME = ('name', 'found', 'reason', 'matches', 'inliers')  # with which frames.csv begins
AXES = ('x', 'y', 'z', 'rx', 'ry', 'rz')

#: Localizes an image, of its name, pixels as in its file, camera, EXIF's orientation and mask.
Find = Callable[[str, NDArray[np.uint8], Camera, int, Optional[NDArray[np.uint8]]], Location]


def find_camera(data: bytes, width: int, height: int, known: Sequence[Camera] = (), orientation: int = 1) -> Camera:
    """The camera of an image: one of the map's, or one with the focal length of its EXIF data.

    :param data: the image's file.
    :param known: cameras of a map. If those of the image's size agree, the middle one is returned, unless EXIF has another focal length.
    :param orientation: EXIF's, of the image: a map's cameras are of upright images.
    :raises ValueError: if no camera is known."""
    known = [*known, *(camera.upright(BACK[orientation]) for camera in known if orientation in (6, 8))]
    focal = exif_focal_length(data, width, height)
    same = tuple(camera for camera in known if (camera.width, camera.height) == (width, height))
    common = _common_camera(same)
    if common is not None and (focal is None or abs(focal / common.params[0] - 1) < SAME_FOCAL):
        return common
    if focal is None:
        differ = ', which differ' if len(same) > 1 else ''
        raise ValueError(f'its EXIF data have no focal length, and {len(same)} cameras of the map have its size{differ}: give '
                         f'--camera PINHOLE,{width},{height},F,F,{width / 2:g},{height / 2:g} with its focal length F in pixels')
    return Camera.parse(f'SIMPLE_PINHOLE,{width},{height},{focal!r},{width / 2},{height / 2}')


@functools.lru_cache
def _common_camera(cameras: tuple[Camera, ...]) -> Optional[Camera]:
    """The camera of the middle focal length, if all project the image's corners to nearly the same places; None otherwise."""
    if not cameras:
        return None
    middle = sorted(cameras, key=lambda camera: camera.params[0])[len(cameras) // 2]
    for camera in cameras:
        right, bottom = camera.width - 1, camera.height - 1
        corners = np.array([(0, 0), (right, 0), (0, bottom), (right, bottom)], float)
        rays = np.column_stack([middle.undistorted(corners), np.ones(4)]) @ np.linalg.inv(middle.matrix).T
        if not np.abs(camera.project(rays) - corners).max() < SAME_FOCAL * max(right, bottom) / 2:
            return None
    return middle


class _Locator:
    """Localizes images, each with the given camera or its own."""

    def __init__(self, find: Find, known: Sequence[AnyCamera], camera: Optional[AnyCamera], exif: bool, mask: Optional[Path], max_size: int,
                 log: Callable[[str], None]) -> None:
        """:param known: cameras of the map."""
        self._find, self._known, self._exif, self._max_size, self._log = find, list(map(as_camera, known)), exif, max_size, log
        self.camera, self.masks, self._reported = None if camera is None else as_camera(camera), Masks(mask), set[Camera]()

    def __call__(self, path: str, name: str) -> tuple[Camera, Location]:
        """An image's camera and location, in pixels of its file. :param name: the image's name among the masks."""
        file = ImageFile(path, self._exif)
        small, mask, scale = file.small(self._max_size, self.masks, name)
        orientation = file.orientation_of_camera
        own = self.camera or find_camera(file.data, file.grey.shape[1], file.grey.shape[0], self._known, orientation)
        found = self._find(name, small, own if small is file.grey else own.resized(*small.shape[::-1]), orientation, mask)
        if small is not file.grey:
            found.pixels = (found.pixels + .5) * scale - .5  # the centre of the first pixel is 0
        return own, found

    def report(self, own: Camera) -> None:
        """Logs, once, that a camera of the map was chosen among several."""
        count = sum((other.width, other.height) == (own.width, own.height) for other in self._known)
        if self.camera is None and own in self._known and own not in self._reported and count > 1:
            self._log(f'{own.width} x {own.height} pixels: {own}, the middle one of {count} cameras of the map, which agree')
        self._reported.add(own)


def locate(find: Find, known: Sequence[AnyCamera], folder: Path, names: Sequence[str], camera: Optional[AnyCamera],
           workers: Optional[int], log: Callable[[str], None], exif: bool, mask: Optional[Path] = None, max_size: int = 0
           ) -> Iterator[tuple[str, Optional[Camera], Any]]:
    """Yields for each image, in order, its name, camera and Location; None and an error text if it cannot be read or has no camera.

    :param find: called by several threads.
    :param known: cameras of the map.
    :param log: gets a line about a camera of the map that was chosen among several."""
    import_cv2()
    locator = _Locator(find, known, camera, exif, mask, max_size, log)
    locator.masks.check(names)
    check_sizes(folder, names, locator.masks, locator.camera)

    def job(name: str) -> tuple[Camera, Location]:
        if not is_utf8(name) or name.startswith('#') or len(name.splitlines()) > 1:
            raise ValueError('the trajectory cannot hold this name: rename it in UTF-8, without a leading # or a line break')
        return locator(os.path.join(folder, name), name)

    located = in_parallel(job, names, Threads(thread_count(workers)), (ValueError, OSError, error))
    for name, result in with_progress(located, 'localizing', len(names)):
        own, location = (None, str(result)) if isinstance(result, Exception) else result
        if own is not None:
            locator.report(own)
        yield name, own, location


def images_of(folder: Path, out: Path = '', log: Callable[[str], None] = note) -> list[str]:
    """Names of the images below a folder, without those in the folder of results. :raises InvalidOption: if there are none."""
    check_is_folder(folder)
    inside = os.path.relpath(os.path.realpath(out), os.path.realpath(folder)).replace(os.sep, '/') if out else '..'
    names = [name for name in find_images(folder, log) if not name.startswith(inside + '/')]
    if not names:
        raise InvalidOption(f'no images below {folder}')
    return names


def labels_of(names: Sequence[str]) -> dict[str, str]:
    """Names of images in trajectories: without extension, unless two would be the same."""
    stems = {name: os.path.splitext(name)[0] for name in names}
    count = collections.Counter(stems.values())
    return {name: name if count[stem] > 1 or stem in stems else stem for name, stem in stems.items()}


def _write_picture(path: str, image: str, camera: Camera, location: Location) -> None:
    cv2 = import_cv2()
    picture = cv2.cvtColor(ImageFile(image).grey, cv2.COLOR_GRAY2BGR)
    pose = np.asarray(location.cam_from_world)
    for seen, mapped in zip(location.pixels, camera.project(location.points @ pose[:3, :3].T + pose[:3, 3])):
        begin, end = ([round(8 * v) for v in place] for place in (seen, mapped))  # eighths of pixels, see shift
        cv2.line(picture, begin, end, (0, 0, 255), 1, cv2.LINE_AA, 3)
        cv2.circle(picture, begin, 3 * 8, (0, 200, 0), 1, cv2.LINE_AA, 3)
    write_picture(path, picture)


def _numbers(cam_from_world: NDArray[np.float64]) -> list[str]:
    """The camera's centre, and the quaternion x y z w from the camera to the world."""
    turn = cam_from_world[:3, :3].T
    vector = import_cv2().Rodrigues(turn)[0].ravel()
    half = np.linalg.norm(vector) / 2
    place = -turn @ cam_from_world[:3, 3]
    return [repr(value) for value in (*place.tolist(), *(vector * np.sinc(half / np.pi) / 2).tolist(), float(np.cos(half)))]


def check_fits(e: error) -> None:
    """:raises InvalidOption: if the library says that an option does not fit the map or this build."""
    if re.search("the map has no lines|built without OpenCV's module|OpenCV 5 has no AKAZE", str(e)):
        raise InvalidOption(str(e)) from None


def _localizer(map: Path, points: int, lines: bool) -> Localizer:
    """:raises InvalidOption: for a missing folder, a map without lines, or an OpenCV that finds none."""
    check_is_folder(map)
    try:
        return Localizer(map, points, lines)
    except error as e:
        check_fits(e)
        raise


def localize_stream(map: Path, paths: Iterable[str], camera: Optional[AnyCamera] = None, lines: bool = False,
                    max_size: int = 0, exif: bool = True, mask: Optional[Path] = None, log: Callable[[str], None] = note) -> Iterator[tuple[str, bool]]:
    """Localizes images one after another, each first near the previous one.

    :param paths: of the images, such as lines of a pipe.
    :param camera: as in localize_images; so are `lines`, `max_size` and `exif`.
    :param mask: a mask, or a folder of masks by the images' names without folders.
    :param log: gets a line about a camera of the map that was chosen among several.
    :return: yields for each image a line, ``PATH tx ty tz qx qy qz qw`` or ``# PATH: why there is no pose``, and whether it has a pose."""
    check_max_size(max_size)
    localizer, last = _localizer(map, 1000, lines), None
    locator = _Locator(lambda name, image, own, *more: localizer.localize(image, own, last, *more), localizer.cameras, camera, exif, mask, max_size, log)
    for path in paths:
        path = path.rstrip('\r\n')
        try:
            if path.startswith('#'):  # its line would look like a failure
                raise ValueError('a path must not begin with #: write ./ before it')
            own, location = locator(path, os.path.basename(path))
            locator.report(own)
            last, problem = location.cam_from_world, location.reason
        except (ValueError, OSError, error) as e:
            last, problem = None, str(e)
        yield f'# {path}: {problem}' if last is None else f'{path} {" ".join(_numbers(last))}', last is not None


def localize_images(map: Path, images: Path, out: Path, camera: Optional[AnyCamera] = None, pictures: bool = False,
                    workers: Optional[int] = None, log: Callable[[str], None] = note, lines: bool = False, max_size: int = 0,
                    imu: Optional[Path] = None, imu_from_camera: ArrayLike = np.eye(4), exif: bool = True,
                    mask: Optional[Path] = None, sequence: bool = False) -> tuple[int, int]:
    """Localizes the images below a folder and writes their poses.

    :param map: folder of a map.
    :param out: folder to write: ``trajectory.txt``, ``frames.csv`` (each image's pose and covariance, or why it has none), a COLMAP model of the
        localized images and, with `pictures`, ``matches/``. Older results there are replaced. A name in .csv, or '-' for standard output:
        ``frames.csv`` alone.
    :param camera: of all images, as in Localizer.localize; None: each one's own, by its EXIF data or the map.
    :param workers: threads; None for one a core.
    :param log: gets a line about each image without a pose.
    :param lines: as in Localizer.
    :param max_size: pixels of the longer side to which larger images are reduced; 0: they are not.
    :param imu: EuRoC's imu.csv, which smooths the poses, see smooth_poses: for a map in metres, and images named by their times.
    :param imu_from_camera: as in smooth_poses.
    :param exif: images are rotated upright by their EXIF data; poses and cameras are those of the files' pixels.
    :param mask: a mask, or a folder of masks that have the name of the image and .png, such as a.jpg.png.
    :param sequence: images follow each other by their names (2 before 10) or times: each is first looked for near the previous one.
    :return: how many images have a pose, and how many there are."""
    workers, out = thread_count(workers), os.fspath(out)
    table_alone = out.lower().endswith('.csv') or is_open_file(out)
    names, times, readings = images_of(images, '' if table_alone else out, log), {}, None
    if sequence:
        workers = 1
    if table_alone and pictures:
        raise InvalidOption(f'{out} is no folder, which pictures need')
    read = [os.path.join(images, name) for name in names] + Masks(mask).check(names) + ([] if imu is None else [os.fspath(imu)])
    if table_alone:
        check_outputs([out], read)
    else:
        check_folder(out, read, ', X.csv and -')
    if imu is None and not np.array_equal(np.asarray(imu_from_camera)[:3], np.eye(4)[:3]):
        raise InvalidOption('imu_from_camera goes with imu alone: give its file (--imu)')
    if imu is not None:
        readings = read_imu(os.fspath(imu))
        times = by_time(names, readings)
        names = list(times)
    labels = labels_of(names)
    given = None if camera is None else as_camera(camera)
    check_max_size(max_size)
    frames: list[list[Any]] = []
    found: list[tuple[Optional[Camera], Location]] = []  # without points, to save memory
    last: Optional[NDArray[np.float64]] = None

    def find_next(name: str, image: NDArray[np.uint8], camera: Camera, *more: Any) -> Location:
        nonlocal last
        location = localizer.localize(image, camera, last, *more)
        last = location.cam_from_world if sequence else None
        return location
    with contextlib.nullcontext() if table_alone else Results(out, 'localize') as results:
        localizer = _localizer(map, 0, lines)
        for name, own, location in locate(find_next, localizer.cameras, images, names, given, workers, log, exif, mask, max_size):
            location = Location(reason=location) if own is None else location
            row = [name, int(location.found), location.reason, location.matches, location.inliers]
            if own is not None and location.covariance is not None:
                row += [f'{value:.6g}' for value in location.covariance[np.triu_indices(6)]]
                if pictures and results is not None:
                    _write_picture(results.place(f'matches/{labels[name]}.png'), os.path.join(images, name), own, location)
            else:
                log(f'{name}: {location.reason}')
            frames.append(row)
            found.append((own, Location(location.cam_from_world, location.covariance, location.reason, pixels=location.pixels)))
        poses = [location.cam_from_world for _, location in found]
        if readings is not None:
            poses = smoothed = smooth_poses(list(times.values()), [location for _, location in found], readings, imu_from_camera)
            if smoothed.reason:
                log(smoothed.reason)
        write_whole(out if results is None else results.place('frames.csv'), _table(frames, poses))
        if results is not None:
            posed_lines = [f'{labels[name]} {" ".join(_numbers(pose))}\n' for name, pose in zip(names, poses) if pose is not None]
            write_whole(results.place('trajectory.txt'), ''.join([f'# name {" ".join(POSE)}\n', *posed_lines]).encode())
            posed = [_core.PosedImage(name, own, pose, location.pixels) for name, pose, (own, location) in zip(names, poses, found)
                     if pose is not None and own is not None]
            if posed:  # no reader takes a model of none
                _core.writeModel(os.path.dirname([results.place(name + '.bin') for name in ('cameras', 'images', 'points3D')][0]), posed)
    return sum(pose is not None for pose in poses), len(names)


def _table(frames: Sequence[list[Any]], poses: Sequence[Optional[NDArray[np.float64]]]) -> bytes:
    """The frames with their poses, as CSV."""
    header = [*FRAME, *(f'{a}_{b}' for n, a in enumerate(AXES) for b in AXES[n:])]
    rows = (row if pose is None else [*row, *[''] * (len(header) - len(row)), *_numbers(pose)] for row, pose in zip(frames, poses))
    return csv_bytes([[*header, *POSE], *rows])
