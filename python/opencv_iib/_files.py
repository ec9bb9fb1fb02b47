"""Writes files and folders: each file as a whole, by one process at a time, and nothing of the user's is lost."""
from __future__ import annotations

import csv
import glob
import io
import json
import os
import re
import threading
from contextlib import AbstractContextManager, contextmanager, suppress
from typing import Any, Iterable, Iterator, Optional

from opencv_iib import _core
from opencv_iib._arguments import MissingFile, Path, TakenFile, UnusableName
from opencv_iib._streams import check_open_file, is_open_file, write_to_open_file

RECORD = '.made-by-opencv-iib'  #: file in a folder of results: the command, and the files that it has written
PART = re.compile(r'\.\d+-\d+\.tmp$')  #: ending of files that are being written


def output_file(path: str) -> str:
    """The path of a file to write, links followed. :raises InvalidOption: for a folder, a missing parent, and a name that is too long."""
    target = os.path.realpath(path)
    try:
        os.lstat(target)
    except FileNotFoundError:
        pass
    except OSError as e:
        raise UnusableName(f'{path} cannot be written: {e.strerror}') from None
    if os.path.isdir(target):
        raise UnusableName(f'{path or target} is a folder: give the name of a file')
    if not os.path.isdir(os.path.dirname(target)):
        raise MissingFile(f'{path}: there is no folder {os.path.dirname(target)}')
    return target


def is_same(path: Path, other: Path) -> bool:
    if os.path.exists(path) and os.path.exists(other):
        return os.path.samefile(path, other)
    return os.path.realpath(path) == os.path.realpath(other)


def is_in(path: Path, folder: Path) -> bool:
    """Whether a file is below a folder, links followed."""
    return os.path.realpath(path).startswith(os.path.join(os.path.realpath(folder), ''))


def check_outputs(outputs: Iterable[Path], inputs: Iterable[Path]) -> None:
    """Checks files before any work is done.
    :raises TakenFile: for an output that is an input, by any name, or another output.
    :raises InvalidOption: as output_file.
    :raises OSError: where no file can be made, or if standard output is closed."""
    taken = {path: 'an input' for path in inputs}
    for path in outputs:
        for other, what in taken.items():
            if is_same(path, other):
                raise TakenFile(f'{path} is {what} too: choose another name for the output')
        taken[path] = 'another output'
        if is_open_file(os.fspath(path)):
            check_open_file(os.fspath(path))
        else:
            try:
                _core.WholeFile(output_file(os.fspath(path))).discard()
            except _core.error as e:
                raise OSError(str(e)) from None


def check_folder(out: Path, inputs: Iterable[Path] = (), others: str = '') -> None:
    """Checks a folder of results, which is made later if it is missing.
    :param others: what else may be given, for the message.
    :raises TakenFile: for a folder that contains an input.
    :raises UnusableName: if it or a parent is a file, and for a new one with a suffix."""
    suffix = os.path.splitext(os.fspath(out))[1]
    if is_open_file(os.fspath(out)) or (suffix[1:2].isalpha() and not os.path.lexists(out)):
        raise UnusableName(f'{os.fspath(out)} cannot be written: known are a folder{others}; one with a suffix must be there before')
    above = os.path.realpath(out)
    while not os.path.lexists(above) and os.path.dirname(above) != above:
        above = os.path.dirname(above)
    if not os.path.isdir(above):
        raise UnusableName(f'{os.fspath(out)} cannot be a folder: {above} is a file')
    for path in inputs:
        if is_in(path, out):
            raise TakenFile(f'{path} is in {out}, whose files would be replaced: choose another folder')


def check_images(*paths: Path) -> None:
    """:raises InvalidOption: for a missing file, and a folder."""
    for path in paths:
        if not os.path.exists(os.fspath(path)):  # fspath: exists() takes integers as open files
            raise MissingFile(f'there is no file {os.fspath(path)}')
        if os.path.isdir(path):
            raise UnusableName(f'{os.fspath(path)} is a folder: give the name of an image')


def check_is_folder(path: Path) -> None:
    if not os.path.isdir(os.fspath(path)):
        raise MissingFile(f'{os.fspath(path)} is a file: give a folder' if os.path.exists(path) else f'there is no folder {os.fspath(path)}')


def csv_bytes(rows: Iterable[Iterable[Any]]) -> bytes:
    """A table as CSV; names of files that are not UTF-8 are escaped."""
    text = io.StringIO(newline='')
    csv.writer(text).writerows(rows)
    return text.getvalue().encode(errors='backslashreplace')


