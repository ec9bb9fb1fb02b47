"""A line that shows how much of some work is done and how long the rest will take."""
from __future__ import annotations

import contextlib
import sys
import time
from datetime import timedelta
from typing import Iterable, Iterator, Optional, TypeVar

from opencv_iib._streams import is_quiet, put

T = TypeVar('T')


class Progress:
    """Counts steps on standard error: rewritten in place on a terminal, a line each 30 seconds elsewhere."""

    def __init__(self, title: str, total: Optional[int], done: int = 0) -> None:
        self.title, self.total, self.first, self.done = title, total, done, done
        self.stream, self.live = None if is_quiet() else sys.stderr, False
        with contextlib.suppress(ValueError):  # closed
            self.live = self.stream is not None and self.stream.isatty()
        self.start = self.shown = time.monotonic()

    def step(self, count: int = 1) -> None:
        self.done += count
        now = time.monotonic()
        if now - self.shown >= (.2 if self.live else 30):
            self.shown = now
            self._write('\r' if self.live else '', '' if self.live else '\n')

    def close(self) -> None:
        self._write('\r' if self.live else '', '\n')

    def _write(self, begin: str, end: str) -> None:
        passed = time.monotonic() - self.start
        text = f'{self.title} {self.done}'
        if self.total is not None:
            text += f'/{self.total}'
            fresh = self.done - self.first
            if fresh and self.done < self.total:
                text += f', {timedelta(seconds=round(passed / fresh * (self.total - self.done)))} left'
        with contextlib.suppress(OSError, ValueError):  # a full or closed stream must not end the work
            put(f'{begin}{text}, {timedelta(seconds=round(passed))}   {end}', self.stream)


def with_progress(results: Iterable[T], title: str, total: int, done: int = 0) -> Iterator[T]:
    """The results, each of which is a step."""
    progress = Progress(title, total, done)
    for result in results:
        yield result
        progress.step()
    progress.close()
