"""Makes maps of COLMAP models and their images, and updates maps with images under changed illumination."""
from __future__ import annotations

import os
import threading
from concurrent.futures import ThreadPoolExecutor
from typing import Callable, Optional

import numpy as np
from numpy.typing import NDArray

from opencv_iib import _core
from opencv_iib._arguments import InvalidOption, Path, check_count
from opencv_iib._arrays import as_mask
from opencv_iib._camera import AnyCamera, Camera
from opencv_iib._files import check_folder, check_is_folder
from opencv_iib._image_file import ImageFile, Masks
from opencv_iib._image_names import in_order
from opencv_iib._parallel import thread_count
from opencv_iib._progress import Progress
from opencv_iib._streams import note
from opencv_iib.features import check_max_size
from opencv_iib.localization.localizer import Location
from opencv_iib.localization.run import check_fits, images_of, locate

LEFT_OUT = ': left out of the map'
UNREAD = (' cannot be read' + LEFT_OUT).encode()


def _check_new(out: Path, force: bool) -> None:
    check_folder(out)
    if os.path.exists(os.path.join(out, 'map.iib')) and not force:
        raise FileExistsError(f'{out} is there already: choose another folder, or pass force (--force) to replace a map')


def build(model: Path, images: Path, out: Path, points: int = 2000, workers: Optional[int] = None, force: bool = False,
          log: Callable[[str], None] = note, lines: bool = False, orb_and_akaze: bool = False, exif: bool = True,
          mask: Optional[Path] = None, max_size: int = 0) -> dict[str, int]:
    """Finds and describes points in the images of a COLMAP model, triangulates them with its poses, and writes a map.

    :param model: folder of a model, binary or text; its poses and cameras are used as they are, in any unit.
    :param images: folder that the names of the model's images are relative to.
    :param out: folder of the map.
    :param points: at most so many keypoints an image.
    :param workers: threads; None for one a core.
    :param force: replace an existing map, unless an image is left out. Programs that read it meanwhile get the old one or the new one.
    :param log: gets a line about each image that is left out: missing, unreadable or of another size than its camera.
    :param lines: map straight edges too, see Localizer.
    :param orb_and_akaze: the paper's points and descriptor instead of the recommended ones, also for images to be localized.
    :param exif: images are rotated upright by their EXIF data; the map then has upright cameras and poses.
    :param mask: a mask, or a folder of masks that have the name of the image and .png, such as a.jpg.png.
    :param max_size: pixels of the longer side to which larger images are reduced; 0: they are not.
    :return: counts of images, points, and images that were left out.
    :raises InvalidOption: for an invalid number of points, for lines or AKAZE's points if this OpenCV has none, and if no image can be read.
    :raises FileExistsError: if there is a map and force is not set, or images are left out.
    :raises FileNotFoundError: for a missing folder.
    :raises opencv_iib.error: for a damaged model, one of other images, and a folder with other files."""
    check_count(points, 'points')
    check_max_size(max_size)
    threads, used = _core.getNumThreads(), thread_count(workers)
    target = os.path.realpath(out)
    _check_new(out, force)
    for folder in (model, images):
        check_is_folder(folder)
    stop = threading.Event()
    progress: Optional[Progress] = None

    masks, left_out, is_there = Masks(mask), 0, os.path.exists(os.path.join(target, 'map.iib'))
    unreported: list[str] = []  # lines about images that are left out, kept until one image is read
    read_any = False
    reasons: dict[bytes, bytes] = {}  # why images cannot be read, by the line of the library about them

    def read(name: bytes) -> tuple[NDArray[np.uint8], int, NDArray[np.uint8]]:
        nonlocal read_any
        if stop.is_set():
            raise KeyboardInterrupt
        try:
            file = ImageFile(os.path.join(images, os.fsdecode(name)), exif)
            found = file.grey, file.orientation_of_camera, as_mask(masks.of(os.fsdecode(name), file.grey))
            read_any = True
            return found
        except (ValueError, OSError) as e:
            reasons[name + UNREAD] = name + f': {getattr(e, "strerror", None) or e}{LEFT_OUT}'.encode(errors='surrogateescape')
            return as_mask(None), 1, as_mask(None)

    def report(done: int, total: int, problem: bytes) -> None:
        nonlocal progress, left_out
        if stop.is_set():
            raise KeyboardInterrupt
        if problem:
            left_out += 1
            unreported.append(reasons.get(problem, problem).decode(errors='backslashreplace'))
            if is_there:
                raise FileExistsError(f'{unreported.pop()}, so that of {os.fspath(out)} is not replaced: choose another folder')
        while read_any and unreported:
            log(unreported.pop(0))
        progress = progress or Progress('mapping', total)
        progress.step(done - progress.done)

    with ThreadPoolExecutor(1) as pool:  # so that Ctrl-C reaches this thread
        try:
            _core.setNumThreads(used)
            pool.submit(_core.buildMap, os.fspath(model), read, target, points, lines, orb_and_akaze, max_size, report).result()
        except _core.error as e:
            check_fits(e)
            if unreported:
                why = min(unreported, key=in_order)[:-len(LEFT_OUT)]
                raise InvalidOption(f"cannot use any of the model's {left_out} images in {os.fspath(images)}; the first: {why}") from None
            raise
        finally:
            stop.set()
            _core.setNumThreads(threads)
            if progress is not None:
                progress.close()
    known, seen = (int(np.fromfile(os.path.join(target, name), '<u8', 1)[0]) for name in ('images.bin', 'points3D.bin'))  # which begin with counts
    return {'images': known - left_out, 'points': seen, 'left out': left_out}


def update(map: Path, images: Path, camera: Optional[AnyCamera] = None, out: Optional[Path] = None,
           workers: Optional[int] = None, force: bool = False, log: Callable[[str], None] = note, exif: bool = True,
           mask: Optional[Path] = None, max_size: int = 0) -> dict[str, int]:
    """Localizes the images below a folder, and adds those under new illumination to the map.

    Points of added images are matched with each other and the map, and triangulated. The size of a map is bounded: codes that eight
    updates in a row did not find are dropped. If a place has more than eight added images, the one that has not helped for longest is dropped.
    The model's own images stay.

    :param map: folder of a map.
    :param camera: as in localize_images.
    :param out: folder for the new map; None: replace the old one.
    :param force: replace an existing map in `out`.
    :param log: gets a line about each image without a pose.
    :param exif: as in localize_images; so are `mask` and `max_size`. Added images are upright and reduced.
    :return: counts of images, localized images, added images, and dropped codes.
    :raises FileExistsError: if there is a map in `out` and force is not set.
    :raises opencv_iib.error: for a folder without a map, or one that another process is changing."""
    workers = thread_count(workers)
    check_max_size(max_size)
    check_is_folder(map)
    if out is not None:
        _check_new(out, force)
    names = images_of(images, log=log)
    changed = _core.MapUpdate(os.path.realpath(map), '' if out is None else os.path.realpath(out))

    def add(name: str, image: NDArray[np.uint8], camera: Camera, orientation: int, mask: Optional[NDArray[np.uint8]]) -> Location:
        return Location(*changed.add(name, image, camera, orientation, as_mask(mask)))

    for name, own, location in locate(add, changed.cameras(), images, names, camera, workers, log, exif, mask, max_size):
        if own is None or location.reason:
            log(f'{name}: {location if own is None else location.reason}')
    localized, added, dropped = changed.commit()
    return {'images': len(names), 'localized': localized, 'added': added, 'codes dropped': dropped}
