"""Detectors of Python, such as those of a foreign cv2, behind an extractor of this package."""
from __future__ import annotations

from typing import Any, Optional

import numpy as np

from opencv_iib import _core
from opencv_iib.keypoints import Keypoints, as_rows


def detector_name(detector: Any) -> str:
    """What :meth:`IIBDescriptorExtractor.scaleFactorFor` knows it by: its getDefaultName(), or its class's name."""
    if isinstance(detector, str):
        return detector
    name = getattr(detector, 'getDefaultName', None)
    return str(name()) if callable(name) else type(detector).__name__


def connect(extractor: _core.Extractor, detector: Any) -> None:
    """Makes `extractor` ask `detector` for keypoints."""
    if not callable(getattr(detector, 'detect', None)):
        raise TypeError(f'a detector has a method detect(image, mask), and {type(detector).__name__} has none')

    def detect(image: np.ndarray, mask: Optional[np.ndarray]) -> np.ndarray:
        found: Keypoints = detector.detect(image, mask)
        return np.ascontiguousarray(as_rows(found))

    extractor.setDetector(detect, detector_name(detector).rsplit('.', 1)[-1])


class MissingDetector:
    """Stands for a detector that could not be pickled with its extractor."""

    def __init__(self, name: str) -> None:
        self.name = name

    def getDefaultName(self) -> str:
        return self.name

    def detect(self, image: Any, mask: Any = None) -> Any:
        raise RuntimeError(f'the detector {self.name} was not pickled with its extractor: call setDetector() again')
