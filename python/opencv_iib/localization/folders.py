"""Folders that appear whole."""
from __future__ import annotations

import contextlib
import fnmatch
import os
import shutil
from typing import Iterator, Sequence

from opencv_iib._files import only_writer


@contextlib.contextmanager
def new_folder(target: str, own: Sequence[str]) -> Iterator[str]:
    """A folder to write to, ``target.partial``, which becomes `target` when the block ends without an error.

    :param target: a link is followed, also if nothing is at its end.
    :param own: names that it may hold, or patterns such as ``*.png``, the first of which it always holds: a folder that is
        there is replaced only if it holds nothing else.
    :raises FileExistsError: for a folder that holds something else.
    :raises BlockingIOError: if another process is writing it.
    """
    target = os.path.realpath(target)
    if os.path.exists(target):
        if not os.path.isdir(target):
            raise FileExistsError(f'{target} is a file: choose another folder')
        names = os.listdir(target)
        foreign = [name for name in names if not any(fnmatch.fnmatchcase(name, pattern) for pattern in own)]
        if foreign or (names and own[0] not in names):
            raise FileExistsError(f'{target} holds {(foreign or names)[0]} and was not written by this command: choose '
                                  'another folder')
    partial = target + '.partial'
    os.makedirs(partial, exist_ok=True)
    with only_writer(partial):
        for entry in list(os.scandir(partial)):
            shutil.rmtree(entry.path) if entry.is_dir(follow_symlinks=False) else os.unlink(entry.path)
        yield partial
        old = partial + '.old'
        if os.path.exists(target):
            shutil.rmtree(old, ignore_errors=True)  # of a killed run
            os.rename(target, old)
        try:
            os.rename(partial, target)
        except OSError:
            if os.path.exists(old):
                os.rename(old, target)
            raise
        shutil.rmtree(old, ignore_errors=True)
