"""MappedIndex: codes in a folder, mapped into memory."""
from __future__ import annotations

import os
from typing import Any, Optional, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from opencv_iib import _core
from opencv_iib._arguments import Path, integer, integers
from opencv_iib._arrays import ArrayOrArrays, as_arrays, as_codes
from opencv_iib._copies import copied
from opencv_iib.matcher import AT_ONCE, check_padding


@copied
class MappedIndex(_core.MappedIndex):
    """Binary codes in a folder of files that are mapped into memory, as C++'s cv::iib::MappedIndex writes and reads them.

    For more codes than fit in memory, for processes that share codes, and for programs that start at once. Each call of :meth:`add` or
    :meth:`remove` is one commit: if it fails, the folder stays as it was. Writers wait for each other; readers see the commit that they
    opened until :meth:`refresh`. Rows and images are numbered in the order in which they were added, and keep their numbers when others
    are removed.

    A file that is missing, truncated or altered raises :class:`opencv_iib.error`, which names it. Searches release the
    GIL; threads may share an object as long as none adds, removes or refreshes. A pickle holds the folder's name alone."""

    def __init__(self, folder: Path) -> None:
        """The same as :meth:`open`."""
        self._folder = os.fspath(folder)
        super().__init__(self._folder)

    @classmethod
    def open(cls, folder: Path) -> MappedIndex:
        """Opens the last commit; codes are mapped and checked at the first search."""
        return cls(folder)

    @classmethod
    def create(cls, folder: Path, levelSizes: Sequence[int]) -> MappedIndex:
        """Makes an index without images in a new folder, whose parent must exist, or in an empty one.

        :param levelSizes: bytes of each level, coarse first, as in HierarchicalMatcher; one level is enough."""
        cls._create(folder, integers(levelSizes, 'levelSizes'))
        return cls(folder)

    def add(self, descriptors: ArrayOrArrays) -> None:
        """Adds the descriptors of one image (an array) or of several (a sequence of arrays), and commits them.

        They become one file. Add many images at once: files of 100,000 rows and more are searched fastest."""
        self._add(as_arrays(descriptors, 'descriptors', as_codes))

    def search(self, queryDescriptors: ArrayLike, k: int = 1, segment: Optional[int] = None
               ) -> tuple[NDArray[np.int64], NDArray[np.int32]]:
        """The k nearest rows of each query by Hamming distance, ties in the order of rows.

        :param segment: the number of the only file to search.
        :return: rows (int64) and distances (int32), queries x k, -1 where there are fewer.
        :raises opencv_iib.error: also for a k of more than there are codes that would fill the memory."""
        queries, k, where = as_codes(queryDescriptors, 'queries'), integer(k, 'k'), -1 if segment is None else integer(segment, 'segment')
        check_padding(len(queries), k, self.rows)
        parts = [self._search(queries[first:first + AT_ONCE], k, where) for first in range(0, max(1, len(queries)), AT_ONCE)]
        rows, distances = (np.concatenate(arrays).reshape(-1, k) for arrays in zip(*parts))
        return rows, distances

    def _parameters(self) -> Any:
        return self._folder

    def _restored(self, parameters: Any) -> Any:
        return _core.MappedIndex(parameters)

    def __repr__(self) -> str:
        return f'{type(self).__name__}({self._folder!r})'
