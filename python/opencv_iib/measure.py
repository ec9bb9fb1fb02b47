"""Matches of two images to a fraction of a pixel, and the pose between their cameras."""
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
from opencv_iib._streams import is_open_file
from opencv_iib._two_views import show_the_same
from opencv_iib._upright import Turn, upright
from opencv_iib.enums import Orientation
from opencv_iib.features import FeatureOptions, Features
from opencv_iib.functions import match
from opencv_iib.geometry import RelativePose, findRelativePose
from opencv_iib.matcher import HierarchicalMatcher
from opencv_iib.refinement import PropagatedMatches, RefinedMatches, prepared, propagateMatches
from opencv_iib.rotation import matchRotated
from opencv_iib.views import match_stored, rotation_and_scale, similarity

COMPARED = .25  # pixels: one scale of poses whose matches are counted, since under scales of their own the looser one has more
CERTAIN = 200  # matches that agree without a pose: fewer may be wrong together
SUFFIXES = '.csv', '.json', '.npz'
COLUMNS = ('x1', 'y1', 'x2', 'y2', 'xx', 'xy', 'yy', 'similarity', 'bits')


class Measured(NamedTuple):
    """What :func:`match_images` finds."""

    matches: RefinedMatches
    bits: NDArray[np.int32]  #: of each match, that differ; -1 where the images were matched in views of them
    pose: Optional[RelativePose]  #: None without cameras
    found: bool  #: there is a pose, or without cameras more matches than chance may give agree with one epipolar geometry or homography
    view: NDArray[np.float64]  #: 3 x 3: approximate affine map from pixels of the first image to pixels of the second
    rotation: float = 0  #: degrees by which the second image is rotated against the first, clockwise, besides EXIF's orientation; 0: less than 8
    scale: float = 1  #: of the second image's pixels by the first's; 1: less than a fifth more or less

    @property
    def refined(self) -> NDArray[np.bool_]:
        """Of each match, whether it could be refined."""
        return self.matches.similarities >= 0

    @property
    def agree(self) -> NDArray[np.bool_]:
        """Of each match, whether it agrees with the pose; without cameras, whether it could be refined."""
        return self.refined if self.pose is None else (self.pose.inliers.ravel() > 0) & self.pose.found

    @property
    def deviations(self) -> NDArray[np.float64]:
        """Of each match, the standard deviation of its second point in pixels, a mean over both axes."""
        return np.sqrt(self.matches.covariances[:, ::2].mean(axis=1))

    def save(self, file: Path) -> None:
        """Writes matches and pose to a file that is replaced when the new one is whole, by its suffix: .csv, .json or .npz; CSV to standard
        output ('-') and to devices.

        A row a match: both points in pixels (the centre of the first pixel is 0), the covariance of the second, the patches'
        correlation (-1: not refined), bits that differ, with cameras whether it agrees with the pose, and `found`. JSON and NPZ have `found`,
        the view, the rotation, the scale and the pose too; in JSON it is null without cameras, the view where not found, as is a number that is not finite, and ``matches`` are objects.

        :raises InvalidOption: for another suffix.
        """
        check_suffix(file)
        write_whole(os.fspath(file), self.content(os.path.splitext(os.fspath(file))[1].lower()))

    def content(self, suffix: str = '') -> bytes:
        """What `save` writes to a file of this suffix."""
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
            return text + '\nthese may not show the same: no more matches agree with one geometry than chance may give' * (not self.found)
        if not self.pose.found:
            return f'{text}\nno pose: {self.pose.reason}'.replace('no pose: no pose', 'no pose')
        turn, towards = rotation_vector(self.pose.R), -self.pose.R.T @ self.pose.t.ravel()
        errors = np.degrees(np.sqrt(np.diag(self.pose.covariance)))
        return (f'{text}\npose: {int(self.pose.inliers.sum())} agree; the second camera stands towards {towards.round(3)} of the '
                f'first (right, down, ahead; +-{np.linalg.norm(errors[3:]):.2g} degrees), and is turned by '
                f'{np.degrees(-turn).round(2)} degrees (+-{np.linalg.norm(errors[:3]):.2g})')


def check_suffix(path: Path) -> None:
    """:raises InvalidOption: for a file of a suffix that Measured.save does not know."""
    name = os.fspath(path)
    if not (is_open_file(name) or name.lower().endswith(SUFFIXES)):
        raise InvalidOption(f'{name}: end its name in {", ".join(SUFFIXES[:-1])} or {SUFFIXES[-1]}')


