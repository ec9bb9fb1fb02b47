"""A folder of images, localized in a map; what is written about it."""
from __future__ import annotations

import csv
import functools
import os
from typing import Any, Iterator, Optional, Sequence

import numpy as np
from numpy.typing import NDArray

from opencv_iib.colmap.images import find_images, read_grey
from opencv_iib.colmap.parallel import Threads, in_parallel
from opencv_iib.colmap.progress import Progress
from opencv_iib.localization._pycolmap import pycolmap
from opencv_iib.localization.folders import new_folder
from opencv_iib.localization.geometry import project
from opencv_iib.localization.localizer import Localizer, Location
from opencv_iib.localization.map import Map, read_map

OWN = ('frames.csv', 'trajectory.txt', 'cameras.bin', 'images.bin', 'points3D.bin', 'rigs.bin', 'frames.bin', 'matches')
SAME_FOCAL = .05  #: of focal lengths, which EXIF tells roughly
AXES = ('x', 'y', 'z', 'rx', 'ry', 'rz')


def parse_camera(text: str) -> Any:
    """pycolmap.Camera of ``MODEL,WIDTH,HEIGHT,PARAMS``, as COLMAP names models and parameters.

    :raises ValueError: saying what is wrong, and which models there are.
    """
    model, _, numbers = text.partition(',')
    models = [name for name in pycolmap.CameraModelId.__members__ if name != 'INVALID']
    if model not in models:
        raise ValueError(f'no camera model {model}: there are {", ".join(models)}')
    try:
        width, height, *params = [float(number) for number in numbers.split(',')]
        camera = pycolmap.Camera(model=model, width=int(width), height=int(height), params=params)
        valid = camera.verify_params() and width >= 1 and height >= 1 and np.isfinite(params).all()
    except ValueError:
        valid = False
    if not valid:
        needed = pycolmap.Camera.create_from_model_name(0, model, 1., 1, 1).params_info
        raise ValueError(f'camera {text}: {model},WIDTH,HEIGHT and then {needed} are needed')
    return camera


def find_camera(path: str, width: int, height: int, known: Sequence[Any] = ()) -> Any:
    """pycolmap.Camera by the focal length that an image's EXIF data tell, or the only one of that size that is known.

    :param known: cameras of a map; one is taken if EXIF tells no focal length, or nearly the same.
    :raises ValueError: if there is none.
    """
    told = pycolmap.infer_camera_from_image(path)
    told = told if told.has_prior_focal_length and (told.width, told.height) == (width, height) else None
    same = [camera for camera in known if (camera.width, camera.height) == (width, height)]
    if len(same) == 1 and (told is None or abs(told.mean_focal_length() / same[0].mean_focal_length() - 1) < SAME_FOCAL):
        return same[0]
    if told is None:
        raise ValueError(f'its EXIF data tell no focal length, and {len(same)} cameras of the map have its size: give '
                         '--camera MODEL,WIDTH,HEIGHT,PARAMS')
    return told


def _localize(localizer: Localizer, folder: str, camera: Any, name: str) -> tuple[Any, Location]:
    path = os.path.join(folder, name)
    grey = read_grey(path)
    own = camera or find_camera(path, grey.shape[1], grey.shape[0], localizer.map.cameras)
    return own, localizer.localize(grey, own)


def locate(localizer: Localizer, folder: str, names: list[str], camera: Any, workers: Optional[int]
           ) -> Iterator[tuple[str, Any, Location]]:
    """Name, camera (None if the image cannot be read or has none) and location of each image, in order."""
    progress = Progress('localizing', len(names))
    job = functools.partial(_localize, localizer, folder, camera)
    for name, result in in_parallel(job, names, Threads(workers or os.cpu_count() or 1)):
        if isinstance(result, Exception) and not isinstance(result, (ValueError, OSError)):
            raise result
        yield (name, None, Location(str(result))) if isinstance(result, Exception) else (name, *result)
        progress.step()
    progress.close()


def images_of(folder: str) -> list[str]:
    """Names of the images below a folder.

    :raises ValueError: if there are none.
    """
    names = find_images(folder) if os.path.isdir(folder) else []
    if not names:
        raise ValueError(f'no images below {folder}')
    return names


