"""Which pairs of images to match. Pairs are made one by one, so that their number costs no memory."""
from __future__ import annotations

import itertools
import os
import re
from typing import Callable, Iterable, Iterator, Mapping, Optional, Sequence

import numpy as np

from opencv_iib._arguments import MissingFile, Path
from opencv_iib._images import is_utf8
from opencv_iib.matcher import HierarchicalMatcher

Pair = tuple[int, int]
BLOCK = 50  # images of a block: the codes of two blocks are held while its pairs are matched


def exhaustive(count: int, block: int = BLOCK) -> Iterator[Pair]:
    """All pairs of 0..count-1, block by block, so that a cache of 2 * `block` images misses seldom."""
    for first in range(0, count, block):
        for second in range(first, count, block):
            for a in range(first, min(first + block, count)):
                for b in range(max(second, a + 1), min(second + block, count)):
                    yield a, b


def tiles(pairs: Iterable[Pair], side: int) -> Iterator[list[Pair]]:
    """The same pairs in lists, each of `side` images with as many others; with a side of 1, as they come."""
    def tile(pair: Pair) -> Pair:
        return pair[0] // side, pair[1] // side

    pairs = iter(pairs)
    while block := list(itertools.islice(pairs, BLOCK * BLOCK if side > 1 else 1)):
        for _, found in itertools.groupby(sorted(block, key=tile), tile):
            yield list(found)


def distinct(pairs: Iterable[Pair]) -> Iterator[Pair]:
    """Each pair once, whichever image comes first."""
    seen: set[Pair] = set()
    for a, b in pairs:
        pair = min(a, b), max(a, b)
        if pair not in seen:
            seen.add(pair)
            yield pair


def sequential(count: int, overlap: int) -> Iterator[Pair]:
    """Each image with the `overlap` that come after it by name."""
    for a in range(count):
        for b in range(a + 1, min(a + 1 + overlap, count)):
            yield a, b


def nearest(places: Sequence[Optional[np.ndarray]], neighbours: int) -> Iterator[Pair]:
    """Each image with those nearest to it; images without a place are in no pair."""
    placed = [i for i, place in enumerate(places) if place is not None]
    known = np.array([places[i] for i in placed], float)
    for a, place in zip(placed, known):
        for b in np.argsort(np.linalg.norm(known - place, axis=1), kind='stable')[:neighbours + 1]:
            if placed[b] != a:
                yield a, placed[b]


def from_file(path: Path, numbers: Mapping[str, Optional[int]]) -> Iterator[Pair]:
    """Pairs of a text file with two names a line, as COLMAP and hloc write them; '#' begins a line of comment.

    :param numbers: of the images by name; None for those that could not be described, whose pairs are left out.
    :raises ValueError: naming file and line, for a line that is not the names of two images.
    :raises MissingFile: if the file is not there.
    """
    if not os.path.exists(path):
        raise MissingFile(f'there is no list of pairs {os.fspath(path)}')
    with open(path, encoding='utf-8-sig', errors='surrogateescape') as file:
        for number, line in enumerate(map(str.strip, file), 1):
            if not is_utf8(line):
                raise ValueError(f'{os.fspath(path)}:{number}: not UTF-8')
            cuts = ((line[:blank.start()], line[blank.end():]) for blank in re.finditer(r'\s+', line))  # names may have blanks
            a, b = next((cut for cut in cuts if numbers.keys() >= set(cut)), ('', ''))
            if a and a != b and None not in (numbers[a], numbers[b]):
                yield numbers[a], numbers[b]  # type: ignore[misc]
            elif not a and line and not line.startswith('#'):
                raise ValueError(f'{os.fspath(path)}:{number}: not the names of two images')


def retrieval(count: int, load: Callable[[int], np.ndarray], level_sizes: Sequence[int], neighbours: int,
              sample: int = 200) -> Iterator[Pair]:
    """Each image with those that most of its codes vote for.

    Each of the `sample` strongest codes of an image votes for the image of its nearest code among the samples of
    all others. The samples are held: count * sample * bytes.
    """
    matcher = HierarchicalMatcher.create(level_sizes)
    matcher.add([load(i)[:sample] for i in range(count)])
    for a in range(count):
        codes = load(a)[:sample]
        images = matcher.knnMatchArrays(codes, k=3)[2]  # an image's own codes come first, at distance 0
        others = (images >= 0) & (images != a)
        first = np.take_along_axis(images, others.argmax(axis=1)[:, None], 1)[others.any(axis=1)]
        votes = np.bincount(first.ravel(), minlength=count)
        for b in np.argsort(-votes, kind='stable')[:neighbours]:
            if votes[b] > 0:
                yield a, int(b)
