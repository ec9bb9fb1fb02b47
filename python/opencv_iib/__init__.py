"""Feature matching under changed illumination: the classes of ``cv2.iib``, with any cv2 or none.

    import opencv_iib
    iib = opencv_iib.IIB.createRecommended()
    keypoints, descriptors = iib.detectAndCompute(image)
    matches = opencv_iib.HierarchicalMatcher.createRecommended().match(descriptors, others)

The same from arrays to arrays:

    points, sizes, codes = opencv_iib.detect_and_describe(image)
    pairs, distances = opencv_iib.match(codes, other_codes)

Classes, their methods and constants have the names of ``cv2.iib``; functions from arrays to arrays have Python's. The OpenCV
inside is its own: nothing but arrays and plain values passes between it and cv2.
"""
from opencv_iib import _core, _methods
from opencv_iib._core import error
from opencv_iib._arguments import integer
from opencv_iib.descriptor import IIB, IIBDescriptorExtractor
from opencv_iib.detectors import HessianDetector, NormalizedDetector
from opencv_iib.enums import AlignmentModel, Border, Channel, Mapping, Mode, Orientation, Preset
from opencv_iib.functions import Features, Matches, detect_and_describe, match
from opencv_iib.geometry import Alignment, ImageAligner, RelativePose, alignImages, confidenceLimit, findRelativePose, logFalseAlarms
from opencv_iib.keypoints import DMatch, KeyPoint, array_to_keypoints, keypoints_to_array
from opencv_iib.mapped_index import MappedIndex
from opencv_iib.matcher import HierarchicalMatcher
from opencv_iib.refinement import PropagatedMatches, RefinedMatches, propagateMatches, refineMatches
from opencv_iib.rotation import estimateRotation, matchRotated
from opencv_iib.views import ViewMatcher, ViewMatches, matchViews

__all__ = ['Alignment', 'AlignmentModel', 'Border', 'Channel', 'DMatch', 'Features', 'HessianDetector',
           'HierarchicalMatcher', 'IIB', 'IIBDescriptorExtractor', 'ImageAligner', 'KeyPoint', 'MappedIndex', 'Mapping', 'Matches',
           'Mode', 'NormalizedDetector', 'OPENCV_VERSION', 'Orientation', 'Preset', 'PropagatedMatches',
           'RefinedMatches', 'RelativePose', 'ViewMatcher', 'ViewMatches', 'alignImages', 'array_to_keypoints', 'confidenceLimit',
           'detect_and_describe', 'error', 'estimateRotation',
           'findRelativePose', 'getNumThreads', 'keypoints_to_array', 'logFalseAlarms', 'match', 'matchRotated', 'matchViews',
           'propagateMatches', 'refineMatches', 'setNumThreads']

__version__: str = _core.VERSION
#: The version of the OpenCV inside.
OPENCV_VERSION: str = _core.OPENCV_VERSION


def setNumThreads(nthreads: int) -> None:
    """Threads of the OpenCV inside, as cv2.setNumThreads: 0 or 1 for the caller's alone, negative for the default."""
    _core.setNumThreads(integer(nthreads, 'nthreads'))


def getNumThreads() -> int:
    """Threads that a call may use."""
    return _core.getNumThreads()

