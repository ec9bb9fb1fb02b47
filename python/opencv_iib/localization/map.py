"""A map: a COLMAP model and the codes of its keypoints, in one folder."""
from __future__ import annotations

import dataclasses
import hashlib
import json
import os
import tempfile
from typing import Any

import numpy as np
from numpy.typing import NDArray

from opencv_iib.localization._pycolmap import pycolmap

MANIFEST, CODES, MISSES = 'map.json', 'codes.npy', 'misses.npy'
MODEL = ('cameras.bin', 'images.bin', 'points3D.bin', 'rigs.bin', 'frames.bin')
OWN = (MANIFEST, CODES, MISSES, *MODEL)  #: files of a map
FORMAT = 1


@dataclasses.dataclass
class Map:
    """What read_map reads; ids are those of the model."""

    model: Any  #: pycolmap.Reconstruction; each keypoint of its images sees a point
    codes: dict[int, NDArray[np.uint8]]  #: of each image, a row a keypoint, the strongest first
    misses: dict[int, NDArray[np.uint8]]  #: of each code: updates in a row that compared it and did not find it
    used: dict[int, int]  #: of each image, the last update in which it helped
    points: int  #: keypoints that are looked for in an image
    updates: int = 0  #: so far


def read_model(path: str) -> Any:
    """A COLMAP model, binary or text.

    :return: pycolmap.Reconstruction.
    :raises ValueError: for what is none or is damaged.
    """
    if not os.path.isdir(path):
        raise ValueError(f'{path} is no folder')
    try:
        model = pycolmap.Reconstruction(path)
    except ImportError:
        raise
    except Exception as e:
        raise ValueError(f'{path}: no COLMAP model, or a damaged one ({e})') from None
    wrong = [f'camera {number} is damaged' for number, camera in model.cameras.items() if not camera.verify_params()]
    with tempfile.TemporaryDirectory() as copy:  # pycolmap takes what is cut off for zeros
        model.write(copy)
        wrong += [f'{name} is cut off' for name in MODEL if os.path.exists(os.path.join(path, name)) and
                  os.path.getsize(os.path.join(path, name)) < os.path.getsize(os.path.join(copy, name))]
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


def _digest(path: str) -> str:
    digest = hashlib.sha256()
    with open(path, 'rb') as file:
        while block := file.read(1 << 20):
            digest.update(block)
    return digest.hexdigest()


def write_map(map: Map, folder: str) -> None:
    """Writes the files of a map into a folder; see new_folder for one that appears whole."""
    map.model.write(folder)
    images = sorted(map.codes)
    np.save(os.path.join(folder, CODES), np.concatenate([map.codes[i] for i in images]))
    np.save(os.path.join(folder, MISSES), np.concatenate([map.misses[i] for i in images]))
    manifest = {'format': FORMAT, 'points': map.points, 'updates': map.updates,
                'images': [[i, len(map.codes[i]), map.used[i]] for i in images],
                'sha256': {name: _digest(os.path.join(folder, name)) for name in OWN[1:]}}
    with open(os.path.join(folder, MANIFEST), 'w', encoding='utf-8') as file:
        json.dump(manifest, file)


def read_map(folder: str) -> Map:
    """Reads a map; its codes are mapped into memory.

    :raises ValueError: for what is no map, or a damaged one.
    """
    try:
        with open(os.path.join(folder, MANIFEST), encoding='utf-8') as file:
            manifest = json.load(file)
        if manifest['format'] != FORMAT:
            raise ValueError(f"format {manifest['format']} is unknown to this version")
        for name, digest in manifest['sha256'].items():
            if name not in OWN or _digest(os.path.join(folder, name)) != digest:
                raise ValueError(f'{name} is damaged')
        images, rows, used = zip(*manifest['images'])
        codes = np.load(os.path.join(folder, CODES), mmap_mode='r')
        misses = np.load(os.path.join(folder, MISSES))
        ends = np.cumsum(rows)[:-1]
        return Map(pycolmap.Reconstruction(folder), dict(zip(images, np.split(codes, ends))),
                   dict(zip(images, np.split(misses, ends))), dict(zip(images, used)), manifest['points'],
                   manifest['updates'])
    except (OSError, ValueError, KeyError, TypeError) as e:
        raise ValueError(f'{folder} is no map, or a damaged one: {e}') from None
