"""Converts arguments to arrays for the extension: C-contiguous, of native byte order."""
from __future__ import annotations

import os
from typing import Any, Callable, Iterable, Optional, Sequence, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from opencv_iib import _core

#: An array, or a sequence of them.
ArrayOrArrays = Union[ArrayLike, Sequence[ArrayLike]]
#: Several images.
Images = Union[list[NDArray[Any]], tuple[NDArray[Any], ...]]


def as_array(value: Any, what: str) -> np.ndarray:
    """`value` as a C-contiguous array of native byte order, copied only if needed. :raises TypeError: naming `what`, if it is no array of numbers."""
    try:
        array = np.asarray(value)
        if array.dtype == object and hasattr(value, '__dlpack__'):
            array = np.from_dlpack(value)
    except (TypeError, ValueError, RuntimeError, BufferError) as e:
        raise TypeError(f'{what}: {type(value).__name__} is no array that numpy can read ({e})') from None
    if array.dtype.kind not in 'buif' or array.ndim == 0:
        raise TypeError(f'{what}: an array of numbers is needed, not {type(value).__name__} of {array.dtype}')
    if array.dtype.itemsize > 8:  # a longdouble
        array = array.astype(np.float64)
    if not array.dtype.isnative:
        array = array.astype(array.dtype.newbyteorder('='))
    return np.ascontiguousarray(array)


def as_matrix(value: Any, what: str) -> np.ndarray:
    """as_array of 2 dimensions, or of 3 with the channels last. :raises opencv_iib.error: naming `what`, if OpenCV's matrices cannot hold it."""
    array = as_array(value, what)
    if array.ndim > 3 or (array.ndim < 2 and array.size):
        raise _core.error(f'{what}: an array of 2 or 3 dimensions is needed, not {array.ndim}')
    if array.dtype not in _DEPTHS:
        raise _core.error(f'{what}: arrays of {array.dtype} are not supported; convert it to uint8, uint16 or float32')
    if array.size >= 1 << 31 and max(array.shape) >= 1 << 31 or array.shape[2:] > (512,):
        raise _core.error(f'{what}: too large, or more than 512 channels')
    return array if array.ndim > 1 else array.reshape(0, 0)


_DEPTHS = frozenset(map(np.dtype, ('bool', 'uint8', 'int8', 'uint16', 'int16', 'int32', 'float32', 'float64')))


def as_image(value: ArrayLike) -> np.ndarray:
    """An image; a tensor of torch or kornia (C x H x W or 1 x C x H x W, RGB) becomes H x W x C, BGR."""
    if value is None:
        raise TypeError('the image is None: did cv2.imread find the file?')
    if isinstance(value, (str, os.PathLike)):
        raise TypeError(f'the image is a path, {value!s}: pass the image, as cv2.imread reads it')
    image = as_array(value, 'the image')
    if isinstance(value, np.ndarray) or not hasattr(value, '__dlpack__'):
        if image.ndim == 3 and image.shape[2] > 4 and len(image) in (1, 3, 4):
            raise _core.error(f'the image has the shape {image.shape}: channels come last, as np.moveaxis(image, 0, 2) has them')
        return as_matrix(image, 'the image')
    if image.ndim == 4 and len(image) == 1:
        image = image[0]
    if image.ndim == 3 and len(image) in (1, 3, 4) and image.shape[2] not in (1, 3, 4):
        image = np.moveaxis(image[[2, 1, 0, 3][:len(image)] if len(image) > 1 else [0]], 0, 2)
    return as_matrix(image, 'the image')


def are_images(value: Any) -> bool:
    """Whether it is a list of images, and not one image."""
    return isinstance(value, (list, tuple)) and any(getattr(each, 'ndim', 0) > 1 for each in value)


def with_images(images: Images, others: Sequence[Any], what: str) -> Iterable[tuple[Any, Any]]:
    """Pairs of images and others. :raises opencv_iib.error: naming `what`, if their numbers differ."""
    count = len(others) if isinstance(others, (Sequence, np.ndarray)) else others
    if len(images) != count:
        raise _core.error(f'{len(images)} images, but {what} of {count}')
    return zip(images, others)


def as_mask(value: Optional[ArrayLike]) -> np.ndarray:
    """The mask of an image; an empty one for None."""
    return np.empty((0, 0), np.uint8) if value is None else as_matrix(value, 'the mask')


def as_codes(value: ArrayLike, what: str) -> np.ndarray:
    """Rows of bytes. :raises opencv_iib.error: for other numbers, such as SIFT's descriptors."""
    codes = as_matrix(value, what)
    if codes.size and codes.dtype not in (np.uint8, bool):
        raise _core.error(f'{what}: binary codes are uint8, not {codes.dtype}; Hamming distances of other numbers mean nothing')
    return codes


def as_arrays(values: Optional[ArrayOrArrays], what: str, check: Callable[[Any, str], np.ndarray] = as_matrix
              ) -> list[np.ndarray]:
    """One array, or a sequence of them, as a list."""
    if values is None:
        return []
    if isinstance(values, np.ndarray) or not isinstance(values, Sequence):
        return [check(values, what)]
    return [check(value, what) for value in values]
