"""Reads and writes images of all formats."""
from __future__ import annotations

import contextlib
import os
from typing import Any, Optional, Sequence

import numpy as np

from opencv_iib._arguments import InvalidOption, Path, import_module
from opencv_iib._exif import TIFF, exif_orientation, is_cut_off, tiff_channels
from opencv_iib._files import write_whole
from opencv_iib._tiff import Entry, Pages, import_tifffile, read_tiff, tiff_bytes
from opencv_iib._orientation import BACK, upright

FORMATS = {'PNG': '.png', 'TIFF': '.tif', 'JPEG': '.jpg'}  #: formats that are written, and their suffixes
IMAGES = (*TIFF, b'\xff\xd8', b'\x89PNG', b'RIFF', b'BM', *(b'P%d' % kind for kind in range(1, 8)))


def import_cv2() -> Any:
    """cv2 of any package. :raises ImportError: saying what to install."""
    return import_module('cv2', 'images are read by cv2: pip install opencv-python, or opencv-python-headless without windows, or apt install '
                                'python3-opencv')


def decode(data: bytes, colour: bool = False) -> np.ndarray:
    """The image in a file's bytes, H x W or H x W x 3 (BGR), uint8, not rotated by EXIF, scaled from other depths.
    :raises ValueError: if it cannot be read, also for a JPEG without its end, which cv2 would fill with grey."""
    cv2, image = import_cv2(), None
    if not data.startswith(TIFF):
        image = _imdecode(data, (cv2.IMREAD_COLOR if colour else cv2.IMREAD_GRAYSCALE) | cv2.IMREAD_IGNORE_ORIENTATION | cv2.IMREAD_ANYDEPTH)
    if image is None or image.dtype != np.uint8:
        image = decode_first(data)
    return in_8_bits(image, colour)


def decode_first(data: bytes) -> np.ndarray:
    """The first page of a file, of its own depth: H x W, or with channels last, 3 or 4 of them BGR and alpha. :raises ValueError: as decode."""
    if not data.startswith(TIFF):
        return _unchanged(data)
    if tiff_channels(data) in (1, 3, 4):
        with contextlib.suppress(ValueError):
            return _unchanged(data)
    return read_tiff(data, _unchanged, first_alone=True).pages[0]


def decode_all(data: bytes) -> Pages:
    return read_tiff(data, _unchanged) if data.startswith(TIFF) else Pages([_unchanged(data)])


def _unchanged(data: bytes) -> np.ndarray:
    image = _imdecode(data, import_cv2().IMREAD_UNCHANGED)
    return upright(image, BACK[exif_orientation(data)]) if data.startswith(TIFF) else image  # cv2 rotates TIFF regardless of flags


def _imdecode(data: bytes, flags: int) -> np.ndarray:
    cv2 = import_cv2()
    if not data:
        raise ValueError('the file is empty')
    if is_cut_off(data):
        raise ValueError('the file is cut off: a JPEG without its end')
    try:
        image = cv2.imdecode(np.frombuffer(data, np.uint8), flags)
    except cv2.error as e:
        why = 'of more than 2^30 pixels' if 'MAX_IMAGE' in str(e) else str(e).splitlines()[0]
        raise ValueError(f'not an image that cv2 reads: {why}') from None
    if image is None:
        raise ValueError('the image is damaged or cut off' if data.startswith(IMAGES) else 'not an image that cv2 reads')
    return np.asarray(image)


def in_8_bits(image: np.ndarray, colour: bool) -> np.ndarray:
    """An image as it is described: H x W, or with `colour` H x W x 3, uint8. :raises ValueError: for one without finite numbers."""
    return _with_channels(_scaled(image), colour)


