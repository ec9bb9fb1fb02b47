"""IIBDescriptorExtractor: the class of cv2.iib, for arrays and for the objects of any cv2."""
from __future__ import annotations

import gzip
import os
import warnings
import zlib
from typing import Any, Optional, Sequence, TypeVar, Union, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from opencv_iib import _core
from opencv_iib._arguments import Path, integer, number
from opencv_iib._arrays import ArrayOrArrays, Images, are_images, as_arrays, as_image, as_matrix, with_images
from opencv_iib._copies import around, copied
from opencv_iib.detectors import HessianDetector, core_detector
from opencv_iib.enums import Border, Channel, Mapping, Orientation, Preset, preset_number
from opencv_iib.keypoints import Keypoints, as_rows

K = TypeVar('K', bound=Keypoints)


@copied
class IIBDescriptorExtractor(_core.IIBDescriptorExtractor):
    """Illumination-insensitive binary descriptor; names, keywords and bits are those of ``cv2.iib``.

    Images are H x W, H x W x 3 (BGR) or H x W x 4 (BGRA) arrays of uint8, uint16 or float32, of any strides.
    Keypoints are a sequence of objects like cv2.KeyPoint, of any cv2 or none, or an array with a row a keypoint:
    N x 3 (x, y, size; pixels), N x 4 (and the angle in degrees, -1 for upright) or N x 7 (and response, octave,
    class_id). Descriptors are N x ``descriptorSize()`` uint8 arrays for the Hamming distance.

    One object may serve several threads as long as none changes its parameters; the GIL is released meanwhile.
    Mistakes raise :class:`opencv_iib.error`, a TypeError if an argument is no array at all."""

    CHANNEL_GRAD_X, CHANNEL_GRAD_Y, CHANNEL_ORIENTATION = Channel.GRAD_X, Channel.GRAD_Y, Channel.ORIENTATION
    CHANNEL_INTENSITY, CHANNEL_SIGNED_GRAD_X = Channel.INTENSITY, Channel.SIGNED_GRAD_X
    CHANNEL_SIGNED_GRAD_Y, CHANNELS_DEFAULT = Channel.SIGNED_GRAD_Y, Channel.DEFAULT
    (MAPPING_MEAN, MAPPING_MAX, MAPPING_MIN, MAPPING_QUARTILE, MAPPING_SORT, MAPPING_HAAR, MAPPING_PAIRWISE,
     MAPPING_BOXES) = Mapping
    BORDER_CLAMP, BORDER_DROP, BORDER_REFLECT = Border
    ORIENTATION_NONE, ORIENTATION_KEYPOINT, ORIENTATION_GRADIENT = Orientation
    (PRESET_S128, PRESET_S256, PRESET_S512, PRESET_ACCURATE, PRESET_COMPACT, PRESET_TINY, PRESET_BALANCED,
     PRESET_VIEWPOINT, PRESET_UNIVERSAL, PRESET_SMALL) = Preset

    _detector: Any = None  #: what its user gave it

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
        :param extraChannels: number of maps that computeWithChannels is given, 0 to 16."""
        super().__init__(
            number(scaleFactor, 'scaleFactor'), integer(granularity, 'granularity'), integer(channels, 'channels'),
            integer(mapping, 'mapping'), bool(overlap), bool(useOrientation), integer(extraChannels, 'extraChannels'))

    @classmethod
    def create(cls, scaleFactor: float = 2.0, granularity: int = 4, channels: int = Channel.DEFAULT,
               mapping: int = Mapping.MEAN, overlap: bool = False, useOrientation: bool = False,
               extraChannels: int = 0) -> IIBDescriptorExtractor:
        """Creates an extractor, as the class itself does."""
        return cls(scaleFactor, granularity, channels, mapping, overlap, useOrientation, extraChannels)

    @classmethod
    def createPreset(cls, preset: Union[int, str], scaleFactor: Optional[float] = None) -> IIBDescriptorExtractor:
        """Creates an extractor with a learned selection, for given keypoints.

        :param preset: one of PRESET_, of :class:`Preset`, or its name: 'COMPACT'.
        :param scaleFactor: that of the keypoints' detector, see scaleFactorFor. None warns and takes ORB's, 2, by which keypoints of other
            detectors lose most matches. ``createFor(detector, preset)`` knows the detector's own."""
        if scaleFactor is None:
            warnings.warn("createPreset without a scaleFactor takes 2, ORB's: for other keypoints say "
                          "scaleFactor=IIB.scaleFactorFor('AKAZE'), or use createFor(detector, preset)", stacklevel=2)
            scaleFactor = 2.0
        return around(cls, cls._createPreset(integer(preset_number(preset), 'preset'), number(scaleFactor, 'scaleFactor')))

    @classmethod
    def createFor(cls, detector: Any, preset: Union[int, str] = -1) -> IIBDescriptorExtractor:
        """Creates an extractor that detects by a detector of any cv2, and has the scale factor for it.

        :param detector: has ``detect(image, mask)``; its ``getDefaultName()`` or its class's name determines the factor.
        :param preset: one of PRESET_, of :class:`Preset`, or its name; -1 for the paper's default descriptor."""
        extractor = around(cls, cls._createFor(core_detector(detector), integer(preset_number(preset), 'preset')))
        extractor._detector = detector
        return extractor

    @classmethod
    def createRecommended(cls, maxFeatures: int = 1000) -> IIBDescriptorExtractor:
        """The recommended detector and descriptor, HessianDetector and PRESET_UNIVERSAL, where light, place or both change.

        Match their descriptors with ``HierarchicalMatcher.createRecommended()``. Photographs of many megapixels are searched at a reduced
        size, see ``HessianDetector.setWorkingSize``.

        :param maxFeatures: keypoints of an image, the strongest; 0 keeps all."""
        return cls.createFor(HessianDetector(maxFeatures), Preset.UNIVERSAL)

    @staticmethod
    def scaleFactorFor(detectorName: Any = None, detector: Any = None) -> float:
        """Scale factor for a detector's keypoints.

        :param detectorName: such as 'ORB' or 'AKAZE', in any case, or a detector object; ``cv2.iib`` calls the latter `detector`."""
        known = detectorName if detector is None else detector
        return _core.IIBDescriptorExtractor._scaleFactorFor(known if isinstance(known, str) else core_detector(known))

    @overload
    def compute(self, image: Images, keypoints: Sequence[K]) -> tuple[tuple[K, ...], tuple[NDArray[np.uint8], ...]]: ...
    @overload
    def compute(self, image: ArrayLike, keypoints: K) -> tuple[K, NDArray[np.uint8]]: ...

    def compute(self, image: Any, keypoints: Any) -> Any:
        """Describes keypoints; with a list of images, those of each.

        :return: the given keypoints (without those that BORDER_DROP removed), and N x descriptorSize() uint8; N is 0 without keypoints,
            and for an empty image."""
        if are_images(image):
            return tuple(zip(*(self.compute(*each) for each in with_images(image, keypoints, 'keypoints'))))
        return self.computeWithChannels(image, [], keypoints)

    def computeWithChannels(self, image: ArrayLike, extraChannels: ArrayOrArrays, keypoints: K) -> tuple[K, NDArray[np.uint8]]:
        """Describes keypoints with the image and with further maps of it, such as depth or labels.

        :param extraChannels: getExtraChannels() arrays, each H x W, of uint8, uint16 or float32.
        :return: as compute."""
        descriptors, kept = self._compute(as_image(image), as_rows(keypoints), as_arrays(extraChannels, 'an extra channel'))
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
        """Sets the detector of `detect`: any object with ``detect(image, mask)`` that returns keypoints, such as one of cv2.

        It gets copies of the arrays. The scale factor stays as it is; see createFor."""
        self._setDetector(core_detector(detector))
        self._detector = detector

    def getDetector(self) -> Any:
        """The detector that was set; None for the default, the ORB of the OpenCV inside."""
        return self._detector

    def setSelection(self, quads: ArrayLike) -> None:
        """Restricts the descriptor to chosen quads.

        :param quads: Q x 5 int32: level, channel, row, column, bits to keep. Empty: all quads again."""
        self._setSelection(as_matrix(quads, 'the selection'))

    def read(self, fileName: Path) -> None:
        """Reads a file of write() or C++, also packed by gzip."""
        name = os.fsdecode(fileName)
        try:
            with open(name, 'rb') as file:  # OpenCV opens no name beyond Windows' code page or with a '?'
                text = file.read()
            text = gzip.decompress(text) if text.startswith(b'\x1f\x8b') else text
        except (OSError, EOFError, zlib.error) as e:
            raise _core.error(f'{name} cannot be read: {getattr(e, "strerror", None) or e}') from None
        try:
            self._setParameters(text.decode('utf-8-sig', 'replace'))
        except _core.error as e:
            raise _core.error(f'{name} holds no parameters that can be read: {e}') from None

    def _restored(self, parameters: str) -> Any:
        core = _core.IIBDescriptorExtractor(2.0, 4, 15, 0, False, False, 0)
        core._setParameters(parameters)
        if self._detector is not None:
            core._setDetector(core_detector(self._detector))
        return core

    def __repr__(self) -> str:
        return f'{type(self).__name__}({self.descriptorSize()} bytes, scaleFactor={self.getScaleFactor():g})'


#: The short name, as in C++.
IIB = IIBDescriptorExtractor
