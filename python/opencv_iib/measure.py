"""Matches two images to a fraction of a pixel, and finds the pose between their cameras."""
from __future__ import annotations

import copy
import io
import json
import os
from typing import Any, NamedTuple, Optional, Sequence

import numpy as np
from numpy.typing import NDArray

from opencv_iib._arguments import InvalidOption, Path, sequence
from opencv_iib._camera import AnyCamera, Camera, as_camera
from opencv_iib._drawing import GOOD, INK, OTHER, draw
from opencv_iib._files import check_images, check_outputs, write_whole
from opencv_iib._image_file import ImageFile, Masks
from opencv_iib._images import check_picture, import_cv2, write_picture
from opencv_iib._orientation import Turn, upright
from opencv_iib._streams import is_open_file
from opencv_iib._two_views import show_the_same
from opencv_iib.enums import Orientation
from opencv_iib.features import FeatureOptions, Features
from opencv_iib.functions import match
from opencv_iib.geometry import RelativePose, findRelativePose
from opencv_iib.matcher import HierarchicalMatcher
from opencv_iib.refinement import PropagatedMatches, RefinedMatches, prepared, propagateMatches
from opencv_iib.rotation import matchRotated
from opencv_iib.views import match_stored, rotation_and_scale, similarity

COMPARED = .25  # pixels: the scale at which inliers of two poses are compared, since at their own scales the looser pose has more
CERTAIN = 200  # inliers without a pose that need no second try: fewer may be wrong together
UNKNOWN = 60  # degrees: an error of a direction of this size leaves it open
SUFFIXES = '.csv', '.json', '.npz'
COLUMNS = ('x1', 'y1', 'x2', 'y2', 'xx', 'xy', 'yy', 'similarity', 'bits')


