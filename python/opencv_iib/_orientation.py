"""Between images as their files store them, with EXIF's orientation, and upright images."""
from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from opencv_iib._arguments import integer

BACK = {**{orientation: orientation for orientation in range(1, 9)}, 6: 8, 8: 6}  #: orientations of the inverse rotations
TRANSPOSED, TO_THE_LEFT, TO_THE_TOP = (5, 6, 7, 8), (2, 3, 6, 7), (3, 4, 7, 8)  # orientations: axes exchanged, then each reversed


def upright(image: NDArray[Any], orientation: int) -> NDArray[Any]:
    """An image or a mask, made upright.
    :param orientation: EXIF's, 1 (as it is) to 8.
    :raises ValueError: for another number."""
    if not 1 <= integer(orientation, 'orientation') <= 8:
        raise ValueError(f'orientation is {orientation}: it must be one of EXIF, 1 to 8')
    turned = image.swapaxes(0, 1) if orientation in TRANSPOSED else image
    return np.ascontiguousarray(turned[::-1 if orientation in TO_THE_TOP else 1, ::-1 if orientation in TO_THE_LEFT else 1])


class Turn:
    """Maps pixels of an upright image to those of the stored one."""

    def __init__(self, orientation: int, width: int, height: int) -> None:
        """:param width: of the stored image; so is `height`."""
        w, h = (height, width) if orientation in TRANSPOSED else (width, height)
        left, top = orientation in TO_THE_LEFT, orientation in TO_THE_TOP
        #: 3 x 3
        self.matrix: NDArray[np.float64] = np.array([[-1. if left else 1, 0, (w - 1) * left], [0, -1. if top else 1, (h - 1) * top], [0, 0, 1]])
        if orientation in TRANSPOSED:
            self.matrix = self.matrix[[1, 0, 2]]
        self.trivial = orientation == 1

    def points(self, points: NDArray[Any]) -> NDArray[Any]:
        """N x 2."""
        return (points @ self.matrix[:2, :2].T + self.matrix[:2, 2]).astype(points.dtype, copy=False)

    def keypoints(self, rows: NDArray[np.float32]) -> NDArray[np.float32]:
        """N x 7, as of keypoints_to_array. Keypoints without an angle get the angle of the upright image's rows."""
        if self.trivial:
            return rows
        turned, angles = rows.copy(), np.radians(np.where(rows[:, 3] < 0, 0, rows[:, 3]))
        turned[:, :2] = self.points(rows[:, :2])
        x, y = self.matrix[:2, :2] @ [np.cos(angles), np.sin(angles)]
        turned[:, 3] = np.degrees(np.arctan2(y, x)) % 360
        return turned

    def corners(self, values: NDArray[Any]) -> NDArray[Any]:
        """Reorders values of the upright image's corners, clockwise from the top left, as those of the stored image's."""
        signs = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
        return values[[int(np.flatnonzero((signs @ self.matrix[:2, :2].T == corner).all(axis=1))[0]) for corner in signs]]

    def covariances(self, rows: NDArray[np.float32]) -> NDArray[np.float32]:
        """N x 3: xx, xy, yy."""
        across = self.matrix[:2, :2]
        full = across @ rows[:, [0, 1, 1, 2]].reshape(-1, 2, 2) @ across.T
        return full.reshape(-1, 4)[:, [0, 1, 3]].astype(rows.dtype, copy=False)
