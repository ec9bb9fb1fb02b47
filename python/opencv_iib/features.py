"""Keypoints and codes of an image."""
from __future__ import annotations

import dataclasses
from typing import Any, Optional, Sequence

import numpy as np

from opencv_iib._arguments import InvalidOption, Path, check_choice, check_count, integer
from opencv_iib._images import import_cv2, reduced, resized_mask
from opencv_iib._orientation import Turn, upright
from opencv_iib.descriptor import IIBDescriptorExtractor
from opencv_iib.detectors import HessianDetector
from opencv_iib.enums import Orientation, Preset
from opencv_iib.keypoints import keypoints_to_array

DETECTORS = ('HESSIAN', 'AKAZE', 'BRISK', 'FAST', 'KAZE', 'ORB', 'SIFT')
WITHOUT_ANGLES = ('HESSIAN', 'FAST')
MIN_SIZE = 32  # pixels


def preset_names() -> dict[str, int]:
    """Numbers of the presets, and of DEFAULT, the paper's descriptor."""
    return {'DEFAULT': -1, **Preset.__members__}


@dataclasses.dataclass(frozen=True)
class FeatureOptions:
    """How images are described; by default by the recommended chain, with more points."""

    detector: str = 'HESSIAN'  #: one of DETECTORS: HessianDetector, or one of cv2
    points: int = 4000  #: at most so many keypoints an image, those of the strongest response
    preset: str = 'UNIVERSAL'  #: one of preset_names()
    orientation: bool = False  #: rotate regions by the keypoints' angles, or by gradients for detectors without angles
    max_size: int = 0  #: pixels of the longer side to which larger images are reduced; 0: they are not
    exif: bool = True  #: rotate images upright by their EXIF data; points stay in the stored pixels
    mask: Optional[Path] = None  #: a mask, or a folder of masks that have the name of the image and .png, such as a.jpg.png

    def __post_init__(self) -> None:
        for field in ('detector', 'preset'):  # in any case, and members of Preset
            name = getattr(self, field)
            object.__setattr__(self, field, getattr(name, 'name', str(name)).upper())

    def check(self) -> None:
        """:raises InvalidOption: for the first wrong one, with the known ones."""
        check_choice(self.detector, 'detector', DETECTORS)
        check_choice(self.preset, 'preset', preset_names())
        check_count(self.points, 'points')
        check_max_size(self.max_size)


def make_detector(name: str, points: int) -> Any:
    """One of DETECTORS, limited to this number of keypoints if it has a limit."""
    if name == 'HESSIAN':
        return HessianDetector(points)
    import cv2
    function = ('FastFeatureDetector' if name == 'FAST' else name) + '_create'
    create = getattr(cv2, function, None) or getattr(getattr(cv2, 'xfeatures2d', None), function, None)
    if create is None:
        raise InvalidOption(f'cv2 {cv2.__version__} has no {name}: take another detector, or OpenCV 4 or opencv_contrib')
    return create(points) if name in ('ORB', 'SIFT') else create()


def detect(detector: Any, image: np.ndarray, mask: Optional[np.ndarray]) -> Sequence[Any]:
    """Keypoints; none where cv2 raises since the image is too small for its detector."""
    try:
        return list(detector.detect(image, mask))
    except import_cv2().error:
        if min(image.shape[:2]) >= MIN_SIZE:
            raise
        return []


def check_max_size(max_size: int) -> None:
    """:raises InvalidOption: below MIN_SIZE, except for 0."""
    if integer(max_size, 'max_size', 64) and not MIN_SIZE <= max_size:
        raise InvalidOption(f'max_size is {max_size}: it must be at least {MIN_SIZE} pixels, or 0')


class Features:
    """Detects and describes. Threads may share it."""

    def __init__(self, options: FeatureOptions) -> None:
        options.check()
        self.options = options
        preset = preset_names()[options.preset]
        self.scale_factor = IIBDescriptorExtractor.scaleFactorFor(options.detector)
        self.extractor = (IIBDescriptorExtractor.create(self.scale_factor) if preset < 0 else
                          IIBDescriptorExtractor.createPreset(preset, self.scale_factor))
        if options.orientation:
            gradient = options.detector in WITHOUT_ANGLES
            self.extractor.setOrientation(Orientation.GRADIENT if gradient else Orientation.KEYPOINT)
        make_detector(options.detector, options.points)  # raises here, not at the first image

    def __call__(self, image: np.ndarray, orientation: int = 1, mask: Optional[np.ndarray] = None) -> tuple[np.ndarray, np.ndarray]:
        """:param orientation: EXIF's, of the image and the mask.
        :return: N x 7 float32 keypoints (see keypoints_to_array), strongest first, and N x bytes codes."""
        turn, image = Turn(orientation, *image.shape[1::-1]), upright(image, orientation)
        detector = make_detector(self.options.detector, self.options.points)  # cv2's are not for several threads
        small = reduced(image, self.options.max_size)
        allowed = mask if mask is None else resized_mask(upright(mask, orientation), small)
        found = sorted(detect(detector, small, allowed), key=lambda keypoint: -keypoint.response)[:self.options.points]
        rows, codes = self.extractor.compute(small, keypoints_to_array(found))
        if small is not image:
            scale = np.array(image.shape[1::-1]) / small.shape[1::-1]
            rows[:, :2] = (rows[:, :2] + .5) * scale - .5  # the centre of the first pixel is 0
            rows[:, 2] *= scale.max()
        return turn.keypoints(rows), codes

    def level_sizes(self) -> tuple[int, ...]:
        """Bytes of each level of the codes, coarse first."""
        return self.extractor.levelSizes()


def to_colmap(rows: np.ndarray) -> np.ndarray:
    """Converts N x 7 of OpenCV to COLMAP's N x 4 float32: x, y (the centre of the first pixel is .5), radius, angle in radians."""
    angles = np.where(rows[:, 3] < 0, 0, np.deg2rad(rows[:, 3]))
    return np.stack([rows[:, 0] + .5, rows[:, 1] + .5, rows[:, 2] / 2, angles], axis=1).astype(np.float32)
