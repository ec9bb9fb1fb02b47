"""Which images of many an image resembles, by votes of its codes."""
from __future__ import annotations

from typing import Sequence

import numpy as np
from numpy.typing import NDArray

TABLES = 16
STRONGEST = 400  #: codes of an image that are in the tables
COARSE = 4  #: bits are taken from the first of so many parts of a code: coarse cells change least
FREQUENT = 64  #: codes that share a key: what is that frequent tells nothing


class Votes:
    """Tables of the images' codes by a few of their bits; threads may share one."""

    def __init__(self, codes: Sequence[NDArray[np.uint8]]) -> None:
        """
        :param codes: of each image, the strongest first.
        """
        samples = [c[:STRONGEST] for c in codes]
        self.images = len(codes)
        count = sum(map(len, samples))
        bits = max(8, min(24, count.bit_length()))  # about one code a key
        self._bytes = codes[0].shape[1] // COARSE
        random = np.random.default_rng(1)
        self._chosen = np.array([random.permutation(8 * self._bytes)[:bits] for _ in range(TABLES)])
        self._begins = np.zeros((TABLES, (1 << bits) + 1), np.uint32)
        self._entries = np.empty((TABLES, count), np.min_scalar_type(self.images))
        owner = np.repeat(np.arange(self.images, dtype=self._entries.dtype), list(map(len, samples)))
        for table, keys in enumerate(np.concatenate([self._keys(s) for s in samples], axis=1)):
            np.cumsum(np.bincount(keys, minlength=1 << bits), out=self._begins[table, 1:])
            low = np.argsort(keys.astype(np.uint16), kind='stable')  # numpy sorts 16 bits and fewer by counting
            high = np.argsort((keys >> 16).astype(np.uint8)[low], kind='stable')
            self._entries[table] = owner[low][high]

    def _keys(self, codes: NDArray[np.uint8]) -> NDArray[np.int32]:
        """Of each table, a column a code; without a product of matrices, for which numpy might start threads."""
        ones = np.ascontiguousarray(np.unpackbits(np.ascontiguousarray(codes[:, :self._bytes]), axis=1).T)
        packed = np.packbits(ones[self._chosen], axis=1, bitorder='little').astype(np.int32)
        return np.asarray((packed << 8 * np.arange(packed.shape[1])[:, None]).sum(1, dtype=np.int32))

    def __call__(self, codes: NDArray[np.uint8]) -> NDArray[np.float64]:
        """Votes for each image: each key of a code has one, shared among the codes of the same key."""
        keys = self._keys(codes)
        tables = np.arange(TABLES)[:, None]
        begins = self._begins[tables, keys].astype(np.int64)
        counts = self._begins[tables, keys + 1] - begins
        rare = (counts > 0) & (counts <= FREQUENT)
        counts = counts[rare]
        begins = (begins + tables * self._entries.shape[1])[rare]
        if not len(counts):
            return np.zeros(self.images)
        places = np.arange(counts.sum()) + np.repeat(begins - np.cumsum(counts) + counts, counts)
        return np.asarray(np.bincount(self._entries.ravel()[places], np.repeat(1 / counts, counts), self.images), np.float64)
