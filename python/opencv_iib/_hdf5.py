"""HDF5 files on a disk that may be full."""
from __future__ import annotations

import contextlib
import io
from typing import Any, Iterator, Optional

from opencv_iib._arguments import import_module


def import_h5py() -> Any:
    return import_module('h5py', 'HDF5 files need pip install h5py')


@contextlib.contextmanager
def new_hdf5(path: str) -> Iterator[Any]:
    """An h5py.File to write; an older file at the path is replaced. :raises OSError: also for a full disk."""
    with _Disk(path, 'w+') as disk:
        try:
            with import_h5py().File(disk, 'w') as made:
                yield made
        except (OSError, RuntimeError, ValueError):
            if disk.error is None:
                raise
        if disk.error is not None:
            raise OSError(f'{path} cannot be written: {disk.error.strerror}')


class _Disk(io.FileIO):
    """The file that HDF5 writes to. HDF5 crashes on write errors, so the first one is kept here and later writes are dropped."""

    error: Optional[OSError] = None

    def write(self, data: Any) -> int:
        rest = memoryview(data).cast('B')
        with self._keeping_errors():
            while len(rest) and self.error is None:
                rest = rest[super().write(rest):]
        return len(data)

    def truncate(self, size: Optional[int] = None) -> int:
        with self._keeping_errors():
            super().truncate(size)
        return size or 0

    @contextlib.contextmanager
    def _keeping_errors(self) -> Iterator[None]:
        try:
            yield
        except OSError as e:
            self.error = self.error or e
