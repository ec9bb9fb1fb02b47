"""HierarchicalMatcher, the class of cv2.iib, for arrays."""
from __future__ import annotations

from typing import Any, Callable, Iterable, Iterator, Optional, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from opencv_iib import _core
from opencv_iib._arguments import Path, integer, integers, number
from opencv_iib._arrays import ArrayOrArrays, as_arrays, as_codes, as_matrix
from opencv_iib._copies import around, copied
from opencv_iib.enums import Mode
from opencv_iib.keypoints import of_cv2

Matches = tuple[tuple[Any, ...], ...]
AT_ONCE = 512  # queries a call: with a million codes, less than a second on one core
MAX_PADDED = 1 << 26  # neighbours of all queries that may be more than there are codes


def check_padding(queries: int, k: int, rows: Callable[[], int]) -> None:
    """:raises opencv_iib.error: if k exceeds the number of codes and the result would fill the memory. The C++ library, which gets a part of the
    queries, cannot check it."""
    if queries * k > MAX_PADDED and k > (count := rows()):  # counted last, since a matcher unpacks its codes for it
        raise _core.error(f'k is {k}, but there are {count} descriptors to find: ask for at most {max(count, MAX_PADDED // queries)} for each '
                          f'of {queries} queries')


def _masks(masks: Any) -> list[np.ndarray]:
    """Masks of the images that were added, empty if all pairs are allowed; or no masks."""
    if masks is None or isinstance(masks, np.ndarray):
        return [] if masks is None else [as_matrix(masks, 'a mask')]
    return [as_matrix(np.empty((0, 0), np.uint8) if mask is None else mask, 'a mask') for mask in masks]


def _objects(matches: Iterable[Sequence[int]], queries: int, compact: bool) -> Matches:
    """A tuple of matches for each query, from (query, train, image, distance). :param compact: omit empty tuples."""
    make, rows = of_cv2('DMatch'), [[] for _ in range(queries)]  # type: ignore[var-annotated]
    for query, train, image, distance in matches:
        rows[query].append(make(query, train, image, float(distance)))
    return tuple(tuple(row) for row in rows if row or not compact)


