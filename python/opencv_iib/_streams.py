"""Standard output and error, which may be missing (pythonw), closed, full, or of an encoding that lacks letters of a file's name."""
from __future__ import annotations

import contextlib
import os
import sys
from typing import Iterator, Optional, TextIO

from opencv_iib._arguments import UnusableName

_quiet = False


@contextlib.contextmanager
def quiet(wanted: bool = True) -> Iterator[None]:
    """Hides the progress of all threads within the block."""
    global _quiet
    before, _quiet = _quiet, wanted
    try:
        yield
    finally:
        _quiet = before


def is_quiet() -> bool:
    return _quiet


def put(text: str, stream: Optional[TextIO]) -> None:
    """Writes a text, with escapes for letters that the stream's encoding lacks; does nothing without a stream."""
    if stream is not None:
        encoding = getattr(stream, 'encoding', None) or 'utf-8'
        stream.write(text.encode(encoding, 'backslashreplace').decode(encoding))
        stream.flush()


def note(line: str) -> None:
    """Writes one line to standard error, even if a file's name in it has two lines. A full or closed stream is no error."""
    with contextlib.suppress(OSError, ValueError):
        put('\\n'.join(line.splitlines()) + '\n', sys.stderr)


STANDARD_OUTPUT = ('-', '/dev/stdout')


def is_open_file(path: str) -> bool:
    """Whether a name stands for standard output, or for a pipe or device, such as the shell's >(...): they cannot be replaced."""
    return path in STANDARD_OUTPUT or os.path.exists(path) and not os.path.isfile(path) and not os.path.isdir(path)


def check_open_file(path: str) -> None:
    """:raises UnusableName: for standard output that was closed."""
    if path in STANDARD_OUTPUT and sys.stdout is None:
        raise UnusableName(f'{path} cannot be written: it is not open')


def write_to_open_file(path: str, content: bytes) -> None:
    """Appends where the shell's >> would."""
    check_open_file(path)
    if path not in STANDARD_OUTPUT:
        with open(path, 'wb') as file:
            file.write(content)
    else:
        assert sys.stdout is not None
        sys.stdout.flush()
        raw = getattr(sys.stdout, 'buffer', None)
        sys.stdout.write(content.decode()) if raw is None else raw.write(content)
        sys.stdout.flush()
