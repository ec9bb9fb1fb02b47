"""Files and folders that are written: where, whole, and by one process at a time."""
from __future__ import annotations

import csv
import os
import re
import shutil
import tempfile
from contextlib import contextmanager, suppress
from typing import Callable, Iterable, Iterator, Optional, Sequence

from opencv_iib import _core
from opencv_iib._arguments import Path
from opencv_iib._streams import is_open_file, write_to_open_file

PART = '.iib-'  #: how the folder's name begins that results are written to, within that of the results
MADE = '.made-by-opencv-iib'  #: a file in that folder: without it, it is the user's


def output_file(path: str) -> str:
    """Where a file is written: at the end of a link, also if nothing is there yet.

    :raises OSError: for a folder, within a folder that is missing, and for a name that is too long.
    """
    target = os.path.realpath(path)
    try:
        os.lstat(target)
    except FileNotFoundError:
        pass
    except OSError as e:
        raise type(e)(f'{path} cannot be written: {e.strerror}') from None
    if os.path.isdir(target):
        raise IsADirectoryError(f'{path or target} is a folder: give the name of a file')
    if not os.path.isdir(os.path.dirname(target)):
        raise FileNotFoundError(f'{path}: there is no folder {os.path.dirname(target)}')
    return target


def is_same(path: Path, other: Path) -> bool:
    """Whether two names are of one file."""
    if os.path.exists(path) and os.path.exists(other):
        return os.path.samefile(path, other)
    return os.path.realpath(path) == os.path.realpath(other)


def is_in(path: Path, folder: Path) -> bool:
    """Whether a file is below a folder, where links lead."""
    return os.path.realpath(path).startswith(os.path.join(os.path.realpath(folder), ''))


def check_outputs(outputs: Iterable[Path], inputs: Iterable[Path]) -> None:
    """What can be told before there is work to lose.

    :raises FileExistsError: for a file to be written that is read, by whatever name, or that is written twice.
    :raises OSError: as output_file, and where no file can be made.
    """
    taken = {path: 'an input' for path in inputs}
    for path in outputs:
        for other, what in taken.items():
            if is_same(path, other):
                raise FileExistsError(f'{path} is {what} too: give what is written a name of its own')
        taken[path] = 'another output'
        target = '' if is_open_file(os.fspath(path)) else output_file(os.fspath(path))
        if target and (os.path.isfile(target) or not os.path.exists(target)):
            try:
                _core.WholeFile(target).discard()
            except _core.error as e:
                raise OSError(str(e)) from None


def check_folder(out: Path, inputs: Iterable[Path]) -> None:
    """:raises FileExistsError: for a folder of results, which are replaced, with something in it that is read."""
    for path in inputs:
        if is_in(path, out):
            raise FileExistsError(f'{path} is in {out}, whose files would be replaced: choose another folder')


def write_whole(path: str, content: bytes) -> None:
    """Writes a file beside the old one, and puts it in its place when all of it is on the disk.

    :raises OSError: for a full disk too; the old file stays.
    """
    target = '' if is_open_file(path) else output_file(path)
    try:
        if not target:
            write_to_open_file(path, content)
        elif os.path.exists(target) and not os.path.isfile(target):  # a device, which cannot be replaced
            with open(target, 'wb') as file:
                file.write(content)
        else:
            with replaced(target) as (part,), open(part, 'wb') as file:
                file.write(content)
    except OSError as e:
        raise type(e)(f'{path} cannot be written: {e.strerror or e}') from None


@contextmanager
def replaced(*paths: str) -> Iterator[list[str]]:
    """Names that nothing has, to write files to, which replace those at the paths when the block ends without an error."""
    parts: list[_core.WholeFile] = []
    try:
        for path in paths:
            parts.append(_core.WholeFile(path))
        yield [os.fsdecode(part.part) for part in parts]
        for part in parts:
            part.commit()
    except _core.error as e:
        raise OSError(str(e)) from None
    finally:
        for part in parts:
            part.discard()