class Measured(NamedTuple):
    """The result of :func:`match_images`."""

    matches: RefinedMatches
    bits: NDArray[np.int32]  #: different bits of each match; -1 where simulated views were matched
    pose: Optional[RelativePose]  #: None without cameras
    found: bool  #: there is a pose; without cameras: the matches that agree with an epipolar geometry or homography are significant
    rotation: float  #: degrees, clockwise, of the second image against the first, besides EXIF's orientation; 0: less than 8
    scale: float  #: size in the second image by that in the first; 1: within a fifth
    view: NDArray[np.float64]  #: 3 x 3: approximate affine map from pixels of the first image to pixels of the second

    @property
    def refined(self) -> NDArray[np.bool_]:
        """Whether each match could be refined."""
        return self.matches.similarities >= 0

    @property
    def agree(self) -> NDArray[np.bool_]:
        """Whether each match agrees with the pose; without cameras, whether it could be refined."""
        return self.refined if self.pose is None else (self.pose.inliers.ravel() > 0) & self.pose.found

    @property
    def deviations(self) -> NDArray[np.float64]:
        """The standard deviation of each match's second point in pixels, a mean over both axes."""
        return np.sqrt(self.matches.covariances[:, ::2].mean(axis=1))

    def save(self, file: Path) -> None:
        """Writes matches and pose to a file in .csv, .json or .npz; as CSV to standard output ('-') and devices.

        A row a match: both points in pixels (the centre of the first pixel is 0), the covariance of the second, the patches'
        correlation (-1: not refined), different bits, with cameras whether it agrees with the pose, and `found`. JSON and NPZ also have `found`,
        view, rotation, scale and pose. In JSON ``matches`` are objects; the pose is null without cameras, the view if not found, and numbers that
        are not finite.

        :raises InvalidOption: for another suffix."""
        check_suffix(file)
        write_whole(os.fspath(file), self.content(os.path.splitext(os.fspath(file))[1].lower()))

    def content(self, suffix: str = '') -> bytes:
        """The content of a file with this suffix."""
        pose: Optional[dict[str, Any]] = None
        table = np.column_stack([self.matches.points1, self.matches.points2, self.matches.covariances, self.matches.similarities, self.bits])
        rows = [[f'{value:.10g}' for value in row] for row in table.astype(float).tolist()]
        if self.pose is not None:
            pose = {name: None if value is None else np.squeeze(value) for name, value in self.pose._asdict().items()}
            pose.update(found=self.pose.found, reason=self.pose.reason, inliers=self.agree)
        if suffix == '.npz':
            arrays = io.BytesIO()
            known = {name: value for name, value in {'found': self.found, 'view': self.view if self.found else None, **(pose or {})}.items() if value is not None}
            np.savez_compressed(arrays, **self.matches._asdict(), bits=self.bits, rotation=self.rotation, scale=self.scale, **known)
            return arrays.getvalue()
        if suffix == '.json':
            matches = [dict(zip(COLUMNS, (json.loads(text) if np.isfinite(float(text)) else None for text in row))) for row in rows]
            return json.dumps({'found': bool(self.found), 'matches': matches, 'pose': pose, 'view': self.view if self.found else None,
                               'rotation': float(self.rotation), 'scale': float(self.scale)}, default=_finite, allow_nan=False).encode()
        header = [*COLUMNS, *['agrees'] * (pose is not None), 'found']
        marks = [[f'{agrees:d}'] * (pose is not None) + [f'{self.found:d}'] for agrees in self.agree.tolist()]
        return ''.join(','.join(row) + '\n' for row in (header, *map(list.__add__, rows, marks))).encode()

    def __str__(self) -> str:
        count = int(self.refined.sum())
        text = f'{len(self.bits)} matches, {count} refined'
        if count:
            text += f' to {np.median(self.deviations[self.refined]):.2f} pixels (median standard deviation)'
        if self.found and (self.rotation, self.scale) != (0, 1):
            text += f', the second image has scale {self.scale:.2f} and is rotated by {round(self.rotation) % 360} degrees'
        if self.pose is None:
            return text + '\nthese may not show the same: their matches could be random' * (not self.found)
        if not self.pose.found:
            return f'{text}\nno pose: {self.pose.reason}'.replace('no pose: no pose', 'no pose')
        turn, towards = import_cv2().Rodrigues(self.pose.R)[0].ravel(), -self.pose.R.T @ self.pose.t.ravel()
        errors = np.degrees(np.sqrt(np.diag(self.pose.covariance)))
        unsure = np.linalg.norm(errors[3:])
        where = (f'stands towards {towards.round(3)} of the first (right, down, ahead; +-{unsure:.2g} degrees)' if unsure < UNKNOWN
                 else 'hardly moved, so its direction is unknown')
        return (f'{text}\npose: {int(self.pose.inliers.sum())} agree; the second camera {where}, and is turned by '
                f'{np.degrees(-turn).round(2)} degrees (+-{np.linalg.norm(errors[:3]):.2g})')


def check_suffix(path: Path) -> None:
    """:raises InvalidOption: for a suffix that Measured.save does not know."""
    name = os.fspath(path)
    if not (is_open_file(name) or name.lower().endswith(SUFFIXES)):
        raise InvalidOption(f'{name}: end its name in {", ".join(SUFFIXES[:-1])} or {SUFFIXES[-1]}')


def _finite(array: NDArray[Any]) -> Any:
    """Nested lists, with None for numbers that are not finite, which JSON lacks."""
    numbers = array.astype(object)
    numbers[~np.isfinite(array)] = None
    return numbers.tolist()


def match_images(image_a: Path, image_b: Path, out: Optional[Path] = None, picture: Optional[Path] = None,
                 cameras: Sequence[AnyCamera] = (), options: FeatureOptions = FeatureOptions()) -> Measured:
    """Matches two images by the recommended chain, refines and propagates the matches, and with cameras finds the pose between them.

    :param out: file to write, see :meth:`Measured.save`.
    :param picture: picture to write.
    :param cameras: one for both images, or one each: ``'MODEL,WIDTH,HEIGHT,PARAMS'`` with COLMAP's names and parameters, or as in
        :meth:`opencv_iib.localization.Localizer.localize`.
    :raises ValueError: for a file that is no image, a camera of another size, or another suffix of `out`.
    :raises FileExistsError: if a file to write is an image.
    :raises FileNotFoundError: for a missing image."""
    options.check()
    cameras = sequence(cameras, 'cameras', 'cameras')
    if len(cameras) > 2:
        raise InvalidOption(f'{len(cameras)} cameras for two images')
    views, features = read_pair((image_a, image_b), out, picture, options, [as_camera(camera) for camera in (cameras[:1] + cameras[-1:])])
    measured = measure(views[0], views[1], features)
    if out is not None:
        measured.save(out)
    if picture is not None:
        what = 'refined' if measured.pose is None else 'agree with the pose'
        write_picture(picture, draw([view.stored for view in views], measured.matches.points1, measured.matches.points2, measured.agree, [
            (f'{len(measured.bits)} matches:  ', INK), (f'{measured.agree.sum()} {what}', GOOD), (f'  {(~measured.agree).sum()} others', OTHER)]))
    return measured


