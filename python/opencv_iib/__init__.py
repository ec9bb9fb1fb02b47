"""Feature matching that survives a change of light: the classes of ``cv2.iib``, beside any cv2 or none.

    import cv2, opencv_iib
    iib = opencv_iib.IIB.createFor(cv2.ORB_create(2000))
    keypoints, descriptors = iib.detectAndCompute(image)
    matches = opencv_iib.HierarchicalMatcher(iib.levelSizes(), crossCheck=True).match(descriptors, others)

The OpenCV inside is its own: nothing but arrays and plain values passes between it and cv2.
"""
from opencv_iib import _core
from opencv_iib._core import error
from opencv_iib._types import DMatch, KeyPoint
from opencv_iib.descriptor import IIB, IIBDescriptorExtractor
from opencv_iib.keypoints import array_to_keypoints, keypoints_to_array
from opencv_iib.matcher import HierarchicalMatcher

__version__ = '0.1.0'
#: Of the OpenCV inside.
OPENCV_VERSION: str = _core.OPENCV_VERSION

# The flat names that cv2.iib has as well.
IIBDescriptorExtractor_create = IIB_create = IIBDescriptorExtractor.create
IIBDescriptorExtractor_createPreset = IIB_createPreset = IIBDescriptorExtractor.createPreset
IIBDescriptorExtractor_createFor = IIB_createFor = IIBDescriptorExtractor.createFor
IIBDescriptorExtractor_scaleFactorFor = IIB_scaleFactorFor = IIBDescriptorExtractor.scaleFactorFor
HierarchicalMatcher_create = HierarchicalMatcher.create
HierarchicalMatcher_loadIndex = HierarchicalMatcher.loadIndex

IIBDescriptorExtractor_CHANNEL_GRAD_X = IIBDescriptorExtractor.CHANNEL_GRAD_X
IIBDescriptorExtractor_CHANNEL_GRAD_Y = IIBDescriptorExtractor.CHANNEL_GRAD_Y
IIBDescriptorExtractor_CHANNEL_ORIENTATION = IIBDescriptorExtractor.CHANNEL_ORIENTATION
IIBDescriptorExtractor_CHANNEL_INTENSITY = IIBDescriptorExtractor.CHANNEL_INTENSITY
IIBDescriptorExtractor_CHANNEL_SIGNED_GRAD_X = IIBDescriptorExtractor.CHANNEL_SIGNED_GRAD_X
IIBDescriptorExtractor_CHANNEL_SIGNED_GRAD_Y = IIBDescriptorExtractor.CHANNEL_SIGNED_GRAD_Y
IIBDescriptorExtractor_CHANNELS_DEFAULT = IIBDescriptorExtractor.CHANNELS_DEFAULT
IIBDescriptorExtractor_MAPPING_MEAN = IIBDescriptorExtractor.MAPPING_MEAN
IIBDescriptorExtractor_MAPPING_MAX = IIBDescriptorExtractor.MAPPING_MAX
IIBDescriptorExtractor_MAPPING_MIN = IIBDescriptorExtractor.MAPPING_MIN
IIBDescriptorExtractor_MAPPING_QUARTILE = IIBDescriptorExtractor.MAPPING_QUARTILE
IIBDescriptorExtractor_MAPPING_SORT = IIBDescriptorExtractor.MAPPING_SORT
IIBDescriptorExtractor_MAPPING_HAAR = IIBDescriptorExtractor.MAPPING_HAAR
IIBDescriptorExtractor_MAPPING_PAIRWISE = IIBDescriptorExtractor.MAPPING_PAIRWISE
IIBDescriptorExtractor_BORDER_CLAMP = IIBDescriptorExtractor.BORDER_CLAMP
IIBDescriptorExtractor_BORDER_DROP = IIBDescriptorExtractor.BORDER_DROP
IIBDescriptorExtractor_PRESET_S128 = IIBDescriptorExtractor.PRESET_S128
IIBDescriptorExtractor_PRESET_S256 = IIBDescriptorExtractor.PRESET_S256
IIBDescriptorExtractor_PRESET_S512 = IIBDescriptorExtractor.PRESET_S512
IIBDescriptorExtractor_PRESET_ACCURATE = IIBDescriptorExtractor.PRESET_ACCURATE
IIBDescriptorExtractor_PRESET_COMPACT = IIBDescriptorExtractor.PRESET_COMPACT
IIBDescriptorExtractor_PRESET_TINY = IIBDescriptorExtractor.PRESET_TINY
IIBDescriptorExtractor_PRESET_BALANCED = IIBDescriptorExtractor.PRESET_BALANCED
HierarchicalMatcher_EXACT = HierarchicalMatcher.EXACT
HierarchicalMatcher_THRESHOLD = HierarchicalMatcher.THRESHOLD
HierarchicalMatcher_ADAPTIVE = HierarchicalMatcher.ADAPTIVE


def setNumThreads(nthreads: int) -> None:
    """Threads of the OpenCV inside, as cv2.setNumThreads: 0 or 1 for the caller's alone, negative for the default."""
    _core.setNumThreads(nthreads)


def getNumThreads() -> int:
    """Threads that a call may use."""
    return _core.getNumThreads()
