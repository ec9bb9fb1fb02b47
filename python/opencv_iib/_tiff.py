"""TIFF files by tifffile: their pages, what GDAL and GeoTIFF say of these, and how they are written."""
from __future__ import annotations

import io
import logging
from typing import Any, Callable, NamedTuple, Sequence

import numpy as np

from opencv_iib._exif import ASCII, DOUBLE, PHOTOMETRIC, SHORT

# GeoTIFF's tags: metres of a pixel, pixels and where they are on the Earth, or a matrix for both; the keys of its coordinates; and their types.
PIXEL_SCALE, TIE_POINTS, TO_MODEL, *GEO_KEYS = 33550, 33922, 34264, 34735, 34736, 34737
GEO = {PIXEL_SCALE: DOUBLE, TIE_POINTS: DOUBLE, TO_MODEL: DOUBLE, **dict(zip(GEO_KEYS, (SHORT, DOUBLE, ASCII)))}
NO_DATA = 0xA481  # GDAL's
AS_STORED = 1, 2  # by PHOTOMETRIC: grey from black on, and RGB
LARGEST = 2**32 - 2**25  # bytes of a file whose places have 32 bits
LARGEST_SIDE = 1 << 20  # as of cv2: a damaged file of 2 kB may say that it has more
Decode = Callable[[bytes], np.ndarray]
Entry = tuple[int, int, Any]  #: of a TIFF directory: tag, type, and numbers or text


class Pages(NamedTuple):
    """What a file shows."""

    pages: Sequence[np.ndarray]  #: all of one shape: H x W, or with the channels last, BGR and alpha where they are 3 or 4
    left_out: int = 0  #: pages of another shape or type, beside those that say that they are reduced or a mask
    no_data: str = ''  #: what GDAL has written of the value of pixels without data, a number if it is right
    geo: Sequence[Entry] = ()  #: where the pixels are on the Earth


def import_tifffile() -> Any:
    """:raises ValueError: without it."""
    try:
        import tifffile  # type: ignore[import-not-found,unused-ignore]
    except ImportError:
        raise ValueError('there is no module tifffile, which this TIFF needs, if it is not damaged: pip install opencv-iib[tiff]') from None
    logging.getLogger('tifffile').setLevel(logging.CRITICAL)  # what matters of it comes as an exception
    return tifffile


def read_tiff(data: bytes, decode: Decode, first_alone: bool = False) -> Pages:
    """Of a file.

    :param decode: cv2's reader, of the first page: it knows more kinds of compression and colours.
    :raises ValueError: saying what is wrong with it, also without tifffile.
    """
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
        try:  # cv2 multiplies colours by their alpha
            image = page.asarray()
            return _other_order(np.moveaxis(image, 0, -1) if page.axes[:1] == 'S' else image, page.samplesperpixel)
        except Exception:  # of many kinds, also for a compression that needs more than tifffile
            if not known_to_cv2:
                raise
    if page.index:  # cv2 reads pages of files alone, and of no name that is not in the system's letters
        word = 8 if page.parent.is_bigtiff else 4
        data = data[:word] + page.offset.to_bytes(word, 'little' if page.parent.byteorder == '<' else 'big') + data[2 * word:]
    return decode(data)


def _other_order(image: np.ndarray, samples: int) -> np.ndarray:
    """From RGB to BGR, or back."""
    return np.asarray(image[..., [2, 1, 0, 3][:samples]] if samples in (3, 4) else image)


def tiff_bytes(pages: Sequence[np.ndarray], no_data: str = '', geo: Sequence[Entry] = ()) -> bytes:
    """A file of these pages, without loss, of any depth and channels; each with what GDAL and GeoTIFF say."""
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
    """The same of a part of the image that begins at this pixel."""
    def moved(tag: int, values: Any) -> Any:
        if tag == TIE_POINTS:
            return [value - (x, y, 0, 0, 0, 0)[n % 6] for n, value in enumerate(values)]
        if tag == TO_MODEL and len(values) == 16:
            return [value + (values[n - 3] * x + values[n - 2] * y if n % 4 == 3 else 0) for n, value in enumerate(values)]
        return values
    return [(tag, kind, moved(tag, values)) for tag, kind, values in entries]
