"""Detectors of Python, such as those of a foreign cv2, behind the classes of this package; the package's own."""
from __future__ import annotations

import weakref
from typing import Any, Callable, Optional

import numpy as np
from numpy.typing import ArrayLike, NDArray

from opencv_iib import _core
from opencv_iib._arguments import integer, number
from opencv_iib._arrays import are_images, as_image, as_matrix, with_images
from opencv_iib._core_object import CoreObject
from opencv_iib.keypoints import array_to_keypoints, as_rows


def detector_name(detector: Any) -> str:
    """Its getDefaultName(), or its class's name."""
    name = getattr(detector, 'getDefaultName', None)
    return str(name()) if callable(name) else type(detector).__name__


def _number(detector: Any, method: str) -> int:
    call = getattr(detector, method, None)
    return int(call()) if callable(call) else 0


def core_detector(detector: Any) -> _core.Detector:
    """What the extension calls: the object inside one of this package, or one that calls ``detector.detect``."""
    core = getattr(detector, '_core', None)
    if isinstance(core, _core.Detector):
        return core
    if isinstance(detector, (str, type)):
        name = detector if isinstance(detector, str) else detector.__name__
        raise TypeError(f'a detector is needed, not the name of one or a class: pass an object, such as cv2.{name}_create()')
    if not callable(getattr(detector, 'detect', None)):
        raise TypeError(f'a detector has a method detect(image, mask), and {type(detector).__name__} has none')
    # The object that detects keeps it alive; the garbage collector could not see a reference from within the extension.
    try:
        kept: Callable[[], Any] = weakref.ref(detector)
    except TypeError:  # those of cv2
        def kept() -> Any:
            return detector

    def found(image: np.ndarray, mask: Optional[np.ndarray]) -> np.ndarray:
        return as_rows(kept().detect(image, mask))

    return _core.Detector.foreign(found, detector_name(detector).rsplit('.', 1)[-1])


def detect_rows(owner: Any, image: ArrayLike, mask: Optional[ArrayLike]) -> NDArray[np.float32]:
    """Keypoints of a detector or extractor of this package as N x 7, see keypoints_to_array."""
    allowed = np.empty((0, 0), np.uint8) if mask is None else as_matrix(mask, 'the mask')
    return owner._core.detect(as_image(image), allowed)


class Detector(CoreObject):
    """What finds keypoints: the base of the detectors and of the descriptor of this package."""

    _detector: Any = None  #: what its user gave it

    def detect(self, image: ArrayLike, mask: Optional[ArrayLike] = None) -> tuple[Any, ...]:
        """Keypoints, as cv2.KeyPoint if cv2 is there; of a list of images, such a tuple for each.

        :param mask: H x W uint8, 0 where nothing is to be found; a list with a list of images.
        """
        if are_images(image):
            given: Any = image
            masks: Any = [None] * len(given) if mask is None else mask
            return tuple(self.detect(*each) for each in with_images(given, masks, 'masks'))
        return array_to_keypoints(detect_rows(self, image, mask))

    def descriptorSize(self) -> int:
        """Bytes of a descriptor; 0 of a detector that describes nothing."""
        return self._core.descriptorSize()

    def empty(self) -> bool:
        """False: it is always ready."""
        return self._core.empty()

    def getDefaultName(self) -> str:
        """The name of its parameters in files, such as Feature2D.IIB."""
        return self._core.getDefaultName()


class MissingDetector:
    """Stands for a detector that could not be pickled with the object that used it."""

    def __init__(self, name: str) -> None:
        self.name = name

    def getDefaultName(self) -> str:
        """The name of the one that is missing."""
        return self.name

    def detect(self, image: ArrayLike, mask: Optional[ArrayLike] = None) -> Any:
        """Raises: there is none."""
        raise RuntimeError(f'the detector {self.name} was not pickled with the object that used it: set it again')


def for_pickle(detector: Any) -> Any:
    """What a pickle holds: detectors of this package. One of cv2 cannot be pickled, and describing needs none."""
    return detector if detector is None or hasattr(detector, '_core') else MissingDetector(detector_name(detector))


