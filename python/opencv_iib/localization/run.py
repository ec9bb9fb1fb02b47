"""A folder of images, localized in a map; what is written about it."""
from __future__ import annotations

import collections
import contextlib
import csv
import functools
import io
import os
import re
from typing import Any, Callable, Iterable, Iterator, Optional, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from opencv_iib import _core, error
from opencv_iib._arguments import InvalidOption, Path
from opencv_iib._camera import AnyCamera, Camera, as_camera
from opencv_iib._exif import exif_focal_length
from opencv_iib._files import Results, check_folder, check_is_folder, check_outputs, write_whole
from opencv_iib._image_file import ImageFile, Masks, check_sizes
from opencv_iib._images import find_images, import_cv2, is_utf8, write_picture
from opencv_iib._parallel import Threads, in_parallel, thread_count
from opencv_iib._progress import Progress
from opencv_iib._streams import is_open_file, note
from opencv_iib._upright import BACK
from opencv_iib.features import check_max_size
from opencv_iib.localization.imu_file import by_time, read_imu
from opencv_iib.localization.localizer import Localizer, Location
from opencv_iib.localization.smoothing import smooth_poses

SAME_FOCAL = .05  #: of focal lengths, which EXIF tells roughly, and COLMAP of a camera an image
POSE = ('tx', 'ty', 'tz', 'qx', 'qy', 'qz', 'qw')  # the camera's centre, and camera to world
FRAME = ('name', 'found', 'reason', 'matches', 'inliers')  # with which frames.csv begins
AXES = ('x', 'y', 'z', 'rx', 'ry', 'rz')

#: What finds an image: its name, pixels as its file has them, camera, EXIF's orientation and mask.
Find = Callable[[str, NDArray[np.uint8], Camera, int, Optional[NDArray[np.uint8]]], Location]


def find_camera(data: bytes, width: int, height: int, known: Sequence[Camera] = (), orientation: int = 1) -> Camera:
    """The camera of the focal length that an image's EXIF data tell, or that of its size which is known.

    :param data: of the image's file.
    :param known: cameras of a map. One of the image's size is taken, or of several that agree the middle one, if EXIF tells no focal
        length or nearly the same.
    :param orientation: of the image, by EXIF: a map's cameras are of upright images.
    :raises ValueError: if there is none.
    """
    known = [*known, *(camera.upright(BACK[orientation]) for camera in known if orientation in (6, 8))]
    focal = exif_focal_length(data, width, height)
    same = tuple(camera for camera in known if (camera.width, camera.height) == (width, height))
    common = _common_camera(same)
    if common is not None and (focal is None or abs(focal / common.params[0] - 1) < SAME_FOCAL):
        return common
    if focal is None:
        differ = ', which differ' if len(same) > 1 else ''
        raise ValueError(f'its EXIF data tell no focal length, and {len(same)} cameras of the map have its size{differ}: give '
                         f'--camera PINHOLE,{width},{height},F,F,{width / 2:g},{height / 2:g} with its focal length F in pixels')
    return Camera.parse(f'SIMPLE_PINHOLE,{width},{height},{focal!r},{width / 2},{height / 2}')


@functools.lru_cache
def _common_camera(cameras: tuple[Camera, ...]) -> Optional[Camera]:
    """Of cameras of one size that of the middle focal length, if all have the image's corners where it has them."""
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


def _locate(find: Find, known: Sequence[Camera], folder: Path, camera: Optional[Camera], exif: bool, masks: Masks, max_size: int, name: str
            ) -> tuple[Camera, Location]:
    """An image's camera, and what `find` finds in it, reduced to this longer side if it is larger; pixels are its own."""
    file = ImageFile(os.path.join(folder, name), exif)
    small, mask, scale = file.small(max_size, masks, name if folder else os.path.basename(name))
    orientation = file.orientation_of_camera
    own = camera or find_camera(file.data, file.grey.shape[1], file.grey.shape[0], known, orientation)
    if small is file.grey:
        return own, find(name, small, own, orientation, mask)
    found = find(name, small, own.resized(*small.shape[::-1]), orientation, mask)
    pixels = (found.pixels + .5) * scale - .5  # the centre of the first one is 0
    return own, Location(found.cam_from_world, found.covariance, found.reason, found.matches, found.inliers, pixels, found.points)


