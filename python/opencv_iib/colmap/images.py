"""Image files: which there are, their grey values, and the focal length that their EXIF data tell."""
from __future__ import annotations

import os
from typing import Optional

import numpy as np

SUFFIXES = ('.jpg', '.jpeg', '.png', '.tif', '.tiff', '.bmp', '.webp', '.ppm', '.pgm')
# Numbers of EXIF tags.
EXIF_IFD, FOCAL_LENGTH, FOCAL_LENGTH_35MM, PLANE_X_RESOLUTION, PLANE_UNIT = 0x8769, 0x920A, 0xA405, 0xA20E, 0xA210
MILLIMETRES = {2: 25.4, 3: 10.0, 4: 1.0, 5: 0.001}  # of EXIF's units of resolution


def find_images(folder: str) -> list[str]:
    """Paths of images below `folder`, relative to it, with '/', sorted: COLMAP's names."""
    names = []
    for root, _, files in os.walk(folder):
        for file in files:
            if file.lower().endswith(SUFFIXES):
                names.append(os.path.relpath(os.path.join(root, file), folder).replace(os.sep, '/'))
    return sorted(names)


def stamp(path: str) -> str:
    """Size and time of a file: others if it was changed."""
    try:
        status = os.stat(path)
    except OSError:
        return ''
    return f'{status.st_size} {status.st_mtime_ns}'


def is_utf8(name: str) -> bool:
    """Whether a file's name can be stored; those that Python could not decode cannot."""
    return not any('\ud800' <= letter <= '\udfff' for letter in name)


def is_listable(name: str) -> bool:
    """Whether a name can stand in COLMAP's and hloc's lists, two a line with a blank between them."""
    return not name.startswith('#') and not any(letter.isspace() for letter in name)


def read_grey(path: str) -> np.ndarray:
    """H x W uint8, as the file has it: like COLMAP, not turned as EXIF may ask.

    :raises ValueError: if it cannot be read, also if it is a JPEG without its end, which cv2 would fill with grey.
    """
    import cv2
    readable = os.path.isfile(path) and not _is_cut_off(path)
    image = cv2.imread(path, cv2.IMREAD_GRAYSCALE | cv2.IMREAD_IGNORE_ORIENTATION) if readable else None
    if image is None:
        raise ValueError('not an image that cv2 reads, or cut off')
    return np.asarray(image)


def _is_cut_off(path: str) -> bool:
    with open(path, 'rb') as file:
        data = file.read()
    at = 2 if data.startswith(b'\xff\xd8') else len(data)
    while data[at:at + 1] == b'\xff':  # segments, one of which may hold a thumbnail with an end of its own
        if data[at + 1:at + 2] == b'\xda':
            return b'\xff\xd9' not in data[at:]
        fill = data[at + 1:at + 2] == b'\xff'
        at += 1 if fill else 2 + int.from_bytes(data[at + 2:at + 4], 'big')
    return False


def exif_focal_length(path: str, width: int, height: int) -> Optional[float]:
    """Focal length in pixels by the file's EXIF data, by COLMAP's rules; None if they tell none."""
    from PIL import Image
    try:
        with Image.open(path) as image:
            exif = image.getexif().get_ifd(EXIF_IFD)
        equivalent = float(exif.get(FOCAL_LENGTH_35MM, 0))
        if equivalent > 0:
            return equivalent / 35.0 * max(width, height)
        focal, resolution = float(exif.get(FOCAL_LENGTH, 0)), float(exif.get(PLANE_X_RESOLUTION, 0))
        if focal > 0 and resolution > 0:
            return focal * resolution / MILLIMETRES.get(int(exif.get(PLANE_UNIT, 2)), 25.4)
    except (OSError, ValueError, TypeError, ZeroDivisionError, SyntaxError):
        pass  # what Pillow cannot read has no prior; whether it is an image at all, read_grey tells
    return None
