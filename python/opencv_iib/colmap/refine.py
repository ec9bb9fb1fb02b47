"""Moves keypoints to where the images agree on them, between matching and COLMAP's mapper."""
from __future__ import annotations

import concurrent.futures
import functools
import os
from typing import Any

import numpy as np

from opencv_iib.colmap.alignment import Patches, combine, frames, offsets
from opencv_iib.colmap.database import Database
from opencv_iib.colmap.features import Features
from opencv_iib.colmap.images import read_grey
from opencv_iib.colmap.progress import Progress
from opencv_iib.colmap.verify import magsac

IMAGES_KEPT = 32  #: read and evened out; 7 bytes a pixel


def _patches(folder: str, name: str) -> Patches:
    try:
        return Patches(read_grey(os.path.join(folder, name)))
    except ValueError as e:
        raise ValueError(f'{name}: {e}') from None


def refine_images(database: Database, folder: str, features: Features, verify: str, workers: int) -> None:
    """Moves the keypoints of the images that were not refined yet, the last image first: it stays.

    Matches whose patches do not fit, or that want their keypoint elsewhere than the others do, are dropped. The pairs
    are verified anew here with magsac, and left without two-view geometries for COLMAP.

    :param verify: magsac, colmap or none; with none all matches are aligned, otherwise the verified ones.
    :raises ValueError: naming an image that can no longer be read.
    """
    numbers = database.image_ids()
    names = {number: name for name, number in numbers.items()}
    images = functools.lru_cache(IMAGES_KEPT)(lambda number: _patches(folder, names[number]))
    done = database.refined()
    progress = Progress('refining', len(numbers), len(done))

    def framed(keypoints: np.ndarray) -> np.ndarray:
        return frames(keypoints, features.scale_factor, features.options.orientation)

    with concurrent.futures.ThreadPoolExecutor(workers) as pool:
        for number in sorted(set(numbers.values()) - done, reverse=True):
            matches = database.matches_with_later(number, verify != 'none')
            keypoints = np.array(database.load_keypoints(number))
            own = framed(keypoints)
            wanted = [np.empty((0, 2))]
            others = list(matches)
            for begin in range(0, len(others), IMAGES_KEPT):
                jobs = [pool.submit(offsets, images(number), own[matches[other][:, 0]], images(other),
                                    framed(database.load_keypoints(other))[matches[other][:, 1]])
                        for other in others[begin:begin + IMAGES_KEPT]]
                wanted += [job.result() for job in jobs]
            indices = np.concatenate([np.empty(0, np.uint32), *(pairs[:, 0] for pairs in matches.values())])
            moves, agree = combine(len(keypoints), indices, np.concatenate(wanted))
            keypoints[:, :2] += np.einsum('nij,nj->ni', own[:, :, :2], moves)
            left: list[tuple[Any, ...]] = []
            for other, pairs in matches.items():
                kept, agree = pairs[agree[:len(pairs)]], agree[len(pairs):]
                inliers, matrix = None, None
                if verify == 'magsac':
                    mask, matrix = magsac(keypoints[kept[:, 0], :2], database.load_keypoints(other)[kept[:, 1], :2])
                    inliers = kept[mask]
                left.append((number, other, kept, inliers, matrix))
            database.add_refined(number, keypoints, left)
            progress.step()
    progress.close()
