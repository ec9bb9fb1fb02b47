"""Files and folders that are written: where, whole, and by one process at a time."""
from __future__ import annotations

import json
import os
import re
import shutil
import stat
from contextlib import contextmanager, suppress
from typing import Any, Collection, Iterable, Iterator

from opencv_iib import _core
from opencv_iib._arguments import MissingFile, Path, TakenFile, UnusableName
from opencv_iib._streams import check_open_file, is_open_file, write_to_open_file

OF_FILE_MANAGERS = {'.DS_Store', 'Thumbs.db', 'desktop.ini'}  #: files that they write into folders that they show
PART = '.iib-part'  #: the folder that results are written to, within that of the results
RECORD = '.made-by-opencv-iib'  #: a file in both: which command has written which files; all others are the user's


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
        target = ''
        if is_open_file(os.fspath(path)):
            check_open_file(os.fspath(path))
        else:
            target = output_file(os.fspath(path))
        if target and (os.path.isfile(target) or not os.path.exists(target)):
            try:
                _core.WholeFile(target).discard()
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


def remove_parts(paths: Collection[str]) -> None:
    """What killed processes were writing, to be put in place of these files. No other may be writing them now."""
    for folder in {os.path.dirname(path) for path in paths}:
        with suppress(FileNotFoundError):
            for name in os.listdir(folder):
                whole = re.fullmatch(r'(.*)\.\d+-\d+\.tmp', name)
                if whole and os.path.join(folder, whole[1]) in paths:
                    os.unlink(os.path.join(folder, name))


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


def _files_below(folder: str) -> list[str]:
    """Their names relative to it, with '/'."""
    return [os.path.relpath(os.path.join(root, name), folder).replace(os.sep, '/') for root, folders, files in os.walk(folder)
            for name in files + [name for name in folders if os.path.islink(os.path.join(root, name))]]


@contextmanager
def new_results(out: str, command: str, state: str = '') -> Iterator[str]:
    """A folder to write files to, which take their place in that of the results when the block ends without an error.

    Until then earlier results stay there. Nothing is removed or replaced but what the record lists, if it was not changed later.

    :param out: made if it is missing; a link is followed, also if nothing is at its end yet.
    :param command: whose results are replaced.
    :param state: a file that tells of what the others are: it is not there while they are replaced.
    :raises FileExistsError: for a folder that holds something else, or that another process is writing.
    """
    target = os.path.realpath(out)
    part, there, (other, newest, files) = os.path.join(target, PART), _files_below(target), _recorded(target)
    if other not in (None, command):
        raise FileExistsError(f'{out} holds results of {other}: choose another folder')
    old = [name for name in there if name in files]
    for name in old:
        if _is_changed(target, name, newest):
            raise FileExistsError(f'{out} holds {name}, which was changed since it was written: move it away, or choose another folder')
    killed = [name for name in there if name.startswith(PART + '/')] if os.path.exists(os.path.join(part, RECORD)) else []
    own = [*old, *killed, *([RECORD] if other else [])]
    try:
        lock = _core.OutputFolder(target, list(map(os.fsencode, own)))
    except _core.error as e:
        raise FileExistsError(str(e)) from None
    try:
        _discard(part)
        os.mkdir(part)
        _record(part, part, command, 0, [])  # by which a later call knows what a killed one has left
        yield part
        new = [name for name in _files_below(part) if name != RECORD]
        for name in new:
            if os.path.lexists(os.path.join(target, name)) and (name not in old or _is_changed(target, name, newest)):
                raise FileExistsError(f'{os.path.join(target, name)} has come there meanwhile: remove it, or choose another folder')
        now = max([newest, *(os.lstat(os.path.join(part, name)).st_mtime_ns for name in new)])
        _record(target, part, command, now, [*old, *new])  # both, until all are there: a process may be killed in between
        _remove(target, [name for name in old if name == state])
        for name in sorted(new, key=lambda name: (name == state, name)):
            os.makedirs(os.path.dirname(os.path.join(target, name)), exist_ok=True)
            os.replace(os.path.join(part, name), os.path.join(target, name))
        _remove(target, [name for name in old if name not in new and not _is_changed(target, name, newest)])
        _record(target, part, command, now, new)
    finally:
        _discard(part)
        del lock


def _record(folder: str, part: str, command: str, newest: int, files: list[str]) -> None:
    """:param newest: time of the newest of the files, nanoseconds: one that is newer was changed by others."""
    record = os.path.join(part, 'record')
    write_whole(record, json.dumps({'command': command, 'newest': newest, 'files': files}).encode())
    os.replace(record, os.path.join(folder, RECORD))


def _recorded(folder: str) -> tuple[Any, int, list[str]]:
    """What _record has written there; None, 0 and nothing without a record."""
    with suppress(OSError, ValueError, KeyError, TypeError), open(os.path.join(folder, RECORD), encoding='ascii') as file:
        record = json.load(file)
        return record['command'], int(record['newest']), list(record['files'])
    return None, 0, []


def _is_changed(folder: str, name: str, newest: int) -> bool:
    with suppress(FileNotFoundError):
        status = os.lstat(os.path.join(folder, name))
        return stat.S_ISLNK(status.st_mode) or status.st_mtime_ns > newest
    return False


def _remove(folder: str, names: Iterable[str]) -> None:
    """Files, and folders that become empty by that."""
    for name in names:
        with suppress(OSError):  # of a folder, what else is in it stays
            os.unlink(os.path.join(folder, name))
            while os.path.dirname(name):
                name = os.path.dirname(name)
                os.rmdir(os.path.join(folder, name))


def _discard(part: str) -> None:
    """What was not published."""
    shutil.rmtree(part, ignore_errors=True)


def read_bytes(path: Path) -> bytes:
    """:raises ValueError: for what is no file, such as a FIFO, which would never end."""
    if not os.path.isfile(path):
        raise ValueError('not a file' if os.path.lexists(path) else 'there is no such file')
    with open(path, 'rb') as file:
        return file.read()
