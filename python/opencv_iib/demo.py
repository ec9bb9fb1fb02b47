"""Two images matched by IIB and, beside it, by SIFT and ORB or the detector's own descriptor: a picture and a line, as scripts/demo.sh's."""
from __future__ import annotations

import os
from typing import Any, NamedTuple, Optional, Sequence

import numpy as np

from opencv_iib._arguments import InvalidOption, Path
from opencv_iib._files import check_images, check_outputs
from opencv_iib._upright import Turn, upright
from opencv_iib._images import Masks, check_picture, import_cv2, read_with_orientation, write_picture
from opencv_iib.features import FeatureOptions, Features, make_detector
from opencv_iib.functions import match
from opencv_iib.keypoints import keypoints_to_array
from opencv_iib.views import match_stored, rotation_and_scale, similarity

MAX_ERROR = 3  # pixels from the homography, in the second image
MIN_CONSISTENT = 10  # a homography agrees with up to 6 of matches drawn at random
HALF_WIDTH, MAX_HEIGHT, MAX_DRAWN, CAPTION_HEIGHT = 640, 1280, 100, 44  # of the picture, in pixels; lines, since more would hide the images
GOOD, OTHER, PAPER, INK = (150, 220, 60), (40, 90, 255), (32, 28, 26), (235, 235, 235)  # distinct for colour-blind eyes too


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
    names, masked = [os.path.basename(os.fspath(path)) for path in (image_a, image_b)], Masks(options.mask)
    check_outputs([out], (image_a, image_b, *masked.check(names)))
    check_picture(out)
    images, orientations = zip(*(read_with_orientation(path, options.exif) for path in (image_a, image_b)))
    try:
        masks = list(map(masked.of, names, images))
    except ValueError as e:
        raise InvalidOption(str(e)) from None
    described = list(map(Features(options), images, orientations, masks))
    results = [_result('IIB', [rows for rows, _ in described], match(described[0][1], described[1][1]).pairs)]
    if options.detector == 'HESSIAN' and (not results[0].good.any() or results[0].view != (0, 1)):
        stored = [upright(image, orientation) for image, orientation in zip(images, orientations)]
        turns = [Turn(orientation, *image.shape[1::-1]) for image, orientation in zip(images, orientations)]
        seen = match_stored(stored, turns, [None if mask is None else upright(mask, way) for mask, way in zip(masks, orientations)], options.points)
        of_views = _judged('IIB', seen.points1, seen.points2)
        results[0] = max(of_views, results[0], key=lambda result: int(result.good.sum()))
    for name in ('SIFT', 'ORB') if options.detector == 'HESSIAN' else (options.detector,):
        other = _own_descriptor(name, images, masks, options.points)
        if other is not None:
            results.append(other)
    write_picture(out, np.vstack([draw(images, result.points_a, result.points_b, result.good, _caption(result))
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


def _own_descriptor(name: str, images: Sequence[np.ndarray], masks: Sequence[Optional[np.ndarray]], points: int) -> Optional[Result]:
    cv2 = import_cv2()
    detector = make_detector(name, points)
    if not detector.descriptorSize():
        return None
    rows, codes = [], []
    for image, mask in zip(images, masks):
        found = detector.detect(image, mask)
        if len(found) > points:  # else in its order, by which equal distances are told apart
            found = sorted(found, key=lambda keypoint: -keypoint.response)[:points]
        found, described = detector.compute(image, found)
        rows.append(keypoints_to_array(found))
        codes.append(np.zeros((0, detector.descriptorSize()), np.uint8) if described is None else described)
    if not all(map(len, codes)):
        return _result(name, rows, np.empty((0, 2), int))
    if codes[0].dtype == np.uint8:
        return _result(name, rows, match(codes[0], codes[1]).pairs)
    nearest = cv2.BFMatcher(detector.defaultNorm(), crossCheck=True).match(*codes)
    return _result(name, rows, np.array([(m.queryIdx, m.trainIdx) for m in nearest]).reshape(-1, 2))


Caption = list[tuple[str, tuple[int, int, int]]]  # texts and their colours


def _caption(result: Result) -> Caption:
    count, good, name = len(result.good), result.good.sum(), (f'{result.name}:  ', INK)
    if not good:
        return [name, (f'{count} matches, no homography found', OTHER)]
    return [name, (f'{good} consistent', GOOD), (f'  {count - good} others', OTHER), (f'  {100 * good / count:.0f} %', INK)]


def draw(images: Sequence[np.ndarray], points_a: np.ndarray, points_b: np.ndarray, good: np.ndarray, caption: Caption) -> np.ndarray:
    """Both images side by side under a caption, a line for each match; good ones lie above the others."""
    cv2 = import_cv2()
    scales = [min(HALF_WIDTH / image.shape[1], MAX_HEIGHT / image.shape[0]) for image in images]
    halves = [cv2.resize(image, [max(1, round(side * scale)) for side in image.shape[1::-1]], interpolation=cv2.INTER_AREA)
              for image, scale in zip(images, scales)]
    canvas: Any = np.full((CAPTION_HEIGHT + max(map(len, halves)), 2 * HALF_WIDTH, 3), PAPER, np.uint8)
    for side, half in enumerate(halves):
        canvas[CAPTION_HEIGHT:CAPTION_HEIGHT + len(half), side * HALF_WIDTH:side * HALF_WIDTH + half.shape[1]] = half
    drawn = np.linspace(0, len(good), min(len(good), MAX_DRAWN), endpoint=False).astype(int)  # a fair choice: strongest first
    ends = [np.rint(points * scale + (side * HALF_WIDTH, CAPTION_HEIGHT)).astype(int)
            for side, (points, scale) in enumerate(zip((points_a, points_b), scales))]
    for colour, opacity, wanted in ((OTHER, .6, False), (GOOD, .8, True)):
        lines = canvas.copy()
        for k in drawn[good[drawn] == wanted]:
            a, b = (tuple(map(int, end[k])) for end in ends)
            cv2.line(lines, a, b, colour, 1, cv2.LINE_AA)
            cv2.circle(canvas, a, 2, colour, cv2.FILLED, cv2.LINE_AA)
            cv2.circle(canvas, b, 2, colour, cv2.FILLED, cv2.LINE_AA)
        canvas = cv2.addWeighted(lines, opacity, canvas, 1 - opacity, 0)  # so that the images are seen
    at = 14
    for text, colour in caption:
        cv2.putText(canvas, text, (at, CAPTION_HEIGHT - 15), cv2.FONT_HERSHEY_DUPLEX, .68, colour, 1, cv2.LINE_AA)
        at += cv2.getTextSize(text, cv2.FONT_HERSHEY_DUPLEX, .68, 1)[0][0]
    return canvas