class View(NamedTuple):
    """An image with its keypoints."""

    stored: np.ndarray  #: the pixels of its file, BGR
    image: np.ndarray  #: upright
    mask: Optional[np.ndarray]  #: of the upright image
    turn: Turn
    lens: Optional[Camera]  #: of the stored image
    rows: np.ndarray  #: keypoints of the upright image
    codes: np.ndarray

    @classmethod
    def of(cls, path: str, masks: Masks, features: Features, lens: Optional[Camera], name: str,
           described: Optional[tuple[np.ndarray, np.ndarray]] = None) -> View:
        """:param name: the image's name among the masks.
        :param described: its rows and codes, if they are known.
        :raises ValueError: for a file that is no image, or has another size than its camera or mask."""
        try:
            file = ImageFile(path, features.options.exif)
            stored, orientation = file.colour, file.orientation if lens is None else file.orientation_of_camera
            mask = masks.of(name, stored)
        except ValueError as e:
            raise type(e)(f'{path}: {e}') from None
        height, width = stored.shape[:2]
        if lens is not None and (lens.width, lens.height) != (width, height):
            raise InvalidOption(f'{path} has {width} x {height} pixels, its camera {lens.width} x {lens.height}: give the '
                                f"image's own camera, PINHOLE,{width},{height},F,F,{width / 2:g},{height / 2:g} with its focal length F in "
                                'pixels')
        image, mask = upright(stored, orientation), None if mask is None else upright(mask, orientation)
        if described is None:
            described = features(image, mask=mask)
        return cls(stored, image, mask, Turn(orientation, width, height), lens, *described)


def read_pair(images: Sequence[Path], out: Optional[Path], picture: Optional[Path], options: FeatureOptions,
              lenses: Sequence[Optional[Camera]] = ()) -> tuple[list[View], Features]:
    """Checks two images and the files to write, and describes the images."""
    check_images(*images)
    masks, features, paths = Masks(options.mask), Features(options), [os.fspath(path) for path in images]
    names = [os.path.basename(path) for path in paths]
    check_outputs([path for path in (out, picture) if path is not None], (*paths, *masks.check(names)))
    if out is not None:
        check_suffix(out)
    if picture is not None:
        check_picture(picture)
    return [View.of(path, masks, features, lens, name) for path, lens, name in zip(paths, lenses or (None, None), names)], features


def measure(first: View, second: View, features: Features) -> Measured:
    """Does what match_images does, for images that were described by these features."""
    pair = _Pair(first, second)
    measured = pair.measured((first.rows, second.rows), (first.codes, second.codes), match(first.codes, second.codes).pairs)
    certain = measured.found and (measured.pose is not None or measured.agree.sum() >= CERTAIN) and (measured.rotation, measured.scale) == (0, 1)
    options = features.options
    if options.orientation or certain:
        return measured
    if (options.detector, options.preset, options.max_size) != ('HESSIAN', 'UNIVERSAL', 0):  # matchViews is of the recommended chain
        return measured if measured.found else pair.rotated(features, measured)
    by_views = pair.by_views(options.points)
    return by_views if by_views.found and (not measured.found or by_views.agree.sum() > measured.agree.sum()) else measured


