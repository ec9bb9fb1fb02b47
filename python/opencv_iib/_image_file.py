"""An image's file, and which of its pixels are described."""
from __future__ import annotations

import contextlib
import functools
import os
from typing import Any, Iterable, Optional, Sequence

import numpy as np
from numpy.typing import NDArray

from opencv_iib._arguments import InvalidOption, MissingFile, Path
from opencv_iib._exif import MIRRORED, TIFF, exif_orientation
from opencv_iib._files import read_bytes
from opencv_iib._images import decode, decode_all, decode_first, reduced, resized_mask, stamp
from opencv_iib._tiff import Pages


class ImageFile:
    """An image's file, which is read once. Pixels are as it has them, not turned as EXIF may ask. All raise ValueError for one that is damaged."""

    def __init__(self, path: Path, exif: bool = True) -> None:
        """:param exif: whether what EXIF tells of the orientation is right."""
        self.data, self._exif = read_bytes(path), exif

    @functools.cached_property
    def grey(self) -> NDArray[np.uint8]:
        """H x W; of other depths by their own range."""
        return decode(self.data)

    @functools.cached_property
    def colour(self) -> NDArray[np.uint8]:
        """H x W x 3, BGR."""
        return decode(self.data, colour=True)

    @functools.cached_property
    def pages(self) -> Pages:
        """Of any depth and channels, with what the file says of them."""
        return decode_all(self.data)

    @property
    def suffix(self) -> str:
        """That of its format, or that of PNG."""
        return '.jpg' if self.data.startswith(b'\xff\xd8') else '.tif' if self.data.startswith(TIFF) else '.png'

    @property
    def orientation(self) -> int:
        """How the image is stored, by EXIF, 1 to 8."""
        return exif_orientation(self.data) if self._exif else 1

    @property
    def orientation_of_camera(self) -> int:
        """The same of an image whose pixels a camera's geometry is computed of. :raises ValueError: for one that is stored mirrored."""
        stored = exif_orientation(self.data)
        if stored in MIRRORED:  # also without `exif`
            raise ValueError(f'its EXIF data say that it is stored mirrored (orientation {stored}), and no camera sees a mirrored image: write it '
                             'as it is seen (exiftran -ai FILE, or magick FILE -auto-orient FILE), or remove the entry if it is wrong (exiftool '
                             '-Orientation= FILE)')
        return self.orientation

    def small(self, max_size: int, masks: Masks, name: str) -> tuple[np.ndarray, Optional[np.ndarray], np.ndarray]:
        """The grey image, reduced to this longer side if it is larger; its mask; and pixels of the file a pixel, along x and y."""
        mask, image = masks.of(name, self.grey), reduced(self.grey, max_size)
        return image, resized_mask(mask, image), np.array(self.grey.shape[1::-1]) / image.shape[1::-1]


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
        """:raises InvalidOption: for a mask of another size than the image, and for one that is no image."""
        path = self.file(name)
        if not path:
            return None
        try:
            mask = decode_first(read_bytes(path))
        except ValueError as e:
            raise InvalidOption(f'its mask {path}: {e}') from None
        mask = (mask if mask.ndim == 2 else mask[..., :3].any(axis=2)).astype(bool).astype(np.uint8)
        if mask.shape != image.shape[:2]:
            raise InvalidOption(f'its mask {path} has {mask.shape[1]} x {mask.shape[0]} pixels, and the image {image.shape[1]} x {image.shape[0]}')
        return mask


def check_sizes(folder: Path, names: Sequence[str], masks: Masks, camera: Any) -> None:
    """Of what was given for all images: masks and a camera, if there is one.

    :raises InvalidOption: if images can be read, but none is of these sizes.
    """
    why = ''
    for name in names if camera is not None or masks.path is not None else ():
        with contextlib.suppress(ValueError, OSError):
            image = ImageFile(os.path.join(folder, name)).grey
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
