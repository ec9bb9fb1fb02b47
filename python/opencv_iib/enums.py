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

    MEAN = 0
    MAX = 1
    MIN = 2
    QUARTILE = 3
    SORT = 4
    HAAR = 5
    PAIRWISE = 6
    BOXES = 7


class Border(IntEnum):
    """What happens to keypoints whose region leaves the image."""

    CLAMP = 0
    DROP = 1
    REFLECT = 2


class Orientation(IntEnum):
    """How the described squares are turned."""

    NONE = 0
    KEYPOINT = 1
    GRADIENT = 2


class Preset(IntEnum):
    """Descriptors whose bits were learned."""

    S128 = 0
    S256 = 1
    S512 = 2
    ACCURATE = 3
    COMPACT = 4
    TINY = 5
    BALANCED = 6
    VIEWPOINT = 7
    UNIVERSAL = 8
    SMALL = 9


class Mode(IntEnum):
    """How the matcher searches."""

    EXACT = 0
    THRESHOLD = 1
    ADAPTIVE = 2
