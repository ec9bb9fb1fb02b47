"""Codes for more than one process or machine: a folder of shards, searched here or by the workers of a Dask cluster.

    from opencv_iib import shards
    shards.write(folder, codes)
    indices, distances = shards.search(folder, queries, k=5, client=distributed.Client(address))

A folder is a :class:`opencv_iib.MappedIndex`, a shard one of its segments; workers read it by the same name.
"""
from __future__ import annotations

import functools
import os
import time
from typing import Any, Callable, Iterable, Iterator, Optional, Sequence, Union

import numpy as np

from opencv_iib._arguments import Path, integer
from opencv_iib._arrays import as_array
from opencv_iib._files import only_writer
from opencv_iib.mapped_index import MappedIndex

Arrays = tuple[np.ndarray, np.ndarray]


def write(folder: Path, codes: Union[np.ndarray, Iterable[np.ndarray]], rows_per_shard: int = 1 << 20,
          level_sizes: Optional[Sequence[int]] = None) -> MappedIndex:
    """Writes codes to a new folder, shard by shard, called ``folder.partial`` until it is complete. A repeated call continues an interrupted one.

    :param codes: N x bytes uint8, to be cut into shards; or several such arrays, each of which becomes one image of the
        :class:`MappedIndex`.
    :param rows_per_shard: a shard ends with the image that brings it to so many rows. One shard is in memory at a time.
    :param level_sizes: bytes of each level, coarse first; None: one level.
    :raises ValueError: if ``folder.partial`` was begun with other codes or other sizes, or there are no codes.
    :raises FileExistsError: if the folder exists, or ``folder.partial`` is a link.
    :raises BlockingIOError: if another process is writing it."""
    if integer(rows_per_shard, 'rows_per_shard', 64) < 1:
        raise ValueError(f'rows_per_shard is {rows_per_shard}: at least 1 is needed')
    if not np.iterable(codes):
        raise TypeError(f'codes: an array, or a sequence of arrays is needed, not {codes!r}')
    folder = os.path.realpath(folder)  # links cannot be replaced
    if os.path.exists(folder) and (not os.path.isdir(folder) or os.listdir(folder)):
        raise FileExistsError(f'{folder} is there already: choose another folder, or add to it with MappedIndex')
    partial = folder + '.partial'
    os.makedirs(partial, exist_ok=True)
    with only_writer(partial, is_folder=True):
        index = _write(partial, _images(codes, rows_per_shard), rows_per_shard, level_sizes)
        del index
        os.rename(partial, folder)
    return MappedIndex(folder)


def _images(codes: Union[np.ndarray, Iterable[np.ndarray]], rows_per_shard: int) -> Iterator[np.ndarray]:
    parts: Iterable[np.ndarray] = codes
    if isinstance(codes, np.ndarray):
        parts = [codes[first:first + rows_per_shard] for first in range(0, max(len(codes), 1), rows_per_shard)]
    for image in parts:
        rows = as_array(image, 'codes')
        if rows.ndim != 2:
            raise ValueError(f'codes: rows x bytes are needed, not an array of {rows.ndim} dimensions')
        yield rows


def _write(folder: str, images: Iterator[np.ndarray], rows_per_shard: int,
           level_sizes: Optional[Sequence[int]]) -> MappedIndex:
    manifest = os.path.join(folder, 'manifest.iib')
    index = MappedIndex(folder) if os.path.exists(manifest) else None
    if index is not None and not index.images():  # of a call that failed at once
        index = None
        os.unlink(manifest)
    if index is not None:
        if level_sizes is not None and index.levelSizes() != tuple(level_sizes):
            raise ValueError(f'{folder} was begun with level sizes {index.levelSizes()}: remove it, or use these')
        for number in range(index.images()):
            if not np.array_equal(next(images, ()), index.descriptors(number)):
                raise ValueError(f'{folder} was begun with other codes or another rows_per_shard: remove it to start again')
    elif level_sizes is not None:
        index = MappedIndex.create(folder, level_sizes)
    shard: list[np.ndarray] = []
    for image in images:
        if index is None:
            index = MappedIndex.create(folder, [image.shape[1]])
        shard.append(image)
        if sum(len(one) for one in shard) >= rows_per_shard:
            index.add(shard)
            shard = []
    if index is None:
        raise ValueError('no codes and no level sizes: at least one of them is needed')
    if shard:
        index.add(shard)
    return index