def _finite(array: NDArray[Any]) -> Any:
    """As lists, with None for the numbers that JSON has not."""
    numbers = array.astype(object)
    numbers[~np.isfinite(array)] = None
    return numbers.tolist()


def rotation_vector(R: NDArray[np.float64]) -> NDArray[np.float64]:
    """Axis times angle in radians."""
    vector: NDArray[np.float64] = import_cv2().Rodrigues(R)[0].ravel()
    return vector


def match_images(image_a: Path, image_b: Path, out: Optional[Path] = None, picture: Optional[Path] = None,
                 cameras: Sequence[AnyCamera] = (), options: FeatureOptions = FeatureOptions()) -> Measured:
    """Matches two images by the recommended chain, refines the matches, adds those they lead to, and with cameras finds the pose
    between them.

    :param out: file to write, as :meth:`Measured.save` does.
    :param picture: picture to write.
    :param cameras: one for both images, or one each: ``'MODEL,WIDTH,HEIGHT,PARAMS'`` with COLMAP's names and parameters, or as
        :meth:`opencv_iib.localization.Localizer.localize` takes it.
    :raises ValueError: for a file that is no image, a camera of another size, or a suffix of `out` that is none of these.
    :raises FileExistsError: for an image as a file to write.
    :raises FileNotFoundError: for an image that is not there.
    """
    options.check()
    cameras = sequence(cameras, 'cameras', 'cameras')
    if len(cameras) > 2:
        raise InvalidOption(f'{len(cameras)} cameras for two images')
    masks, features, paths = Masks(options.mask), Features(options), [os.fspath(image_a), os.fspath(image_b)]
    check_images(*paths)
    masked = masks.check([os.path.basename(path) for path in paths])
    check_outputs([path for path in (out, picture) if path is not None], (*paths, *masked))
    if out is not None:
        check_suffix(out)
    if picture is not None:
        check_picture(picture)
    lenses = [as_camera(camera) for camera in (cameras[0], cameras[-1])] if len(cameras) else [None, None]
    views = [View.of(path, masks, features, lens, os.path.basename(path)) for path, lens in zip(paths, lenses)]
    measured = measure(views[0], views[1], features)
    if out is not None:
        measured.save(out)
    if picture is not None:
        what = 'refined' if measured.pose is None else 'agree with the pose'
        write_picture(picture, draw([view.stored for view in views], measured.matches.points1, measured.matches.points2, measured.agree, [
            (f'{len(measured.bits)} matches:  ', INK), (f'{measured.agree.sum()} {what}', GOOD), (f'  {(~measured.agree).sum()} others', OTHER)]))
    return measured


class View(NamedTuple):
    """An image, and what is found in it."""

    stored: np.ndarray  #: as its file has it, BGR
    image: np.ndarray  #: as people see it
    mask: Optional[np.ndarray]  #: of that
    turn: Turn
    lens: Optional[Camera]  #: of the file
    rows: np.ndarray  #: keypoints of the upright image
    codes: np.ndarray

    @classmethod
    def of(cls, path: str, masks: Masks, features: Features, lens: Optional[Camera], name: str,
           described: Optional[tuple[np.ndarray, np.ndarray]] = None) -> View:
        """:param name: by which it has its mask.
        :param described: its rows and codes, if they are known.
        :raises ValueError: for a file that is no image, or of another size than its camera's or its mask."""
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


def measure(first: View, second: View, features: Features) -> Measured:
    """What match_images does, of images that were described by these features."""
    pair = _Pair(first, second)
    measured = pair.measured((first.rows, second.rows), (first.codes, second.codes), match(first.codes, second.codes).pairs)
    certain = measured.found and (measured.pose is not None or measured.agree.sum() >= CERTAIN) and (measured.rotation, measured.scale) == (0, 1)
    if features.options.orientation or certain:
        return measured
    if not features.options.are_recommended:
        return measured if measured.found else pair.rotated(features, measured)
    seen = pair.seen(features.options.points)
    return seen if seen.found and (not measured.found or seen.agree.sum() > measured.agree.sum()) else measured