def _camera_reporter(cameras: Sequence[Camera], log: Callable[[str], None]) -> Callable[[Camera], None]:
    """What tells, once, of a camera that was taken for others of the map."""
    told = set()

    def report_camera(own: Camera) -> None:
        alike = sum((other.width, other.height) == (own.width, own.height) for other in cameras)
        if own in cameras and own not in told and alike > 1:
            log(f'{own.width} x {own.height} pixels: {own}, the middle one of {alike} cameras of the map, which agree')
        told.add(own)
    return report_camera


def locate(find: Find, known: Sequence[AnyCamera], folder: Path, names: Sequence[str], camera: Optional[AnyCamera],
           workers: Optional[int], log: Callable[[str], None], exif: bool, mask: Optional[Path] = None, max_size: int = 0
           ) -> Iterator[tuple[str, Optional[Camera], Any]]:
    """Of each image in order its name, its camera and Location; None and what is wrong if it cannot be read or has no camera.

    :param find: threads call it.
    :param known: cameras of the map.
    :param log: told of cameras that were taken for others.
    """
    import_cv2()
    masks = Masks(mask)
    masks.check(names)
    given, cameras = None if camera is None else as_camera(camera), list(map(as_camera, known))
    check_sizes(folder, names, masks, given)
    report_camera = _camera_reporter(cameras, log)
    progress = Progress('localizing', len(names))

    def job(name: str) -> tuple[Camera, Location]:
        check_name(name)
        return _locate(find, cameras, folder, given, exif, masks, max_size, name)

    for name, result in in_parallel(job, names, Threads(thread_count(workers)), (ValueError, OSError, error)):
        own, location = (None, str(result)) if isinstance(result, Exception) else result
        if given is None and own is not None:
            report_camera(own)
        yield name, own, location
        progress.step()
    progress.close()


def images_of(folder: Path, out: Path = '', log: Callable[[str], None] = note) -> list[str]:
    """Names of the images below a folder, but for those in `out`, where results are.

    :raises ValueError: if there are none.
    """
    check_is_folder(folder)
    inside = os.path.relpath(os.path.realpath(out), os.path.realpath(folder)).replace(os.sep, '/') if out else '..'
    names = [name for name in find_images(folder, log) if not name.startswith(inside + '/')]
    if not names:
        raise ValueError(f'no images below {folder}')
    return names


def check_name(name: str) -> None:
    """:raises ValueError: for one that results cannot hold."""
    if not is_utf8(name) or name.startswith('#') or len(name.splitlines()) > 1:
        raise ValueError('rename it, in UTF-8, without a leading # and line breaks: a trajectory cannot hold these')


def labels_of(names: Sequence[str]) -> dict[str, str]:
    """What stands for images in trajectories: names without extension, or with it where another would have the same."""
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


def _localizer(map: Path, points: int, lines: bool) -> Localizer:
    """:raises InvalidOption: for no folder, lines of a map without them, or where OpenCV finds none."""
    check_is_folder(map)
    try:
        return Localizer(map, points, lines)
    except error as e:
        if re.search("the map has no lines|lines need OpenCV's module", str(e)):
            raise InvalidOption(str(e)) from None
        raise


def localize_stream(map: Path, paths: Iterable[str], camera: Optional[AnyCamera] = None, lines: bool = False,
                    max_size: int = 0, exif: bool = True, mask: Optional[Path] = None, log: Callable[[str], None] = note) -> Iterator[tuple[str, bool]]:
    """Localizes images one after another, each first where the last one was.

    :param paths: of the images, which may come from a pipe; line ends behind them are dropped.
    :param camera: as of localize_images; so are `lines`, `max_size` and `exif`.
    :param mask: what is described, as of Masks, by the names of images without their folders.
    :param log: told of cameras that were taken for others.
    :return: of each image a line, ``PATH tx ty tz qx qy qz qw`` or ``# PATH: why there is no pose``, and whether there is one.
    """
    check_max_size(max_size)
    localizer, masks = _localizer(map, 1000, lines), Masks(mask)
    known, given, last = localizer.cameras, None if camera is None else as_camera(camera), None
    report_camera = _camera_reporter(known, log)
    for path in paths:
        path = path.rstrip('\r\n')
        try:
            if path.startswith('#'):  # would look like a failure
                raise ValueError('a path must not begin with #: write ./ before it')
            own, location = _locate(lambda name, image, own, *more: localizer.localize(image, own, last, *more), known, '', given, exif, masks, max_size,
                                    path)
            if given is None:
                report_camera(own)
            last, problem = location.cam_from_world, location.reason
        except (ValueError, OSError, error) as e:
            last, problem = None, str(e)
        yield f'# {path}: {problem}' if last is None else f'{path} {" ".join(_numbers(last))}', last is not None


