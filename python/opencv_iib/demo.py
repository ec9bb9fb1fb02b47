"""Two images matched by IIB and, beside it, by SIFT and ORB or the detector's own descriptor: a picture and a line, as scripts/demo.sh's."""
from __future__ import annotations

import os
from typing import NamedTuple, Optional, Sequence

import numpy as np

from opencv_iib._arguments import Path
from opencv_iib._drawing import GOOD, INK, OTHER, Caption, draw
from opencv_iib._files import check_images, check_outputs
from opencv_iib._image_file import Masks
from opencv_iib._images import check_picture, import_cv2, write_picture
from opencv_iib.features import FeatureOptions, Features, make_detector
from opencv_iib.functions import match
from opencv_iib.keypoints import keypoints_to_array
from opencv_iib.measure import View
from opencv_iib.views import match_stored, rotation_and_scale, similarity

MAX_ERROR = 3  # pixels from the homography, in the second image
MIN_CONSISTENT = 10  # a homography agrees with up to 6 of matches drawn at random


class Result(NamedTuple):
    """Matches of one descriptor."""

    name: str
    points_a: np.ndarray  #: M x 2, pixels
    points_b: np.ndarray  #: M x 2
    good: np.ndarray  #: M: whether it agrees with the homography; none does where no homography was found

    @property
    def view(self) -> tuple[float, float]:
        """Rotation of the second image, degrees, and its scale; 0 and 1 where it is matched as it is."""
        return rotation_and_scale(similarity(self.points_a[self.good], self.points_b[self.good]))

    def __str__(self) -> str:
        if self.good.any():
            seen = f', scale {self.view[1]:.2f}, rotated by {round(self.view[0]) % 360} degrees' if self.name == 'IIB' and self.view != (0, 1) else ''
            return f'{self.name} {self.good.sum()} of {len(self.good)} consistent{seen}'
        return f'{self.name}: no homography found in {len(self.good)} matches'


def demo(image_a: Path, image_b: Path, out: Path, options: FeatureOptions = FeatureOptions(points=1000)) -> list[Result]:
    """Matches two images by the recommended chain, and by SIFT and ORB or what the detector has; draws all, IIB below.

    *Consistent* are matches within 3 pixels of the homography that most agree with, if those are ten.

    :param out: picture to write.
    :return: of IIB first.
    :raises ValueError: for a file that is no image, or one that cannot be written.
    :raises FileExistsError: for an image as the picture to write.
    :raises FileNotFoundError: for an image that is not there.
    """
    options.check()
    check_images(image_a, image_b)
    masks, features, paths = Masks(options.mask), Features(options), [os.fspath(path) for path in (image_a, image_b)]
    check_outputs([out], (*paths, *masks.check(list(map(os.path.basename, paths)))))
    check_picture(out)
    views = [View.of(path, masks, features, None, os.path.basename(path)) for path in paths]
    results = [_result('IIB', [view.turn.keypoints(view.rows) for view in views], match(views[0].codes, views[1].codes).pairs)]
    if options.detector == 'HESSIAN' and (not results[0].good.any() or results[0].view != (0, 1)):
        images, turns, allowed = zip(*((view.image, view.turn, view.mask) for view in views))
        seen = match_stored(images, turns, allowed, options.points)
        results[0] = max(_judged('IIB', seen.points1, seen.points2), results[0], key=lambda result: int(result.good.sum()))
    for name in ('SIFT', 'ORB') if options.detector == 'HESSIAN' else (options.detector,):
        other = _own_descriptor(name, views, options.points, results[0].view == (0, 1))
        if other is not None:
            results.append(other)
    write_picture(out, np.vstack([draw([view.stored for view in views], result.points_a, result.points_b, result.good, _caption(result))
                                  for result in reversed(results)]))
    return results


def _result(name: str, rows: list[np.ndarray], pairs: np.ndarray) -> Result:
    return _judged(name, *(each[pairs[:, side], :2] for side, each in enumerate(rows)))


def _judged(name: str, a: np.ndarray, b: np.ndarray) -> Result:
    cv2 = import_cv2()
    good = np.zeros(len(a), bool)
    matrix = cv2.findHomography(a, b, cv2.USAC_MAGSAC, MAX_ERROR)[0] if len(a) >= 4 else None
    if matrix is not None:
        good = np.linalg.norm(cv2.perspectiveTransform(a[:, None].astype(float), matrix)[:, 0] - b, axis=1) <= MAX_ERROR
    return Result(name, a, b, good if good.sum() >= MIN_CONSISTENT else np.zeros_like(good))


def _own_descriptor(name: str, views: Sequence[View], points: int, upright: bool) -> Optional[Result]:
    """:param upright: whether keypoints are described so, as the recommended chain's are, since no image is rotated."""
    cv2 = import_cv2()
    detector = make_detector(name, points)
    if not detector.descriptorSize():
        return None
    rows, codes = [], []
    for view in views:
        found = detector.detect(view.image, view.mask)
        if len(found) > points:  # else in its order, by which equal distances are told apart
            found = sorted(found, key=lambda keypoint: -keypoint.response)[:points]
        for keypoint in found if upright else ():
            keypoint.angle = 0
        found, described = detector.compute(view.image, found)
        rows.append(view.turn.keypoints(keypoints_to_array(found)))
        codes.append(np.zeros((0, detector.descriptorSize()), np.uint8) if described is None else described)
    if not all(map(len, codes)):
        return _result(name, rows, np.empty((0, 2), int))
    if codes[0].dtype == np.uint8:
        return _result(name, rows, match(codes[0], codes[1]).pairs)
    nearest = cv2.BFMatcher(detector.defaultNorm(), crossCheck=True).match(*codes)
    return _result(name, rows, np.array([(m.queryIdx, m.trainIdx) for m in nearest]).reshape(-1, 2))


def _caption(result: Result) -> Caption:
    count, good, name = len(result.good), result.good.sum(), (f'{result.name}:  ', INK)
    if not good:
        return [name, (f'{count} matches, no homography found', OTHER)]
    return [name, (f'{good} consistent', GOOD), (f'  {count - good} others', OTHER), (f'  {100 * good / count:.0f} %', INK)]
