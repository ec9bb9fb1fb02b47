"""A map: a COLMAP model and the codes of its keypoints, in one folder."""
from __future__ import annotations

import dataclasses
import functools
import json
import os
import zlib
from typing import Any, Sequence

import numpy as np
from numpy.typing import NDArray

from opencv_iib.localization._pycolmap import pycolmap

MANIFEST, CODES, MISSES = 'map.json', 'codes.npy', 'misses.npy'
GEOMETRY = ('points.npy', 'sees.npy', 'views.npy')  #: what a Localizer needs of the model
MODEL = ('cameras.bin', 'images.bin', 'points3D.bin', 'rigs.bin', 'frames.bin')
OWN = (MANIFEST, CODES, MISSES, *GEOMETRY, *MODEL)  #: files of a map
FORMAT = 2


@dataclasses.dataclass
class Map:
    """What read_map reads; ids are those of the model."""

    folder: str
    codes: dict[int, NDArray[np.uint8]]  #: of each image, a row a keypoint, the strongest first
    misses: dict[int, NDArray[np.uint8]]  #: of each code: updates in a row that compared it and did not find it
    used: dict[int, int]  #: of each image, the last update in which it helped
    points: int  #: keypoints that are looked for in an image
    updates: int  #: so far
    places: NDArray[np.float64]  #: P x 3, of the model's points
    sees: dict[int, NDArray[np.int32]]  #: of each code, which of the places it sees
    views: NDArray[np.float64]  #: an image each: centre, viewing direction, median distance to what it sees
    cameras: list[Any]  #: pycolmap.Camera

    @functools.cached_property
    def model(self) -> Any:
        """pycolmap.Reconstruction; each keypoint of its images sees a point."""
        return pycolmap.Reconstruction(self.folder)


def _end(name: str, data: bytes, at: int) -> int:
    """Of a record in one of COLMAP's binary files, which begins at `at`."""
    def number(place: int, size: int = 4) -> int:
        return int.from_bytes(data[place:place + size], 'little')

    if name == 'cameras.bin':
        return at + 24 + 8 * len(pycolmap.Camera.create_from_model_id(0, number(at + 4), 1., 1, 1).params)
    if name == 'images.bin':
        ended = data.index(0, at + 64)
        return ended + 9 + 24 * number(ended + 1, 8)
    if name == 'points3D.bin':
        return at + 51 + 8 * number(at + 43, 8)
    if name == 'frames.bin':
        return at + 68 + 16 * number(at + 64)
    sensors, at = number(at + 4), at + 8
    for sensor in range(sensors):
        at += 8 if sensor == 0 else 9 + 56 * data[at + 8]
    return at


def _is_whole(folder: str, name: str) -> bool:
    """pycolmap takes what is cut off for zeros, and reads as many of them as a damaged number says."""
    with open(os.path.join(folder, name), 'rb') as file:
        data = file.read()
    at = 8
    try:
        for _ in range(int.from_bytes(data[:8], 'little')):
            if at >= len(data):
                return False
            at = _end(name, data, at)
    except (IndexError, TypeError, ValueError):
        return False
    return at == len(data)


def read_model(path: str) -> Any:
    """A COLMAP model, binary or text.

    :return: pycolmap.Reconstruction.
    :raises ValueError: for what is none or is damaged.
    """
    if not os.path.isdir(path):
        raise ValueError(f'{path} is no folder')
    for name in MODEL:
        if os.path.exists(os.path.join(path, name)) and not _is_whole(path, name):
            raise ValueError(f'{path}: {name} is damaged')
    try:
        model = pycolmap.Reconstruction(path)
    except ImportError:
        raise
    except Exception as e:
        raise ValueError(f'{path}: no COLMAP model, or a damaged one ({e})') from None
    wrong = [f'camera {number} is damaged' for number, camera in model.cameras.items() if not camera.verify_params()]
    if not model.reg_image_ids():
        wrong.append('no image has a pose')
    if wrong:
        raise ValueError(f'{path}: {wrong[0]}')
    return model


