"""Exports a COLMAP database to the HDF5 files of hloc (Hierarchical-Localization)."""
from __future__ import annotations

import os
import sqlite3

import numpy as np

from opencv_iib._arguments import MissingFile, Path
from opencv_iib._files import check_outputs, output_file, replaced
from opencv_iib._hdf5 import new_hdf5
from opencv_iib._image_names import is_listable
from opencv_iib._pair_list import pair_name
from opencv_iib.colmap.database import MAX_IMAGE_ID, opened

SHORT = 2 ** 15 - 1  # hloc's own files hold int16; its readers take any integers


def _write_features(connection: sqlite3.Connection, path: str) -> tuple[dict[int, str], dict[int, int]]:
    """:return: names of the images, and their numbers of keypoints, by the images' numbers."""
    names, counts = {}, {}
    with new_hdf5(path) as file:
        for number, name, width, height, cols, data in connection.execute(
                'SELECT image_id, name, width, height, cols, data FROM images NATURAL JOIN cameras JOIN keypoints USING (image_id)'):
            if not is_listable(name):
                raise ValueError(f'{name}: hloc\'s lists hold no names with blanks or a leading #; rename it')
            points = np.frombuffer(data, np.float32).reshape(-1, cols)[:, :2] - np.float32(.5)
            names[number], counts[number] = name, len(points)
            group = file.create_group(name)
            group['keypoints'] = points
            group['scores'] = np.ones(len(points), np.float32)
            group['image_size'] = np.array([width, height])
    return names, counts


def _write_matches(connection: sqlite3.Connection, path: str, pairs: str, names: dict[int, str], counts: dict[int, int]) -> int:
    verified = connection.execute('SELECT COUNT(*) FROM two_view_geometries').fetchone()[0]  # pairs that were refused count too
    table, total = 'two_view_geometries' if verified else 'matches', 0
    with new_hdf5(path) as file, open(pairs, 'w', encoding='utf-8') as listing:
        for key, data in connection.execute(f'SELECT pair_id, data FROM {table} WHERE rows > 0'):
            a, b = divmod(key, MAX_IMAGE_ID)
            found = np.frombuffer(data, np.uint32).reshape(-1, 2)
            nearest: np.ndarray = np.full(counts[a], -1, np.int16 if counts[b] <= SHORT else np.int32)
            nearest[found[:, 0]] = found[:, 1]
            group = file.create_group(pair_name(names[a], names[b]))
            group['matches0'] = nearest
            group['matching_scores0'] = (nearest >= 0).astype(np.float16)
            listing.write(f'{names[a]} {names[b]}\n')
            total += 1
    return total


def export(database: Path, features: Path, matches: Path, pairs: Path, force: bool = False) -> int:
    """Writes keypoints, matches and the list of pairs as hloc's reconstruction and localization read them.
    :param database: what build_database wrote. If its pairs are verified, only matches that agree are exported.
    :param features: HDF5 to write: for each image ``keypoints`` (N x 2; the centre of the first pixel is 0), ``scores`` (N, ones) and
        ``image_size`` (width, height).
    :param matches: HDF5 to write: for each pair ``matches0`` (N; index or -1; int16 up to 32767 keypoints in the second image, int32 above)
        and ``matching_scores0`` (N).
    :param pairs: text file to write, two names a line.
    :return: number of pairs.
    :raises FileExistsError: for a file that is there, unless force is set, and for the database.
    :raises ValueError: for an image's name that the list of pairs cannot hold, or one file given twice.

    Files that are there are replaced when all three are complete."""
    paths = [output_file(os.fspath(path)) for path in (features, matches, pairs)]
    check_outputs(paths, [database])
    for path in paths:
        if os.path.exists(path) and not force:
            raise FileExistsError(f'{path} is there already: remove it, or pass force (--force)')
    if not os.path.isfile(database):
        raise MissingFile(f'there is no database {os.fspath(database)}')
    with opened(database) as connection, replaced(*paths) as (new_features, new_matches, new_pairs):
        return _write_matches(connection, new_matches, new_pairs, *_write_features(connection, new_features))
