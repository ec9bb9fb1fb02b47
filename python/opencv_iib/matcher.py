"""HierarchicalMatcher: the class of cv2.iib, on arrays."""
from __future__ import annotations

import os
from typing import Any, Iterable, Optional, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from opencv_iib import _core
from opencv_iib._arrays import ArrayOrArrays, as_array, as_arrays
from opencv_iib._names import Method, Parameter, Path, SnakeCase
from opencv_iib._types import match_type
from opencv_iib.enums import Mode

Matches = tuple[tuple[Any, ...], ...]


def _masks(masks: Any) -> Optional[list[Optional[np.ndarray]]]:
    if masks is None:
        return None
    if isinstance(masks, np.ndarray):
        masks = [masks]
    return [None if mask is None else as_array(mask, 'a mask') for mask in masks]


def _descriptors(descriptors: ArrayLike) -> np.ndarray:
    return as_array(descriptors, 'descriptors')


def _objects(matches: Iterable[Sequence[int]], queries: int, compact: bool) -> Matches:
    """A tuple for each query, empty ones left out if that is asked for, of its matches: (query, train, image, distance)."""
    make, rows = match_type(), [[] for _ in range(queries)]  # type: ignore[var-annotated]
    for query, train, image, distance in matches:
        rows[query].append(make(query, train, image, float(distance)))
    return tuple(tuple(row) for row in rows if row or not compact)