def write_whole(path: str, content: bytes) -> None:
    """Writes a file, which replaces an older one when it is complete. :raises OSError: also for a full disk; the old file stays."""
    try:
        if is_open_file(path):
            write_to_open_file(path, content)
        else:
            with replaced(output_file(path)) as (part,), open(part, 'wb') as file:
                file.write(content)
    except OSError as e:
        raise type(e)(f'{path} cannot be written: {e.strerror or e}') from None


@contextmanager
def replaced(*paths: str) -> Iterator[list[str]]:
    """New names to write files to. They replace the files at the paths when the block ends without an error."""
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


def remove_parts(path: str) -> None:
    """Removes unfinished replacements of this file, of killed processes. No process may be writing it now."""
    for other in glob.iglob(glob.escape(path) + '.*.tmp'):
        if PART.sub('', other) == path:
            os.unlink(other)


@contextmanager
def only_writer(path: str, is_folder: bool = False) -> Iterator[None]:
    """Locks an existing folder, or a file, which is made if it is missing, and removed if it stays empty after an error.
    :raises FileExistsError: for a link, and for a folder in place of a file.
    :raises BlockingIOError: if another process has locked it, or has removed the folder."""
    if os.path.islink(path) or (os.path.isdir(path) and not is_folder):
        raise FileExistsError(f'{path} is a {"link" if os.path.islink(path) else "folder"}: remove it, or choose another name')
    made = not os.path.exists(path)
    try:
        lock = _core.FileLock(path, is_folder)
    except _core.error as e:
        raise BlockingIOError(str(e)) from None
    try:
        yield
    except BaseException:
        with suppress(OSError):
            if made and not os.path.getsize(path):
                os.unlink(path)
        raise
    finally:
        del lock


class Results(AbstractContextManager['Results']):
    """A folder of a command's results. A record in it lists the files of the command; all others are the user's.

    After a block without an error, files of earlier calls that were not written again are removed."""

    def __init__(self, out: str, command: str) -> None:
        """:param out: made if it is missing; links are followed.
        :raises FileExistsError: for a folder with other files, or one that another process is writing."""
        self.folder, self._command = os.path.realpath(out), command
        self.written: set[str] = set()  #: names of files, with '/'
        self._adding, self._record = threading.Lock(), os.path.join(self.folder, RECORD)
        by, listed = None, list[str]()
        with suppress(OSError, ValueError), open(self._record, encoding='ascii') as file:
            by, *listed = [json.loads(line) for line in file if line.endswith('\n')]  # the last one may be cut off
        if by not in (None, command) or not all(isinstance(name, str) for name in listed):  # version 0.3 wrote lists
            raise FileExistsError(f'{out} holds results of {by}{" of an earlier version" * (by == command)}: choose another folder')
        whole = {RECORD, *listed}
        own = {name for name in _files_below(self.folder) if PART.sub('', name) in whole}
        try:
            self._lock = _core.OutputFolder(self.folder, list(map(os.fsencode, own)))
        except _core.error as e:
            raise FileExistsError(str(e)) from None
        self.old = own.intersection(listed)  #: files of earlier calls
        self.remove(own - whole)  # unfinished files of killed processes
        self._list(self.old)

    def place(self, name: str) -> str:
        """The path of a file to write, which is added to the record. Threads may call it."""
        with self._adding, open(self._record, 'a', encoding='ascii') as file:
            self.written.add(name)
            file.write(json.dumps(name) + '\n')
        path = os.path.join(self.folder, name)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        return path

    def _list(self, names: Iterable[str]) -> None:
        write_whole(self._record, ''.join(json.dumps(each) + '\n' for each in (self._command, *sorted(names))).encode())

    def remove(self, names: Iterable[str]) -> None:
        """Removes files, and folders that are empty then."""
        for name in names:
            with suppress(OSError):  # folders with other files stay
                os.unlink(os.path.join(self.folder, name))
                while os.path.dirname(name):
                    name = os.path.dirname(name)
                    os.rmdir(os.path.join(self.folder, name))

    def __exit__(self, kind: Optional[type[BaseException]], *_: Any) -> None:
        if kind is None:
            self.remove(self.old - self.written)
            self._list(self.written)
        elif not self.old | self.written:
            self.remove([RECORD])
        del self._lock


def _files_below(folder: str) -> list[str]:
    """Names of files below a folder, relative to it, with '/', without links."""
    found = [os.path.relpath(os.path.join(root, name), folder).replace(os.sep, '/') for root, _, files in os.walk(folder) for name in files]
    return [name for name in found if not os.path.islink(os.path.join(folder, name))]


def read_bytes(path: Path) -> bytes:
    """:raises ValueError: for a missing file, and for anything else, such as a FIFO, which might never end."""
    if not os.path.isfile(path):
        raise ValueError('not a file' if os.path.lexists(path) else 'there is no such file')
    with open(path, 'rb') as file:
        return file.read()
