"""Image files: which there are, what is read of them, and masks; and how pictures are written."""
from __future__ import annotations

import contextlib
import hashlib
import io
import os
import re
import struct
import zlib
from typing import Any, Iterable, NoReturn, Optional, Sequence, Union

import numpy as np

from opencv_iib._arguments import InvalidOption, MissingFile, Path
from opencv_iib._exif import ASCII, LONG, NO_DATA, SAMPLES, SHORT, TIFF, Entry, begin_at, exif_orientation, is_cut_off, packed, pages_of_tiff
from opencv_iib._files import read_bytes, write_whole

SUFFIXES = ('.jpg', '.jpeg', '.png', '.tif', '.tiff', '.bmp', '.webp', '.ppm', '.pgm')
FORMATS = {'PNG': '.png', 'TIFF': '.tif', 'JPEG': '.jpg'}  #: that pictures are written in, and their suffixes
IMAGES = (*TIFF, b'\xff\xd8', b'\x89PNG', b'RIFF', b'BM', *(b'P%d' % kind for kind in range(1, 8)))


def find_images(folder: Path) -> list[str]:
    """Paths of images below `folder`, relative to it, with '/', in_order: COLMAP's names.

    :raises OSError: for a folder that cannot be read.
    """
    def fail(why: OSError) -> NoReturn:
        raise type(why)(f'{why.filename} cannot be read: {why.strerror}')

    names = []
    for root, _, files in os.walk(folder, onerror=fail):
        for file in files:
            if file.lower().endswith(SUFFIXES):
                names.append(os.path.relpath(os.path.join(root, file), folder).replace(os.sep, '/'))
    return sorted(names, key=in_order)


def in_order(name: str) -> tuple[list[tuple[int, str]], str]:
    """A key to sort names by as people do: 2 before 10, and b before C."""
    return [(int(part), '') if n % 2 else (-1, part) for n, part in enumerate(re.split('([0-9]+)', name.lower()))], name


def stamp(path: str) -> str:
    """Of a file's content, whatever its time; '' of a file that cannot be read."""
    with contextlib.suppress(OSError, ValueError):
        return hashlib.blake2b(read_bytes(path), digest_size=16).hexdigest()
    return ''


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
    cv2, image = import_cv2(), None
    _check(data)
    mode = (cv2.IMREAD_COLOR if colour else cv2.IMREAD_GRAYSCALE) | cv2.IMREAD_IGNORE_ORIENTATION | cv2.IMREAD_ANYDEPTH
    # What is not of 8 bits as the file has it. Of TIFF first, where cv2 gives floats in no other way, and prints of that.
    if data.startswith(TIFF):
        image = decode_pages(data, first_alone=True)[0]
    if image is None or (image.dtype == np.uint8 and image.shape[2:] < (5,)):
        image = _imdecode(data, mode)
    if image.dtype != np.uint8 and not data.startswith(TIFF):
        image = _imdecode(data, cv2.IMREAD_UNCHANGED)
    return in_8_bits(image, colour)


def decode_pages(data: bytes, first_alone: bool = False) -> list[np.ndarray]:
    """As a file has it: H x W, or with the channels last, BGR and alpha where they are 3 or 4; of a TIFF all pages of one shape.

    :raises ValueError: as _decode.
    """
    cv2 = import_cv2()
    _check(data)
    places, samples = pages_of_tiff(data)
    if samples not in (1, 3, 4):
        read = _by_tifffile(data, samples)
    elif len(places) < 2 or first_alone:
        return [_imdecode(data, cv2.IMREAD_UNCHANGED)]
    else:  # cv2 reads pages of files alone, and of no name that is not in the system's letters
        content, read = bytearray(data), []
        for place in places:
            begin_at(content, place)
            read.append(_imdecode(content, cv2.IMREAD_UNCHANGED))
    return [page for page in read if page.shape == read[0].shape and page.dtype == read[0].dtype]  # not thumbnails


def _by_tifffile(data: bytes, samples: int) -> list[np.ndarray]:
    try:
        import tifffile  # type: ignore[import-not-found,unused-ignore]
    except ImportError:
        raise ValueError(f'a TIFF of {samples} channels, which cv2 cannot read: pip install tifffile, or store each as a page') from None
    try:
        with tifffile.TiffFile(io.BytesIO(data)) as tiff:
            read = [page.asarray() for page in tiff.pages]
    except Exception as e:  # of many kinds
        raise ValueError(f'not an image that tifffile reads: {e}') from None
    if not read:
        raise ValueError('the image is damaged or cut off')
    return [page if page.shape[0] != samples else np.moveaxis(page, 0, 2) for page in read]


def _check(data: bytes) -> None:
    if not data:
        raise ValueError('the file is empty')
    if is_cut_off(data):
        raise ValueError('the file is cut off: a JPEG without its end')


