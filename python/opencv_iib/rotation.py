"""The angle between two images."""
from __future__ import annotations

from typing import Any, Optional

import numpy as np

from opencv_iib import _core
from opencv_iib._arguments import number
from opencv_iib._arrays import as_image
from opencv_iib.descriptor import IIBDescriptorExtractor
from opencv_iib.keypoints import Keypoints, MatchesOfKeypoints, array_to_keypoints, as_pairs, as_rows, of_cv2
from opencv_iib.matcher import HierarchicalMatcher


def estimateRotation(keypoints1: Keypoints, keypoints2: Keypoints, matches1to2: MatchesOfKeypoints) -> float:
    """The rotation of most matched points of one image in another, as ``cv2.iib.estimateRotation``.

    :param keypoints1: of the first image: objects like cv2.KeyPoint, or an array with 3, 4 or 7 columns; so is `keypoints2` of the second.
    :param matches1to2: objects like cv2.DMatch, or an M x 2 array of integers (queryIdx, trainIdx).
    :return: degrees, 0 to 360, clockwise in the image.
    :raises opencv_iib.error: for a match without a keypoint, and without two matches whose points differ in place."""
    return _core.estimateRotation(as_rows(keypoints1), as_rows(keypoints2), as_pairs(matches1to2))


def matchRotated(image1: Any, image2: Any, extractor: IIBDescriptorExtractor, matcher: HierarchicalMatcher,
                 rotation: float = -1, keypoints1: Optional[Keypoints] = None,
                 keypoints2: Optional[Keypoints] = None) -> tuple[float, Any, Any, Any]:
    """Matches two images that may be rotated in the image plane, and finds the angle.

    The angle is estimated from a few of the strongest keypoints. Then all are described with this angle and matched. In ``cv2.iib`` the
    keypoints of an image follow it: (image1, keypoints1, image2, keypoints2, ...).

    :param extractor: with ORIENTATION_KEYPOINT.
    :param matcher: such as ``HierarchicalMatcher.createRecommended()``.
    :param rotation: degrees, clockwise in the image, 0 or more and less than 360, if it is known; -1 to find it.
    :param keypoints1: objects like cv2.KeyPoint, or an array with 3, 4 or 7 columns; None: the extractor detects them. So is `keypoints2`.
    :return: the rotation; the keypoints of both images with the angles of their descriptors (-1: upright), N x 7 if an array was given;
        matches, cv2.DMatch if cv2 is installed, or M x 3 int32 (queryIdx, trainIdx, distance) if keypoints1 is an array.
    :raises opencv_iib.error: for an extractor of another orientation, and a rotation out of range."""
    for given, name, kind in ((extractor, 'extractor', IIBDescriptorExtractor), (matcher, 'matcher', HierarchicalMatcher)):
        if not isinstance(given, kind):
            raise TypeError(f'{name}: an object of {kind.__name__} is needed, not {type(given).__name__}')
    images, rotation, none = (as_image(image1), as_image(image2)), number(rotation, 'rotation'), as_rows([])
    _core.matchRotated(images[0], none, images[1], none, extractor, matcher, rotation)  # raises for mistakes, before the extractor detects
    points = [extractor.detect(image) if given is None else given
              for image, given in zip(images, (keypoints1, keypoints2))]
    first, second = map(as_rows, points)
    rotation, first, second, matches = _core.matchRotated(images[0], first, images[1], second, extractor, matcher, rotation)
    found = [described if isinstance(given, np.ndarray) else array_to_keypoints(described)
             for given, described in zip(points, (first, second))]
    if isinstance(keypoints1, np.ndarray):
        return rotation, found[0], found[1], matches[:, [0, 1, 3]]
    make = of_cv2('DMatch')
    return rotation, found[0], found[1], tuple(make(*match) for match in matches.tolist())
