"""Two-view geometry by MAGSAC, and whether two images show the same."""
from __future__ import annotations

from typing import Optional

import numpy as np

from opencv_iib import _core
from opencv_iib.geometry import logFalseAlarms

MIN_INLIERS = 15  # COLMAP's


def magsac(points_a: np.ndarray, points_b: np.ndarray, threshold: float = 1.5) -> tuple[np.ndarray, Optional[np.ndarray]]:
    """Whether each match agrees with a fundamental matrix, and that matrix (3 x 3; None if it is not significant).
    :param points_a: M x 2, pixels of the first image; so are `points_b` of the second.
    :param threshold: pixels from the epipolar line."""
    import cv2
    none = np.zeros(len(points_a), bool)
    if len(points_a) < MIN_INLIERS:
        return none, None
    try:
        matrix, mask = cv2.findFundamentalMat(np.ascontiguousarray(points_a, np.float64), np.ascontiguousarray(points_b, np.float64),
                                              cv2.USAC_MAGSAC, threshold, .9999, 10000)
    except cv2.error:  # degenerate points, for some versions
        return none, None
    if matrix is None or matrix.shape != (3, 3) or mask is None:
        return none, None
    inliers = mask.ravel() > 0
    certain = inliers.sum() >= MIN_INLIERS and logFalseAlarms(points_a, points_b, inliers, True, threshold) < _core.CERTAIN
    return (inliers, matrix) if certain else (none, None)


def show_the_same(points_a: np.ndarray, points_b: np.ndarray, threshold: float = 1.5) -> bool:
    """Whether the matches that agree with a fundamental matrix or a homography are significant."""
    import cv2
    if magsac(points_a, points_b, threshold)[0].any():
        return True
    if len(points_a) < 4:
        return False
    try:
        _, mask = cv2.findHomography(np.ascontiguousarray(points_a, np.float64), np.ascontiguousarray(points_b, np.float64),
                                     cv2.USAC_MAGSAC, threshold, maxIters=10000, confidence=.9999)
    except cv2.error:  # degenerate points, for some versions
        return False
    return mask is not None and logFalseAlarms(points_a, points_b, mask, False, threshold) < _core.CERTAIN
