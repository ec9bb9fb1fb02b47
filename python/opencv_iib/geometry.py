"""Where a second camera stands, and where a second image lies."""
from __future__ import annotations

from typing import Any, Literal, NamedTuple, Optional, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from opencv_iib import _core
from opencv_iib._arguments import integer, number
from opencv_iib._arrays import as_array, as_image, as_mask, as_matrix
from opencv_iib.enums import AlignmentModel


class _Pose(NamedTuple):
    found: bool
    R: Optional[NDArray[np.float64]]
    t: Optional[NDArray[np.float64]]
    inliers: NDArray[np.uint8]
    covariance: Optional[NDArray[np.float64]]


class FoundPose(_Pose):
    """What :func:`findRelativePose` finds; `reason` is ''."""

    __slots__ = ()
    found: Literal[True]
    R: NDArray[np.float64]  #: 3 x 3: from the axes of camera 1 to those of camera 2
    t: NDArray[np.float64]  #: 3 x 1, of length 1: direction of the translation, in the axes of camera 2
    inliers: NDArray[np.uint8]  #: N x 1: 1 for matches that agree with the pose
    covariance: NDArray[np.float64]  #: 5 x 5, radians: of the rotation, and of the direction of t
    reason = ''


class NoPose(_Pose):
    """What :func:`findRelativePose` gives where it finds none: R, t and covariance are None, and `reason` is a sentence."""

    found: Literal[False]
    R: None
    t: None
    covariance: None
    reason: str = ''


class _Alignment(NamedTuple):
    found: bool
    transform: Optional[NDArray[np.float64]]
    error: Optional[NDArray[np.float64]]
    matches: NDArray[np.float32]


class Alignment(_Alignment):
    """What :func:`alignImages` finds; `reason` is ''."""

    __slots__ = ()
    found: Literal[True]
    transform: NDArray[np.float64]  #: 3 x 3: from pixels of the image to pixels of the reference
    error: NDArray[np.float64]  #: 4 x 1: standard deviations of the places of the image's corners, pixels
    matches: NDArray[np.float32]  #: M x 4: those that agree, x and y in the reference, x and y in the image
    reason = ''


class NoAlignment(_Alignment):
    """What :func:`alignImages` gives where images do not show the same: transform and error are None, and `reason` is a sentence."""

    found: Literal[False]
    transform: None
    error: None
    reason: str = ''


def _numbers(value: ArrayLike, what: str) -> NDArray[Any]:
    array = as_array(value, what)
    return as_matrix(array if array.dtype in (np.float32, np.float64) else array.astype(np.float64), what)


def findRelativePose(points1: ArrayLike, points2: ArrayLike, cameraMatrix1: ArrayLike, cameraMatrix2: ArrayLike,
                     scale: float = 0, covariances: Optional[ArrayLike] = None) -> Union[FoundPose, NoPose]:
    """Finds where camera 2 stands, seen from camera 1, from matched points of which many may be wrong.

    As ``cv2.iib.findRelativePose``. Points must be free of lens distortion:
    ``cv2.undistortPoints(points, K, distortion, P=K)`` first.

    :param points1: N x 2: pixels of image 1.
    :param points2: N x 2: their matches in image 2.
    :param cameraMatrix1: 3 x 3, [fx 0 cx; 0 fy cy; 0 0 1], of camera 1.
    :param cameraMatrix2: of camera 2.
    :param scale: pixels: about the standard deviation of the points; 0: the residuals tell it.
    :param covariances: N x 3, pixels^2: of the places of the matches, xx, xy, yy, as refineMatches and propagateMatches give them. What was located
        less exactly then counts less in the choice among poses.
    :return: a tuple (found, R, t, inliers, covariance): a NoPose where the matches that agree are not more than chance, or where
        two poses explain them as well, as of a plane.
        Once `found` is checked, type checkers know that R, t and covariance are there.
    :raises opencv_iib.error: for arrays of other shapes, points that are not one for one, and a scale below 0.
    """
    rows = np.empty((0, 3)) if covariances is None else _numbers(covariances, 'covariances')
    pose, reason = _core.findRelativePose(_numbers(points1, 'points1'), _numbers(points2, 'points2'), _numbers(cameraMatrix1, 'cameraMatrix1'),
                                          _numbers(cameraMatrix2, 'cameraMatrix2'), number(scale, 'scale'), rows)
    if pose[0]:
        return FoundPose(*pose)
    none = NoPose(*pose)
    none.reason = reason
    return none


