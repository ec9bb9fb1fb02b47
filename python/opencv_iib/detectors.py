"""The detectors of this package, and those of Python or cv2 as the extension calls them."""
from __future__ import annotations

import weakref
from typing import Any, Callable, Optional

import numpy as np
from numpy.typing import ArrayLike, NDArray

from opencv_iib import _core
from opencv_iib._arguments import number
from opencv_iib._arrays import are_images, as_image, as_matrix, with_images
from opencv_iib._copies import MissingDetector, copied, detector_name  # pickles look for the first one here
from opencv_iib._core import Detector
from opencv_iib.keypoints import array_to_keypoints, as_rows


def _number(detector: Any, method: str) -> int:
    call = getattr(detector, method, None)
    return int(call()) if callable(call) else 0


def core_detector(detector: Any) -> Detector:
    """A detector as the extension takes it: of this package, or one that calls ``detector.detect``."""
    if isinstance(detector, Detector):
        return detector
    if isinstance(detector, (str, type)):
        name = detector if isinstance(detector, str) else detector.__name__
        raise TypeError(f'a detector is needed, not the name of one or a class: pass an object, such as cv2.{name}_create()')
    if not callable(getattr(detector, 'detect', None)):
        raise TypeError(f'a detector has a method detect(image, mask), and {type(detector).__name__} has none')
    # Weak, since the garbage collector cannot see references of the extension. The object that detects keeps the detector alive.
    try:
        kept: Callable[[], Any] = weakref.ref(detector)
    except TypeError:  # those of cv2
        def kept() -> Any:
            return detector

    def found(image: np.ndarray, mask: Optional[np.ndarray]) -> np.ndarray:
        return as_rows(kept().detect(image, mask))

    return Detector._foreign(found, detector_name(detector).rsplit('.', 1)[-1])


def detect_rows(owner: Detector, image: ArrayLike, mask: Optional[ArrayLike]) -> NDArray[np.float32]:
    """N x 7 keypoints of a detector or extractor of this package, see keypoints_to_array."""
    allowed = np.empty((0, 0), np.uint8) if mask is None else as_matrix(mask, 'the mask')
    return owner._detect(as_image(image), allowed)


def detected(owner: Detector, image: ArrayLike, mask: Optional[ArrayLike]) -> tuple[Any, ...]:
    """The method `detect` of all detectors and the extractor."""
    if are_images(image):
        given: Any = image
        masks: Any = [None] * len(given) if mask is None else mask
        return tuple(detected(owner, *each) for each in with_images(given, masks, 'masks'))
    return array_to_keypoints(detect_rows(owner, image, mask))


@copied
class HessianDetector(_core.HessianDetector):
    """Finds blobs of the locally normalized image: maxima over place and scale of the determinant of its Hessian.

    Names, keywords and keypoints are those of ``cv2.iib``. ``IIB.createRecommended()`` combines it with its descriptor. Images are as in
    IIBDescriptorExtractor. Keypoints come strongest first; their size is twice the sigma of the blob in pixels, their angle -1."""

    @classmethod
    def create(cls, maxFeatures: int = 1000, threshold: float = 0.0, scales: int = 5, sigma: float = 2.2,
               normalizationSigma: float = 5.0, workingSize: int = 1024) -> HessianDetector:
        """Creates a detector, as the class itself does."""
        return cls(maxFeatures, threshold, scales, sigma, normalizationSigma, workingSize)

    def _parameters(self) -> tuple[Any, ...]:
        return (self.getMaxFeatures(), self.getThreshold(), self.getScales(), self.getSigma(),
                self.getNormalizationSigma(), self.getWorkingSize())

    def _restored(self, parameters: tuple[Any, ...]) -> Any:
        return _core.HessianDetector(*parameters)

    def __repr__(self) -> str:
        return f'{type(self).__name__}(maxFeatures={self.getMaxFeatures()}, sigma={self.getSigma():g})'


@copied
class NormalizedDetector(_core.NormalizedDetector):
    """Finds the keypoints of another detector on the locally normalized image, where light changes them less.

    Names, keywords and keypoints are those of ``cv2.iib``. Descriptors are best computed on the plain image:
    ``IIB.createFor(NormalizedDetector(cv2.ORB_create()))`` does so. Images are as in IIBDescriptorExtractor."""

    def __init__(self, detector: Any, sigma: float = 4.0) -> None:
        """Wraps a detector.
        :param detector: of any cv2, or any object with ``detect(image, mask)``.
        :param sigma: of the Gaussian filter in pixels, 1 to 256."""
        super().__init__(core_detector(detector), number(sigma, 'sigma'))
        self._detector = detector

    @classmethod
    def create(cls, detector: Any, sigma: float = 4.0) -> NormalizedDetector:
        """Wraps a detector, as the class itself does."""
        return cls(detector, sigma)

    def compute(self, image: Any, keypoints: Any) -> Any:
        """Descriptors of the detector inside, on the plain image."""
        if not self.descriptorSize():
            raise _core.error(f'{detector_name(self._detector)} finds keypoints but does not describe them; describe '
                              'them with another object, such as IIBDescriptorExtractor.createFor')
        return self._detector.compute(image, keypoints)

    def detectAndCompute(self, image: ArrayLike, mask: Optional[ArrayLike] = None) -> Any:
        """detect, then compute."""
        return self.compute(image, self.detect(image, mask))

    def getDetector(self) -> Any:
        """The detector inside."""
        return self._detector

    def descriptorSize(self) -> int:
        """Bytes of the inner detector's descriptors; 0 if it has none."""
        return _number(self._detector, 'descriptorSize')

    def descriptorType(self) -> int:
        """The inner detector's type of descriptors."""
        return _number(self._detector, 'descriptorType')

    def defaultNorm(self) -> int:
        """The inner detector's norm."""
        return _number(self._detector, 'defaultNorm')

    def _parameters(self) -> float:
        return self.getSigma()

    def _restored(self, parameters: float) -> Any:
        return _core.NormalizedDetector(core_detector(self._detector), parameters)

    def __repr__(self) -> str:
        return f'{type(self).__name__}({detector_name(self._detector)}, sigma={self.getSigma():g})'
