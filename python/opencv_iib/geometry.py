"""The pose between two cameras, and the transform between two images."""
from __future__ import annotations

from typing import Any, NamedTuple, Optional

import numpy as np
from numpy.typing import ArrayLike, NDArray

from opencv_iib import _core
from opencv_iib._arguments import integer, number
from opencv_iib._arrays import as_array, as_image, as_mask, as_matrix
from opencv_iib.enums import AlignmentModel

_Pose = NamedTuple('_Pose', [('found', bool), ('R', Any), ('t', Any), ('inliers', NDArray[np.uint8]), ('covariance', Any)])
_Alignment = NamedTuple('_Alignment', [('found', bool), ('transform', Any), ('error', Any), ('matches', NDArray[np.float32])])


class RelativePose(_Pose):
    """The result of :func:`findRelativePose`, a tuple (found, R, t, inliers, covariance).

    R is 3 x 3, from the axes of camera 1 to those of camera 2; t is 3 x 1, the direction of the translation in the axes of camera 2, of length 1;
    the covariance is 5 x 5, radians, of the rotation and of the direction of t. All three are None if no pose is found. The inliers are N x 1,
    1 for matches that agree.
    """

    reason: str = ''  #: why no pose is found, a sentence


class Alignment(_Alignment):
    """The result of :func:`alignImages`, a tuple (found, transform, error, matches).

    The transform is 3 x 3, from pixels of the image to pixels of the reference; the error 4 x 1, standard deviations of the places of the
    image's corners, pixels. Both are None if the images do not show the same. The matches are those that agree, M x 4: x and y in the
    reference, x and y in the image.
    """

    reason: str = ''  #: why it is not found, a sentence
    simplest: AlignmentModel  #: if found: the simplest true model, with AUTO that of the transform
    note: str = ''  #: advice about the transform, such as that a part moved otherwise; mostly ''


def _numbers(value: ArrayLike, what: str) -> NDArray[Any]:
    array = as_array(value, what)
    return as_matrix(array if array.dtype in (np.float32, np.float64) else array.astype(np.float64), what)


def findRelativePose(points1: ArrayLike, points2: ArrayLike, cameraMatrix1: ArrayLike, cameraMatrix2: ArrayLike,
                     scale: float = 0, covariances: Optional[ArrayLike] = None) -> RelativePose:
    """Estimates the pose of camera 2 relative to camera 1 from matches, as ``cv2.iib.findRelativePose``. Many matches may be wrong.

    Points must be free of lens distortion: call ``cv2.undistortPoints(points, K, distortion, P=K)`` first.

    :param points1: N x 2, pixels of image 1; so are their matches `points2` in image 2.
    :param cameraMatrix1: 3 x 3, [fx 0 cx; 0 fy cy; 0 0 1], of camera 1; so is `cameraMatrix2` of camera 2.
    :param scale: standard deviation of the points in pixels, roughly; 0: estimated from the residuals.
    :param covariances: N x 3, xx, xy, yy of the matches in squared pixels, as of refineMatches and propagateMatches. Less exact matches have less
        weight in the choice among poses.
    :return: with its `reason`. Not found: the inliers could be random, or two poses explain them equally well, as for a plane.
    :raises opencv_iib.error: for arrays of other shapes or lengths, and a scale below 0.
    """
    rows = np.empty((0, 3)) if covariances is None else _numbers(covariances, 'covariances')
    pose, reason = _core.findRelativePose(_numbers(points1, 'points1'), _numbers(points2, 'points2'), _numbers(cameraMatrix1, 'cameraMatrix1'),
                                          _numbers(cameraMatrix2, 'cameraMatrix2'), number(scale, 'scale'), rows)
    result = RelativePose(*pose)
    result.reason = reason
    return result


