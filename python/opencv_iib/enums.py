"""Values of parameters by name; each is the integer of ``cv2.iib`` as well."""
from __future__ import annotations

from enum import IntEnum, IntFlag


class Channel(IntFlag):
    """What of the image is compared; a sum of these."""

    GRAD_X = 1
    GRAD_Y = 2
    ORIENTATION = 4
    INTENSITY = 8
    SIGNED_GRAD_X = 16
    SIGNED_GRAD_Y = 32
    DEFAULT = 15


class Mapping(IntEnum):
    """How the four cells of a quad become bits."""

    MEAN, MAX, MIN, QUARTILE, SORT, HAAR, PAIRWISE, BOXES = range(8)


class Border(IntEnum):
    """What happens to keypoints whose region leaves the image."""

    CLAMP, DROP, REFLECT = range(3)


class Orientation(IntEnum):
    """How the described squares are turned."""

    NONE, KEYPOINT, GRADIENT = range(3)


class Preset(IntEnum):
    """Descriptors whose bits were learned."""

    S128, S256, S512, ACCURATE, COMPACT, TINY, BALANCED, VIEWPOINT, UNIVERSAL, SMALL = range(10)


class Mode(IntEnum):
    """How the matcher searches."""

    EXACT, THRESHOLD, ADAPTIVE = range(3)
