"""Who does the work on images and pairs: threads of this process, or the workers of a Dask client."""
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
    """As many, or one a core for None. :raises InvalidOption: for less than 1, or more than a system can have."""
    check_count(1 if workers is None else workers, 'workers', MAX_THREADS)
    return workers or os.cpu_count() or 1


class Threads:
    """Of this process."""

    tile_side = 1  #: images that a job matches with as many others
    lost: tuple[type[Exception], ...] = ()  #: what is raised, by no job, when those who work have gone

    def __init__(self, count: int) -> None:
        self._count = count

    def executor(self) -> concurrent.futures.Executor:
        """What jobs are submitted to."""
        return concurrent.futures.ThreadPoolExecutor(self._count)

    def ahead(self) -> int:
        """How many jobs may wait or run at once."""
        return 2 * self._count

    def hold(self, *arrays: np.ndarray) -> Any:
        """What a job takes for the arrays, as one argument or within one."""
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
        # A worker keeps and hands on what it was given once. As a task and not as scattered data: if the worker vanishes,
        # the scheduler gives the arrays to another.
        return self._client.submit(tuple, arrays, pure=False)


def in_parallel(function: Callable[[T], R], jobs: Iterable[T], crew: Threads, told: tuple[type[Exception], ...] = ()) -> Iterator[tuple[T, Any]]:
    """Has jobs done, a few ahead: each job and its result, in order, in bounded memory.

    :param told: exceptions that are results; others are raised.
    :raises ConnectionError: if those who work have gone.
    """
    waiting: collections.deque[tuple[T, concurrent.futures.Future[R]]] = collections.deque()

    def first() -> tuple[T, Any]:
        job, future = waiting.popleft()
        failed = future.exception()
        if failed is not None and not isinstance(failed, told):
            raise failed
        return job, future.result() if failed is None else failed

    try:
        with crew.executor() as pool:
            try:
                for job in jobs:
                    waiting.append((job, pool.submit(function, job)))
                    while len(waiting) >= crew.ahead():
                        yield first()
                while waiting:
                    yield first()
            finally:
                for _, future in waiting:
                    future.cancel()
    except crew.lost:
        raise ConnectionError('the scheduler has gone: when it is back, the same command goes on from here') from None
