"""Runs jobs on images and pairs: in threads of this process, or by the workers of a Dask client."""
from __future__ import annotations

import collections
import concurrent.futures
import os
from typing import Any, Callable, Iterable, Iterator, Optional, TypeVar

import numpy as np

from opencv_iib._arguments import check_count

T = TypeVar('T')
R = TypeVar('R')
MAX_THREADS = 1024


def thread_count(workers: Optional[int]) -> int:
    """That many; None: one a core. :raises InvalidOption: for less than 1, or more than a system can have."""
    check_count(1 if workers is None else workers, 'workers', MAX_THREADS)
    return workers or os.cpu_count() or 1


class Threads:
    tile_side = 1  #: images that a job matches with as many others
    lost: tuple[type[Exception], ...] = ()  #: exceptions that mean the workers are gone; jobs never raise them

    def __init__(self, count: int) -> None:
        self._count = count

    def executor(self) -> concurrent.futures.Executor:
        return concurrent.futures.ThreadPoolExecutor(self._count)

    def ahead(self) -> int:
        """How many jobs may wait or run at once."""
        return 2 * self._count

    def hold(self, *arrays: np.ndarray) -> Any:
        """Arrays in the form in which jobs get them, as one argument or within one."""
        return arrays


class Cluster(Threads):
    """The workers of a ``distributed.Client``."""

    tile_side = 8

    def __init__(self, client: Any) -> None:
        from distributed.comm.core import CommClosedError
        self._client = client
        self.lost = CommClosedError, concurrent.futures.CancelledError

    def executor(self) -> Any:
        return self._client.get_executor(pure=False)

    def ahead(self) -> int:
        return 2 * max(1, int(sum(self._client.nthreads().values())))  # workers come and go

    def hold(self, *arrays: np.ndarray) -> Any:
        # Workers fetch a task's result once and pass it on. Scattered data would be lost with the worker that holds it.
        return self._client.submit(tuple, arrays, pure=False)


def in_parallel(function: Callable[[T], R], jobs: Iterable[T], workers: Threads, returned: tuple[type[Exception], ...] = ()) -> Iterator[tuple[T, Any]]:
    """Runs jobs, a few ahead: yields each job and its result, in order, in bounded memory.
    :param returned: exceptions of jobs that are results; others are raised.
    :raises ConnectionError: if the workers are gone."""
    waiting: collections.deque[tuple[T, concurrent.futures.Future[R]]] = collections.deque()

    def first() -> tuple[T, Any]:
        job, future = waiting.popleft()
        failure = future.exception()
        return job, failure if isinstance(failure, returned) else future.result()

    try:
        with workers.executor() as executor:
            try:
                for job in jobs:
                    waiting.append((job, executor.submit(function, job)))
                    while len(waiting) >= workers.ahead():
                        yield first()
                while waiting:
                    yield first()
            finally:
                for _, future in waiting:
                    future.cancel()
    except workers.lost:
        raise ConnectionError('the scheduler has gone: when it is back, the same command goes on from here') from None
