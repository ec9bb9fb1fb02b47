"""Keypoints and matches: objects like those of cv2, or arrays with a row each."""
from __future__ import annotations

import dataclasses
import functools
from contextlib import suppress
from typing import Any, Iterable, Sequence, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from opencv_iib import _core
from opencv_iib._arguments import sequence
from opencv_iib._arrays import as_array, as_matrix

#: A sequence of objects like cv2.KeyPoint, or an N x 3, N x 4 or N x 7 array.
Keypoints = Union[Sequence[Any], ArrayLike]
#: A sequence of objects like cv2.DMatch, or M x 2 integers (queryIdx, trainIdx), an array or a sequence of pairs.
MatchesOfKeypoints = Union[Sequence[Any], NDArray[Any]]


class KeyPoint:
    """A keypoint with the attributes of cv2.KeyPoint; pixels and degrees, angle -1 for none."""

    def __init__(self, x: float, y: float, size: float, angle: float = -1, response: float = 0,
                 octave: int = 0, class_id: int = -1) -> None:
        self.pt, self.size, self.angle = (x, y), size, angle
        self.response, self.octave, self.class_id = response, octave, class_id

    def __repr__(self) -> str:
        return f'KeyPoint(pt={self.pt}, size={self.size}, angle={self.angle})'


@dataclasses.dataclass(eq=False)
class DMatch:
    """A match with the attributes of cv2.DMatch; the distance is in bits."""

    queryIdx: int
    trainIdx: int
    imgIdx: int
    distance: float

    def __lt__(self, other: DMatch) -> bool:
        return self.distance < other.distance


@functools.lru_cache(maxsize=None)
def of_cv2(name: str) -> Any:
    """A class of cv2, or this module's own without cv2."""
    try:  # here, since the import takes longer than that of this package, and many users need arrays alone
        import cv2
    except ImportError:
        return globals()[name]
    return getattr(cv2, name)


def keypoints_to_array(keypoints: Iterable[Any]) -> NDArray[np.float32]:
    """An N x 7 float32 array: x, y, size (pixels), angle (degrees), response, octave, class_id, the last two rounded beyond 2**24.

    :param keypoints: objects with the attributes of cv2.KeyPoint, of any cv2 or none.
    :raises AttributeError: for an object that is no keypoint."""
    keypoints = sequence(keypoints, 'keypoints', 'objects like cv2.KeyPoint')
    try:
        return _core.readKeyPoints(keypoints)
    except (AttributeError, TypeError) as e:
        raise type(e)(f'keypoints: a sequence of objects like cv2.KeyPoint is needed ({e})') from None


def array_to_keypoints(rows: ArrayLike) -> tuple[Any, ...]:
    """Rows of :func:`keypoints_to_array` as cv2.KeyPoint, or without cv2 as :class:`opencv_iib.KeyPoint`."""
    array, make = as_array(rows, 'keypoints').astype(np.float32, copy=False), of_cv2('KeyPoint')
    if array.size and array.shape[1:] != (7,):
        raise ValueError(f'keypoints: an array of N x 7 is needed, as keypoints_to_array gives it, not of {" x ".join(map(str, array.shape))}')
    return tuple(make(x, y, size, angle, response, int(octave), int(class_id))
                 for x, y, size, angle, response, octave, class_id in array.reshape(-1, 7).tolist())


def as_rows(keypoints: Any) -> NDArray[np.float32]:
    """Rows of 3, 4 or 7 float32 columns for the extension.

    :raises opencv_iib.error: for an array with other columns."""
    if isinstance(keypoints, (list, tuple)) and not (len(keypoints) and isinstance(keypoints[0], (np.ndarray, list, tuple))):
        return keypoints_to_array(keypoints)
    rows = as_matrix(as_array(keypoints, 'keypoints').astype(np.float32, copy=False), 'keypoints')
    if len(rows) and rows.shape[1:] not in ((3,), (4,), (7,)):
        raise _core.error('keypoints are objects like cv2.KeyPoint or an array of 3 columns (x, y, size), 4 (and the angle) or 7 '
                          f'(and response, octave, class_id), not of {rows.shape[1]}')
    return rows


def as_pairs(matches: MatchesOfKeypoints) -> NDArray[Any]:
    """Rows of 2 int32 columns (queryIdx, trainIdx) for the extension.

    :raises opencv_iib.error: for other arrays.
    :raises TypeError: for anything else."""
    if not isinstance(matches, np.ndarray):
        with suppress(AttributeError, TypeError):  # then they are pairs of integers, or a mistake
            matches = np.array([(m.queryIdx, m.trainIdx) for m in matches], np.int32).reshape(-1, 2)
    pairs = as_array(matches, 'matches')
    if pairs.size and (pairs.dtype.kind not in 'iu' or pairs.shape[1:] != (2,)):
        raise _core.error('matches are objects like cv2.DMatch or an array of 2 columns of integers (queryIdx, trainIdx)')
    return pairs.astype(np.int64).clip(-1, np.iinfo(np.int32).max).astype(np.int32)  # out of range, like too large ones
