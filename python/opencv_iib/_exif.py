"""EXIF data of image files, and segments of JPEG."""
from __future__ import annotations

import contextlib
import struct
from typing import Any, Iterator, Optional

import numpy as np

# Numbers of TIFF's and EXIF's tags.
PHOTOMETRIC, SAMPLES, ORIENTATION = 0x0106, 0x0115, 0x0112
EXIF_IFD, FOCAL_LENGTH, FOCAL_LENGTH_35MM, PLANE_X_RESOLUTION, PLANE_UNIT = 0x8769, 0x920A, 0xA405, 0xA20E, 0xA210
MILLIMETRES = {2: 25.4, 3: 10.0, 4: 1.0, 5: 0.001}  # of EXIF's units of resolution
GPS_IFD, LATITUDE_REF, LATITUDE, LONGITUDE_REF, LONGITUDE, ALTITUDE_REF, ALTITUDE = 0x8825, 1, 2, 3, 4, 5, 6
EARTH = 6371000  # metres, the radius
ASCII, SHORT, RATIONAL = 2, 3, 5  # TIFF's types
FORMS = {1: 'B', ASCII: 's', SHORT: 'H', 4: 'I', RATIONAL: 'II', 16: 'Q', 18: 'Q'}  #: of a value, by the type; as in struct
MIRRORED = 2, 4, 5, 7  #: EXIF's orientations of images that are stored mirrored
START_OF_SCAN, APP1 = 0xda, 0xe1  # JPEG's markers
TIFF = (b'II*\0', b'MM\0*', b'II+\0', b'MM\0+')  #: first bytes of TIFF files; the last two have offsets of 64 bits


def _jpeg_segments(data: bytes) -> Iterator[tuple[int, int, int]]:
    """Marker, begin and end of each segment of a JPEG, up to its image data; nothing for other files."""
    at = 2 if data.startswith(b'\xff\xd8') else len(data)
    while data[at:at + 1] == b'\xff' and at + 4 <= len(data):
        marker = data[at + 1]
        if marker == 0xff:  # padding
            at += 1
            continue
        end = at + 2 + int.from_bytes(data[at + 2:at + 4], 'big')
        yield marker, at + 4, end
        if marker == START_OF_SCAN:
            return
        at = end


def is_cut_off(data: bytes) -> bool:
    """Whether the file is a JPEG without its end. Thumbnails in segments have ends of their own."""
    return any(marker == START_OF_SCAN and data.find(b'\xff\xd9', begin) < 0 for marker, begin, _ in _jpeg_segments(data))


def _exif(data: bytes) -> bytes:
    """The TIFF structure of the EXIF data of a JPEG, PNG, WebP or TIFF file; empty without any."""
    if data[:4] in TIFF:
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


def _directory(tiff: bytes, pointer: int = 0) -> dict[int, Any]:
    """The entries of the first directory of a TIFF, or of the directory that its entry `pointer` leads to, by their tags: a list of
    numbers, or a text. Empty for a damaged directory."""
    order, (counted, word, room) = '<' if tiff[:1] == b'I' else '>', ('Q', 'Q', 8) if tiff[:4] in TIFF[2:] else ('H', 'I', 4)

    def unpacked(form: str, at: int) -> tuple[Any, ...]:
        return struct.unpack_from(order + form, tiff, at if 0 <= at < len(tiff) else len(tiff))  # which has no integers without limit

    found: dict[int, Any] = {}
    try:
        at = int(_number(_directory(tiff), pointer, -1)) if pointer else unpacked(word, room)[0]
        count, first = unpacked(counted, at)[0], at + struct.calcsize(order + counted)
        for entry in range(first, first + (4 + 2 * room) * count, 4 + 2 * room):
            tag, kind, length = struct.unpack_from(order + 'HH' + word, tiff, entry)
            with contextlib.suppress(struct.error, KeyError):  # a value beyond the file, or of another type
                form = f'{length * len(FORMS[kind])}{FORMS[kind][0]}'
                values: Any = unpacked(form, entry + 4 + room if struct.calcsize(order + form) <= room else unpacked(word, entry + 4 + room)[0])
                if kind == RATIONAL:
                    values = [above / below if below else 0 for above, below in zip(values[::2], values[1::2])]
                if length:
                    found[tag] = values[0].split(b'\0')[0].decode('latin-1').strip() if kind == ASCII else values
    except struct.error:
        return {}
    return found


def _number(entries: dict[int, Any], tag: int, default: float) -> float:
    """The first number of an entry; the default without one, and for a text."""
    values = entries.get(tag, '')
    return default if isinstance(values, str) else values[0]


def tiff_channels(data: bytes) -> int:
    """The channels of a TIFF's first page; 0 if their meaning is not known."""
    entries = _directory(data)
    return int(_number(entries, SAMPLES, 1)) if PHOTOMETRIC in entries else 0


def exif_orientation(data: bytes) -> int:
    """EXIF's orientation of an image file, 1 (upright) to 8; 1 without one."""
    value = int(_number(_directory(_exif(data)), ORIENTATION, 1))
    return value if 1 <= value <= 8 else 1


def exif_focal_length(data: bytes, width: int, height: int) -> Optional[float]:
    """Focal length in pixels by an image file's EXIF data and COLMAP's rules; None without one."""
    entries = _directory(_exif(data), EXIF_IFD)
    pixels = _number(entries, FOCAL_LENGTH_35MM, 0) / 35.0 * max(width, height)
    if not pixels > 0:
        unit = MILLIMETRES.get(int(_number(entries, PLANE_UNIT, 2)), 25.4)
        pixels = _number(entries, FOCAL_LENGTH, 0) * _number(entries, PLANE_X_RESOLUTION, 0) / unit
    return pixels if 0 < pixels < 1e9 else None


def gps_place(data: bytes) -> Optional[np.ndarray]:
    """The place of an image file's EXIF data in metres: on the Earth's sphere from its centre, and the height (NaN without one). None without a
    place, and for 0, 0, which cameras without a signal write."""
    try:
        gps = _directory(_exif(data), GPS_IFD)
        latitude, longitude = (np.radians(np.dot(gps[tag], (1, 1 / 60, 1 / 3600)) * (-1 if gps.get(ref) in ('S', 'W') else 1))
                               for tag, ref in ((LATITUDE, LATITUDE_REF), (LONGITUDE, LONGITUDE_REF)))
    except (KeyError, TypeError, ValueError):
        return None
    height = _number(gps, ALTITUDE, np.nan) * (-1 if _number(gps, ALTITUDE_REF, 0) == 1 else 1)
    if not (latitude or longitude):
        return None
    return EARTH * np.array([np.cos(latitude) * np.cos(longitude), np.cos(latitude) * np.sin(longitude), np.sin(latitude), height / EARTH])