def localize_images(map: Path, images: Path, out: Path, camera: Optional[AnyCamera] = None, pictures: bool = False,
                    workers: Optional[int] = None, log: Callable[[str], None] = note, lines: bool = False, max_size: int = 0,
                    imu: Optional[Path] = None, imu_from_camera: ArrayLike = np.eye(4), exif: bool = True,
                    mask: Optional[Path] = None, sequence: bool = False) -> tuple[int, int]:
    """Localizes the images below a folder and writes what was found.

    :param map: folder of a map.
    :param out: a name in .csv, or '-' for standard output, for the table ``frames.csv`` alone: of each image whether there is a pose, or why
        not, its covariance and the pose. Else a folder to write: ``trajectory.txt``, ``frames.csv``, a COLMAP model of the localized images and, with
        `pictures`, ``matches/``. Older results there are replaced.
    :param camera: of all images, as Localizer.localize takes it; None for each one's own, by its EXIF data or the map.
    :param workers: threads; None for one a core.
    :param log: told of each image without a pose, and why.
    :param lines: as Localizer takes it.
    :param max_size: pixels of the longer side to which larger images are reduced; 0: they are not.
    :param imu: EuRoC's imu.csv, in a map in metres, of images that are named by their times: poses are smoothed by it, see smooth_poses.
    :param imu_from_camera: as smooth_poses takes it.
    :param exif: images are looked for as upright as their EXIF data say; poses and cameras are those of the files' pixels.
    :param mask: what is described, as of Masks.
    :param sequence: images follow each other in the order of their names (2 before 10) or times: each is first looked for where the last one was.
    :return: how many images have a pose, and of how many.
    """
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
    if imu is not None:
        readings = read_imu(os.fspath(imu))
        times = by_time(names, readings)
        names = list(times)
    labels = labels_of(names)
    given = None if camera is None else as_camera(camera)
    check_max_size(max_size)
    frames: list[list[Any]] = []
    cameras: list[Optional[Camera]] = []
    found: list[Location] = []  # with their pixels alone, and not the points, which are many
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
            cameras.append(own)
            found.append(Location(location.cam_from_world, location.covariance, location.reason, pixels=location.pixels))
        poses = [location.cam_from_world for location in found]
        if readings is not None:
            poses = smoothed = smooth_poses(list(times.values()), found, readings, imu_from_camera)
            if smoothed.reason:
                log(smoothed.reason)
        table = _table(frames, poses)
        write_whole(out if results is None else results.place('frames.csv'), table)
        if results is not None:
            posed_lines = [f'{labels[name]} {" ".join(_numbers(pose))}\n' for name, pose in zip(names, poses) if pose is not None]
            write_whole(results.place('trajectory.txt'), ''.join([f'# name {" ".join(POSE)}\n', *posed_lines]).encode())
            posed = [_core.PosedImage(name, own, pose, location.pixels) for name, own, pose, location in zip(names, cameras, poses, found)
                     if pose is not None and own is not None]
            if posed:  # no reader takes a model of none
                _core.writeModel(os.path.dirname([results.place(name + '.bin') for name in ('cameras', 'images', 'points3D')][0]), posed)
    return sum(pose is not None for pose in poses), len(names)


def _table(frames: Sequence[list[Any]], poses: Sequence[Optional[NDArray[np.float64]]]) -> bytes:
    """A CSV of the frames, with the poses."""
    text = io.StringIO(newline='')
    table, covariance = csv.writer(text), [f'{a}_{b}' for n, a in enumerate(AXES) for b in AXES[n:]]
    table.writerow([*FRAME, *covariance, *POSE])
    for row, pose in zip(frames, poses):
        table.writerow(row if pose is None else [*row, *[''] * (len(FRAME) + len(covariance) - len(row)), *_numbers(pose)])
    return text.getvalue().encode(errors='backslashreplace')
