"""KeyPoint and DMatch: those of cv2 where it is there, plain ones otherwise."""
from __future__ import annotations

import dataclasses
import functools
from typing import Any, Protocol, Sequence


class KeyPointLike(Protocol):
    """What is read of a keypoint: cv2.KeyPoint has it."""

    @property
    def pt(self) -> Sequence[float]: ...
    @property
    def size(self) -> float: ...
    @property
    def angle(self) -> float: ...
    @property
    def response(self) -> float: ...
    @property
    def octave(self) -> int: ...
    @property
    def class_id(self) -> int: ...


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
    """A class of cv2, or this module's own where cv2 is missing."""
    try:  # not at import: it takes longer than all of this package, and many use arrays alone
        import cv2
    except ImportError:
        return globals()[name]
    return getattr(cv2, name)
