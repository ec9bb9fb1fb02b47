"""IIBDescriptorExtractor: the class of cv2.iib, for arrays and for the objects of any cv2."""
from __future__ import annotations

from typing import Any, Optional, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from opencv_iib import _core
from opencv_iib._arrays import ArrayOrArrays, as_array, as_arrays, as_image
from opencv_iib._names import Method, Parameter, Path
from opencv_iib.detectors import Detector, HessianDetector, core_detector, for_pickle
from opencv_iib.enums import Border, Channel, Mapping, Orientation, Preset
from opencv_iib.keypoints import Keypoints, as_rows

K = TypeVar('K', bound=Keypoints)


class IIBDescriptorExtractor(Detector, enums=(Channel, Mapping, Border, Orientation, Preset)):
    """Illumination-insensitive binary descriptor; names, keywords and bits are those of ``cv2.iib``.

    Images are H x W, H x W x 3 (BGR) or H x W x 4 (BGRA) arrays of uint8, uint16 or float32, of any strides.
    Keypoints are a sequence of objects like cv2.KeyPoint, of any cv2 or none, or an array with a row a keypoint:
    N x 3 (x, y, size; pixels), N x 4 (and the angle in degrees, -1 for upright) or N x 7 (and response, octave,
    class_id). Descriptors are N x ``descriptorSize()`` uint8 arrays for the Hamming distance.

    One object may serve several threads as long as none changes its parameters; the GIL is released meanwhile.
    Mistakes raise :class:`opencv_iib.error`, a TypeError if an argument is no array at all.
    """

    def __init__(self, scaleFactor: float = 2.0, granularity: int = 4, channels: int = Channel.DEFAULT,
                 mapping: int = Mapping.MEAN, overlap: bool = False, useOrientation: bool = False,
                 extraChannels: int = 0) -> None:
        """Creates an extractor.

        :param scaleFactor: side of the described square in units of a keypoint's size, > 0; see scaleFactorFor.
        :param granularity: number of levels, 1 to 6.
        :param channels: a sum of CHANNEL_ values; may be 0 if there are extra channels.
        :param mapping: one of MAPPING_.
        :param overlap: slide the windows of 2 x 2 cells by one cell instead of two.
        :param useOrientation: turn the square by a keypoint's angle.
        :param extraChannels: number of maps that computeWithChannels is given, 0 to 16.
        """
        self._core = _core.Extractor.create(scaleFactor, granularity, channels, mapping, overlap, useOrientation,
                                            extraChannels)

    @classmethod
    def createPreset(cls, preset: int, scaleFactor: float = 2.0) -> IIBDescriptorExtractor:
        """Creates an extractor with a learned selection: one of PRESET_."""
        return cls._of(_core.Extractor.createPreset(preset, scaleFactor))

    @classmethod
    def createFor(cls, detector: Any, preset: int = -1) -> IIBDescriptorExtractor:
        """Creates an extractor for a detector object, of any cv2: with its scale factor, and it detects.

        :param detector: has ``detect(image, mask)``; its ``getDefaultName()`` or its class's name gives the factor.
        :param preset: one of PRESET_; -1 for the paper's default descriptor.
        """
        extractor = cls._of(_core.Extractor.createFor(core_detector(detector), preset))
        extractor._detector = detector
        return extractor

    @classmethod
    def createRecommended(cls, maxFeatures: int = 1000) -> IIBDescriptorExtractor:
        """What to take first, where light, place or both change: HessianDetector and PRESET_UNIVERSAL.

        ``detectAndCompute`` finds and describes; match with ``HierarchicalMatcher.createRecommended()``.

        :param maxFeatures: keypoints of an image, the strongest; 0 keeps all.
        """
        return cls.createFor(HessianDetector(maxFeatures), Preset.UNIVERSAL)

    @staticmethod
    def scaleFactorFor(detectorName: Any = None, detector: Any = None) -> float:
        """Scale factor for a detector's keypoints.

        :param detectorName: such as 'ORB' or 'AKAZE', any case, or a detector object.
        :param detector: a detector object, by the name that it has in ``cv2.iib``.
        """
        known = detectorName if detector is None else detector
        return _core.Extractor.scaleFactorFor(known if isinstance(known, str) else core_detector(known))

    def compute(self, image: ArrayLike, keypoints: K) -> tuple[K, NDArray[np.uint8]]:
        """Describes keypoints.

        :return: the keypoints as they were given (those left, if BORDER_DROP removed some), and N x
            descriptorSize() uint8. Without keypoints, or with an empty image, there are 0 descriptors.
        """
        return self.computeWithChannels(image, [], keypoints)

    def computeWithChannels(self, image: ArrayLike, extraChannels: ArrayOrArrays, keypoints: K) -> tuple[K, NDArray[np.uint8]]:
        """Describes keypoints with the image and with further maps of it, such as depth or labels.

        :param extraChannels: getExtraChannels() arrays, each H x W, of uint8, uint16 or float32.
        :return: as compute.
        """
        descriptors, kept = self._core.compute(as_image(image), np.ascontiguousarray(as_rows(keypoints)),
                                               as_arrays(extraChannels, 'an extra channel'))
        if kept is None:
            return keypoints, descriptors
        indices = kept.ravel()
        given: Any = keypoints
        left: Any = given[indices] if isinstance(given, np.ndarray) else [given[i] for i in indices]
        if isinstance(keypoints, tuple):
            left = tuple(left)
        return left, descriptors

    def detectAndCompute(self, image: ArrayLike, mask: Optional[ArrayLike] = None) -> tuple[tuple[Any, ...], NDArray[np.uint8]]:
        """detect, then compute."""
        return self.compute(image, self.detect(image, mask))

    def setDetector(self, detector: Any) -> None:
        """The detector behind detect: any object with ``detect(image, mask)`` that returns keypoints.

        It gets arrays of its own and may be of a foreign cv2. The scale factor stays as it is; see createFor.
        """
        self._core.setDetector(core_detector(detector))
        self._detector = detector

    def getDetector(self) -> Any:
        """What setDetector was given; None for the default, the ORB of the OpenCV inside."""
        return self._detector

    levelSizes = Method('() -> tuple[int, ...]', 'Bytes of each level, coarse first; their sum is descriptorSize().')
    descriptorType = Method('() -> int', 'CV_8U, which is 0.')
    defaultNorm = Method('() -> int', 'NORM_HAMMING, which is 6.')

    scaleFactor = Parameter(float, "Side of the described square in units of a keypoint's size, > 0.")
    granularity = Parameter(int, 'Number of levels, 1 to 6. Another one ends a selection, as other channels, mapping or overlap do.')
    channels = Parameter(Channel, 'A sum of CHANNEL_ values; may be 0 if there are extra channels.')
    mapping = Parameter(Mapping, 'One of MAPPING_.')
    overlap = Parameter(bool, 'Whether the windows of 2 x 2 cells slide by one cell instead of two.')
    useOrientation = Parameter(bool, 'True: ORIENTATION_KEYPOINT, False: ORIENTATION_NONE.')
    extraChannels = Parameter(int, 'Number of maps that computeWithChannels is given, 0 to 16.')
    border = Parameter(Border, 'One of BORDER_.')

    orientation = Parameter(Orientation, 'How the described squares are turned: one of ORIENTATION_.', 'mode')

    def setSelection(self, quads: ArrayLike) -> None:
        """Restricts the descriptor to chosen quads.

        :param quads: Q x 5 int32: level, channel, row, column, bits to keep. Empty: all quads again.
        """
        self._core.setSelection(as_array(quads, 'the selection'))

    getSelection = Method('() -> NDArray[np.int32]', 'Q x 5 int32, as setSelection takes it; 0 x 5 if there is no selection.')
    save = Method('(filename: Path) -> None', 'Writes the parameters, but not the detector, to a .yml, .xml or .json file, as '
                  'Algorithm::save does.')
    write = Method('(fileName: Path) -> None', 'Writes the parameters, but not the detector, to a .yml, .xml or .json file, '
                   'which read() and C++ read.')
    read = Method('(fileName: Path) -> None', 'Reads what write() or C++ wrote.')

    def __getstate__(self) -> dict[str, Any]:
        return {'parameters': self._core.parameters(), 'detector': for_pickle(self._detector)}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self._core = _core.Extractor.create(2.0, 4, 15, 0, False, False, 0)
        self._core.setParameters(state['parameters'])
        if state['detector'] is not None:
            self.setDetector(state['detector'])

    def __copy__(self) -> IIBDescriptorExtractor:
        twin = type(self).__new__(type(self))
        twin.__setstate__({'parameters': self._core.parameters(), 'detector': self._detector})
        return twin

    def __repr__(self) -> str:
        return f'{type(self).__name__}({self.descriptorSize()} bytes, scaleFactor={self.getScaleFactor():g})'


#: As in C++.
IIB = IIBDescriptorExtractor