@contextmanager
def only_writer(path: str) -> Iterator[None]:
    """Locks a folder, or a file, which is made if it is missing.

    :raises FileExistsError: for a link, which could lead to files of others.
    :raises BlockingIOError: if another process has it locked.
    """
    if os.path.islink(path):
        raise FileExistsError(f'{path} is a link: remove it, or choose another name')
    try:
        lock = _core.FileLock(path)
    except _core.error as e:
        raise BlockingIOError(str(e)) from None
    try:
        yield
    finally:
        del lock


def _files_below(folder: str) -> list[str]:
    """Their names relative to it, with '/'."""
    return [os.path.relpath(os.path.join(root, name), folder).replace(os.sep, '/') for root, folders, files in os.walk(folder)
            for name in files + [name for name in folders if os.path.islink(os.path.join(root, name))]]


def rows_of(path: str, columns: Sequence[str]) -> Optional[list[dict[str, str]]]:
    """Of a CSV file that begins with these columns; None for another file."""
    with open(path, encoding='utf-8', errors='replace', newline='') as file, suppress(csv.Error):
        table = csv.DictReader(file)
        if list(table.fieldnames or ())[:len(columns)] == list(columns):
            return list(table)
    return None


@contextmanager
def new_results(out: str, mark: str, earlier: Callable[[str], Optional[Iterable[str]]]) -> Iterator[str]:
    """A folder to write to, whose files take their place in that of the results when the block ends without an error.

    Until then earlier results stay there. Nothing is removed or replaced but these.

    :param out: made if it is missing; a link is followed, also if nothing is at its end yet.
    :param mark: file that results always hold.
    :param earlier: names of the files of earlier results besides it, told by the folder; None if the file of that name is another.
    :raises FileExistsError: for a folder that holds something else, or that another process is writing.
    """
    target = os.path.realpath(out)
    there = _files_below(target)
    others = earlier(target) if os.path.isfile(os.path.join(target, mark)) else None
    listed = set() if others is None else {mark, *others}
    old = {name for name in there if name in listed}
    killed = {name.split('/')[0] for name in there if re.fullmatch(re.escape(PART) + r'\w{8}/' + re.escape(MADE), name)}
    own = old.union(name for name in there if '/' in name and name.split('/')[0] in killed)
    try:
        lock = _core.OutputFolder(target, [os.fsencode(name) for name in own])
    except _core.error as e:
        raise FileExistsError(str(e)) from None
    for folder in killed:
        shutil.rmtree(os.path.join(target, folder), ignore_errors=True)
    part = tempfile.mkdtemp(prefix=PART, dir=target)
    try:
        with open(os.path.join(part, MADE), 'wb'):
            pass
        yield part
        _publish(part, target, mark, old)
    finally:
        shutil.rmtree(part, ignore_errors=True)
        del lock


def _publish(part: str, target: str, mark: str, old: set[str]) -> None:
    new = sorted({*_files_below(part)} - {MADE}, key=lambda name: name == mark)
    for name in new:
        if name not in old and os.path.lexists(os.path.join(target, name)):
            raise FileExistsError(f'{os.path.join(target, name)} has come there meanwhile: remove it, or choose another folder')
    for name in new:
        os.makedirs(os.path.dirname(os.path.join(target, name)), exist_ok=True)
        os.replace(os.path.join(part, name), os.path.join(target, name))
    for name in old.difference(new):
        with suppress(OSError):  # of a folder, what else is in it stays
            os.unlink(os.path.join(target, name))
            while os.path.dirname(name):
                name = os.path.dirname(name)
                os.rmdir(os.path.join(target, name))


def read_bytes(path: Path) -> bytes:
    """:raises ValueError: for what is no file, such as a FIFO, which would never end."""
    if not os.path.isfile(path):
        raise ValueError('not a file' if os.path.lexists(path) else 'there is no such file')
    with open(path, 'rb') as file:
        return file.read()
