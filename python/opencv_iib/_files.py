"""Files and folders that are written: where, whole, and by one process at a time."""
from __future__ import annotations

import json
import os
import re
import tempfile
from contextlib import contextmanager, suppress
from typing import Any, Iterable, Iterator, Optional

from opencv_iib import _core
from opencv_iib._arguments import MissingFile, Path, TakenFile, UnusableName
from opencv_iib._streams import check_open_file, is_open_file, write_to_open_file

OF_FILE_MANAGERS = {'.DS_Store', 'Thumbs.db', 'desktop.ini'}  #: files that they write into folders that they show
PART = '.iib-'  #: how the folder's name begins that results are written to, within that of the results
RECORD = '.made-by-opencv-iib'  #: a file in both: which command has written which files, of which size and time; all others are the user's


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
    """A folder to write files to that were planned, which take their place in that of the results when the block ends without an error.

    Until then earlier results stay there. Nothing is removed or replaced but what the record tells, if it still is as it was written.

    :param out: made if it is missing; a link is followed, also if nothing is at its end yet.
    :param command: whose results are replaced.
    :param state: a file that tells of what the others are: it is not there while they are replaced.
    :raises FileExistsError: for a folder that holds something else, or that another process is writing.
    """
    target = os.path.realpath(out)
    there, other = _files_below(target), _command(target)
    if other not in (None, command):
        raise FileExistsError(f'{out} holds results of {other}: choose another folder')
    old = _recorded(target, command, there)
    for name in old:
        if not _is_as_written(target, name, old):
            raise FileExistsError(f'{out} holds {name}, which was changed since it was written: move it away, or choose another folder')
    killed = {folder for folder, _, name in (name.partition('/') for name in there)
              if re.fullmatch(re.escape(PART) + r'\w{8}', folder) and (name == RECORD or _core.isPartOf(RECORD, name))}
    parts = {folder: _recorded(os.path.join(target, folder), command, [name[len(folder) + 1:] for name in there if name.startswith(folder + '/')])
             for folder in killed}
    own = [*old, *(f'{folder}/{name}' for folder, names in parts.items() for name in names)]
    try:
        lock = _core.OutputFolder(target, list(map(os.fsencode, own)))
    except _core.error as e:
        raise FileExistsError(str(e)) from None
    for folder, names in parts.items():
        _discard(os.path.join(target, folder), names)
    part = tempfile.mkdtemp(prefix=PART, dir=target)
    try:
        _record(part, command, [])
        yield part
        _publish(part, target, command, old, state)
    finally:
        _discard(part, _recorded(part, command, _files_below(part)))
        del lock


def plan(part: str, names: Iterable[str]) -> None:
    """Tells which files the block of new_results may write: if the process is killed, a later one knows them by that."""
    with open(os.path.join(part, RECORD), 'a', encoding='ascii') as file:
        file.writelines(json.dumps([name, None]) + '\n' for name in names)


def _record(folder: str, command: str, names: Iterable[tuple[str, Optional[str]]]) -> None:
    lines = [json.dumps(line) + '\n' for line in (command, *names, (RECORD, None))]
    write_whole(os.path.join(folder, RECORD), ''.join(lines).encode())


def _command(folder: str) -> Any:
    """Whose record is there; None without one."""
    with suppress(OSError, ValueError), open(os.path.join(folder, RECORD), encoding='ascii') as file:
        return json.loads(next(file, 'null'))
    return None


def _recorded(folder: str, command: str, there: Iterable[str]) -> dict[str, set[Optional[str]]]:
    """Of the files that are there, those that a command has written, or was writing, and their stamps, None if that was not known yet."""
    stamps: dict[str, set[Optional[str]]] = {}
    if _command(folder) == command:
        with suppress(OSError, ValueError, TypeError), open(os.path.join(folder, RECORD), encoding='ascii') as file:
            next(file)
            for line in file:  # the last one may be cut off
                name, stamp = json.loads(line)
                stamps.setdefault(name, set()).add(stamp)
    known: dict[str, set[Optional[str]]] = {}
    for name in there:
        if name in stamps:
            known[name] = stamps[name]
        elif name.endswith('.tmp') and (any(_core.isPartOf(whole, name) for whole in (*stamps, RECORD)) or
                                        _core.isPartOf('probe', name) and _stamp(folder, name).startswith('0 ')):  # which is OutputFolder's
            known[name] = {None}
    return known


def _stamp(folder: str, name: str) -> str:
    """Size and time of a file; '' of one that is not there."""
    with suppress(FileNotFoundError):
        status = os.lstat(os.path.join(folder, name))
        return f'{status.st_size} {status.st_mtime_ns}'
    return ''


def _is_as_written(folder: str, name: str, recorded: dict[str, set[Optional[str]]]) -> bool:
    stamp = _stamp(folder, name)
    return not stamp or not recorded[name].isdisjoint({None, stamp}) and not os.path.islink(os.path.join(folder, name))


def _publish(part: str, target: str, command: str, old: dict[str, set[Optional[str]]], state: str) -> None:
    new = {name: _stamp(part, name) for name in _files_below(part) if name != RECORD}
    for name in new:
        if os.path.lexists(os.path.join(target, name)) and not (name in old and _is_as_written(target, name, old)):
            raise FileExistsError(f'{os.path.join(target, name)} has come there meanwhile: remove it, or choose another folder')
    # Both, until all are there: a process may be killed in between.
    _record(target, command, [*new.items(), *((name, stamp) for name, stamps in old.items() for stamp in stamps)])
    _remove(target, [name for name in old if name == state])
    for name in sorted(new, key=lambda name: (name == state, name)):
        os.makedirs(os.path.dirname(os.path.join(target, name)), exist_ok=True)
        os.replace(os.path.join(part, name), os.path.join(target, name))
    _remove(target, [name for name in old if name not in new and name != RECORD and _is_as_written(target, name, old)])
    _record(target, command, new.items())


def _remove(folder: str, names: Iterable[str]) -> None:
    """Files, and folders that become empty by that."""
    for name in names:
        with suppress(OSError):  # of a folder, what else is in it stays
            os.unlink(os.path.join(folder, name))
            while os.path.dirname(name):
                name = os.path.dirname(name)
                os.rmdir(os.path.join(folder, name))


def _discard(part: str, names: Iterable[str]) -> None:
    """What was not published, and last by what it is known."""
    _remove(part, sorted(names, key=lambda name: name == RECORD))
    for root, _, _ in os.walk(part, topdown=False):
        with suppress(OSError):
            os.rmdir(root)


def read_bytes(path: Path) -> bytes:
    """:raises ValueError: for what is no file, such as a FIFO, which would never end."""
    if not os.path.isfile(path):
        raise ValueError('not a file' if os.path.lexists(path) else 'there is no such file')
    with open(path, 'rb') as file:
        return file.read()
