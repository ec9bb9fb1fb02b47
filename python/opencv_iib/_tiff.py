"""Reads and writes pages of TIFF files, with the tags of GDAL and GeoTIFF, by tifffile."""
from __future__ import annotations

import io
import logging
from typing import Any, Callable, NamedTuple, Sequence

import numpy as np

from opencv_iib._exif import ASCII, PHOTOMETRIC, SHORT

DOUBLE = 12  # TIFF's type
# GeoTIFF's tags and their types: size of a pixel in metres, tie points of pixels and the Earth, or a matrix for both; keys of the coordinates.
PIXEL_SCALE, TIE_POINTS, TO_MODEL, *GEO_KEYS = 33550, 33922, 34264, 34735, 34736, 34737
GEO = {PIXEL_SCALE: DOUBLE, TIE_POINTS: DOUBLE, TO_MODEL: DOUBLE, **dict(zip(GEO_KEYS, (SHORT, DOUBLE, ASCII)))}
NO_DATA = 0xA481  # GDAL's
AS_STORED = 1, 2  # values of PHOTOMETRIC: grey, 0 is black; and RGB
LARGEST = 2**32 - 2**25  # bytes of a file with offsets of 32 bits
LARGEST_SIDE = 1 << 20  # pixels, as in cv2, since a small damaged file may claim any size
Decode = Callable[[bytes], np.ndarray]
Entry = tuple[int, int, Any]  #: of a TIFF directory: tag, type, and numbers or text


class Pages(NamedTuple):
    pages: Sequence[np.ndarray]  #: all of one shape: H x W, or with channels last, 3 or 4 of them BGR and alpha
    left_out: int = 0  #: how many have another shape or type; reduced pages and masks are not counted
    no_data: str = ''  #: GDAL's value of pixels without data, usually a number
    geo: Sequence[Entry] = ()  #: place on the Earth


def import_tifffile() -> Any:
    try:
        import tifffile  # type: ignore[import-not-found,unused-ignore]
    except ImportError:
        raise ValueError('there is no module tifffile, which this TIFF needs, if it is not damaged: pip install opencv-iib[tiff]') from None
    logging.getLogger('tifffile').setLevel(logging.CRITICAL)  # errors that matter are exceptions
    return tifffile


def read_tiff(data: bytes, decode: Decode, first_alone: bool = False) -> Pages:
    """The pages of a file. :param decode: cv2's reader of a first page, which knows more compressions and colours.
    :raises ValueError: for a damaged file, and without tifffile."""
    tifffile = import_tifffile()
    try:
        with tifffile.TiffFile(io.BytesIO(data)) as tiff:
            first = tiff.pages[0]
            whole = [first] if first_alone else [first, *(page for page in tiff.pages[1:] if not page.is_reduced and not page.is_mask)]
            read = [_page(page, data, decode) for page in whole]
            tags = [first.tags.get(tag) for tag in GEO]
            geo = [(tag.code, int(tag.dtype), tag.value if isinstance(tag.value, (str, tuple)) else (tag.value,)) for tag in tags if tag is not None]
            no_data = str(first.tags.valueof(NO_DATA, ''))
    except Exception as e:  # of many kinds
        raise ValueError(f'the image is damaged or cut off, or not one that tifffile reads: {e}') from None
    same = [page for page in read if page.shape == read[0].shape and page.dtype == read[0].dtype]
    right = all(kind == GEO[tag] and (kind == ASCII or np.isfinite(values).all()) for tag, kind, values in geo)
    return Pages(same, len(read) - len(same), no_data, geo if right else ())


def _page(page: Any, data: bytes, decode: Decode) -> np.ndarray:
    if not page.size or max(page.imagewidth, page.imagelength) > LARGEST_SIDE:
        raise ValueError(f'it has {page.imagewidth} x {page.imagelength} pixels')
    known_to_cv2 = page.samplesperpixel in (1, 3, 4)
    if not known_to_cv2 or (page.bitspersample in (8, 16, 32, 64) and (PHOTOMETRIC not in page.tags or page.photometric in AS_STORED)):
        try:  # first, since cv2 multiplies colours by their alpha
            image = page.asarray()
            return _other_order(np.moveaxis(image, 0, -1) if page.axes[:1] == 'S' else image, page.samplesperpixel)
        except Exception:  # of many kinds, also for compressions that need another module
            if not known_to_cv2:
                raise
    if page.index:  # cv2 decodes first pages only: make this one the first
        word = 8 if page.parent.is_bigtiff else 4
        data = data[:word] + page.offset.to_bytes(word, 'little' if page.parent.byteorder == '<' else 'big') + data[2 * word:]
    return decode(data)


def _other_order(image: np.ndarray, samples: int) -> np.ndarray:
    """RGB to BGR, or back."""
    return np.asarray(image[..., [2, 1, 0, 3][:samples]] if samples in (3, 4) else image)


def tiff_bytes(pages: Sequence[np.ndarray], no_data: str = '', geo: Sequence[Entry] = ()) -> bytes:
    """A lossless file of pages of any depth and channels, each with the tags of GDAL and GeoTIFF."""
    more = [*geo, *([(NO_DATA, ASCII, no_data)] if no_data else [])]
    content = io.BytesIO()
    with import_tifffile().TiffWriter(content, bigtiff=sum(page.nbytes for page in pages) > LARGEST) as writer:
        for page in pages:
            samples = (*page.shape, 1)[2]
            colours = 3 if samples in (3, 4) else 1
            extra = {} if samples == colours else {'extrasamples': [2 if samples in (2, 4) else 0] * (samples - colours)}
            writer.write(_other_order(page, samples), photometric='rgb' if colours == 3 else 'minisblack', compression='adobe_deflate',
                         compressionargs={'level': 1}, planarconfig=None if samples == 1 else 'contig', metadata=None, software=False,
                         extratags=[(tag, kind, len(values) + (kind == ASCII), values, False) for tag, kind, values in more], **extra)
    return content.getvalue()


def geo_of_part(entries: Sequence[Entry], x: int, y: int) -> list[Entry]:
    """The GeoTIFF entries for a part of the image that begins at this pixel."""
    def moved(tag: int, values: Any) -> Any:
        if tag == TIE_POINTS:
            return [value - (x, y, 0, 0, 0, 0)[n % 6] for n, value in enumerate(values)]
        if tag == TO_MODEL and len(values) == 16:
            return [value + (values[n - 3] * x + values[n - 2] * y if n % 4 == 3 else 0) for n, value in enumerate(values)]
        return values
    return [(tag, kind, moved(tag, values)) for tag, kind, values in entries]