class HessianDetector(Detector):
    """Finds blobs of the locally normalized image: maxima over place and scale of the determinant of its Hessian.

    Names, keywords and keypoints are those of ``cv2.iib``. ``IIB.createRecommended()`` puts it together with the
    descriptor for it. Images are as IIBDescriptorExtractor takes them. Keypoints come strongest first; their size is twice
    the sigma of the blob in pixels, their angle -1.
    """

    def __init__(self, maxFeatures: int = 1000, threshold: float = 0.0, scales: int = 5, sigma: float = 2.2,
                 normalizationSigma: float = 5.0, workingSize: int = 1024) -> None:
        """Creates a detector.

        :param maxFeatures: the strongest that are kept; 0 keeps all.
        :param threshold: smallest response, 0 or more.
        :param scales: number of scales, 1 to 8, each sqrt(2) times the one before.
        :param sigma: of the smallest scale in pixels of the (reduced) image, 1.5 to 8.
        :param normalizationSigma: of the local normalization's Gaussian in pixels of the (reduced) image, 2 to 256.
        :param workingSize: of images, pixels of the longer side, 64 or more; larger ones are reduced by a whole factor
            before points are found, which are in the image's own pixels all the same. 0 never reduces.
        """
        self._core = _core.HessianDetector.create(
            integer(maxFeatures, 'maxFeatures'), number(threshold, 'threshold'), integer(scales, 'scales'),
            number(sigma, 'sigma'), number(normalizationSigma, 'normalizationSigma'),
            integer(workingSize, 'workingSize'))

    @classmethod
    def create(cls, maxFeatures: int = 1000, threshold: float = 0.0, scales: int = 5, sigma: float = 2.2,
               normalizationSigma: float = 5.0, workingSize: int = 1024) -> HessianDetector:
        """Creates a detector, as the class itself does."""
        return cls(maxFeatures, threshold, scales, sigma, normalizationSigma, workingSize)

    def setMaxFeatures(self, maxFeatures: int) -> None:
        """The strongest that are kept; 0 keeps all."""
        self._core.maxFeatures = integer(maxFeatures, 'maxFeatures')

    def getMaxFeatures(self) -> int:
        """See setMaxFeatures."""
        return self._core.maxFeatures

    def setThreshold(self, threshold: float) -> None:
        """Smallest response, 0 or more."""
        self._core.threshold = number(threshold, 'threshold')

    def getThreshold(self) -> float:
        """See setThreshold."""
        return self._core.threshold

    def setScales(self, scales: int) -> None:
        """Number of scales, 1 to 8, each sqrt(2) times the one before."""
        self._core.scales = integer(scales, 'scales')

    def getScales(self) -> int:
        """See setScales."""
        return self._core.scales

    def setSigma(self, sigma: float) -> None:
        """Of the smallest scale in pixels, 1.5 to 8."""
        self._core.sigma = number(sigma, 'sigma')

    def getSigma(self) -> float:
        """See setSigma."""
        return self._core.sigma

    def setNormalizationSigma(self, normalizationSigma: float) -> None:
        """Of the local normalization's Gaussian in pixels, 2 to 256."""
        self._core.normalizationSigma = number(normalizationSigma, 'normalizationSigma')

    def getNormalizationSigma(self) -> float:
        """See setNormalizationSigma."""
        return self._core.normalizationSigma

    def setWorkingSize(self, workingSize: int) -> None:
        """Of images, pixels of the longer side, 64 or more; larger ones are reduced. 0 never reduces."""
        self._core.workingSize = integer(workingSize, 'workingSize')

    def getWorkingSize(self) -> int:
        """See setWorkingSize."""
        return self._core.workingSize

    def _parameters(self) -> tuple[Any, ...]:
        return (self.getMaxFeatures(), self.getThreshold(), self.getScales(), self.getSigma(),
                self.getNormalizationSigma(), self.getWorkingSize())

    def _restored(self, parameters: tuple[Any, ...]) -> Any:
        return _core.HessianDetector.create(*parameters)

    def __repr__(self) -> str:
        return f'{type(self).__name__}(maxFeatures={self.getMaxFeatures()}, sigma={self.getSigma():g})'


class NormalizedDetector(Detector):
    """Finds the keypoints of another detector on the locally normalized image, where light changes them less.

    Names, keywords and keypoints are those of ``cv2.iib``. Descriptors are best computed on the plain image:
    ``IIB.createFor(NormalizedDetector(cv2.ORB_create()))`` does so. Images are as IIBDescriptorExtractor takes them.
    """

    def __init__(self, detector: Any, sigma: float = 4.0) -> None:
        """Wraps a detector.

        :param detector: of any cv2, or any object with ``detect(image, mask)``.
        :param sigma: of the Gaussian filter in pixels, 1 to 256.
        """
        self._core = _core.NormalizedDetector.create(core_detector(detector), number(sigma, 'sigma'))
        self._detector = detector

    @classmethod
    def create(cls, detector: Any, sigma: float = 4.0) -> NormalizedDetector:
        """Wraps a detector, as the class itself does."""
        return cls(detector, sigma)

    def compute(self, image: Any, keypoints: Any) -> Any:
        """The descriptors of the detector inside, on the plain image: what its own ``compute`` gives."""
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

    def setSigma(self, sigma: float) -> None:
        """Of the Gaussian filter in pixels, 1 to 256."""
        self._core.sigma = number(sigma, 'sigma')

    def getSigma(self) -> float:
        """See setSigma."""
        return self._core.sigma

    def descriptorSize(self) -> int:
        """Of the detector inside; 0 if it describes nothing."""
        return _number(self._detector, 'descriptorSize')

    def descriptorType(self) -> int:
        """Of the detector inside."""
        return _number(self._detector, 'descriptorType')

    def defaultNorm(self) -> int:
        """Of the detector inside."""
        return _number(self._detector, 'defaultNorm')

    def __getstate__(self) -> dict[str, Any]:
        return {**super().__getstate__(), '_detector': for_pickle(self._detector)}

    def _parameters(self) -> float:
        return self.getSigma()

    def _restored(self, parameters: float) -> Any:
        return _core.NormalizedDetector.create(core_detector(self._detector), parameters)

    def __repr__(self) -> str:
        return f'{type(self).__name__}({detector_name(self._detector)}, sigma={self.getSigma():g})'
