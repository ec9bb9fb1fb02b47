"""One line that says how far it is and how long it will take."""
from __future__ import annotations

import sys
import time
from typing import Optional, TextIO


def clock(seconds: float) -> str:
    """Hours, minutes and seconds, as in 1:02:03 or 2:03."""
    minutes, s = divmod(int(seconds + .5), 60)
    hours, m = divmod(minutes, 60)
    return f'{hours}:{m:02}:{s:02}' if hours else f'{m}:{s:02}'


class Progress:
    """Counts steps on `stream` (standard error): rewritten in place on a terminal, a line each 30 seconds elsewhere."""

    def __init__(self, title: str, total: Optional[int], done: int = 0, stream: Optional[TextIO] = None) -> None:
        self.title, self.total, self.first, self.done = title, total, done, done
        self.stream = sys.stderr if stream is None else stream
        self.live = self.stream.isatty()
        self.start = self.shown = time.monotonic()

    def step(self, count: int = 1) -> None:
        """So many more are done."""
        self.done += count
        now = time.monotonic()
        if now - self.shown >= (.2 if self.live else 30):
            self.shown = now
            self._write('\r' if self.live else '', '' if self.live else '\n')

    def close(self) -> None:
        """Ends the line."""
        self._write('\r' if self.live else '', '\n')

    def _write(self, begin: str, end: str) -> None:
        passed = time.monotonic() - self.start
        text = f'{self.title} {self.done}'
        if self.total is not None:
            text += f'/{self.total}'
            fresh = self.done - self.first
            if fresh and self.done < self.total:
                text += f', {clock(passed / fresh * (self.total - self.done))} left'
        self.stream.write(f'{begin}{text}, {clock(passed)}   {end}')
        self.stream.flush()
