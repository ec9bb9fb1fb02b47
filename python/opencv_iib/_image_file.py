"""Image files and their masks."""
from __future__ import annotations

import contextlib
import functools
import hashlib
import os
from typing import Any, Iterable, Optional, Sequence

import numpy as np
from numpy.typing import NDArray

from opencv_iib._arguments import InvalidOption, MissingFile, Path
from opencv_iib._exif import MIRRORED, TIFF, exif_orientation
from opencv_iib._files import read_bytes
from opencv_iib._images import decode, decode_all, decode_first, reduced, resized_mask
from opencv_iib._tiff import Pages


class ImageFile:
    """An image file, read once. Pixels are those stored, not rotated by EXIF. All members raise ValueError for a damaged file."""

    def __init__(self, path: Path, exif: bool = True) -> None:
        """:param exif: False: the orientation in the EXIF data is wrong."""
        self.data, self._exif = read_bytes(path), exif

    @functools.cached_property
    def grey(self) -> NDArray[np.uint8]:
        """H x W, scaled from other depths."""
        return decode(self.data)

    @functools.cached_property
    def colour(self) -> NDArray[np.uint8]:
        """H x W x 3, BGR."""
        return decode(self.data, colour=True)

    @functools.cached_property
    def pages(self) -> Pages:
        """Pages of any depth and channels."""
        return decode_all(self.data)

    @property
    def suffix(self) -> str:
        """.jpg, .tif, or .png for all other formats."""
        return '.jpg' if self.data.startswith(b'\xff\xd8') else '.tif' if self.data.startswith(TIFF) else '.png'

    @property
    def orientation(self) -> int:
        """EXIF's orientation, 1 to 8."""
        return exif_orientation(self.data) if self._exif else 1

    @property
    def orientation_of_camera(self) -> int:
        """The orientation of an image with a camera. :raises ValueError: for an image stored mirrored."""
        stored = exif_orientation(self.data)
        if stored in MIRRORED:  # regardless of `exif`
            raise ValueError(f'its EXIF data say that it is stored mirrored (orientation {stored}), and no camera sees a mirrored image: write it '
                             'as it is seen (exiftran -ai FILE, or magick FILE -auto-orient FILE), or remove the entry if it is wrong (exiftool '
                             '-Orientation= FILE)')
        return self.orientation

    def small(self, max_size: int, masks: Masks, name: str) -> tuple[np.ndarray, Optional[np.ndarray], np.ndarray]:
        """The grey image, reduced to this longer side if it is larger, its mask, and the factors of reduction along x and y."""
        mask, image = masks.of(name, self.grey), reduced(self.grey, max_size)
        return image, resized_mask(mask, image), np.array(self.grey.shape[1::-1]) / image.shape[1::-1]


class Masks:
    """Masks with COLMAP's names: ``more/a.jpg.png`` in their folder for the image more/a.jpg. Pixels that are 0 are not described."""

    def __init__(self, path: Optional[Path]) -> None:
        """:param path: folder, or a file for all images; None: no masks. :raises MissingFile: for a missing one."""
        self.path = None if path is None else os.fspath(path)
        if self.path is not None and not os.path.exists(self.path):
            raise MissingFile(f'there is no mask {self.path}')

    def file(self, name: str) -> str:
        """The file of an image's mask; '' without one."""
        if self.path is None or not os.path.isdir(self.path):
            return self.path or ''
        path = os.path.join(self.path, name + '.png')
        return path if os.path.exists(path) else ''

    def stamp(self, path: str, name: str) -> str:
        """Hashes of the content of an image's file and its mask; '' for one that cannot be read."""
        return ' '.join(map(_stamp, filter(None, (path, self.file(name)))))

    def check(self, names: Iterable[str]) -> list[str]:
        """:return: the files of the images' masks. :raises InvalidOption: for a folder without any of them."""
        names = list(names)
        files = list(filter(None, map(self.file, names)))
        if self.path is not None and not files:
            raise InvalidOption(f'{self.path} has no mask of any image: that of {names[0]} would be {names[0]}.png')
        return files

    def of(self, name: str, image: np.ndarray) -> Optional[np.ndarray]:
        """The mask of an image, H x W uint8. :raises InvalidOption: for one of another size than the image, and one that cannot be read."""
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


def _stamp(path: str) -> str:
    with contextlib.suppress(OSError, ValueError):
        return hashlib.blake2b(read_bytes(path), digest_size=16).hexdigest()
    return ''


def check_sizes(folder: Path, names: Sequence[str], masks: Masks, camera: Any) -> None:
    """Checks masks and a camera for all images. :raises InvalidOption: if none of the readable images has their sizes."""
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
