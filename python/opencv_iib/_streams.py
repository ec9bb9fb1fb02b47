"""Standard output and error: missing (pythonw), closed or full, or of an encoding that lacks the letters of a file's name."""
from __future__ import annotations

import contextlib
import contextvars
import os
import re
import sys
from typing import Iterator, Optional, TextIO

_QUIET = contextvars.ContextVar('quiet', default=False)


@contextlib.contextmanager
def quiet(wanted: bool = True) -> Iterator[None]:
    """Within it, no progress is shown."""
    token = _QUIET.set(wanted)
    try:
        yield
    finally:
        _QUIET.reset(token)


def is_quiet() -> bool:
    """Whether no progress is to be shown."""
    return _QUIET.get()


def put(text: str, stream: Optional[TextIO]) -> None:
    """Writes a text, with escapes for letters that the stream's encoding lacks; nothing without a stream.

    :raises OSError: of the stream, such as for a full disk.
    """
    if stream is not None:
        encoding = getattr(stream, 'encoding', None) or 'utf-8'
        stream.write(text.encode(encoding, 'backslashreplace').decode(encoding))
        stream.flush()


def note(line: str) -> None:
    """A line on standard error. What is told of the work does not end it where nobody can read it."""
    with contextlib.suppress(OSError, ValueError):  # full, closed
        put(line + '\n', sys.stderr)


STANDARD_OUTPUT = ('-', '/dev/stdout', '/dev/fd/1', '/proc/self/fd/1')
_OPEN_FILE = re.compile(r'/(?:dev|proc/self)/fd/(\d+)|/dev/stderr')


def is_open_file(path: str) -> bool:
    """Whether a name stands for what was open before this program began: '-', /dev/stdout, /dev/fd/63 of the shell's >(...)."""
    return path in STANDARD_OUTPUT or _OPEN_FILE.fullmatch(path) is not None


def write_to_open_file(path: str, content: bytes) -> None:
    """Goes on where it is. Opened anew by its name, it would begin again what >> adds to."""
    if path not in STANDARD_OUTPUT:
        with os.fdopen(os.dup(int(_OPEN_FILE.fullmatch(path)[1] or 2)), 'wb') as file:  # type: ignore[index]
            file.write(content)
    elif sys.stdout is not None:
        sys.stdout.flush()
        raw = getattr(sys.stdout, 'buffer', None)
        sys.stdout.write(content.decode()) if raw is None else raw.write(content)
        sys.stdout.flush()