def alignImages(reference: ArrayLike, image: ArrayLike, model: int = AlignmentModel.HOMOGRAPHY, referenceMask: Optional[ArrayLike] = None,
                mask: Optional[ArrayLike] = None) -> Union[Alignment, NoAlignment]:
    """Aligns an image with a reference that was taken in another light, as ``cv2.iib.alignImages``.

    For images of a plane, or of anything by a camera that stays where it is, though it may turn and zoom. With cv2,
    ``cv2.warpPerspective(image, transform, (width, height))`` has the image as the reference's camera would see it.

    :param reference: as IIBDescriptorExtractor takes it; so is `image`.
    :param model: an AlignmentModel; the simplest one that is true of the images gives the smallest errors.
    :param referenceMask: H x W uint8, 0 where no points are to be found in the reference; so is `mask` of the image.
    :return: a tuple (found, transform, error, matches): a NoAlignment where the matches are not more than chance, where
        they span a small part of what both show, as a logo does, or where the images differ by more than the model.
    :raises opencv_iib.error: for images of another type, and a model that is none.
    """
    images = as_image(reference), as_image(image)  # mistakes of both, before either is described
    return ImageAligner(images[0], model, referenceMask).align(images[1], mask)


class ImageAligner:
    """Aligns many images with one reference as :func:`alignImages` does, and describes the reference once. Threads may share one."""

    def __init__(self, reference: ArrayLike, model: int = AlignmentModel.HOMOGRAPHY, mask: Optional[ArrayLike] = None) -> None:
        """:param reference: as of alignImages; so is `model`.
        :param mask: H x W uint8, 0 where nothing is to be found.
        :raises opencv_iib.error: for a mask of another size or type, and a model that is none."""
        self._reference = as_image(reference)  # which the core looks at, and does not copy
        self._core = _core.ImageAligner.create(self._reference, integer(model, 'model'), as_mask(mask))

    @staticmethod
    def create(reference: ArrayLike, model: int = AlignmentModel.HOMOGRAPHY, mask: Optional[ArrayLike] = None) -> ImageAligner:
        """As the class itself."""
        return ImageAligner(reference, model, mask)

    def align(self, image: ArrayLike, mask: Optional[ArrayLike] = None) -> Union[Alignment, NoAlignment]:
        """As alignImages. The GIL is released meanwhile.

        :param mask: of the image.
        :raises opencv_iib.error: for an image of another type, and a mask of another size or type."""
        alignment, reason = self._core.align(as_image(image), as_mask(mask))
        if alignment[0]:
            return Alignment(*alignment)
        none = NoAlignment(*alignment)
        none.reason = reason
        return none


def logFalseAlarms(points1: ArrayLike, points2: ArrayLike, inliers: ArrayLike, epipolar: bool, threshold: float) -> float:
    """Whether matches agree with a fundamental matrix or a homography by more than chance, as ``cv2.iib.logFalseAlarms``.

    :param points1: N x 2: pixels of image 1, of right and wrong matches.
    :param points2: N x 2: their matches in image 2.
    :param inliers: N marks, not 0 for matches that agree, such as ``cv2.findHomography`` gives.
    :param epipolar: whether they agree with a fundamental matrix, in place of a homography.
    :param threshold: pixels: the largest distance of a match that agrees.
    :return: logarithm to base 10 of the number of models that agree as well by chance; above -3 it may be chance.
    :raises opencv_iib.error: for arrays of other shapes, and a threshold that is not above 0.
    """
    given = as_array(inliers, 'inliers')
    if given.size != max(given.shape, default=0):
        raise _core.error(f'logFalseAlarms: inliers must be a mark for each match, not of shape {given.shape}')
    marks = np.ascontiguousarray(given.astype(bool), np.uint8).reshape(-1, 1)
    return float(_core.logFalseAlarms(_numbers(points1, 'points1'), _numbers(points2, 'points2'), marks, bool(epipolar),
                                      number(threshold, 'threshold')))
