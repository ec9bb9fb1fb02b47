"""IIBDescriptorExtractor: the class of cv2.iib, for arrays and for the objects of any cv2."""
from __future__ import annotations

import os
import warnings
from typing import Any, Optional, Sequence, TypeVar, Union, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from opencv_iib import _core
from opencv_iib._arguments import Path, integer, number
from opencv_iib._arrays import ArrayOrArrays, Images, are_images, as_arrays, as_image, as_matrix, with_images
from opencv_iib._parameter_file import text_of
from opencv_iib.detectors import Detector, HessianDetector, core_detector, for_pickle
from opencv_iib.enums import Border, Channel, Mapping, Orientation, Preset, preset_number
from opencv_iib.keypoints import Keypoints, as_rows

K = TypeVar('K', bound=Keypoints)


class IIBDescriptorExtractor(Detector):
    """Illumination-insensitive binary descriptor; names, keywords and bits are those of ``cv2.iib``.

    Images are H x W, H x W x 3 (BGR) or H x W x 4 (BGRA) arrays of uint8, uint16 or float32, of any strides.
    Keypoints are a sequence of objects like cv2.KeyPoint, of any cv2 or none, or an array with a row a keypoint:
    N x 3 (x, y, size; pixels), N x 4 (and the angle in degrees, -1 for upright) or N x 7 (and response, octave,
    class_id). Descriptors are N x ``descriptorSize()`` uint8 arrays for the Hamming distance.

    One object may serve several threads as long as none changes its parameters; the GIL is released meanwhile.
    Mistakes raise :class:`opencv_iib.error`, a TypeError if an argument is no array at all.
    """

    CHANNEL_GRAD_X, CHANNEL_GRAD_Y, CHANNEL_ORIENTATION = Channel.GRAD_X, Channel.GRAD_Y, Channel.ORIENTATION
    CHANNEL_INTENSITY, CHANNEL_SIGNED_GRAD_X = Channel.INTENSITY, Channel.SIGNED_GRAD_X
    CHANNEL_SIGNED_GRAD_Y, CHANNELS_DEFAULT = Channel.SIGNED_GRAD_Y, Channel.DEFAULT
    (MAPPING_MEAN, MAPPING_MAX, MAPPING_MIN, MAPPING_QUARTILE, MAPPING_SORT, MAPPING_HAAR, MAPPING_PAIRWISE,
     MAPPING_BOXES) = Mapping
    BORDER_CLAMP, BORDER_DROP, BORDER_REFLECT = Border
    ORIENTATION_NONE, ORIENTATION_KEYPOINT, ORIENTATION_GRADIENT = Orientation
    (PRESET_S128, PRESET_S256, PRESET_S512, PRESET_ACCURATE, PRESET_COMPACT, PRESET_TINY, PRESET_BALANCED,
     PRESET_VIEWPOINT, PRESET_UNIVERSAL, PRESET_SMALL) = Preset

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
        self._core = _core.Extractor.create(
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
        """Creates an extractor with a learned selection, for keypoints that you have.

        :param preset: one of PRESET_, of :class:`Preset`, or its name: 'COMPACT'.
        :param scaleFactor: what the detector's keypoints need, see scaleFactorFor. Without one it is 2, ORB's, and there is
            a warning, since other detectors' keypoints lose most matches by it: ``createFor(detector, preset)`` knows the
            detector's own.
        """
        if scaleFactor is None:
            warnings.warn("createPreset without a scaleFactor takes 2, ORB's: for other keypoints say "
                          "scaleFactor=IIB.scaleFactorFor('AKAZE'), or use createFor(detector, preset)", stacklevel=2)
            scaleFactor = 2.0
        return cls._of(_core.Extractor.createPreset(integer(preset_number(preset), 'preset'),
                                                    number(scaleFactor, 'scaleFactor')))

    @classmethod
    def createFor(cls, detector: Any, preset: Union[int, str] = -1) -> IIBDescriptorExtractor:
        """Creates an extractor for a detector object, of any cv2: with its scale factor, and it detects.

        :param detector: has ``detect(image, mask)``; its ``getDefaultName()`` or its class's name gives the factor.
        :param preset: one of PRESET_, of :class:`Preset`, or its name; -1 for the paper's default descriptor.
        """
        extractor = cls._of(_core.Extractor.createFor(core_detector(detector), integer(preset_number(preset), 'preset')))
        extractor._detector = detector
        return extractor

    @classmethod
    def createRecommended(cls, maxFeatures: int = 1000) -> IIBDescriptorExtractor:
        """What to take first, where light, place or both change: HessianDetector and PRESET_UNIVERSAL.

        ``detectAndCompute`` finds and describes; match with ``HierarchicalMatcher.createRecommended()``. Photographs of many
        megapixels are searched at a reduced size, see ``HessianDetector.setWorkingSize``.

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

    @overload
    def compute(self, image: Images, keypoints: Sequence[K]) -> tuple[tuple[K, ...], tuple[NDArray[np.uint8], ...]]: ...
    @overload
    def compute(self, image: ArrayLike, keypoints: K) -> tuple[K, NDArray[np.uint8]]: ...

    def compute(self, image: Any, keypoints: Any) -> Any:
        """Describes keypoints; with a list of images, those of each.

        :return: the keypoints as they were given (those left, if BORDER_DROP removed some), and N x
            descriptorSize() uint8. Without keypoints, or with an empty image, there are 0 descriptors.
        """
        if are_images(image):
            return tuple(zip(*(self.compute(*each) for each in with_images(image, keypoints, 'keypoints'))))
        return self.computeWithChannels(image, [], keypoints)

    def computeWithChannels(self, image: ArrayLike, extraChannels: ArrayOrArrays, keypoints: K) -> tuple[K, NDArray[np.uint8]]:
        """Describes keypoints with the image and with further maps of it, such as depth or labels.

        :param extraChannels: getExtraChannels() arrays, each H x W, of uint8, uint16 or float32.
        :return: as compute.
        """
        descriptors, kept = self._core.compute(as_image(image), as_rows(keypoints), as_arrays(extraChannels, 'an extra channel'))
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

    def levelSizes(self) -> tuple[int, ...]:
        """Bytes of each level, coarse first; their sum is descriptorSize()."""
        return tuple(self._core.levelSizes())

    def descriptorType(self) -> int:
        """CV_8U, which is 0."""
        return self._core.descriptorType()

    def defaultNorm(self) -> int:
        """NORM_HAMMING, which is 6."""
        return self._core.defaultNorm()

    def setScaleFactor(self, scaleFactor: float) -> None:
        """Side of the described square in units of a keypoint's size, > 0."""
        self._core.scaleFactor = number(scaleFactor, 'scaleFactor')

    def getScaleFactor(self) -> float:
        """See setScaleFactor."""
        return self._core.scaleFactor

    def setGranularity(self, granularity: int) -> None:
        """Number of levels, 1 to 6. Another one ends a selection, as other channels, mapping or overlap do."""
        self._core.granularity = integer(granularity, 'granularity')

    def getGranularity(self) -> int:
        """See setGranularity."""
        return self._core.granularity

    def setChannels(self, channels: int) -> None:
        """A sum of CHANNEL_ values; may be 0 if there are extra channels."""
        self._core.channels = integer(channels, 'channels')

    def getChannels(self) -> Channel:
        """See setChannels."""
        return Channel(self._core.channels)

    def setMapping(self, mapping: int) -> None:
        """One of MAPPING_."""
        self._core.mapping = integer(mapping, 'mapping')

    def getMapping(self) -> Mapping:
        """See setMapping."""
        return Mapping(self._core.mapping)

    def setOverlap(self, overlap: bool) -> None:
        """Whether the windows of 2 x 2 cells slide by one cell instead of two."""
        self._core.overlap = bool(overlap)

    def getOverlap(self) -> bool:
        """See setOverlap."""
        return self._core.overlap

    def setUseOrientation(self, useOrientation: bool) -> None:
        """True: ORIENTATION_KEYPOINT, False: ORIENTATION_NONE."""
        self._core.useOrientation = bool(useOrientation)

    def getUseOrientation(self) -> bool:
        """Whether the orientation is another than ORIENTATION_NONE."""
        return self._core.useOrientation

    def setOrientation(self, mode: int) -> None:
        """How the described squares are turned: one of ORIENTATION_."""
        self._core.orientation = integer(mode, 'orientation')

    def getOrientation(self) -> Orientation:
        """See setOrientation."""
        return Orientation(self._core.orientation)

    def setExtraChannels(self, extraChannels: int) -> None:
        """Number of maps that computeWithChannels is given, 0 to 16."""
        self._core.extraChannels = integer(extraChannels, 'extraChannels')

    def getExtraChannels(self) -> int:
        """See setExtraChannels."""
        return self._core.extraChannels

    def setBorder(self, border: int) -> None:
        """One of BORDER_."""
        self._core.border = integer(border, 'border')

    def getBorder(self) -> Border:
        """See setBorder."""
        return Border(self._core.border)

    def setSelection(self, quads: ArrayLike) -> None:
        """Restricts the descriptor to chosen quads.

        :param quads: Q x 5 int32: level, channel, row, column, bits to keep. Empty: all quads again.
        """
        self._core.setSelection(as_matrix(quads, 'the selection'))

    def getSelection(self) -> NDArray[np.int32]:
        """Q x 5 int32, as setSelection takes it; 0 x 5 if there is no selection."""
        return self._core.getSelection()

    def save(self, filename: Path) -> None:
        """As write()."""
        self.write(filename)

    def write(self, fileName: Path) -> None:
        """Writes the parameters, but not the detector, to a .yml, .xml or .json file, which read() and C++ read.

        A link is followed. An older file is replaced when the new one is whole.

        :raises opencv_iib.error: if it cannot be written whole; an older file is there then as it was. Also for a link that leads to
            no file, a folder, a device or a pipe.
        """
        self._core.save(fileName)

    def read(self, fileName: Path) -> None:
        """Reads what write() or C++ wrote."""
        text = text_of(fileName)
        try:
            self._core.setParameters(text)
        except _core.error as e:
            raise _core.error(f'{os.fsdecode(fileName)} holds no parameters that can be read: {e}') from None

    def __getstate__(self) -> dict[str, Any]:
        return {**super().__getstate__(), '_detector': for_pickle(self._detector)}

    def _parameters(self) -> str:
        return self._core.parameters()

    def _restored(self, parameters: str) -> Any:
        core = _core.Extractor.create(2.0, 4, 15, 0, False, False, 0)
        core.setParameters(parameters)
        if self._detector is not None:
            core.setDetector(core_detector(self._detector))
        return core

    def __repr__(self) -> str:
        return f'{type(self).__name__}({self.descriptorSize()} bytes, scaleFactor={self.getScaleFactor():g})'


#: As in C++.
IIB = IIBDescriptorExtractor
