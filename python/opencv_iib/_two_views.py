"""Two-view geometry by MAGSAC, and whether two images show the same."""
from __future__ import annotations

from typing import Optional

import numpy as np

from opencv_iib import _core
from opencv_iib.geometry import logFalseAlarms

MIN_INLIERS = 15  # COLMAP's


def magsac(points_a: np.ndarray, points_b: np.ndarray, threshold: float = 1.5, epipolar: bool = True) -> tuple[np.ndarray, Optional[np.ndarray]]:
    """Whether each match agrees with a fundamental matrix or a homography, and that matrix (3 x 3; None if it is not significant).
    :param points_a: M x 2, pixels of the first image; so are `points_b` of the second.
    :param threshold: pixels from the epipolar line, or from the place."""
    import cv2
    none = np.zeros(len(points_a), bool)
    a, b = (np.ascontiguousarray(points, np.float64) for points in (points_a, points_b))
    least = MIN_INLIERS if epipolar else 4
    try:
        matrix, mask = ((None, None) if len(a) < least else cv2.findFundamentalMat(a, b, cv2.USAC_MAGSAC, threshold, .9999, 10000) if epipolar else
                        cv2.findHomography(a, b, cv2.USAC_MAGSAC, threshold, maxIters=10000, confidence=.9999))
    except cv2.error:  # degenerate points, for some versions
        return none, None
    if matrix is None or matrix.shape != (3, 3) or mask is None:
        return none, None
    inliers = mask.ravel() > 0
    certain = inliers.sum() >= least and logFalseAlarms(points_a, points_b, inliers, epipolar, threshold) < _core.CERTAIN
    return (inliers, matrix) if certain else (none, None)


def show_the_same(points_a: np.ndarray, points_b: np.ndarray) -> bool:
    """Whether the matches that agree with a fundamental matrix or a homography are significant."""
    return any(magsac(points_a, points_b, epipolar=epipolar)[0].any() for epipolar in (True, False))
