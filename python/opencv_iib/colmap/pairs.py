"""Chooses pairs of images to match. Pairs are generated one by one, so that many need no memory."""
from __future__ import annotations

import contextlib
import os
from typing import Callable, Iterable, Iterator, Optional, Sequence

import numpy as np

from opencv_iib._arguments import Path
from opencv_iib._exif import gps_place
from opencv_iib._files import read_bytes
from opencv_iib._pair_list import BLOCK, Pair, read_list
from opencv_iib.colmap.database import Database
from opencv_iib.matcher import HierarchicalMatcher

PAIRS = ('exhaustive', 'sequential', 'retrieval', 'gps')
Pairs = tuple[Iterator[Pair], Optional[int]]  # of image ids, and how many if that is known


def exhaustive(count: int, block: int = BLOCK) -> Iterator[Pair]:
    """All pairs of 0..count-1, block by block, for a cache of 2 * `block` images."""
    for first in range(0, count, block):
        for second in range(first, count, block):
            for a in range(first, min(first + block, count)):
                for b in range(max(second, a + 1), min(second + block, count)):
                    yield a, b


def distinct(pairs: Iterable[Pair]) -> Iterator[Pair]:
    """Each pair once, whichever image comes first."""
    seen: set[Pair] = set()
    for a, b in pairs:
        pair = min(a, b), max(a, b)
        if pair not in seen:
            seen.add(pair)
            yield pair


def nearest(places: Sequence[Optional[np.ndarray]], neighbours: int) -> Iterator[Pair]:
    """Each image with those nearest to it, without images that have no place. Coordinates that are NaN in one of two places are ignored."""
    placed = [i for i, place in enumerate(places) if place is not None]
    known = np.array([places[i] for i in placed], float)
    for a, place in zip(placed, known):
        for b in np.argsort(np.linalg.norm(np.nan_to_num(known - place), axis=1), kind='stable')[:neighbours + 1]:
            if placed[b] != a:
                yield a, placed[b]


def retrieval(count: int, load: Callable[[int], np.ndarray], level_sizes: Sequence[int], neighbours: int,
              sample: int = 200) -> Iterator[Pair]:
    """Each image with those that most of its codes vote for.

    Each of the `sample` strongest codes votes for the image of its nearest code among all other images' samples. Memory: count * sample * bytes."""
    matcher = HierarchicalMatcher.create(level_sizes)
    matcher.add([load(i)[:sample] for i in range(count)])
    for a in range(count):
        codes = load(a)[:sample]
        images = matcher.knnMatchArrays(codes, k=3)[2]  # three, since an image's own codes have distance 0
        others = (images >= 0) & (images != a)
        first = np.take_along_axis(images, others.argmax(axis=1)[:, None], 1)[others.any(axis=1)]
        votes = np.bincount(first.ravel(), minlength=count)
        for b in np.argsort(-votes, kind='stable')[:neighbours]:
            if votes[b] > 0:
                yield a, int(b)


def gps_places(folder: str, names: Iterable[str]) -> Iterator[Optional[np.ndarray]]:
    """As gps_place, of each image; None also for a file that cannot be read."""
    def place(path: str) -> Optional[np.ndarray]:
        with contextlib.suppress(OSError, ValueError):
            return gps_place(read_bytes(path))
        return None
    return (place(os.path.join(folder, name)) for name in names)


def list_pairs(database: Database, folder: str, names: Iterable[str], pairs: Path, neighbours: int, level_sizes: tuple[int, ...]) -> Pairs:
    """:param pairs: as in Options; so is `neighbours`. :return: pairs of image ids, and their number if it is known."""
    numbers = database.image_ids()
    ids = list(numbers.values())
    count = len(ids)
    if pairs == 'exhaustive':
        chosen, total = exhaustive(count), count * (count - 1) // 2
    elif pairs == 'sequential':
        after = [range(a + 1, min(a + 1 + neighbours, count)) for a in range(count)]
        chosen, total = ((a, b) for a in range(count) for b in after[a]), sum(map(len, after))
    elif pairs == 'retrieval':
        voted = retrieval(count, lambda i: database.load_codes(ids[i]), level_sizes, neighbours)
        chosen, total = distinct(voted), None
    elif pairs == 'gps':
        chosen, total = distinct(nearest(list(gps_places(folder, numbers)), neighbours)), None
    else:
        return distinct(read_list(pairs, {**dict.fromkeys(names), **numbers})[0]), None
    return ((ids[a], ids[b]) for a, b in chosen), total