def search(folder: Path, queries: Any, k: int = 5, client: Any = None) -> Arrays:
    """The k nearest codes of each query by Hamming distance, in all shards; ties in the order of the codes.

    The result is the same, byte for byte, for any number of shards and workers. Shards of a worker that is lost go to others.

    :param queries: rows of as many bytes as the codes.
    :param client: None to search in this process; or a ``distributed.Client``, whose workers read the folder by the same
        name. Each shard goes to the same worker in all calls, which has mapped it.
    :return: indices (int64) and distances (int32), queries x k, -1 if there are fewer codes.
    :raises opencv_iib.error: for a shard that is missing, truncated or altered, with its name. Also if k exceeds the number of codes and the
        result would fill the memory.
    :raises RuntimeError: if the client has had no worker for a minute."""
    queries = as_array(queries, 'queries')
    index = _opened(os.path.abspath(os.fspath(folder)))
    k = integer(k, 'k')
    if client is None or not 1 <= k <= index.rows():
        return index.search(queries, k)
    search_shard = functools.partial(_search_shard, os.path.abspath(os.fspath(folder)), index.version(), queries, k)
    best = np.full((len(queries), k), -1), np.full((len(queries), k), -1, np.int32)
    for found in _by_workers(client, search_shard, range(index.segments())):
        indices, distances = (np.concatenate(arrays, 1) for arrays in zip(best, found))
        # As in the C++ library: ties go to the lowest index; -1, where there are fewer, comes last.
        order = np.lexsort((indices, np.where(indices < 0, np.iinfo(np.int32).max, distances)))[:, :k]
        best = np.take_along_axis(indices, order, 1), np.take_along_axis(distances, order, 1)
    return best


def _by_workers(client: Any, call: Callable[[int], Arrays], shards: Iterable[int]) -> Iterator[Arrays]:
    from distributed import TimeoutError, wait
    workers = sorted(client.scheduler_info(n_workers=-1)['workers'])
    place = {shard: workers[shard % len(workers)] for shard in shards} if workers else {}
    waiting = {client.submit(call, shard, workers=place.get(shard), allow_other_workers=shard in place, pure=False): shard
               for shard in shards}
    seen = time.monotonic()
    while waiting:
        try:
            done = wait(list(waiting), _PATIENCE,  # type: ignore[no-untyped-call,unused-ignore]
                        'FIRST_COMPLETED').done
        except TimeoutError:
            done = ()
        found = []
        for future in done:
            try:
                found.append(future.result(_PATIENCE))
            except TimeoutError:  # the worker is lost, or slow: try in the next round
                continue
            del waiting[future]
        yield from found
        alive = client.nthreads()
        if alive:
            seen = time.monotonic()
        elif time.monotonic() - seen > _WITHOUT_WORKERS:
            raise RuntimeError(f'no worker has been there for {_WITHOUT_WORKERS} s: start some and search again')
        # If all workers are lost at once, the scheduler keeps their tasks for them, so submit these again.
        for future, shard in list(waiting.items()):
            if alive and not found and shard in place and place[shard] not in alive:
                del waiting[future], place[shard]
                waiting[client.submit(call, shard, pure=False)] = shard


_PATIENCE, _WITHOUT_WORKERS = 2, 60  # seconds


_indices: dict[str, MappedIndex] = {}


def _opened(folder: str) -> MappedIndex:
    """The folder's last commit. Parts that this process has mapped stay mapped."""
    index = MappedIndex(folder)
    if folder not in _indices or _indices[folder].version() != index.version():
        _indices[folder] = index
    return _indices[folder]


def _search_shard(folder: str, version: int, queries: np.ndarray, k: int, shard: int) -> Arrays:
    index = _opened(folder)
    if index.version() != version:
        raise RuntimeError(f'{folder} was changed meanwhile, or is not the same for all workers: search again')
    return index.search(queries, k, shard)
