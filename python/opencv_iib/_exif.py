"""What the heads of image files say: EXIF data, segments of JPEG."""
from __future__ import annotations

import contextlib
import struct
from typing import Any, Iterator, Optional

import numpy as np

from opencv_iib._files import read_bytes

# Numbers of TIFF's and EXIF's tags.
PHOTOMETRIC, SAMPLES, ORIENTATION = 0x0106, 0x0115, 0x0112
EXIF_IFD, FOCAL_LENGTH, FOCAL_LENGTH_35MM, PLANE_X_RESOLUTION, PLANE_UNIT = 0x8769, 0x920A, 0xA405, 0xA20E, 0xA210
MILLIMETRES = {2: 25.4, 3: 10.0, 4: 1.0, 5: 0.001}  # of EXIF's units of resolution
NOWHERE = 2**32 - 1  #: of a directory: behind the end of any file
GPS_IFD, LATITUDE_REF, LATITUDE, LONGITUDE_REF, LONGITUDE, ALTITUDE_REF, ALTITUDE = 0x8825, 1, 2, 3, 4, 5, 6
EARTH = 6371000  # metres, the radius
BYTE, ASCII, SHORT, LONG, RATIONAL, DOUBLE, LONG8, IFD8 = 1, 2, 3, 4, 5, 12, 16, 18  # TIFF's types, the last two of files of 64 bits
MIRRORED = 2, 4, 5, 7  #: EXIF's orientations of images that are stored mirrored
START_OF_SCAN, APP1 = 0xda, 0xe1  # JPEG's markers
TIFF = (b'II*\0', b'MM\0*', b'II+\0', b'MM\0+')  # how files begin; the last two have places of 64 bits


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


def is_cut_off(data: bytes) -> bool:
    """Whether the file is a JPEG without its end. A thumbnail within a segment has an end of its own."""
    return any(marker == START_OF_SCAN and data.find(b'\xff\xd9', begin) < 0 for marker, begin, _ in _jpeg_segments(data))


def _exif(data: bytes) -> bytes:
    """The TIFF structure of a file's EXIF data, in JPEG, PNG, WebP or TIFF; empty without any."""
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


def _order(tiff: bytes) -> str:
    """Of its bytes, as struct names it."""
    return '<' if tiff[:1] == b'I' else '>'


def _directory(tiff: bytes, at: int) -> dict[int, Any]:
    """By tag, the finite numbers or the text of each entry of a TIFF directory.

    :raises struct.error: for one that is cut off.
    """
    order = _order(tiff)
    counted, word, room = ('Q', 'Q', 8) if tiff[:4] in TIFF[2:] else ('H', 'I', 4)
    count, first = _unpacked(order + counted, tiff, at)[0], at + struct.calcsize(order + counted)
    end = first + (4 + 2 * room) * count
    found: dict[int, Any] = {}
    for entry in range(first, end, 4 + 2 * room):
        tag, kind, length = struct.unpack_from(order + 'HH' + word, tiff, entry)
        form = {BYTE: f'{length}B', ASCII: f'{length}s', SHORT: f'{length}H', LONG: f'{length}I', RATIONAL: f'{2 * length}I', DOUBLE: f'{length}d',
                LONG8: f'{length}Q', IFD8: f'{length}Q'}.get(kind)
        with contextlib.suppress(struct.error):  # of an entry that leads nowhere
            if form is not None and length:
                size = struct.calcsize(order + form)
                place, = (entry + 4 + room,) if size <= room else struct.unpack_from(order + word, tiff, entry + 4 + room)
                values: Any = _unpacked(order + form, tiff, place)
                if kind == RATIONAL:
                    values = [above / below if below else 0 for above, below in zip(values[::2], values[1::2])]
                if kind != DOUBLE or np.isfinite(values).all():
                    found[tag] = values[0].split(b'\0')[0].decode('latin-1').strip() if kind == ASCII else values
    return found


def _unpacked(form: str, tiff: bytes, place: int) -> tuple[Any, ...]:
    """:raises struct.error: also for a place that no computer has."""
    return struct.unpack_from(form, tiff, place if 0 <= place < len(tiff) else len(tiff))


def _first_directory(tiff: bytes) -> dict[int, Any]:
    """:raises struct.error: if there is none."""
    word, at = ('Q', 8) if tiff[:4] in TIFF[2:] else ('I', 4)
    return _directory(tiff, struct.unpack_from(_order(tiff) + word, tiff, at)[0])


def _number(entries: dict[int, Any], tag: int, default: float) -> float:
    """The first one of an entry; the default where there is none, or a text that some program wrote there."""
    values = entries.get(tag, '')
    return default if isinstance(values, str) else values[0]


def tiff_channels(data: bytes) -> int:
    """Of a TIFF's first page; 0 if nothing says what they mean."""
    with contextlib.suppress(struct.error):
        entries = _first_directory(data)
        return int(_number(entries, SAMPLES, 1)) if PHOTOMETRIC in entries else 0
    return 0


def exif_orientation(data: bytes) -> int:
    """How a file's EXIF data say that the image is stored, 1 (upright) to 8; 1 if they tell nothing."""
    try:
        told = int(_number(_first_directory(_exif(data)), ORIENTATION, 1))
    except struct.error:
        return 1
    return told if 1 <= told <= 8 else 1


def exif_focal_length(data: bytes, width: int, height: int) -> Optional[float]:
    """Focal length in pixels by a file's EXIF data, by COLMAP's rules; None if they tell none."""
    tiff = _exif(data)
    try:
        entries = _directory(tiff, int(_number(_first_directory(tiff), EXIF_IFD, NOWHERE)))
    except struct.error:
        return None
    exif: dict[int, float] = {tag: values[0] for tag, values in entries.items() if not isinstance(values, str)}
    pixels = exif.get(FOCAL_LENGTH_35MM, 0) / 35.0 * max(width, height)
    if not pixels > 0:
        pixels = exif.get(FOCAL_LENGTH, 0) * exif.get(PLANE_X_RESOLUTION, 0) / MILLIMETRES.get(int(exif.get(PLANE_UNIT, 2)), 25.4)
    return pixels if 0 < pixels < 1e9 else None


def gps_place(path: str) -> Optional[np.ndarray]:
    """Where a file's EXIF data say that it was taken, metres: on the Earth's sphere from its centre, and the height (NaN where they tell none);
    None if they do not, or say 0, 0, which cameras without a signal write."""
    try:
        tiff = _exif(read_bytes(path))
        gps = _directory(tiff, int(_number(_first_directory(tiff), GPS_IFD, NOWHERE)))
        latitude, longitude = (np.radians(np.dot(gps[tag], (1, 1 / 60, 1 / 3600)) * (-1 if gps.get(ref) in ('S', 'W') else 1))
                               for tag, ref in ((LATITUDE, LATITUDE_REF), (LONGITUDE, LONGITUDE_REF)))
        height = _number(gps, ALTITUDE, np.nan) * (-1 if _number(gps, ALTITUDE_REF, 0) == 1 else 1)
    except (struct.error, KeyError, TypeError, ValueError, OSError):
        return None
    if not (latitude or longitude):
        return None
    return EARTH * np.array([np.cos(latitude) * np.cos(longitude), np.cos(latitude) * np.sin(longitude), np.sin(latitude), height / EARTH])
