"""The angle between two images."""
from __future__ import annotations

from typing import Any, Sequence, Union

import numpy as np
from numpy.typing import NDArray

from opencv_iib import _core
from opencv_iib._arrays import as_array
from opencv_iib.keypoints import Keypoints, as_rows


def estimateRotation(keypoints1: Keypoints, keypoints2: Keypoints, matches1to2: Union[Sequence[Any], NDArray[Any]]) -> float:
    """Angle by which most of the matched points of one image are turned in another, as ``cv2.iib.estimateRotation``.

    :param keypoints1: of the first image: objects like cv2.KeyPoint, or an array with 3, 4 or 7 columns.
    :param keypoints2: of the second image.
    :param matches1to2: objects like cv2.DMatch, or an M x 2 array of integers (queryIdx, trainIdx).
    :return: degrees, 0 to 360, clockwise in the image.
    """
    if not isinstance(matches1to2, np.ndarray):
        matches1to2 = np.array([(m.queryIdx, m.trainIdx) for m in matches1to2], np.int32).reshape(-1, 2)
    pairs = as_array(matches1to2, 'matches')
    if pairs.dtype.kind in 'iu':
        pairs = pairs.astype(np.int32)
    return _core.estimateRotation(np.ascontiguousarray(as_rows(keypoints1)), np.ascontiguousarray(as_rows(keypoints2)),
                                  pairs)
