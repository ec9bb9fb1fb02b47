"""Files that are written: where, and by one process at a time."""
from __future__ import annotations

import os
import shutil
import sys
import uuid
from contextlib import contextmanager, nullcontext, suppress
from typing import Iterator

if sys.platform == 'win32':
    import msvcrt
else:
    import fcntl


def output_file(path: str) -> str:
    """Where a file is written: at the end of a link, also if nothing is there yet.

    :raises OSError: for a folder, or within a folder that is missing.
    """
    target = os.path.realpath(path)
    if os.path.isdir(target):
        raise IsADirectoryError(f'{path or target} is a folder: give the name of a file')
    if not os.path.isdir(os.path.dirname(target)):
        raise FileNotFoundError(f'{path}: there is no folder {os.path.dirname(target)}')
    return target


def write_whole(path: str, content: bytes) -> None:
    """Writes a file beside the old one, and puts it in its place when all of it is on the disk.

    :raises OSError: for a full disk too; the old file stays.
    """
    target = output_file(path)
    # A device, such as /dev/stdout, is no file that could be replaced.
    device = os.path.exists(target) and not os.path.isfile(target)
    try:
        with (nullcontext([target]) if device else replaced(target, suffix=f'.{uuid.uuid4().hex[:8]}')) as (part,), open(part, 'wb') as file:
            file.write(content)
    except OSError as e:
        raise type(e)(f'{path} cannot be written: {e.strerror}') from None


@contextmanager
def replaced(*paths: str, suffix: str = '.new') -> Iterator[list[str]]:
    """Names to write files to, which replace those at the paths when the block ends without an error."""
    parts = [path + suffix for path in paths]
    try:
        yield parts
        for part, path in zip(parts, paths):
            if os.path.exists(path):
                shutil.copymode(path, part)
            os.replace(part, path)
    finally:
        for part in parts:
            with suppress(FileNotFoundError):
                os.unlink(part)


@contextmanager
def only_writer(path: str) -> Iterator[None]:
    """Locks a folder, or a file, which is made if it is missing.

    :raises BlockingIOError: if another process has it locked.
    """
    if sys.platform == 'win32':  # where no folder is locked: a file beside it, which goes with its last descriptor
        descriptor = os.open(path + '.lock', os.O_RDWR | os.O_CREAT | os.O_TEMPORARY)
    else:
        descriptor = os.open(path, os.O_RDONLY if os.path.isdir(path) else os.O_RDWR | os.O_CREAT)
    try:
        try:
            if sys.platform == 'win32':
                msvcrt.locking(descriptor, msvcrt.LK_NBLCK, 1)
            else:
                fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except (BlockingIOError, PermissionError):
            raise BlockingIOError(f'{path} is being written by another process: wait until it has ended') from None
        yield
    finally:
        os.close(descriptor)
