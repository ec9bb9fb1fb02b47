"""Image files: which there are, their grey values, and the focal length that their EXIF data tell."""
from __future__ import annotations

import os
import struct
from typing import Any, Iterator, NoReturn, Optional

import numpy as np

from opencv_iib._arguments import InvalidOption, Path
from opencv_iib._files import write_whole

SUFFIXES = ('.jpg', '.jpeg', '.png', '.tif', '.tiff', '.bmp', '.webp', '.ppm', '.pgm')
# Numbers of EXIF tags.
ORIENTATION = 0x0112
EXIF_IFD, FOCAL_LENGTH, FOCAL_LENGTH_35MM, PLANE_X_RESOLUTION, PLANE_UNIT = 0x8769, 0x920A, 0xA405, 0xA20E, 0xA210
MILLIMETRES = {2: 25.4, 3: 10.0, 4: 1.0, 5: 0.001}  # of EXIF's units of resolution
SHORT, LONG, RATIONAL = 3, 4, 5  # EXIF's types of numbers
START_OF_SCAN, APP1 = 0xda, 0xe1  # JPEG's markers
TIFF = (b'II*\0', b'MM\0*', b'II+\0', b'MM\0+')  # how files begin
IMAGES = (*TIFF, b'\xff\xd8', b'\x89PNG', b'RIFF', b'BM', *(b'P%d' % kind for kind in range(1, 8)))


def find_images(folder: Path) -> list[str]:
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


def read_bytes(path: Path) -> bytes:
    """:raises ValueError: for what is no file, such as a FIFO, which would never end."""
    if not os.path.isfile(path):
        raise ValueError('not a file' if os.path.lexists(path) else 'there is no such file')
    with open(path, 'rb') as file:
        return file.read()


def read_grey(path: Path) -> np.ndarray:
    """H x W uint8, as the file has it: like COLMAP, not turned as EXIF may ask. What is not of 8 bits is scaled by its own range.

    :raises ValueError: saying what is wrong with the file.
    """
    return decode_grey(read_bytes(path))


def read_colour(path: Path) -> np.ndarray:
    """H x W x 3 uint8, BGR; otherwise as read_grey.

    :raises ValueError: naming the file.
    """
    return read_with_orientation(path)[0]


def read_with_orientation(path: Path, exif: bool = True) -> tuple[np.ndarray, int]:
    """As read_colour, and how the file stores the image, by its EXIF data; without `exif`, 1."""
    try:
        data = read_bytes(path)
        return _decode(data, colour=True), exif_orientation(data) if exif else 1
    except ValueError as e:
        raise ValueError(f'{os.fspath(path)}: {e}') from None


def decode_grey(data: bytes) -> np.ndarray:
    """As read_grey, of a file's bytes: cv2 itself takes no path that is not UTF-8."""
    return _decode(data, colour=False)


def _decode(data: bytes, colour: bool) -> np.ndarray:
    """:raises ValueError: if it cannot be read, also if it is a JPEG without its end, which cv2 would fill with grey."""
    cv2 = import_cv2()
    if not data:
        raise ValueError('the file is empty')
    if _is_cut_off(data):
        raise ValueError('the file is cut off: a JPEG without its end')
    mode = (cv2.IMREAD_COLOR if colour else cv2.IMREAD_GRAYSCALE) | cv2.IMREAD_IGNORE_ORIENTATION | cv2.IMREAD_ANYDEPTH
    try:
        # What is not of 8 bits as the file has it. Of TIFF first, where cv2 gives floats in no other way, and prints of that.
        for flags in (cv2.IMREAD_UNCHANGED, mode) if data.startswith(TIFF) else (mode, cv2.IMREAD_UNCHANGED):
            image = cv2.imdecode(np.frombuffer(data, np.uint8), flags)
            if (flags == mode) == (image is None or image.dtype == np.uint8):
                break
    except cv2.error as e:
        why = 'of more than 2^30 pixels' if 'MAX_IMAGE' in str(e) else str(e).splitlines()[0]
        raise ValueError(f'not an image that cv2 reads: {why}') from None
    if image is None:
        raise ValueError('the image is damaged or cut off' if data.startswith(IMAGES) else 'not an image that cv2 reads')
    return _with_channels(_in_8_bits(image), colour)


def _in_8_bits(image: np.ndarray) -> np.ndarray:
    """Other numbers scaled from their own range, of which a few dead pixels are no part; NaN becomes 0."""
    if image.dtype == np.uint8:
        return image
    colours = image[..., :3] if image.ndim == 3 else image
    values = colours[np.isfinite(colours)]
    if not values.size:
        raise ValueError('the image holds no finite number')
    low, high = np.percentile(values[::1 + values.size // 1000000], (.01, 99.99))
    if high > low:
        values = values[(values >= 2 * low - high) & (values <= 2 * high - low)]
    low, high = float(values.min()), float(values.max())
    with np.errstate(invalid='ignore'):
        return np.nan_to_num(np.rint((image - low) * (255 / ((high - low) or 1))).clip(0, 255)).astype(np.uint8)


def _with_channels(image: np.ndarray, colour: bool) -> np.ndarray:
    """H x W, or with colour H x W x 3, of as many as there are."""
    cv2, channels = import_cv2(), image.shape[2] if image.ndim == 3 else 1
    if channels > 4:
        raise ValueError(f'the image has {channels} channels: grey ones and those of three colours are read')
    if channels in (3, 4):
        return image[..., :3] if colour else cv2.cvtColor(image[..., :3], cv2.COLOR_BGR2GRAY)
    grey = image if image.ndim == 2 else np.ascontiguousarray(image[..., 0])
    return cv2.cvtColor(grey, cv2.COLOR_GRAY2BGR) if colour else grey


def check_picture(path: Path) -> None:
    """:raises InvalidOption: for a suffix of no format that cv2 writes."""
    if not import_cv2().haveImageWriter('x' + os.path.splitext(os.fspath(path))[1]):
        raise InvalidOption(f'{path}: end its name in .png or .jpg')


def write_picture(path: Path, picture: np.ndarray) -> None:
    """:raises InvalidOption: as check_picture."""
    check_picture(path)
    path = os.fspath(path)
    write_whole(path, import_cv2().imencode(os.path.splitext(path)[1], picture)[1].tobytes())


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


def exif_orientation(data: bytes) -> int:
    """How a file's EXIF data say that the image is stored, 1 (upright) to 8; 1 if they tell nothing."""
    tiff = _exif(data)
    try:
        told = int(_numbers(tiff, struct.unpack_from('<I' if tiff[:1] == b'I' else '>I', tiff, 4)[0]).get(ORIENTATION, 1))
    except struct.error:
        return 1
    return told if 1 <= told <= 8 else 1


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