@np.errstate(invalid='ignore', over='ignore')  # for NaN, infinity, and limits that overflow
def _scaled(image: np.ndarray) -> np.ndarray:
    """Scales other types from their own range, without a few dead pixels; NaN becomes 0."""
    if image.dtype == np.uint8:
        return image
    if image.dtype.kind == 'f':
        image = image / 2  # so that differences do not overflow
    colours = image[..., :3] if image.ndim == 3 else image
    values = colours[np.isfinite(colours)]
    if not values.size:
        raise ValueError('the image holds no finite number')
    low, high = map(float, np.percentile(values[::1 + values.size // 1000000], (.01, 99.99)))
    if high > low:
        values = values[(values >= 2 * low - high) & (values <= 2 * high - low)]
    low, high = float(values.min()), float(values.max())
    return np.nan_to_num(np.rint((image - low) * (255 / ((high - low) or 1))).clip(0, 255)).astype(np.uint8)


def _with_channels(image: np.ndarray, colour: bool) -> np.ndarray:
    """H x W, or with colour H x W x 3, from any number of channels."""
    cv2, channels = import_cv2(), image.shape[2] if image.ndim == 3 else 1
    if channels in (3, 4):
        return image[..., :3] if colour else cv2.cvtColor(image[..., :3], cv2.COLOR_BGR2GRAY)
    grey = image if image.ndim == 2 else np.ascontiguousarray(image[..., 0])
    if channels > 4:  # spectral bands
        grey = np.rint(image.mean(axis=2)).astype(np.uint8)
    return cv2.cvtColor(grey, cv2.COLOR_GRAY2BGR) if colour else grey


TIFFS = ('.tif', '.tiff')


def check_picture(path: Path) -> None:
    """:raises InvalidOption: for a suffix that cv2 cannot write."""
    cv2, suffix = import_cv2(), os.path.splitext(os.fspath(path))[1].lower()
    if suffix in TIFFS:
        import_tifffile()
        return
    with contextlib.suppress(cv2.error):
        if cv2.haveImageWriter('x' + suffix) and cv2.imencode(suffix, np.zeros((64, 64, 3), np.uint8))[0]:
            return
    raise InvalidOption(f'{path}: end its name in .png or .jpg')


def write_picture(path: Path, picture: np.ndarray, *pages: np.ndarray, no_data: str = '', geo: Sequence[Entry] = ()) -> None:
    """Writes an image, laid out as by decode_first, in the format of the suffix.
    :param pages: further ones, of a TIFF.
    :param no_data: of a TIFF, as in Pages; so is `geo`.
    :raises InvalidOption: as check_picture.
    :raises ValueError: for an image that the format cannot hold, and for TIFF without tifffile."""
    check_picture(path)
    path, suffix = os.fspath(path), os.path.splitext(path)[1].lower()
    if suffix in TIFFS:
        write_whole(path, tiff_bytes([picture, *pages], no_data, geo))
    elif pages or not holds(suffix, picture):
        raise ValueError(f'{suffix[1:].upper()} cannot hold {1 + len(pages)} x {" x ".join(map(str, picture.shape))} of {picture.dtype}: take TIFF')
    else:
        write_whole(path, import_cv2().imencode(suffix, picture)[1].tobytes())


def reduced(image: np.ndarray, max_size: int) -> np.ndarray:
    """An image reduced to this longer side; 0, or a smaller image: as it is."""
    longer = max(image.shape[:2])
    if not 0 < max_size < longer:
        return image
    cv2, size = import_cv2(), [max(1, round(side * max_size / longer)) for side in image.shape[1::-1]]
    return np.asarray(cv2.resize(image, size, interpolation=cv2.INTER_AREA))


def resized_mask(mask: Optional[np.ndarray], image: np.ndarray) -> Optional[np.ndarray]:
    """A mask in the size of a reduced image; None without one."""
    if mask is None or mask.shape == image.shape[:2]:
        return mask
    cv2 = import_cv2()
    return np.asarray(cv2.resize(mask, image.shape[1::-1], interpolation=cv2.INTER_NEAREST))


def can_be(text: str, dtype: np.dtype) -> bool:
    """Whether pixels of this type can have a value: uint8 cannot be -9999."""
    try:
        value = float(text)
    except ValueError:
        return False
    if dtype.kind == 'f':
        return bool(np.isnan(value) or abs(value) <= np.finfo(dtype).max)
    return value.is_integer() and np.iinfo(dtype).min <= value <= np.iinfo(dtype).max


def holds(suffix: str, picture: np.ndarray) -> bool:
    """Whether files of a suffix can hold a picture of one page without loss of depth or channels."""
    depths = {'.png': (np.uint8, np.uint16), '.tif': (picture.dtype,)}.get(suffix, (np.uint8,))
    channels = {'.png': (1, 3, 4), '.tif': picture.shape[2:]}.get(suffix, (1, 3))
    return picture.dtype in depths and (picture.ndim == 2 or picture.shape[2] in channels)