def _check_names(names: Sequence[str]) -> None:
    """:raises ValueError: for names that a trajectory, which has them without their suffixes, cannot hold."""
    known: dict[str, str] = {}
    for name in names:
        if name.startswith('#') or len(name.splitlines()) > 1:
            raise ValueError(f'{name!r}: rename it, without a leading # and line breaks: a trajectory cannot hold these')
        other = known.setdefault(os.path.splitext(name)[0], name)
        if other != name:
            raise ValueError(f'{other} and {name} would have one pose: rename one of them')


def _write_picture(path: str, image: str, camera: Any, location: Location) -> None:
    import cv2
    picture = cv2.cvtColor(read_grey(image), cv2.COLOR_GRAY2BGR)
    for seen, mapped in zip(location.pixels, camera.img_from_cam(project(location.cam_from_world, location.points))):
        begin, end = ([round(8 * (v - .5)) for v in place] for place in (seen, mapped))  # eighths of pixels, see shift
        cv2.line(picture, begin, end, (0, 0, 255), 1, cv2.LINE_AA, 3)
        cv2.circle(picture, begin, 3 * 8, (0, 200, 0), 1, cv2.LINE_AA, 3)
    if not cv2.imwrite(path, picture):
        raise OSError(f'{path} cannot be written')


def add_image(model: Any, name: str, camera: Any, pixels: NDArray[np.float64], cam_from_world: Any) -> int:
    """Adds an image with its pose to a pycolmap.Reconstruction, and its camera unless that is there; the image's id."""
    def key(camera: Any) -> tuple[Any, ...]:
        return camera.model, camera.width, camera.height, *camera.params

    known: list[int] = [c.camera_id for c in model.cameras.values() if key(c) == key(camera) and c.camera_id in model.rigs and
             model.rig(c.camera_id).sensor_ids() == {c.sensor_id}]
    if not known:
        known = [max((*model.cameras, *model.rigs, 0)) + 1]
        model.add_camera_with_trivial_rig(pycolmap.Camera(camera_id=known[0], model=camera.model, width=camera.width,
                                                          height=camera.height, params=camera.params))
    number = 1 + int(max((*model.images, *model.frames, 0)))
    model.add_image_with_trivial_frame(pycolmap.Image(name, pixels, known[0], number), cam_from_world)
    return number


def localize_images(map: str | Map, images: str, out: str, camera: Any = None, pictures: bool = False,
                    workers: Optional[int] = None) -> tuple[int, int]:
    """Localizes the images below a folder and writes what was found.

    :param map: folder of a map, or what read_map gave.
    :param out: folder to write: ``trajectory.txt``, ``frames.csv``, a COLMAP model of the localized images and, with
        `pictures`, ``matches/``. It appears whole; older results there are replaced.
    :param camera: pycolmap.Camera of all images; None for each one's own, see find_camera.
    :param workers: threads; None for one a core.
    :return: how many images have a pose, and of how many.
    """
    names = images_of(images)
    _check_names(names)
    known = map if isinstance(map, Map) else read_map(map)
    localizer = Localizer(known, known.points)
    model = pycolmap.Reconstruction()
    with new_folder(out, OWN) as partial:
        os.makedirs(os.path.join(partial, 'matches'), exist_ok=True)
        with open(os.path.join(partial, 'trajectory.txt'), 'w', encoding='utf-8') as trajectory, \
                open(os.path.join(partial, 'frames.csv'), 'w', encoding='utf-8', newline='') as file:
            frames = csv.writer(file)
            trajectory.write('# name tx ty tz qx qy qz qw\n')
            frames.writerow(['name', 'found', 'reason', 'matches', 'inliers',
                             *(f'{a}_{b}' for n, a in enumerate(AXES) for b in AXES[n:])])
            for name, own, location in locate(localizer, images, names, camera, workers):
                found = location.cam_from_world is not None
                covariance = location.covariance[np.triu_indices(6)] if location.covariance is not None else ()
                frames.writerow([name, int(found), location.reason, location.matches, location.inliers,
                                 *(f'{value:.6g}' for value in covariance if found)])
                if not found:
                    continue
                pose = location.cam_from_world.inverse()
                numbers = [repr(float(v)) for v in (*pose.translation, *pose.rotation.quat)]
                trajectory.write(f'{os.path.splitext(name)[0]} {" ".join(numbers)}\n')
                add_image(model, name, own, location.pixels, location.cam_from_world)
                if pictures:
                    flat = name.replace('/', '-') + '.png'
                    _write_picture(os.path.join(partial, 'matches', flat), os.path.join(images, name), own, location)
        model.write(partial)
    return model.num_images(), len(names)
