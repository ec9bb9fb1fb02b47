"""From what users have to what the extension takes: C-contiguous arrays of native byte order."""
from __future__ import annotations

from typing import Any, Sequence

import numpy as np


def as_array(value: Any, what: str) -> np.ndarray:
    """`value` as a C-contiguous array of native byte order; a copy only where it is not one.

    :raises TypeError: naming `what`, for what is no array of numbers.
    """
    try:
        array = np.asarray(value)
        if array.dtype == object and hasattr(value, '__dlpack__'):
            array = np.from_dlpack(value)
    except (TypeError, ValueError, RuntimeError, BufferError) as e:
        raise TypeError(f'{what}: {type(value).__name__} is no array that numpy can read ({e})') from None
    if array.dtype.kind not in 'buif' or array.ndim == 0:
        raise TypeError(f'{what}: an array of numbers is needed, not {type(value).__name__} of {array.dtype}')
    if not array.dtype.isnative:
        array = array.astype(array.dtype.newbyteorder('='))
    return np.ascontiguousarray(array)


def as_arrays(values: Any, what: str) -> list[np.ndarray]:
    """One array, or a sequence of them, as a list."""
    if values is None:
        return []
    if isinstance(values, np.ndarray) or not isinstance(values, Sequence):
        return [as_array(values, what)]
    return [as_array(value, what) for value in values]