def compact(model: Any, codes: dict[int, NDArray[Any]]) -> dict[int, NDArray[np.int64]]:
    """Removes the keypoints that see no point, and images without any; points get new ids.

    :param codes: of each image id, a row a keypoint; replaced by the rows that are left.
    :return: the rows that are left.
    """
    kept = {i: np.flatnonzero([p.has_point3D() for p in model.image(i).points2D]) for i in model.reg_image_ids()}
    # Copies: what pycolmap gives are views of what is deleted below.
    xy = {i: [model.image(i).points2D[int(row)].xy.copy() for row in rows] for i, rows in kept.items()}
    new = {i: {int(row): n for n, row in enumerate(rows)} for i, rows in kept.items()}
    points = [(p.xyz.copy(), p.color.copy(), [(e.image_id, new[e.image_id][e.point2D_idx]) for e in p.track.elements])
              for _, p in sorted(model.points3D.items())]
    model.delete_all_points2D_and_points3D()
    for i, places in xy.items():
        model.image(i).points2D = pycolmap.Point2DList([pycolmap.Point2D(place) for place in places])
    for xyz, color, track in points:
        model.add_point3D(xyz, pycolmap.Track([pycolmap.TrackElement(*element) for element in track]), color)
    model.update_point_3d_errors()
    for i, rows in kept.items():
        codes[i] = codes[i][rows]
    return kept


def _checksum(path: str) -> str:
    checksum = 0
    with open(path, 'rb') as file:
        while block := file.read(1 << 20):
            checksum = zlib.crc32(block, checksum)
    return f'{checksum:08x}'


def _geometry(model: Any, images: Sequence[int]) -> tuple[NDArray[Any], ...]:
    """The arrays of GEOMETRY."""
    numbers = {number: row for row, number in enumerate(sorted(model.points3D))}
    places = np.array([model.points3D[number].xyz for number in numbers]).reshape(-1, 3)
    sees = [np.array([numbers[p.point3D_id] for p in model.image(i).points2D], np.int32) for i in images]
    views = np.ones((len(images), 7))
    for view, i, rows in zip(views, images, sees):
        view[:3], view[3:6] = model.image(i).projection_center(), model.image(i).viewing_direction()
        if len(rows):
            view[6] = np.median(np.linalg.norm(places[rows] - view[:3], axis=1))
    return places, np.concatenate(sees), views


def write_map(folder: str, model: Any, codes: dict[int, NDArray[np.uint8]], misses: dict[int, NDArray[np.uint8]],
              used: dict[int, int], points: int, updates: int = 0) -> None:
    """Writes the files of a map into a folder, see Map; see new_folder for one that appears whole."""
    model.write(folder)
    images = sorted(codes)
    arrays = (np.concatenate([rows[i] for i in images]) for rows in (codes, misses))
    for name, array in zip((CODES, MISSES, *GEOMETRY), (*arrays, *_geometry(model, images))):
        np.save(os.path.join(folder, name), array)
    manifest = {'format': FORMAT, 'points': points, 'updates': updates,
                'images': [[i, len(codes[i]), used[i]] for i in images],
                'cameras': list(dict.fromkeys((c.model.name, c.width, c.height, tuple(c.params)) for c in model.cameras.values())),
                'crc32': {name: _checksum(os.path.join(folder, name)) for name in OWN[1:]}}
    with open(os.path.join(folder, MANIFEST), 'w', encoding='utf-8') as file:
        json.dump(manifest, file)


def read_map(folder: str) -> Map:
    """Reads a map; its codes are mapped into memory, its model is read when it is asked for.

    :raises ValueError: for what is no map, or a damaged one.
    """
    try:
        with open(os.path.join(folder, MANIFEST), encoding='utf-8') as file:
            manifest = json.load(file)
        if manifest['format'] != FORMAT:
            raise ValueError('its format is not that of this version: make it again')
        for name in OWN[1:]:
            if _checksum(os.path.join(folder, name)) != manifest['crc32'][name]:
                raise ValueError(f'{name} is damaged')
        images, rows, used = zip(*manifest['images'])
        places, sees, views = (np.load(os.path.join(folder, name)) for name in GEOMETRY)
        cameras = [pycolmap.Camera(model=m, width=w, height=h, params=p) for m, w, h, p in manifest['cameras']]
        arrays = np.load(os.path.join(folder, CODES), mmap_mode='r'), np.load(os.path.join(folder, MISSES)), sees
        codes, misses, seen = (dict(zip(images, np.split(array, np.cumsum(rows)[:-1]))) for array in arrays)
        return Map(folder, codes, misses, dict(zip(images, used)), manifest['points'], manifest['updates'], places, seen, views,
                   cameras)
    except (OSError, ValueError, KeyError, TypeError) as e:
        raise ValueError(f'{folder} is no map, or a damaged one: {e}') from None
