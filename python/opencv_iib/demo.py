"""Matches two images by IIB and, for comparison, by SIFT and ORB or by the detector's own descriptor, and draws both."""
from __future__ import annotations

from typing import NamedTuple, Optional, Sequence

import numpy as np

from opencv_iib._arguments import Path
from opencv_iib._drawing import GOOD, INK, OTHER, Caption, draw
from opencv_iib._images import import_cv2, write_picture
from opencv_iib.features import FeatureOptions, detect, make_detector
from opencv_iib.functions import match
from opencv_iib.keypoints import keypoints_to_array
from opencv_iib.measure import View, read_pair
from opencv_iib.views import match_stored, rotation_and_scale, similarity

MAX_ERROR = 3  # pixels from the homography, in the second image
MIN_CONSISTENT = 10  # up to 6 random matches agree with a homography


class Result(NamedTuple):
    """Matches of one descriptor."""

    name: str
    points_a: np.ndarray  #: M x 2, pixels
    points_b: np.ndarray  #: M x 2
    good: np.ndarray  #: M: whether each match agrees with the homography; False if none was found

    @property
    def view(self) -> tuple[float, float]:
        """Rotation of the second image in degrees, and its scale; 0 and 1 if the images match as they are."""
        return rotation_and_scale(similarity(self.points_a[self.good], self.points_b[self.good]))

    def __str__(self) -> str:
        if self.good.any():
            seen = f', scale {self.view[1]:.2f}, rotated by {round(self.view[0]) % 360} degrees' if self.name == 'IIB' and self.view != (0, 1) else ''
            return f'{self.name} {self.good.sum()} of {len(self.good)} consistent{seen}'
        return f'{self.name}: no homography found in {len(self.good)} matches'


def demo(image_a: Path, image_b: Path, out: Path, options: FeatureOptions = FeatureOptions(points=1000)) -> list[Result]:
    """Matches two images by the recommended chain, and by SIFT and ORB or the detector's own descriptor. Draws all, IIB below.

    *Consistent* matches lie within 3 pixels of the best homography, which at least ten must do.

    :param out: picture to write.
    :return: results, IIB's first.
    :raises ValueError: for a file that is no image, or cannot be written.
    :raises FileExistsError: if the picture to write is an image.
    :raises FileNotFoundError: for a missing image."""
    options.check()
    views, _ = read_pair((image_a, image_b), None, out, options)
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
    """:param upright: describe keypoints without rotation, as the recommended chain does."""
    cv2 = import_cv2()
    detector = make_detector(name, points)
    if not detector.descriptorSize():
        return None
    rows, codes = [], []
    for view in views:
        found = detect(detector, view.image, view.mask)
        if len(found) > points:  # else keep the order, which decides between equal distances
            found = sorted(found, key=lambda keypoint: -keypoint.response)[:points]
        for keypoint in found if upright else ():
            keypoint.angle = 0
        found, described = detector.compute(view.image, found) if found else ((), None)  # SIFT describes no point of small images
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
