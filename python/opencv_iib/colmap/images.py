"""Image files: which there are, their grey values, and the focal length that their EXIF data tell."""
from __future__ import annotations

import os
import struct
from typing import Any, Iterator, NoReturn, Optional

import numpy as np

from opencv_iib._files import write_whole

SUFFIXES = ('.jpg', '.jpeg', '.png', '.tif', '.tiff', '.bmp', '.webp', '.ppm', '.pgm')
# Numbers of EXIF tags.
EXIF_IFD, FOCAL_LENGTH, FOCAL_LENGTH_35MM, PLANE_X_RESOLUTION, PLANE_UNIT = 0x8769, 0x920A, 0xA405, 0xA20E, 0xA210
MILLIMETRES = {2: 25.4, 3: 10.0, 4: 1.0, 5: 0.001}  # of EXIF's units of resolution
SHORT, LONG, RATIONAL = 3, 4, 5  # EXIF's types of numbers
START_OF_SCAN, APP1 = 0xda, 0xe1  # JPEG's markers


def find_images(folder: str) -> list[str]:
    """Paths of images below `folder`, relative to it, with '/', sorted: COLMAP's names.

    :raises OSError: for a folder that cannot be read.
    """
    def fail(why: OSError) -> NoReturn:
        raise type(why)(f'{why.filename} cannot be read: {why.strerror}')

    names = []
    for root, _, files in os.walk(folder, onerror=fail):
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


def import_cv2() -> Any:
    """cv2, whichever package has it: an extra that names one would install it over another.

    :raises ImportError: saying what to install.
    """
    try:
        import cv2
    except ImportError as e:
        raise ImportError(f'{e}: images are read by cv2: pip install opencv-python, or opencv-python-headless without '
                          'windows, or apt install python3-opencv') from None
    return cv2


def read_bytes(path: str) -> bytes:
    """:raises ValueError: for what is no file, such as a FIFO, which would never end."""
    if not os.path.isfile(path):
        raise ValueError('not a file' if os.path.lexists(path) else 'there is no such file')
    with open(path, 'rb') as file:
        return file.read()


def read_grey(path: str) -> np.ndarray:
    """H x W uint8, as the file has it: like COLMAP, not turned as EXIF may ask."""
    return decode_grey(read_bytes(path))


def read_colour(path: str) -> np.ndarray:
    """H x W x 3 uint8, BGR; otherwise as read_grey.

    :raises ValueError: naming the file.
    """
    try:
        return _decode(read_bytes(path), colour=True)
    except ValueError as e:
        raise ValueError(f'{path}: {e}') from None


def decode_grey(data: bytes) -> np.ndarray:
    """As read_grey, of a file's bytes: cv2 itself takes no path that is not UTF-8."""
    return _decode(data, colour=False)


def _decode(data: bytes, colour: bool) -> np.ndarray:
    """:raises ValueError: if it cannot be read, also if it is a JPEG without its end, which cv2 would fill with grey.
    """
    cv2 = import_cv2()
    image = None
    if data and not _is_cut_off(data):
        try:
            image = cv2.imdecode(np.frombuffer(data, np.uint8),
                                 (cv2.IMREAD_COLOR if colour else cv2.IMREAD_GRAYSCALE) | cv2.IMREAD_IGNORE_ORIENTATION)
        except cv2.error:  # such as more pixels than it takes
            pass
    if image is None:
        raise ValueError('not an image that cv2 reads, cut off, or of more than 2^30 pixels')
    return np.asarray(image)


def write_picture(path: str, picture: np.ndarray) -> None:
    """:raises ValueError: for a suffix of no format that cv2 writes."""
    cv2 = import_cv2()
    try:
        written, data = cv2.imencode(os.path.splitext(path)[1] or '.', picture)
    except cv2.error:
        written = False
    if not written:
        raise ValueError(f'{path}: end its name in .png or .jpg')
    write_whole(path, data.tobytes())


def _jpeg_segments(data: bytes) -> Iterator[tuple[int, int, int]]:
    """Marker, begin and end of each segment of a JPEG, up to its image data; nothing for other files."""
    at = 2 if data.startswith(b'\xff\xd8') else len(data)
    while data[at:at + 1] == b'\xff' and at + 4 <= len(data):
        marker = data[at + 1]
        end = at + 2 + int.from_bytes(data[at + 2:at + 4], 'big')
        if marker == 0xff:  # a byte that fills
            at += 1
            continue
        yield marker, at + 4, end
        if marker == START_OF_SCAN:
            return
        at = end


def _is_cut_off(data: bytes) -> bool:
    """Whether the file is a JPEG without its end. A thumbnail within a segment has an end of its own."""
    return any(marker == START_OF_SCAN and data.find(b'\xff\xd9', begin) < 0 for marker, begin, _ in _jpeg_segments(data))


def _exif(data: bytes) -> bytes:
    """The TIFF structure of a file's EXIF data, in JPEG, PNG, WebP or TIFF; empty without any."""
    if data[:4] in (b'II*\0', b'MM\0*'):
        return data
    for marker, begin, end in _jpeg_segments(data):
        if marker == APP1 and data[begin:begin + 6] == b'Exif\0\0':
            return data[begin + 6:end]
    png, webp = data[:4] == b'\x89PNG', data[8:12] == b'WEBP'
    at = 8 if png else 12 if webp else len(data)
    while at + 8 <= len(data):
        name, size = data[at + 4:at + 8], int.from_bytes(data[at:at + 4], 'big')
        if webp:
            name, size = data[at:at + 4], int.from_bytes(data[at + 4:at + 8], 'little')
        if name in (b'eXIf', b'EXIF'):
            return data[at + 8:at + 8 + size].removeprefix(b'Exif\0\0')
        at += 8 + size + (4 if png else size % 2)
    return b''


def _numbers(tiff: bytes, at: int) -> dict[int, float]:
    """By tag, the first number of each entry of a TIFF directory.

    :raises struct.error: for one that is cut off.
    """
    order = '<' if tiff[:1] == b'I' else '>'
    found: dict[int, float] = {}
    for entry in range(struct.unpack_from(order + 'H', tiff, at)[0]):
        tag, kind, _, value = struct.unpack_from(order + 'HHI4s', tiff, at + 2 + 12 * entry)
        if kind in (SHORT, LONG):
            found[tag], = struct.unpack_from(order + ('H' if kind == SHORT else 'I'), value)
        elif kind == RATIONAL:
            above, below = struct.unpack_from(order + 'II', tiff, struct.unpack(order + 'I', value)[0])
            found[tag] = above / below if below else 0
    return found


def exif_focal_length(data: bytes, width: int, height: int) -> Optional[float]:
    """Focal length in pixels by a file's EXIF data, by COLMAP's rules; None if they tell none."""
    tiff = _exif(data)
    try:
        first = _numbers(tiff, struct.unpack_from('<I' if tiff[:1] == b'I' else '>I', tiff, 4)[0])
        exif = _numbers(tiff, int(first[EXIF_IFD]))
    except (struct.error, KeyError):
        return None
    if exif.get(FOCAL_LENGTH_35MM, 0) > 0:
        return exif[FOCAL_LENGTH_35MM] / 35.0 * max(width, height)
    focal, resolution = exif.get(FOCAL_LENGTH, 0), exif.get(PLANE_X_RESOLUTION, 0)
    return focal * resolution / MILLIMETRES.get(int(exif.get(PLANE_UNIT, 2)), 25.4) or None
