"""Names of parameters' values; each is also the integer of ``cv2.iib``."""
from __future__ import annotations

from enum import IntEnum, IntFlag
from typing import Union


class Channel(IntFlag):
    """Channels of the image that are compared; a sum of these."""

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
    """How the described squares are rotated."""

    NONE, KEYPOINT, GRADIENT = range(3)


class Preset(IntEnum):
    """Descriptors whose bits were learned.

    ========= ===== ==============================================================================================
    name      bytes for
    ========= ===== ==============================================================================================
    UNIVERSAL 128   light and camera both change, or you do not know yet
    SMALL     32    the same where memory is scarce
    VIEWPOINT 64    the camera moves far
    BALANCED  64    the camera moves, and the light changes more than the view
    ACCURATE  170   a still camera, at points of another detector than HessianDetector
    COMPACT   64    a still camera, many images to keep
    TINY      32    a still camera, and memory is scarce
    S512      64    the paper's default, shortened; likewise S256 (32 bytes) and S128 (16)
    ========= ===== =============================================================================================="""

    S128, S256, S512, ACCURATE, COMPACT, TINY, BALANCED, VIEWPOINT, UNIVERSAL, SMALL = range(10)


class AlignmentModel(IntEnum):
    """Transforms between two images, each with more freedom than the one before: rotation and scale, shear, perspective. AUTO: the simplest one
    that is true."""

    TRANSLATION, SIMILARITY, AFFINE, HOMOGRAPHY, AUTO = range(5)


class Mode(IntEnum):
    """How the matcher searches."""

    EXACT, THRESHOLD, ADAPTIVE = range(3)


def preset_number(preset: Union[int, str]) -> Union[int, str]:
    """The number of a preset's name, in any case, with or without PRESET_; other values are returned as they are."""
    if not isinstance(preset, str):
        return preset
    name = preset.upper().removeprefix('PRESET_')
    if name not in Preset.__members__:
        raise ValueError(f'there is no preset {preset!r}, but {", ".join(Preset.__members__)}')
    return Preset[name]