class _Pair:
    """Two images as people see them, and the cameras of their files, if these are known."""

    def __init__(self, *views: View) -> None:
        self.images, self._masks, self._turns = zip(*((view.image, view.mask, view.turn) for view in views))
        self._rows = [view.rows for view in views]
        self._prepared = [prepared(image) for image in self.images]
        self.lenses = [view.lens for view in views if view.lens is not None]

    def measured(self, rows: Sequence[np.ndarray], codes: Sequence[np.ndarray], given: np.ndarray) -> Measured:
        """From keypoints of the upright images, their codes and matches of them."""
        propagated, count = self._propagated(rows, given)
        pose = None
        if self.lenses:
            # Where a pattern repeats, wrong matches lead to further ones, but seldom to one pose: a second try is from those alone
            # that agree with a first one. Only where right matches are few, the first try knows more.
            pose = self._pose(*propagated[1:3])
            first = self._pose(*(points[:count] for points in propagated[1:3]))
            again, _ = self._propagated(rows, propagated.matches[:count][first.inliers.ravel() > 0])
            pose, propagated = max((pose, propagated), (self._pose(*again[1:3]), again),
                                   key=lambda found: (found[0].found, int(self._pose(*found[1][1:3], scale=COMPARED).inliers.sum())))
        a, b = (some[propagated.matches[:, side]] for side, some in enumerate(codes))
        bits = np.unpackbits(a ^ b, axis=1).sum(axis=1, dtype=np.int32)
        matches = RefinedMatches(*propagated[1:])
        found = pose.found if pose is not None else show_the_same(matches.points1, matches.points2)
        agree = pose.inliers.ravel() > 0 if pose is not None else matches.similarities >= 0
        view = similarity(matches.points1[agree], matches.points2[agree])
        return Measured(matches, bits, pose, found, view, *rotation_and_scale(self._upright(view)))

    def seen(self, points: int) -> Measured:
        """In views of both images, whatever the zoom, rotation and tilt between them; bits are -1, since no keypoints are kept."""
        found = match_stored(self.images, self._turns, self._masks, points)
        visible = self._visible(found.points1, found.points2)
        matches = RefinedMatches(*(each[visible] for each in found[2:6]))
        pose = self._pose(matches.points1, matches.points2) if self.lenses else None
        view = np.eye(3) if found.view is None else found.view
        return Measured(matches, np.full(len(matches.points1), -1, np.int32), pose, found.found if pose is None else pose.found,
                        view, *rotation_and_scale(self._upright(view)))

    def _upright(self, view: np.ndarray) -> np.ndarray:
        """Of a map between the files' pixels."""
        return np.linalg.inv(self._turns[1].matrix) @ view @ self._turns[0].matrix

    def rotated(self, features: Features, otherwise: Measured) -> Measured:
        """With features of any detector, by one angle for all."""
        if not len(self._rows[0]) or not len(self._rows[1]):
            return otherwise
        extractor = copy.copy(features.extractor)
        extractor.setOrientation(Orientation.KEYPOINT)
        _, *rows, matches = matchRotated(self.images[0], self.images[1], extractor, HierarchicalMatcher.createRecommended(), -1,
                                                self._rows[0], self._rows[1])
        found = self.measured(rows, [extractor.compute(image, some)[1] for image, some in zip(self.images, rows)], matches[:, :2])
        return found if found.found else otherwise

    def _visible(self, *points: np.ndarray) -> np.ndarray:
        """Which matches the cameras can see: a lens shows nothing beyond its range."""
        seen = np.ones(len(points[0]), bool)
        for some, lens in zip(points, self.lenses):
            seen &= np.isfinite(lens.undistorted(some)).all(axis=1)
        return seen

    def _propagated(self, rows: Sequence[np.ndarray], given: np.ndarray) -> tuple[PropagatedMatches, int]:
        """What cameras see of what matches lead to, in the files' pixels, and how many of them were given."""
        found = propagateMatches(self._prepared[0], rows[0], self._prepared[1], rows[1], given)
        found = found._replace(points1=self._turns[0].points(found.points1), points2=self._turns[1].points(found.points2),
                               covariances=self._turns[1].covariances(found.covariances))
        seen = self._visible(*found[1:3])
        return PropagatedMatches(*(each[seen] for each in found)), int(seen[:len(given)].sum())

    def _pose(self, *points: np.ndarray, scale: float = 0) -> RelativePose:
        a, b = (lens.undistorted(some) for some, lens in zip(points, self.lenses))
        return findRelativePose(a, b, self.lenses[0].matrix, self.lenses[1].matrix, scale)