class HierarchicalMatcher(SnakeCase):
    """Matcher of binary descriptors by Hamming distance; names, keywords and matches are those of ``cv2.iib``.

    Descriptors are N x bytes uint8 arrays. ``trainDescriptors`` given to a call are searched instead of those added.
    Matches are cv2.DMatch if cv2 is there, else :class:`opencv_iib.DMatch`. Masks are uint8, queries x train rows, 0
    where a pair is not allowed. Where distances tie, the lower image and then the lower row comes first.

    Calls run on all cores and release the GIL; one object may serve several threads as long as none adds
    descriptors or changes parameters. Mistakes raise :class:`opencv_iib.error`.
    """

    EXACT = Mode.EXACT
    THRESHOLD = Mode.THRESHOLD
    ADAPTIVE = Mode.ADAPTIVE

    def __init__(self, levelSizes: Optional[Sequence[int]] = None, mode: int = EXACT, threshold: float = 0.35,
                 crossCheck: bool = False) -> None:
        """Creates a matcher.

        :param levelSizes: bytes of each level, coarse first; their sum is the descriptors' width. None: descriptors of
            any width are one level, as wide as the first that are added or passed to a call.
        :param mode: EXACT (what brute force finds), THRESHOLD (the paper's rule) or ADAPTIVE (approximate).
        :param threshold: of THRESHOLD, for every level, 0 to 1.
        :param crossCheck: report only pairs that are among each other's nearest.
        """
        if levelSizes is not None:
            self._core = _core.Matcher.create(list(levelSizes), mode, threshold, crossCheck)
        else:
            self._core = _core.Matcher.create()
            self._core.mode, self._core.crossCheck = mode, crossCheck

    @classmethod
    def createRecommended(cls) -> HierarchicalMatcher:
        """What suits IIB best where light and view change: EXACT, with cross-check and a maximal ratio of 0.9.

        For descriptors of any width, as :meth:`create` without level sizes.
        """
        return cls._of(_core.Matcher.createRecommended())

    def match(self, queryDescriptors: ArrayLike, trainDescriptors: Optional[ArrayLike] = None, mask: Optional[ArrayLike] = None,
              masks: Optional[Sequence[ArrayLike]] = None) -> tuple[Any, ...]:
        """The nearest train descriptor of each query that has one, in the order of the queries."""
        rows = self.knnMatch(queryDescriptors, trainDescriptors, 1, mask, True, masks)
        return tuple(row[0] for row in rows)

    def knnMatch(self, queryDescriptors: ArrayLike, trainDescriptors: Optional[ArrayLike] = None, k: int = 1, mask: Optional[ArrayLike] = None,
                 compactResult: bool = False, masks: Optional[Sequence[ArrayLike]] = None) -> Matches:
        """The k nearest of each query, nearest first; with compactResult, without the queries that have none.

        ``knnMatch(queries, k=2)`` searches the descriptors added, ``knnMatch(queries, train, 2)`` those given.
        """
        if isinstance(trainDescriptors, (int, np.integer)):  # cv2's order of arguments without a train set
            return self.knnMatch(queryDescriptors, None, int(trainDescriptors), mask, compactResult, masks)
        indices, distances, *images = self.knnMatchArrays(queryDescriptors, trainDescriptors, k, mask, masks)
        queries, _ = found = np.nonzero(indices >= 0)
        image = images[0][found] if images else np.zeros_like(queries)
        return _objects(zip(*(array.tolist() for array in (queries, indices[found], image, distances[found]))), len(indices),
                        compactResult)

    def radiusMatch(self, queryDescriptors: ArrayLike, trainDescriptors: Optional[ArrayLike] = None, maxDistance: float = 0,
                    mask: Optional[ArrayLike] = None, compactResult: bool = False, masks: Optional[Sequence[ArrayLike]] = None) -> Matches:
        """All within maxDistance bits of each query, nearest first.

        ``radiusMatch(queries, maxDistance=64)`` searches the descriptors added.
        """
        if isinstance(trainDescriptors, (int, float, np.number)):
            return self.radiusMatch(queryDescriptors, None, float(trainDescriptors), mask, compactResult, masks)
        queries = _descriptors(queryDescriptors)
        found = self._core.radiusMatch(queries, self._train(trainDescriptors), maxDistance,
                                       _masks(mask if masks is None else masks))
        return _objects(found.tolist(), len(queries), compactResult)

    def knnMatchArrays(self, queryDescriptors: ArrayLike, trainDescriptors: Optional[ArrayLike] = None, k: int = 1,
                       mask: Optional[ArrayLike] = None, masks: Optional[Sequence[ArrayLike]] = None) -> tuple[NDArray[np.int32], ...]:
        """knnMatch with arrays for results: many times faster than tuples of DMatch.

        :return: indices and distances, queries x k int32, -1 where there is none; among the descriptors added, the
            number of the image as well.
        """
        return self._core.knnMatchArrays(_descriptors(queryDescriptors), self._train(trainDescriptors), k,
                                         _masks(mask if masks is None else masks))

    @staticmethod
    def _train(descriptors: Optional[ArrayLike]) -> Optional[np.ndarray]:
        return None if descriptors is None else _descriptors(descriptors)

    def add(self, descriptors: ArrayOrArrays) -> None:
        """Adds the descriptors of one image (an array) or of several (a sequence of arrays); they are copied."""
        self._core.add(as_arrays(descriptors, 'descriptors'))

    clear = Method('() -> None', 'Forgets all train descriptors.')
    empty = Method('() -> bool', 'True without train descriptors.')

    def train(self) -> None:
        """Nothing: the index is ready after add()."""

    def isMaskSupported(self) -> bool:
        """True."""
        return True

    getTrainDescriptors = Method('() -> tuple[NDArray[np.uint8], ...]', 'Copies of the descriptors added, an array an image.')

    def clone(self, emptyTrainData: bool = False) -> HierarchicalMatcher:
        """A copy; with emptyTrainData, of the parameters alone."""
        return self._of(self._core.clone(emptyTrainData))

    levelSizes = Method('() -> tuple[int, ...]', 'Bytes of each level, coarse first; empty while a matcher created without them '
                        'has seen no descriptors.')
    mode = Parameter(Mode, 'EXACT, THRESHOLD or ADAPTIVE.')
    setThresholds = Method('(thresholds: Sequence[float]) -> None', 'Of THRESHOLD, 0 to 1: one for every level but the last, or a '
                           'single one for all.')
    getThresholds = Method('() -> tuple[float, ...]', 'Of THRESHOLD, one a level.')
    crossCheck = Parameter(bool, "Whether to report only pairs that are among each other's nearest.")
    maxRatio = Parameter(float, 'Of the distances to the nearest and the second nearest, the largest in match, knnMatch and '
                                'knnMatchArrays, in (0, 1]; 1 turns the test off.')

    matchCost = Method('() -> float', "The paper's MC: bits compared / bits brute force would compare, since resetCost(); 0 "
                       'before any call.')
    resetCost = Method('() -> None', 'Begins a new count for matchCost().')
    saveIndex = Method('(filename: Path) -> None', 'Writes level sizes, parameters and all train descriptors to a binary file, the '
                       'same as C++ writes.')

    @classmethod
    def loadIndex(cls, filename: Path) -> HierarchicalMatcher:
        """Reads what saveIndex wrote, here or in C++."""
        return cls._of(_core.Matcher.loadIndex(os.fspath(filename)))

    def __getstate__(self) -> dict[str, Any]:
        return {'parameters': self._core.parameters(), 'descriptors': self.getTrainDescriptors()}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self._core = _core.Matcher.create()
        self._core.setParameters(state['parameters'])
        self._core.add(list(state['descriptors']))

    def __copy__(self) -> HierarchicalMatcher:
        return self.clone()

    def __deepcopy__(self, memo: Any) -> HierarchicalMatcher:
        return self.clone()

    def __repr__(self) -> str:
        return f'{type(self).__name__}(levelSizes={list(self.levelSizes())})'
