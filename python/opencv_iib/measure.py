"""Matches of two images to a fraction of a pixel, and the pose between their cameras."""
from __future__ import annotations

from typing import NamedTuple, Optional, Sequence

import numpy as np
from numpy.typing import NDArray

from opencv_iib._files import check_outputs, write_whole
from opencv_iib.colmap.features import FeatureOptions, Features
from opencv_iib.colmap.images import import_cv2, read_colour, write_picture
from opencv_iib.demo import GOOD, INK, OTHER, draw
from opencv_iib.functions import match
from opencv_iib.geometry import FoundPose, findRelativePose
from opencv_iib.localization import Camera
from opencv_iib.refinement import PropagatedMatches, RefinedMatches, propagateMatches

HEADER = 'x1,y1,x2,y2,xx,xy,yy,similarity,bits'


class Measured(NamedTuple):
    """What :func:`match_images` finds."""

    matches: RefinedMatches
    bits: NDArray[np.int32]  #: of each match, that differ
    pose: Optional[FoundPose]  #: None without cameras

    @property
    def refined(self) -> NDArray[np.bool_]:
        """Of each match, whether it could be refined."""
        return self.matches.similarities >= 0

    @property
    def deviations(self) -> NDArray[np.float64]:
        """Of each match, the standard deviation of its second point in pixels, a mean over both axes."""
        return np.sqrt(self.matches.covariances[:, ::2].mean(axis=1))

    @property
    def found(self) -> bool:
        """Whether there are matches, and with cameras a pose."""
        return self.pose.found if self.pose is not None else len(self.bits) > 0

    def __str__(self) -> str:
        count = int(self.refined.sum())
        text = f'{len(self.bits)} matches, {count} refined'
        if count:
            text += f' to {np.median(self.deviations[self.refined]):.2f} pixels (median standard deviation)'
        if self.pose is None:
            return text
        if self.pose.R is None or self.pose.t is None or self.pose.covariance is None:
            return text + '\nno pose'
        turn, towards = rotation_vector(self.pose.R), -self.pose.R.T @ self.pose.t.ravel()
        errors = np.degrees(np.sqrt(np.diag(self.pose.covariance)))
        return (f'{text}\npose: {int(self.pose.inliers.sum())} agree; the second camera stands towards {towards.round(3)} of the '
                f'first (right, down, ahead; +-{np.linalg.norm(errors[3:]):.2g} degrees), and is turned by '
                f'{np.degrees(-turn).round(2)} degrees (+-{np.linalg.norm(errors[:3]):.2g})')


def rotation_vector(R: NDArray[np.float64]) -> NDArray[np.float64]:
    """Axis times angle in radians."""
    vector: NDArray[np.float64] = import_cv2().Rodrigues(R)[0].ravel()
    return vector


def match_images(image_a: str, image_b: str, out: Optional[str] = None, picture: Optional[str] = None,
                 cameras: Sequence[str] = (), options: FeatureOptions = FeatureOptions(points=2000)) -> Measured:
    """Matches two images by the recommended chain, refines the matches, adds those they lead to, and with cameras finds the pose
    between them.

    :param out: file to write, a line a match: both points in pixels (the centre of the first pixel is 0), the covariance of the
        second, the patches' correlation (-1: not refined), bits that differ, and with cameras whether it agrees with the pose.
    :param picture: picture to write.
    :param cameras: one for both images, or one each: ``'MODEL,WIDTH,HEIGHT,PARAMS'`` with COLMAP's names and parameters.
    :raises ValueError: for a file that is no image, or a camera of another size.
    :raises FileExistsError: for an image as a file to write.
    """
    check_outputs([path for path in (out, picture) if path is not None], (image_a, image_b))
    images = [read_colour(path) for path in (image_a, image_b)]
    lenses = [Camera.parse(text) for text in (cameras[0], cameras[-1])] if cameras else []
    for path, image, lens in zip((image_a, image_b), images, lenses):
        if (lens.width, lens.height) != image.shape[1::-1]:
            raise ValueError(f'{path} has {image.shape[1]} x {image.shape[0]} pixels, its camera {lens.width} x {lens.height}')
    (rows_a, codes_a), (rows_b, codes_b) = map(Features(options), images)
    given = match(codes_a, codes_b).pairs
    propagated = propagateMatches(images[0], rows_a, images[1], rows_b, given)
    pose = None
    if lenses:
        # Where a pattern repeats, wrong matches lead to further ones, but seldom to one pose: a second try is from those alone
        # that agree with a first one. Only where right matches are few, the first try knows more.
        pose = _pose(propagated, lenses)
        first = _pose(PropagatedMatches(*(rows[:len(given)] for rows in propagated)), lenses)
        again = propagateMatches(images[0], rows_a, images[1], rows_b, given[first.inliers.ravel() > 0])
        pose, propagated = max((pose, propagated), (_pose(again, lenses), again), key=lambda found: int(found[0].inliers.sum()))
    pairs, matches = propagated.matches, RefinedMatches(*propagated[1:])
    bits = np.unpackbits(codes_a[pairs[:, 0]] ^ codes_b[pairs[:, 1]], axis=1).sum(axis=1, dtype=np.int32)
    measured = Measured(matches, bits, pose)
    good = measured.refined if pose is None else pose.inliers.ravel() > 0
    if out is not None:
        columns = [*matches.points1.T, *matches.points2.T, *matches.covariances.T, matches.similarities, bits]
        lines = [HEADER + ',agrees' * (pose is not None)]
        lines += [','.join(f'{value:.5g}' for value in row) + f',{agrees:d}' * (pose is not None)
                  for row, agrees in zip(np.column_stack(columns).astype(float).tolist(), good.tolist())]
        write_whole(out, ('\n'.join(lines) + '\n').encode())
    if picture is not None:
        what = 'refined' if pose is None else 'agree with the pose'
        write_picture(picture, draw(images, matches.points1, matches.points2, good, [
            (f'{len(bits)} matches:  ', INK), (f'{good.sum()} {what}', GOOD), (f'  {(~good).sum()} others', OTHER)]))
    return measured


def _pose(matches: PropagatedMatches, lenses: Sequence[Camera]) -> FoundPose:
    (a, matrix_a), (b, matrix_b) = (_without_distortion(points, lens) for points, lens in zip(matches[1:3], lenses))
    return findRelativePose(a, b, matrix_a, matrix_b)


def _without_distortion(points: NDArray[np.float32], camera: Camera) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Where a camera without distortion has the points, and its matrix."""
    step = 1e-6
    centre, right, down = camera.project(np.array([[0, 0, 1], [step, 0, 1], [0, step, 1]]))
    focal = np.array([right[0] - centre[0], down[1] - centre[1]]) / step
    rays = (points - centre) / focal
    for _ in range(50):
        rays -= (camera.project(np.column_stack([rays, np.ones(len(rays))])) - points) / focal
    return rays * focal + centre, np.array([[focal[0], 0, centre[0]], [0, focal[1], centre[1]], [0, 0, 1]])
