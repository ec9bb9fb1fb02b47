"""Keypoints moved to where the images agree on them.

Two keypoints that match lie within a few pixels of the same place, since IIB bears such shifts. Reconstruction wants
them exact: each image's keypoints are moved, one image after the other, to where the patches around them fit best those
of the keypoints that they match in the images before.
"""
from __future__ import annotations

import math
from typing import Optional

import numpy as np

SIDE, MARGIN = 31, 8  #: samples across a patch that stays; how much farther one that is moved reaches on each side
SIGMA = 4.  #: samples, of the Gaussian filter that evens out the local contrast
LEAST_CORRELATION = .8  #: of two patches that show the same
FARTHEST = 3.  #: samples that a keypoint may move along x or y
AGREEMENT = 1.  #: samples between where one image wants a keypoint and where it goes


class Patches:
    """An image from which patches are sampled: octaves, with their local contrast evened out."""

    def __init__(self, grey: np.ndarray) -> None:
        """
        :param grey: H x W uint8.
        """
        self._grey = {0: grey}
        self._even: dict[int, np.ndarray] = {}

    def _octave(self, number: int) -> np.ndarray:
        import cv2
        if number not in self._even:
            if number not in self._grey:
                self._octave(number - 1)
                self._grey[number] = np.asarray(cv2.pyrDown(self._grey[number - 1]))
            detail = self._grey[number].astype(np.float32)
            detail -= cv2.GaussianBlur(detail, (0, 0), SIGMA)
            self._even[number] = detail / (np.sqrt(cv2.GaussianBlur(detail * detail, (0, 0), SIGMA)) + 2)
        return self._even[number]

    def sample(self, frame: np.ndarray, side: int) -> np.ndarray:
        """side x side float32 around a point.

        :param frame: 2 x 3: pixels of one sample along x and along y, and the point (the first pixel's centre is 0).
        """
        import cv2
        octaves = math.log2(min(self._grey[0].shape) / side)
        octave = max(0, min(round(math.log2(math.hypot(*frame[:, 0]))), int(octaves)))
        matrix = frame / 2 ** octave
        matrix[:, 2] -= matrix[:, :2].sum(axis=1) * (side - 1) / 2
        return np.asarray(cv2.warpAffine(self._octave(octave), matrix, (side, side),
                                         flags=cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP, borderMode=cv2.BORDER_REFLECT_101))


def frames(keypoints: np.ndarray, factor: float, turned: bool) -> np.ndarray:
    """N x 2 x 3: how the region of each keypoint is sampled, see Patches.sample; 64 samples across it, as IIB does.

    :param keypoints: N x 4, as COLMAP has them.
    :param factor: the extractor's scale factor.
    :param turned: by the keypoints' angles.
    """
    steps = 2 * factor / 64 * keypoints[:, 2].astype(np.float64)
    angles = keypoints[:, 3] if turned else np.zeros(len(keypoints))
    c, s = steps * np.cos(angles), steps * np.sin(angles)
    return np.stack([np.stack([c, -s, keypoints[:, 0] - .5], axis=1), np.stack([s, c, keypoints[:, 1] - .5], axis=1)],
                    axis=1)


def _offset(reference: np.ndarray, patch: np.ndarray) -> Optional[np.ndarray]:
    """Where the reference's centre lies in the larger patch, in samples from that one's centre."""
    import cv2
    begin = np.array([[1, 0, MARGIN], [0, 1, MARGIN]], np.float32)
    stop = (cv2.TERM_CRITERIA_COUNT | cv2.TERM_CRITERIA_EPS, 30, 1e-3)
    try:
        everywhere = np.ones(patch.shape, np.uint8)
        correlation, warp = cv2.findTransformECC(reference, patch, begin, cv2.MOTION_AFFINE, stop, everywhere, 3)
    except cv2.error:  # it does not converge
        return None
    middle = (SIDE - 1) / 2
    offset = np.asarray(warp) @ np.array([middle, middle, 1]) - (middle + MARGIN)
    return offset if correlation >= LEAST_CORRELATION and np.abs(offset).max() <= FARTHEST else None


def offsets(image: Patches, image_frames: np.ndarray, reference: Patches, reference_frames: np.ndarray) -> np.ndarray:
    """How the matches of a pair of images want the first's keypoints to move.

    :param image_frames: M x 2 x 3, of the first image's keypoints (see frames).
    :param reference_frames: M x 2 x 3, of the second's, which stay.
    :return: M x 2, samples of the first's frame; NaN where the patches do not fit.
    """
    found = np.full((len(image_frames), 2), np.nan)
    for i, (moved, fixed) in enumerate(zip(image_frames, reference_frames)):
        offset = _offset(reference.sample(fixed, SIDE), image.sample(moved, SIDE + 2 * MARGIN))
        if offset is not None:
            found[i] = offset
    return found


def combine(count: int, indices: np.ndarray, wanted: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The median of what the matches want of each keypoint, and which matches agree with it.

    :param count: of keypoints.
    :param indices: M, the keypoint of each match.
    :param wanted: M x 2, samples; NaN for those that want nothing.
    :return: count x 2 samples, 0 where nothing is wanted, and M bool: the move is within AGREEMENT of what it wants.
    """
    moves = np.zeros((count, 2))
    order = np.argsort(indices, kind='stable')
    order = order[~np.isnan(wanted[order, 0])]
    keypoints, begins = np.unique(indices[order], return_index=True)
    for keypoint, group in zip(keypoints, np.split(order, begins[1:])):
        moves[keypoint] = np.median(wanted[group], axis=0)
    return moves, np.abs(wanted - moves[indices]).max(axis=1) <= AGREEMENT  # False for NaN
