"""Files and folders that are written: where, whole, and by one process at a time."""
from __future__ import annotations

import glob
import json
import os
import re
import threading
from contextlib import AbstractContextManager, contextmanager, suppress
from typing import Any, Iterable, Iterator, Optional

from opencv_iib import _core
from opencv_iib._arguments import MissingFile, Path, TakenFile, UnusableName
from opencv_iib._streams import check_open_file, is_open_file, write_to_open_file

RECORD = '.made-by-opencv-iib'  #: in a folder of results: which command has written which files
PART = re.compile(r'\.\d+-\d+\.tmp$')  #: behind the names of files that are being written


def output_file(path: str) -> str:
    """Where a file is written: at the end of a link, also if nothing is there yet.

    :raises InvalidOption: for a folder, within a folder that is missing, and for a name that is too long.
    """
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
    """Whether two names are of one file."""
    if os.path.exists(path) and os.path.exists(other):
        return os.path.samefile(path, other)
    return os.path.realpath(path) == os.path.realpath(other)


def is_in(path: Path, folder: Path) -> bool:
    """Whether a file is below a folder, where links lead."""
    return os.path.realpath(path).startswith(os.path.join(os.path.realpath(folder), ''))


def check_outputs(outputs: Iterable[Path], inputs: Iterable[Path]) -> None:
    """What can be told before there is work to lose.

    :raises TakenFile: for a file to be written that is read, by whatever name, or that is written twice.
    :raises InvalidOption: as output_file.
    :raises OSError: where no file can be made, or nothing written to what is open.
    """
    taken = {path: 'an input' for path in inputs}
    for path in outputs:
        for other, what in taken.items():
            if is_same(path, other):
                raise TakenFile(f'{path} is {what} too: give what is written a name of its own')
        taken[path] = 'another output'
        if is_open_file(os.fspath(path)):
            check_open_file(os.fspath(path))
        else:
            try:
                _core.WholeFile(output_file(os.fspath(path))).discard()
            except _core.error as e:
                raise OSError(str(e)) from None


def check_folder(out: Path, inputs: Iterable[Path] = (), others: str = '') -> None:
    """Of a folder to be written, which is made if it is missing, as are those that it is in.

    :param others: what else may be given, for the message.
    :raises TakenFile: for one whose files are replaced, with something in it that is read.
    :raises UnusableName: where it or one that it would be in is a file; for a new one whose name ends like that of a file.
    """
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
    """Of files that are given by their names. :raises InvalidOption: for one that is not there."""
    for path in paths:
        if not os.path.exists(os.fspath(path)):  # which takes integers for open files
            raise MissingFile(f'there is no file {os.fspath(path)}')
        if os.path.isdir(path):
            raise UnusableName(f'{os.fspath(path)} is a folder: give the name of an image')


def check_is_folder(path: Path) -> None:
    """:raises MissingFile: for one that is not there."""
    if not os.path.isdir(os.fspath(path)):
        raise MissingFile(f'there is no folder {os.fspath(path)}')


def write_whole(path: str, content: bytes) -> None:
    """Writes a file beside the old one, and puts it in its place when all of it is on the disk.

    :raises OSError: for a full disk too; the old file stays.
    """
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


def remove_parts(path: str) -> None:
    """What killed processes were writing, to be put in place of this file. No other may be writing it now."""
    for other in glob.iglob(glob.escape(path) + '.*.tmp'):
        if PART.sub('', other) == path:
            os.unlink(other)


@contextmanager
def only_writer(path: str, is_folder: bool = False) -> Iterator[None]:
    """Locks a folder that is there, or a file, which is made if it is missing, and removed if nothing came of it.

    :raises FileExistsError: for a link, which could lead to files of others, and for a folder in a file's place.
    :raises BlockingIOError: if another process has it locked, or has removed the folder.
    """
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
    """A folder that a command writes its results to, file by file. A record in it lists the command's files; all others are the user's.

    At the end those of earlier calls that were not written again are removed, if no error was raised.
    """

    def __init__(self, out: str, command: str) -> None:
        """:param out: made if it is missing; a link is followed, also if nothing is at its end yet.
        :raises FileExistsError: for a folder that holds something else, or that another process is writing."""
        self.folder, self._command = os.path.realpath(out), command
        self.written: set[str] = set()  #: names of files, with '/'
        self._adding, self._record = threading.Lock(), os.path.join(self.folder, RECORD)
        by, listed = _recorded(self._record)
        if by not in (None, command):
            raise FileExistsError(f'{out} holds results of {by}: choose another folder')
        own = {name for name in _files_below(self.folder) if PART.sub('', name) in listed | {RECORD}}
        try:
            self._lock = _core.OutputFolder(self.folder, list(map(os.fsencode, own)))
        except _core.error as e:
            raise FileExistsError(str(e)) from None
        self.old = own & listed  #: what earlier calls have written
        self.remove(own - self.old - {RECORD})  # what killed processes were writing
        self._list(self.old)

    def place(self, name: str) -> str:
        """The path for a file to write, which is put on the record. Threads may ask at once."""
        with self._adding, open(self._record, 'a', encoding='ascii') as file:
            self.written.add(name)
            file.write(json.dumps(name) + '\n')
        path = os.path.join(self.folder, name)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        return path

    def _list(self, names: Iterable[str]) -> None:
        write_whole(self._record, ''.join(json.dumps(each) + '\n' for each in (self._command, *sorted(names))).encode())

    def remove(self, names: Iterable[str]) -> None:
        """Files, and folders that become empty by that."""
        for name in names:
            with suppress(OSError):  # of a folder, what else is in it stays
                os.unlink(os.path.join(self.folder, name))
                while os.path.dirname(name):
                    name = os.path.dirname(name)
                    os.rmdir(os.path.join(self.folder, name))

    def __exit__(self, kind: Optional[type[BaseException]], *_: Any) -> None:
        if kind is None:  # all is written
            self.remove(self.old - self.written)
            self._list(self.written)
        elif not self.old | self.written:
            self.remove([RECORD])
        del self._lock


def _files_below(folder: str) -> list[str]:
    """Their names relative to it, with '/'; links are none."""
    found = [os.path.relpath(os.path.join(root, name), folder).replace(os.sep, '/') for root, _, files in os.walk(folder) for name in files]
    return [name for name in found if not os.path.islink(os.path.join(folder, name))]


def _recorded(record: str) -> tuple[Any, set[str]]:
    """Which command has written which files; None and nothing without a record."""
    with suppress(OSError, ValueError), open(record, encoding='ascii') as file:
        command, *names = [json.loads(line) for line in file if line.endswith('\n')]  # the last one may be cut off
        return command, set(names)
    return None, set()


def read_bytes(path: Path) -> bytes:
    """:raises ValueError: for what is no file, such as a FIFO, which would never end."""
    if not os.path.isfile(path):
        raise ValueError('not a file' if os.path.lexists(path) else 'there is no such file')
    with open(path, 'rb') as file:
        return file.read()
