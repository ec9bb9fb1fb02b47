"""Things of the last images used."""
from __future__ import annotations

import collections
from typing import Callable, Generic, TypeVar

T = TypeVar('T')


class Cache(Generic[T]):
    """What `load` gives for a number, of the last `size` numbers asked for."""

    def __init__(self, load: Callable[[int], T], size: int) -> None:
        self._load, self._size = load, size
        self._kept: collections.OrderedDict[int, T] = collections.OrderedDict()

    def __getitem__(self, number: int) -> T:
        if number in self._kept:
            self._kept.move_to_end(number)
        else:
            self._kept[number] = self._load(number)
            if len(self._kept) > self._size:
                self._kept.popitem(last=False)
        return self._kept[number]