def _imdecode(data: Union[bytes, bytearray], flags: int) -> np.ndarray:
    cv2 = import_cv2()
    try:
        image = cv2.imdecode(np.frombuffer(data, np.uint8), flags)
    except cv2.error as e:
        why = 'of more than 2^30 pixels' if 'MAX_IMAGE' in str(e) else str(e).splitlines()[0]
        raise ValueError(f'not an image that cv2 reads: {why}') from None
    if image is None:
        raise ValueError('the image is damaged or cut off' if data.startswith(IMAGES) else 'not an image that cv2 reads')
    return np.asarray(image)


def in_8_bits(image: np.ndarray, colour: bool) -> np.ndarray:
    """What is described of an image as its file has it: H x W, or with `colour` H x W x 3, uint8; of other numbers by their own range.

    :raises ValueError: for one without a finite number.
    """
    return _with_channels(_scaled(image), colour)


def _scaled(image: np.ndarray) -> np.ndarray:
    """Other numbers scaled from their own range, of which a few dead pixels are no part; NaN becomes 0."""
    if image.dtype == np.uint8:
        return image
    if image.dtype.kind == 'f':
        image = image / 2  # so that no difference is beyond the largest number
    colours = image[..., :3] if image.ndim == 3 else image
    values = colours[np.isfinite(colours)]
    if not values.size:
        raise ValueError('the image holds no finite number')
    with np.errstate(invalid='ignore', over='ignore'):  # of infinity, and of limits beyond the largest number
        low, high = map(float, np.percentile(values[::1 + values.size // 1000000], (.01, 99.99)))
        if high > low:
            values = values[(values >= 2 * low - high) & (values <= 2 * high - low)]
        low, high = float(values.min()), float(values.max())
        return np.nan_to_num(np.rint((image - low) * (255 / ((high - low) or 1))).clip(0, 255)).astype(np.uint8)


def _with_channels(image: np.ndarray, colour: bool) -> np.ndarray:
    """H x W, or with colour H x W x 3, of as many as there are."""
    cv2, channels = import_cv2(), image.shape[2] if image.ndim == 3 else 1
    if channels in (3, 4):
        return image[..., :3] if colour else cv2.cvtColor(image[..., :3], cv2.COLOR_BGR2GRAY)
    grey = image if image.ndim == 2 else np.ascontiguousarray(image[..., 0])
    if channels > 4:  # of bands, all together
        grey = np.rint(image.mean(axis=2)).astype(np.uint8)
    return cv2.cvtColor(grey, cv2.COLOR_GRAY2BGR) if colour else grey


class Masks:
    """Which pixels of images are described: those that are not 0 in masks by COLMAP's names, ``more/a.jpg.png`` in their folder for the
    image more/a.jpg. An image without one is described as a whole."""

    def __init__(self, path: Optional[Path]) -> None:
        """:param path: folder, or a file for all images; None: no masks.
        :raises MissingFile: if there is nothing."""
        self.path = None if path is None else os.fspath(path)
        if self.path is not None and not os.path.exists(self.path):
            raise MissingFile(f'there is no mask {self.path}')

    def file(self, name: str) -> str:
        """Of an image's mask, if there is one; else ''."""
        if self.path is None or not os.path.isdir(self.path):
            return self.path or ''
        path = os.path.join(self.path, name + '.png')
        return path if os.path.exists(path) else ''

    def stamp(self, path: str, name: str) -> str:
        """Of an image's file and that of its mask, as :func:`stamp`."""
        return ' '.join(map(stamp, filter(None, (path, self.file(name)))))

    def check(self, names: Iterable[str]) -> list[str]:
        """:return: the files of the images' masks.
        :raises InvalidOption: for a folder without a mask of any image."""
        names = list(names)
        files = list(filter(None, map(self.file, names)))
        if self.path is not None and not files:
            raise InvalidOption(f'{self.path} has no mask of any image: that of {names[0]} would be {names[0]}.png')
        return files

    def of(self, name: str, image: np.ndarray) -> Optional[np.ndarray]:
        """:raises ValueError: for a mask of another size than the image."""
        path = self.file(name)
        if not path:
            return None
        try:
            mask = decode_pages(read_bytes(path), first_alone=True)[0]
        except ValueError as e:
            raise ValueError(f'its mask {path}: {e}') from None
        mask = (mask if mask.ndim == 2 else mask[..., :3].any(axis=2)).astype(bool).astype(np.uint8)
        if mask.shape != image.shape[:2]:
            raise ValueError(f'its mask {path} has {mask.shape[1]} x {mask.shape[0]} pixels, and the image {image.shape[1]} x {image.shape[0]}')
        return mask


def check_sizes(folder: Path, names: Sequence[str], masks: Masks, camera: Any) -> None:
    """Of what was given for all images: masks and a camera, if there is one.

    :raises InvalidOption: if images can be read, but none is of these sizes.
    """
    why = ''
    for name in names if camera is not None or masks.path is not None else ():
        with contextlib.suppress(ValueError, OSError):
            image = read_grey(os.path.join(folder, name))
            height, width = image.shape
            try:
                if camera is None or (camera.width, camera.height) == (width, height):
                    masks.of(name, image)
                    return
                why = why or f'{name}: its camera has {camera.width} x {camera.height} pixels, and the image {width} x {height}'
            except ValueError as e:
                why = why or f'{name}: {e}'
    if why:
        raise InvalidOption(f"{why}, and so it is with all others: give the images' own")


def check_picture(path: Path) -> None:
    """:raises InvalidOption: for a suffix of no format in which cv2 writes pictures of three channels."""
    cv2 = import_cv2()
    with contextlib.suppress(cv2.error):
        if cv2.imencode(os.path.splitext(os.fspath(path))[1], np.zeros((64, 64, 3), np.uint8))[0]:
            return
    raise InvalidOption(f'{path}: end its name in .png or .jpg')


def write_picture(path: Path, picture: np.ndarray, *pages: np.ndarray, no_data: str = '', geo: Sequence[Entry] = ()) -> None:
    """An image as decode_pages gives it, by the suffix of the name.

    :param pages: of a TIFF, further ones.
    :param no_data: of a TIFF, what GDAL_NODATA tells.
    :param geo: of a TIFF, as geo_entries gives them.
    :raises InvalidOption: as check_picture.
    :raises ValueError: for what the format cannot hold.
    """
    check_picture(path)
    path = os.fspath(path)
    suffix = os.path.splitext(path)[1].lower()
    if suffix in ('.tif', '.tiff'):
        write_whole(path, _tiff([picture, *pages], [*geo, *([(NO_DATA, ASCII, no_data)] if no_data else [])]))
    elif pages or not holds(suffix, picture):
        raise ValueError(f'{suffix[1:].upper()} cannot hold {1 + len(pages)} x {" x ".join(map(str, picture.shape))} of {picture.dtype}: take TIFF')
    else:
        write_whole(path, import_cv2().imencode(suffix, picture)[1].tobytes())


def can_be(text: str, dtype: np.dtype) -> bool:
    """Whether a pixel of this type can have a value: -9999 is none of 8 bits without a sign."""
    value = float(text)
    if dtype.kind == 'f':
        return bool(np.isnan(value) or abs(value) <= np.finfo(dtype).max)
    return value.is_integer() and np.iinfo(dtype).min <= value <= np.iinfo(dtype).max


def holds(suffix: str, picture: np.ndarray) -> bool:
    """Whether files of a suffix keep all of a picture of one page."""
    depths = {'.png': (np.uint8, np.uint16), '.tif': (picture.dtype,)}.get(suffix, (np.uint8,))
    channels = {'.png': (1, 3, 4), '.tif': picture.shape[2:]}.get(suffix, (1, 3))
    return picture.dtype in depths and (picture.ndim == 2 or picture.shape[2] in channels)


STRIP = 1 << 18  # bytes that are compressed together


def _tiff(pages: Sequence[np.ndarray], more: Sequence[Entry]) -> bytes:
    """Without loss, of any depth and channels: what cv2 writes loses some of floats, and is of 4 channels at most.

    :param more: entries of each page, by their tags."""
    content = bytearray(b'II*\0\0\0\0\0')
    link = 4  # where the place of the next directory stands
    for page in pages:
        height, width, samples = (*page.shape, 1)[:3]
        if samples in (3, 4):
            page = page[..., [2, 1, 0, 3][:samples]]
        rows = max(1, STRIP // (page[0].nbytes or 1))
        strips = [zlib.compress(np.ascontiguousarray(page[at:at + rows], page.dtype.newbyteorder('<')).tobytes(), 1)
                  for at in range(0, height, rows)]
        begins = np.cumsum([len(content), *map(len, strips)]).tolist()
        content += b''.join(strips)
        kind = {'u': 1, 'i': 2, 'f': 3}[page.dtype.kind]
        colours = 3 if samples in (3, 4) else 1
        entries: list[Entry] = [
            (256, LONG, [width]), (257, LONG, [height]), (258, SHORT, [page.dtype.itemsize * 8] * samples), (259, SHORT, [8]),
            (262, SHORT, [2 if colours == 3 else 1]), (273, LONG, begins[:-1]), (SAMPLES, SHORT, [samples]), (278, LONG, [rows]),
            (279, LONG, list(map(len, strips))), (339, SHORT, [kind] * samples)]
        if samples > colours:
            entries.insert(-1, (338, SHORT, [2 if samples in (2, 4) else 0] * (samples - colours)))
        entries += more
        directory = struct.pack('<H', len(entries))
        for tag, kind, values in entries:
            value = packed(kind, values)
            content += bytes(len(content) % 2)
            count = len(value) if kind == ASCII else len(values)
            if len(value) > 4:
                content += value
                value = struct.pack('<I', len(content) - len(value))
            directory += struct.pack('<HHI', tag, kind, count) + value.ljust(4, b'\0')
        content += bytes(len(content) % 2)
        struct.pack_into('<I', content, link, len(content))
        link = len(content) + len(directory)
        content += directory + bytes(4)
    return bytes(content)
