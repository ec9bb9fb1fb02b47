"""Keypoints and codes of one image."""
from __future__ import annotations

import dataclasses
import threading
from typing import Any

import numpy as np

from opencv_iib.descriptor import IIBDescriptorExtractor
from opencv_iib.detectors import HessianDetector
from opencv_iib.enums import Preset
from opencv_iib.keypoints import keypoints_to_array

DETECTORS = ('HESSIAN', 'AKAZE', 'BRISK', 'FAST', 'KAZE', 'ORB', 'SIFT')


def preset_names() -> dict[str, int]:
    """The presets of IIBDescriptorExtractor, without their prefix, and DEFAULT, the paper's."""
    return {'DEFAULT': -1, **Preset.__members__}


@dataclasses.dataclass(frozen=True)
class FeatureOptions:
    """What to find and how to describe it; by default the recommended chain, with more points."""

    detector: str = 'HESSIAN'  #: one of DETECTORS: HessianDetector, or one of cv2
    points: int = 4000  #: at most so many keypoints an image, those of the strongest response
    preset: str = 'UNIVERSAL'  #: one of preset_names()
    orientation: bool = False  #: turn the regions by the keypoints' angles

    def check(self) -> None:
        """:raises ValueError: naming what is wrong, and what there is."""
        if self.detector not in DETECTORS:
            raise ValueError(f'no detector {self.detector}: there are {", ".join(DETECTORS)}')
        if self.preset not in preset_names():
            raise ValueError(f'no preset {self.preset}: there are {", ".join(preset_names())}')
        if not 1 <= self.points:
            raise ValueError(f'points is {self.points}: it has to be at least 1')


def _make_detector(name: str, points: int) -> Any:
    if name == 'HESSIAN':
        return HessianDetector(points)
    import cv2
    if name in ('ORB', 'SIFT'):
        return getattr(cv2, name + '_create')(points)
    create = getattr(cv2, name + '_create', None) or getattr(getattr(cv2, name, None), 'create', None)
    if create is None:
        create = getattr(getattr(cv2, 'xfeatures2d', None), name + '_create', None)
    if create is None:
        raise ValueError(f'this cv2, {cv2.__version__}, has no {name}: take another detector, or opencv-contrib')
    return create(20) if name == 'FAST' else create()


class Features:
    """Detects and describes; one object serves all threads, each with a detector of its own."""

    def __init__(self, options: FeatureOptions) -> None:
        options.check()
        self.options = options
        preset = preset_names()[options.preset]
        self.scale_factor = IIBDescriptorExtractor.scaleFactorFor(options.detector)
        self.extractor = (IIBDescriptorExtractor.create(self.scale_factor) if preset < 0 else
                          IIBDescriptorExtractor.createPreset(preset, self.scale_factor))
        if options.orientation:
            self.extractor.setUseOrientation(True)
        self._local = threading.local()

    def __call__(self, image: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """:return: N x 7 float32 keypoints (see keypoints_to_array), strongest first, and N x bytes codes."""
        if not hasattr(self._local, 'detector'):
            self._local.detector = _make_detector(self.options.detector, self.options.points)
        found = sorted(self._local.detector.detect(image), key=lambda keypoint: -keypoint.response)[:self.options.points]
        return self.extractor.compute(image, keypoints_to_array(found))

    def level_sizes(self) -> tuple[int, ...]:
        """Bytes of each level of the codes, coarse first."""
        return self.extractor.levelSizes()


def to_colmap(rows: np.ndarray) -> np.ndarray:
    """N x 7 of OpenCV to COLMAP's N x 4 float32: x, y, scale, angle.

    OpenCV's centre of the first pixel is 0, COLMAP's .5; a diameter becomes a radius, degrees radians (upright: 0).
    """
    angles = np.where(rows[:, 3] < 0, 0, np.deg2rad(rows[:, 3]))
    return np.stack([rows[:, 0] + .5, rows[:, 1] + .5, rows[:, 2] / 2, angles], axis=1).astype(np.float32)