class _Pair:
    """Two upright images, and the cameras of the stored ones, if these are known."""

    def __init__(self, *views: View) -> None:
        self.images, self._masks, self._turns = zip(*((view.image, view.mask, view.turn) for view in views))
        self._rows = [view.rows for view in views]
        self._prepared = [prepared(image) for image in self.images]
        self.lenses = [view.lens for view in views if view.lens is not None]

    def measured(self, rows: Sequence[np.ndarray], codes: Sequence[np.ndarray], given: np.ndarray) -> Measured:
        """The result of keypoints of the upright images, their codes and matches."""
        propagated, count = self._propagated(rows, given)
        pose = None
        if self.lenses:
            # Wrong matches of a repeating pattern propagate too, but seldom agree with a pose. A second try propagates the inliers of a
            # first pose alone. If these are few, the first try is better.
            pose = self._pose(*propagated[1:3])
            first = self._pose(*(points[:count] for points in propagated[1:3]))
            again, _ = self._propagated(rows, propagated.matches[:count][first.inliers.ravel() > 0])
            pose, propagated = max((pose, propagated), (self._pose(*again[1:3]), again),
                                   key=lambda found: (found[0].found, int(self._pose(*found[1][1:3], scale=COMPARED).inliers.sum())))
        a, b = (some[propagated.matches[:, side]] for side, some in enumerate(codes))
        bits = np.unpackbits(a ^ b, axis=1).sum(axis=1, dtype=np.int32)
        matches = RefinedMatches(*propagated[1:])
        agree = pose.inliers.ravel() > 0 if pose is not None else matches.similarities >= 0
        view = similarity(matches.points1[agree], matches.points2[agree])
        return self._result(matches, bits, pose, pose is None and show_the_same(matches.points1, matches.points2), view)

    def by_views(self, points: int) -> Measured:
        """The result of simulated views, of rotated, zoomed and tilted images; bits are -1, since matches have no keypoints."""
        found = match_stored(self.images, self._turns, self._masks, points)
        visible = self._visible(found.points1, found.points2)
        matches = RefinedMatches(*(each[visible] for each in found[2:6]))
        pose = self._pose(matches.points1, matches.points2) if self.lenses else None
        view = np.eye(3) if found.view is None else found.view
        return self._result(matches, np.full(len(matches.points1), -1, np.int32), pose, found.found, view)

    def _result(self, matches: RefinedMatches, bits: np.ndarray, pose: Optional[RelativePose], found: bool, view: np.ndarray) -> Measured:
        """:param found: without a pose. :param view: between stored images."""
        upright_view = np.linalg.inv(self._turns[1].matrix) @ view @ self._turns[0].matrix
        return Measured(matches, bits, pose, found if pose is None else pose.found, *rotation_and_scale(upright_view), view)

    def rotated(self, features: Features, otherwise: Measured) -> Measured:
        """The result of features of any detector, rotated by one angle."""
        if not len(self._rows[0]) or not len(self._rows[1]):
            return otherwise
        extractor = copy.copy(features.extractor)
        extractor.setOrientation(Orientation.KEYPOINT)
        _, *rows, matches = matchRotated(self.images[0], self.images[1], extractor, HierarchicalMatcher.createRecommended(), -1,
                                                self._rows[0], self._rows[1])
        found = self.measured(rows, [extractor.compute(image, some)[1] for image, some in zip(self.images, rows)], matches[:, :2])
        return found if found.found else otherwise

    def _visible(self, *points: np.ndarray) -> np.ndarray:
        """Whether the cameras can see each match: a lens model ends at some angle."""
        seen = np.ones(len(points[0]), bool)
        for some, lens in zip(points, self.lenses):
            seen &= np.isfinite(lens.undistorted(some)).all(axis=1)
        return seen

    def _propagated(self, rows: Sequence[np.ndarray], given: np.ndarray) -> tuple[PropagatedMatches, int]:
        """Propagated matches that the cameras can see, in pixels of the stored images, and how many of them were given."""
        found = propagateMatches(self._prepared[0], rows[0], self._prepared[1], rows[1], given)
        found = found._replace(points1=self._turns[0].points(found.points1), points2=self._turns[1].points(found.points2),
                               covariances=self._turns[1].covariances(found.covariances))
        seen = self._visible(*found[1:3])
        return PropagatedMatches(*(each[seen] for each in found)), int(seen[:len(given)].sum())

    def _pose(self, *points: np.ndarray, scale: float = 0) -> RelativePose:
        a, b = (lens.undistorted(some) for some, lens in zip(points, self.lenses))
        return findRelativePose(a, b, self.lenses[0].matrix, self.lenses[1].matrix, scale)
