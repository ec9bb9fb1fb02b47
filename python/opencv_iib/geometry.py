"""Where a second camera stands, and where a second image lies."""
from __future__ import annotations

from typing import Any, NamedTuple, Optional

import numpy as np
from numpy.typing import ArrayLike, NDArray

from opencv_iib import _core
from opencv_iib._arguments import integer, number
from opencv_iib._arrays import as_array, as_image, as_matrix
from opencv_iib.enums import AlignmentModel


class FoundPose(NamedTuple):
    """What :func:`findRelativePose` finds. Without a pose, R, t and covariance are None."""

    found: bool
    R: Optional[NDArray[np.float64]]  #: 3 x 3: from the axes of camera 1 to those of camera 2
    t: Optional[NDArray[np.float64]]  #: 3 x 1, of length 1: direction of the translation, in the axes of camera 2
    inliers: NDArray[np.uint8]  #: N x 1: 1 for matches that agree with the pose
    covariance: Optional[NDArray[np.float64]]  #: 5 x 5, radians: of the rotation, and of the direction of t


class Alignment(NamedTuple):
    """What :func:`alignImages` finds. Where the images do not show the same, transform and error are None."""

    found: bool
    transform: Optional[NDArray[np.float64]]  #: 3 x 3: from pixels of the image to pixels of the reference
    error: Optional[NDArray[np.float64]]  #: 4 x 1: standard deviations of the places of the image's corners, pixels
    matches: NDArray[np.float32]  #: M x 4: those that agree, x and y in the reference, x and y in the image


def _numbers(value: ArrayLike, what: str) -> NDArray[Any]:
    array = as_array(value, what)
    return as_matrix(array if array.dtype in (np.float32, np.float64) else array.astype(np.float64), what)


def findRelativePose(points1: ArrayLike, points2: ArrayLike, cameraMatrix1: ArrayLike, cameraMatrix2: ArrayLike,
                     scale: float = .25) -> FoundPose:
    """Finds where camera 2 stands, seen from camera 1, from matched points of which many may be wrong.

    As ``cv2.iib.findRelativePose``. Points must be free of lens distortion:
    ``cv2.undistortPoints(points, K, distortion, P=K)`` first.

    :param points1: N x 2: pixels of image 1.
    :param points2: N x 2: their matches in image 2.
    :param cameraMatrix1: 3 x 3, [fx 0 cx; 0 fy cy; 0 0 1], of camera 1.
    :param cameraMatrix2: of camera 2.
    :param scale: pixels: about the standard deviation of the points; .25 for refined points, .5 for points as detected.
    :return: not found with fewer than five matches, or where no pose agrees with five or more.
    :raises opencv_iib.error: for arrays of other shapes, points that are not one for one, and a scale that is not above 0.
    """
    return FoundPose(*_core.findRelativePose(_numbers(points1, 'points1'), _numbers(points2, 'points2'),
                                             _numbers(cameraMatrix1, 'cameraMatrix1'),
                                             _numbers(cameraMatrix2, 'cameraMatrix2'), number(scale, 'scale')))


def alignImages(reference: ArrayLike, image: ArrayLike, model: int = AlignmentModel.HOMOGRAPHY) -> Alignment:
    """Aligns an image with a reference that was taken in another light, as ``cv2.iib.alignImages``.

    For images of a plane, or of anything by a camera that stays where it is, though it may turn and zoom. With cv2,
    ``cv2.warpPerspective(image, transform, (width, height))`` has the image as the reference's camera would see it.

    :param reference: as IIBDescriptorExtractor takes it; so is `image`.
    :param model: an AlignmentModel; the simplest one that is true of the images gives the smallest errors.
    :return: not found where too few matches agree for the images to show the same.
    :raises opencv_iib.error: for images of another type, and a model that is none.
    """
    return Alignment(*_core.alignImages(as_image(reference), as_image(image), integer(model, 'model')))
