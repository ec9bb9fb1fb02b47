"""Matches rotated, zoomed and tilted images."""
from __future__ import annotations

from typing import Any, NamedTuple, Optional, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from opencv_iib import _core
from opencv_iib._arguments import integer, number
from opencv_iib._arrays import as_image, as_mask
from opencv_iib._orientation import Turn
from opencv_iib.refinement import float_rows


class ViewMatches(NamedTuple):
    """The result of :func:`matchViews`, a row a match; pixels, the centre of the first pixel is 0."""

    found: bool  #: whether the matches that agree with one geometry are significant
    reason: str  #: why not, a sentence; '' if found
    points1: NDArray[np.float32]  #: N x 2: in image 1; if not found, of the best matches
    points2: NDArray[np.float32]  #: N x 2: in image 2
    covariances: NDArray[np.float32]  #: N x 3: xx, xy, yy of points2 given points1, squared pixels
    similarities: NDArray[np.float32]  #: N: correlation of the patches; -1: not refined
    view: Optional[NDArray[np.float64]]  #: 3 x 3: approximate affine map from pixels of image 1 to pixels of image 2; None if not found


def matchViews(image1: ArrayLike, image2: ArrayLike, maxFeatures: int = 4000, maxTilt: float = 4,
               mask1: Optional[ArrayLike] = None, mask2: Optional[ArrayLike] = None) -> ViewMatches:
    """Matches two images under changed illumination: at any rotation, tilted, from a quarter to four times the size; as ``cv2.iib.matchViews``.

    Pairs that match as they are take no longer than detection, description, matching and :func:`propagateMatches`. For others views of both
    images are simulated: reduced by up to 4, rotated, tilted.

    :param image1: as in IIBDescriptorExtractor; so is `image2`.
    :param maxFeatures: at most so many keypoints of each image; 0 keeps all.
    :param maxTilt: largest tilt, 1 to 8: the factor by which one axis is shortened.
    :param mask1: H x W uint8, 0 where no keypoints may be found; so is `mask2` for image 2.
    :raises opencv_iib.error: for images of another type, masks of another size or type, and an invalid maxTilt or maxFeatures."""
    images = as_image(image1), as_image(image2)  # check both before either is described
    return ViewMatcher(images[0], maxFeatures, maxTilt, mask1).match(images[1], mask2)


def match_stored(images: Sequence[NDArray[Any]], turns: Sequence[Turn], masks: Sequence[Optional[NDArray[Any]]], points: int) -> ViewMatches:
    """matchViews of two upright images and their masks, with the result in pixels of the stored images."""
    found = matchViews(images[0], images[1], points, mask1=masks[0], mask2=masks[1])
    return found._replace(points1=turns[0].points(found.points1), points2=turns[1].points(found.points2),
                          covariances=turns[1].covariances(found.covariances),
                          view=None if found.view is None else turns[1].matrix @ found.view @ np.linalg.inv(turns[0].matrix))


def similarity(points1: np.ndarray, points2: np.ndarray) -> np.ndarray:
    """3 x 3: from points of image 1 to those of image 2, most of which are right, by medians over pairs of points."""
    if len(points1) < 2:
        return np.eye(3)
    a, b = (points.astype(float) @ [1, 1j] for points in (points1, points2))
    i, j = np.random.default_rng(1).integers(len(a), size=(2, 4000))
    ratios = ((b[i] - b[j])[a[i] != a[j]]) / ((a[i] - a[j])[a[i] != a[j]])
    turn = np.median(ratios.real) + 1j * np.median(ratios.imag)
    shift = b - turn * a
    return np.array([[turn.real, -turn.imag, np.median(shift.real)], [turn.imag, turn.real, np.median(shift.imag)], [0, 0, 1]])


def rotation_and_scale(view: np.ndarray) -> tuple[float, float]:
    """The rotation in degrees and the scale of an affine map; 0 and 1 if both are small."""
    turn = (view[0, 0] + view[1, 1] + 1j * (view[1, 0] - view[0, 1])) / 2
    rotation, scale = np.angle(turn), float(np.sqrt(abs(np.linalg.det(view[:2, :2]))))
    small = abs(np.log(scale)) < np.log(_core.MOST_SCALE) and abs(rotation) < _core.MOST_TURN
    return (0, 1) if small else (float(np.degrees(rotation) % 360), scale)


class ViewMatcher:
    """Matches one image with many others, see :func:`matchViews`, and computes its views once. Threads may share one."""

    def __init__(self, image1: ArrayLike, maxFeatures: int = 4000, maxTilt: float = 4, mask1: Optional[ArrayLike] = None) -> None:
        """Arguments are those of :func:`matchViews`."""
        self._image = as_image(image1)  # the core keeps a view of it
        self._core = _core.ViewMatcher.create(self._image, integer(maxFeatures, 'maxFeatures'), number(maxTilt, 'maxTilt'), as_mask(mask1))

    @staticmethod
    def create(image1: ArrayLike, maxFeatures: int = 4000, maxTilt: float = 4, mask1: Optional[ArrayLike] = None) -> ViewMatcher:
        """Makes one, as the class itself does."""
        return ViewMatcher(image1, maxFeatures, maxTilt, mask1)

    def match(self, image2: ArrayLike, mask2: Optional[ArrayLike] = None) -> ViewMatches:
        """matchViews with another image. The GIL is released meanwhile."""
        found, reason, view, *rows = self._core.match(as_image(image2), as_mask(mask2))
        points1, points2, covariances, similarities = float_rows(*rows)
        return ViewMatches(found, reason, points1, points2, covariances, similarities, view)