def alignImages(reference: ArrayLike, image: ArrayLike, model: int = AlignmentModel.HOMOGRAPHY, referenceMask: Optional[ArrayLike] = None,
                mask: Optional[ArrayLike] = None) -> Alignment:
    """Aligns an image with a reference under changed illumination, as ``cv2.iib.alignImages``.

    For images of a plane, or of any scene by a camera that does not move; it may rotate and zoom. With cv2,
    ``cv2.warpPerspective(image, transform, (width, height))`` returns the image as the reference's camera would see it.

    :param reference: as IIBDescriptorExtractor takes it; so is `image`.
    :param model: an AlignmentModel. The simplest true model gives the smallest errors, and AUTO chooses it.
    :param referenceMask: H x W uint8, 0 where no points are to be found in the reference; so is `mask` of the image.
    :return: a tuple (found, transform, error, matches), with its `reason`. Not found: the matches could be random, they span a small
        part of the overlap, like a logo, or the images differ by more than the model.
    :raises opencv_iib.error: for images of another type, and an unknown model.
    """
    images = as_image(reference), as_image(image)  # checks both before either is described
    return ImageAligner(images[0], model, referenceMask).align(images[1], mask)


class ImageAligner:
    """Aligns many images with one reference as :func:`alignImages` does, and describes the reference once. Threads may share one."""

    def __init__(self, reference: ArrayLike, model: int = AlignmentModel.HOMOGRAPHY, mask: Optional[ArrayLike] = None) -> None:
        """:param reference: as in alignImages; so is `model`.
        :param mask: H x W uint8, 0 where no points are to be found.
        :raises opencv_iib.error: for a mask of another size or type, and an unknown model."""
        self._reference = as_image(reference)  # the core refers to it and does not copy it
        self._core = _core.ImageAligner.create(self._reference, integer(model, 'model'), as_mask(mask))

    @staticmethod
    def create(reference: ArrayLike, model: int = AlignmentModel.HOMOGRAPHY, mask: Optional[ArrayLike] = None) -> ImageAligner:
        """As the class itself."""
        return ImageAligner(reference, model, mask)

    def align(self, image: ArrayLike, mask: Optional[ArrayLike] = None) -> Alignment:
        """As alignImages. The GIL is released meanwhile.

        :param mask: of the image.
        :raises opencv_iib.error: for an image of another type, and a mask of another size or type."""
        alignment, reason, simplest, note = self._core.align(as_image(image), as_mask(mask))
        result = Alignment(*alignment)
        result.reason, result.note = reason, note
        if result.found:
            result.simplest = AlignmentModel(simplest)
        return result


def logFalseAlarms(points1: ArrayLike, points2: ArrayLike, inliers: ArrayLike, epipolar: bool, threshold: float) -> float:
    """Whether inliers of a fundamental matrix or a homography are significant, as ``cv2.iib.logFalseAlarms``.

    :param points1: N x 2, pixels of image 1, of right and wrong matches; so are their matches `points2` in image 2.
    :param inliers: N marks, not 0 for inliers, as of ``cv2.findHomography``.
    :param epipolar: the model is a fundamental matrix, not a homography.
    :param threshold: largest distance of an inlier, pixels.
    :return: logarithm to base 10 of the expected number of models with as many random inliers; above -3 it is not significant.
    :raises opencv_iib.error: for arrays of other shapes, and a threshold of 0 or less.
    """
    given = as_array(inliers, 'inliers')
    if given.size != max(given.shape, default=0):
        raise _core.error(f'logFalseAlarms: inliers must be a mark for each match, not of shape {given.shape}')
    marks = np.ascontiguousarray(given.astype(bool), np.uint8).reshape(-1, 1)
    return float(_core.logFalseAlarms(_numbers(points1, 'points1'), _numbers(points2, 'points2'), marks, bool(epipolar),
                                      number(threshold, 'threshold')))


def confidenceLimit(probability: float, dimensions: int) -> float:
    """The limit of error @ inv(covariance) @ error that errors of poses, alignments and refined points stay below with this probability, as
    ``cv2.iib.confidenceLimit``. The errors are distributed as Student's t with two degrees of freedom.

    :param probability: 0 or more and below 1.
    :param dimensions: 1 or more, of the error: 3 for a rotation, 2 for a direction or a point.
    :raises opencv_iib.error: for other values.
    """
    return float(_core.confidenceLimit(number(probability, 'probability'), integer(dimensions, 'dimensions')))
