"""Refines matches to a fraction of a pixel."""
from __future__ import annotations

from typing import Any, NamedTuple, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from opencv_iib import _core
from opencv_iib._arrays import as_image
from opencv_iib.keypoints import Keypoints, MatchesOfKeypoints, as_pairs, as_rows, of_cv2


class RefinedMatches(NamedTuple):
    """The result of :func:`refineMatches`, a row a match; pixels, the centre of the first pixel is 0."""

    points1: NDArray[np.float32]  #: N x 2: in the first image, as detected
    points2: NDArray[np.float32]  #: N x 2: in the second image, refined, or as detected if refinement failed
    covariances: NDArray[np.float32]  #: N x 3: xx, xy, yy of points2 given points1, squared pixels; 1, 0, 1: not refined
    similarities: NDArray[np.float32]  #: N: correlation of the patches; -1: not refined


def refineMatches(image1: ArrayLike, keypoints1: Keypoints, image2: ArrayLike, keypoints2: Keypoints,
                  matches1to2: MatchesOfKeypoints) -> RefinedMatches:
    """Moves the second point of each match to where the surroundings of both points agree best, as ``cv2.iib.refineMatches``.

    :param image1: as in IIBDescriptorExtractor; so is `image2`.
    :param keypoints1: objects like cv2.KeyPoint, or an array with 3, 4 or 7 columns: x, y, size, angle; so is `keypoints2`. Only differences
        of angles and ratios of sizes count.
    :param matches1to2: objects like cv2.DMatch, or M x 2 integers (queryIdx, trainIdx), as the pairs of :func:`opencv_iib.match`.
    :raises opencv_iib.error: for a match without a keypoint, and for images and keypoints that cannot be described.
    :raises TypeError: for other matches."""
    return RefinedMatches(*float_rows(*_core.refineMatches(
        as_image(image1), as_rows(keypoints1), as_image(image2), as_rows(keypoints2), as_pairs(matches1to2))))


class PropagatedMatches(NamedTuple):
    """The result of :func:`propagateMatches`: the matches, and the fields of :class:`RefinedMatches`."""

    matches: Any  #: given ones, then added ones: pairs of int32 if integers were given, else objects like cv2.DMatch
    points1: NDArray[np.float32]
    points2: NDArray[np.float32]
    covariances: NDArray[np.float32]
    similarities: NDArray[np.float32]


def prepared(image: ArrayLike) -> _core.PreparedImage:
    """An image for several calls of :func:`propagateMatches`."""
    return _core.PreparedImage(as_image(image))


def propagateMatches(image1: Union[ArrayLike, _core.PreparedImage], keypoints1: Keypoints, image2: Union[ArrayLike, _core.PreparedImage],
                     keypoints2: Keypoints, matches1to2: MatchesOfKeypoints) -> PropagatedMatches:
    """Refines matches and adds further ones near them, as ``cv2.iib.propagateMatches``.

    For poses: under changed illumination or distant views it adds half as many right matches.

    :param keypoints1: of any detector; all parameters are as in :func:`refineMatches`.
    :return: distances of added matches are the largest float, since no descriptors were compared.
    :raises opencv_iib.error: as in :func:`refineMatches`."""
    images: list[Any] = [image1, image2]
    if any(isinstance(image, _core.PreparedImage) for image in images):
        images = [image if isinstance(image, _core.PreparedImage) else prepared(image) for image in images]
    else:
        images = [as_image(image) for image in images]
    found, *rows = _core.propagateMatches(images[0], as_rows(keypoints1), images[1], as_rows(keypoints2), as_pairs(matches1to2))
    if isinstance(matches1to2, np.ndarray) or (len(matches1to2) and not hasattr(matches1to2[0], 'queryIdx')):
        return PropagatedMatches(found.reshape(-1, 4)[:, :2], *float_rows(*rows))
    make, distance = of_cv2('DMatch'), float(np.finfo(np.float32).max)
    added = [make(query, train, image, distance) for query, train, image in found[len(matches1to2):, :3].tolist()]
    return PropagatedMatches((*matches1to2, *added), *float_rows(*rows))


def float_rows(points1: NDArray[Any], points2: NDArray[Any], covariances: NDArray[Any], similarities: NDArray[Any]) -> tuple[NDArray[Any], ...]:
    """Gives the core's arrays their type and columns, which they lack without matches."""
    return tuple(rows.astype(np.float32, copy=False).reshape(shape)
                 for rows, shape in ((points1, (-1, 2)), (points2, (-1, 2)), (covariances, (-1, 3)), (similarities, -1)))