@copied
class HierarchicalMatcher(_core.HierarchicalMatcher):
    """Matcher of binary descriptors by Hamming distance; names, keywords and matches are those of ``cv2.iib``.

    Descriptors are N x bytes uint8 arrays. ``trainDescriptors`` given to a call are searched instead of those added.
    Matches are cv2.DMatch, or without cv2 :class:`opencv_iib.DMatch`. Masks are uint8, queries x train rows, 0
    for forbidden pairs. Ties go to the lower image, then to the lower row.

    Calls run on all cores and release the GIL; one object may serve several threads as long as none adds
    descriptors or changes parameters. Mistakes raise :class:`opencv_iib.error`."""

    EXACT = Mode.EXACT
    THRESHOLD = Mode.THRESHOLD
    ADAPTIVE = Mode.ADAPTIVE

    def __init__(self, levelSizes: Optional[Sequence[int]] = None, mode: int = EXACT, threshold: float = 0.35,
                 crossCheck: bool = False) -> None:
        """Creates a matcher.
        :param levelSizes: bytes of each level, coarse first; their sum is the descriptors' width. None: one level, as wide as the
            first descriptors that are added or passed to a call.
        :param mode: EXACT (what brute force finds), THRESHOLD (the paper's rule) or ADAPTIVE (approximate).
        :param threshold: of THRESHOLD, for every level, 0 to 1.
        :param crossCheck: report only pairs that are among each other's nearest."""
        if levelSizes is not None:
            super().__init__(integers(levelSizes, 'levelSizes'), integer(mode, 'mode'), number(threshold, 'threshold'), bool(crossCheck))
        else:
            super().__init__()
            self.setMode(mode)
            self.setCrossCheck(crossCheck)

    @classmethod
    def create(cls, levelSizes: Optional[Sequence[int]] = None, mode: int = EXACT, threshold: float = 0.35,
               crossCheck: bool = False) -> HierarchicalMatcher:
        """Creates a matcher, as the class itself does."""
        return cls(levelSizes, mode, threshold, crossCheck)

    @classmethod
    def createRecommended(cls) -> HierarchicalMatcher:
        """The best matcher for IIB where light and view change: EXACT, cross-check, maximal ratio 0.92, descriptors of any width."""
        return around(cls, cls._createRecommended())

    def match(self, queryDescriptors: ArrayLike, trainDescriptors: Optional[ArrayLike] = None, mask: Optional[ArrayLike] = None,
              masks: Optional[Sequence[ArrayLike]] = None) -> tuple[Any, ...]:
        """The nearest train descriptor of each query that has one, in the order of the queries."""
        rows = self.knnMatch(queryDescriptors, trainDescriptors, 1, mask, True, masks)
        return tuple(row[0] for row in rows)

    def knnMatch(self, queryDescriptors: ArrayLike, trainDescriptors: Optional[ArrayLike] = None, k: int = 1, mask: Optional[ArrayLike] = None,
                 compactResult: bool = False, masks: Optional[Sequence[ArrayLike]] = None) -> Matches:
        """The k nearest of each query, nearest first; with compactResult, without the queries that have none.

        A row is shorter than k, or empty, if fewer pass the masks, the cross-check and the maximal ratio. The ratio test of tutorials,
        ``for nearest, second in knnMatch(...)``, needs a plain ``HierarchicalMatcher()``; the recommended matcher does that test itself.

        ``knnMatch(queries, k=2)`` searches the descriptors added, ``knnMatch(queries, train, 2)`` those given."""
        if isinstance(trainDescriptors, (int, np.integer)):  # cv2's arguments without a train set
            return self.knnMatch(queryDescriptors, None, int(trainDescriptors), mask, compactResult, masks)
        indices, distances, *images = self.knnMatchArrays(queryDescriptors, trainDescriptors, k, mask, masks)
        queries, _ = found = np.nonzero(indices >= 0)
        image = images[0][found] if images else np.zeros_like(queries)
        return _objects(zip(*(array.tolist() for array in (queries, indices[found], image, distances[found]))), len(indices),
                        compactResult)

    def radiusMatch(self, queryDescriptors: ArrayLike, trainDescriptors: Optional[ArrayLike] = None, maxDistance: float = 0,
                    mask: Optional[ArrayLike] = None, compactResult: bool = False, masks: Optional[Sequence[ArrayLike]] = None) -> Matches:
        """All within maxDistance bits of each query, nearest first.

        ``radiusMatch(queries, maxDistance=64)`` searches the descriptors added."""
        if isinstance(trainDescriptors, (int, float, np.number)):
            return self.radiusMatch(queryDescriptors, None, float(trainDescriptors), mask, compactResult, masks)
        queries, distance = as_codes(queryDescriptors, 'descriptors'), number(maxDistance, 'maxDistance')
        if not distance > 0:
            raise _core.error(f'maxDistance is {distance:g}: it must be more than 0')
        distance = max(distance, .5)  # OpenCV refuses tiny distances; .5 finds equal codes too
        matcher, matches = self._searched(trainDescriptors), []
        for first, some, allowed in self._parts(queries, _masks(mask if masks is None else masks)):
            found = matcher._radiusMatch(some, distance, allowed)
            matches += (found + [first, 0, 0, 0]).tolist()
        return _objects(matches, len(queries), compactResult)

    def knnMatchArrays(self, queryDescriptors: ArrayLike, trainDescriptors: Optional[ArrayLike] = None, k: int = 1,
                       mask: Optional[ArrayLike] = None, masks: Optional[Sequence[ArrayLike]] = None) -> tuple[NDArray[np.int32], ...]:
        """knnMatch with arrays as results: many times faster than tuples of DMatch.

        :return: indices and distances, queries x k int32, -1 for none; among added descriptors the number of the image too."""
        queries, k, matcher = as_codes(queryDescriptors, 'descriptors'), integer(k, 'k'), self._searched(trainDescriptors)
        check_padding(len(queries), k, lambda: sum(map(len, matcher.getTrainDescriptors())))
        parts = [matcher._knnMatchArrays(some, k, allowed)
                 for _, some, allowed in self._parts(queries, _masks(mask if masks is None else masks))]
        found = tuple(np.concatenate(arrays) for arrays in zip(*parts)) if len(parts) > 1 else parts[0]
        return found if trainDescriptors is None else found[:2]

    def _searched(self, descriptors: Optional[ArrayLike]) -> _core.HierarchicalMatcher:
        """The matcher of the descriptors of a call, or of those added."""
        return self if descriptors is None else self._on(as_codes(descriptors, 'descriptors'))

    def _parts(self, queries: np.ndarray, masks: list[np.ndarray]) -> Iterator[tuple[int, np.ndarray, list[np.ndarray]]]:
        """Queries in parts, so that Ctrl-C acts between them: the number of the first query, the queries and their masks.

        A cross-check needs all queries in one part, as do masks of a wrong size, for the error about them."""
        whole = self.getCrossCheck() or any(mask.size and len(mask) != len(queries) for mask in masks)
        size = max(1, len(queries)) if whole else AT_ONCE
        for first in range(0, max(1, len(queries)), size):
            rows = slice(first, first + size)
            yield first, queries[rows], [mask[rows] for mask in masks]

    def add(self, descriptors: ArrayOrArrays) -> None:
        """Adds the descriptors of one image (an array) or of several (a sequence of arrays); they are copied."""
        self._add(as_arrays(descriptors, 'descriptors', as_codes))

    def clone(self, emptyTrainData: bool = False) -> HierarchicalMatcher:
        """A copy; with emptyTrainData without descriptors."""
        return around(type(self), self._clone(bool(emptyTrainData)))

    @classmethod
    def loadIndex(cls, filename: Path) -> HierarchicalMatcher:
        """Reads what saveIndex wrote, here or in C++."""
        return around(cls, cls._loadIndex(filename))

    def _parameters(self) -> tuple[str, tuple[NDArray[np.uint8], ...]]:
        return self._parametersAsText(), self.getTrainDescriptors()

    def _restored(self, parameters: tuple[str, Sequence[NDArray[np.uint8]]]) -> Any:
        core = _core.HierarchicalMatcher()
        core._setParameters(parameters[0])
        core._add(list(parameters[1]))
        return core

    def __repr__(self) -> str:
        return f'{type(self).__name__}(levelSizes={list(self.levelSizes())})'
