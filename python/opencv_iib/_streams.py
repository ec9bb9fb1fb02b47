"""Standard output and error: missing (pythonw), closed or full, or of an encoding that lacks the letters of a file's name."""
from __future__ import annotations

import contextlib
import os
import re
import sys
from typing import Iterator, Optional, TextIO

from opencv_iib._arguments import UnusableName

try:
    import fcntl
except ImportError:  # of Windows
    fcntl = None  # type: ignore[assignment,unused-ignore]

_quiet = False


@contextlib.contextmanager
def quiet(wanted: bool = True) -> Iterator[None]:
    """Within it, no progress is shown, whichever thread makes it."""
    global _quiet
    before, _quiet = _quiet, wanted
    try:
        yield
    finally:
        _quiet = before


def is_quiet() -> bool:
    """Whether no progress is to be shown."""
    return _quiet


def put(text: str, stream: Optional[TextIO]) -> None:
    """Writes a text, with escapes for letters that the stream's encoding lacks; nothing without a stream.

    :raises OSError: of the stream, such as for a full disk.
    """
    if stream is not None:
        encoding = getattr(stream, 'encoding', None) or 'utf-8'
        stream.write(text.encode(encoding, 'backslashreplace').decode(encoding))
        stream.flush()


def note(line: str) -> None:
    """A line on standard error, one also where a file's name has two. What is told of the work does not end it where nobody can read it."""
    with contextlib.suppress(OSError, ValueError):  # full, closed
        put('\\n'.join(line.splitlines()) + '\n', sys.stderr)


STANDARD_OUTPUT = ('-', '/dev/stdout', '/dev/fd/1', '/proc/self/fd/1')
_OPEN_FILE = re.compile(r'/(?:dev|proc/self)/fd/(\d+)|/dev/stderr')


def is_open_file(path: str) -> bool:
    """Whether a name stands for what was open before this program began: '-', /dev/stdout, /dev/fd/63 of the shell's >(...)."""
    return path in STANDARD_OUTPUT or _OPEN_FILE.fullmatch(path) is not None


def _number(path: str) -> int:
    return 1 if path in STANDARD_OUTPUT else int(_OPEN_FILE.fullmatch(path)[1] or 2)  # type: ignore[index]


def check_open_file(path: str) -> None:
    """:raises UnusableName: for one that was closed, or is there to be read alone."""
    number = _number(path)
    standard = {1: sys.stdout, 2: sys.stderr}  # without one, its number may have gone to another file
    if not (_is_written_to(number) if number not in standard else standard[number] is not None):
        raise UnusableName(f'{path} cannot be written: it is not open')


def _is_written_to(number: int) -> bool:
    try:
        if fcntl is None:
            return bool(os.fstat(number))
        return fcntl.fcntl(number, fcntl.F_GETFL) & os.O_ACCMODE != os.O_RDONLY
    except (OSError, OverflowError):
        return False


def write_to_open_file(path: str, content: bytes) -> None:
    """Goes on where it is. Opened anew by its name, it would begin again what >> adds to."""
    check_open_file(path)
    if path not in STANDARD_OUTPUT:
        with os.fdopen(os.dup(_number(path)), 'wb') as file:
            file.write(content)
    else:
        assert sys.stdout is not None
        sys.stdout.flush()
        raw = getattr(sys.stdout, 'buffer', None)
        sys.stdout.write(content.decode()) if raw is None else raw.write(content)
        sys.stdout.flush()
