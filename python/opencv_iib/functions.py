"""The recommended chain in two calls, from arrays to arrays."""
from __future__ import annotations

from typing import NamedTuple, Optional

import numpy as np
from numpy.typing import ArrayLike, NDArray

from opencv_iib._arrays import as_image, as_mask
from opencv_iib._orientation import Turn, upright
from opencv_iib.descriptor import IIBDescriptorExtractor
from opencv_iib.detectors import detect_rows
from opencv_iib.matcher import HierarchicalMatcher


class Features(NamedTuple):
    """The result of :func:`detect_and_describe`, a row a keypoint, the strongest first."""

    points: NDArray[np.float32]  #: N x 2: x, y in pixels, the centre of the first pixel is 0
    sizes: NDArray[np.float32]  #: N: diameters in pixels
    codes: NDArray[np.uint8]  #: N x bytes


class Matches(NamedTuple):
    """The result of :func:`match`, a row a match."""

    pairs: NDArray[np.int32]  #: M x 2: rows of both arrays of codes
    distances: NDArray[np.int32]  #: M: different bits


def detect_and_describe(image: ArrayLike, n: int = 1000, mask: Optional[ArrayLike] = None, orientation: int = 1) -> Features:
    """Finds and describes the n strongest points of an image: ``IIB.createRecommended(n)``.

    :param image: as in IIBDescriptorExtractor.
    :param n: 0 keeps all.
    :param mask: H x W uint8, 0 where no points may be found.
    :param orientation: EXIF's, 1 to 8: the image is described upright; points are those of the array.
    :raises opencv_iib.error: for an image of another type, a mask of another size, and n below 0."""
    iib = IIBDescriptorExtractor.createRecommended(n)
    stored = as_image(image)
    turned = upright(stored, orientation)
    rows = detect_rows(iib, turned, mask if mask is None else upright(as_mask(mask), orientation))
    points = Turn(orientation, *stored.shape[1::-1]).points(rows[:, :2])
    return Features(points, rows[:, 2], iib.compute(turned, rows)[1])


def match(a: ArrayLike, b: ArrayLike, matcher: Optional[HierarchicalMatcher] = None) -> Matches:
    """Matches the codes of two images, in the order of the first's.

    :param a: N x bytes uint8, of any binary descriptor.
    :param b: M x bytes uint8.
    :param matcher: None for ``HierarchicalMatcher.createRecommended()``.
    :raises opencv_iib.error: for codes of other numbers than uint8, or of two widths."""
    nearest, distances = (matcher or HierarchicalMatcher.createRecommended()).knnMatchArrays(a, b)
    queries, _ = found = np.nonzero(nearest >= 0)
    return Matches(np.stack([queries.astype(np.int32), nearest[found]], axis=1), distances[found])
