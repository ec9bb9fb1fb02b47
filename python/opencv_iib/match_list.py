"""Matches pairs of a list as match_images does, to a folder of tables or a file that hloc reads."""
from __future__ import annotations

import collections
import contextlib
import csv
import io
import json
import os
import threading
from typing import Any, Callable, Collection, Iterator, Optional

import numpy as np

from opencv_iib import __version__
from opencv_iib._arguments import InvalidOption, Path
from opencv_iib._camera import AnyCamera, Camera, as_camera
from opencv_iib._files import Results, check_folder, check_is_folder, check_outputs, csv_bytes, only_writer, output_file, remove_parts, replaced, write_whole
from opencv_iib._hdf5 import import_h5py, new_hdf5
from opencv_iib._image_file import Masks, check_sizes
from opencv_iib._image_names import find_images
from opencv_iib._pair_list import check_list, pair_name, tiles
from opencv_iib._parallel import Threads, in_parallel, thread_count
from opencv_iib._partial import LOGS, close_partial, open_partial
from opencv_iib._progress import with_progress
from opencv_iib._streams import note
from opencv_iib.features import FeatureOptions, Features
from opencv_iib.measure import Measured, View, measure

HDF5 = ('.h5', '.hdf5')
TABLE, PARTIAL = 'pairs.csv', '.partial'
COLUMNS = ['image_a', 'image_b', 'found', 'reason', 'matches', 'agree', 'rotation', *(f'r{row}{column}' for row in '123' for column in '123'),
           't1', 't2', 't3', 'files', 'settings']
FOUND, MARK = 2, slice(-2, None)  # columns; a pair whose mark is the same is not matched again
IMAGES_HELD = 32  # described images whose pixels are kept
Row = list[str]  # of COLUMNS


def _row(a: str, b: str, measured: Measured, mark: Row) -> Row:
    pose = measured.pose
    numbers = [f'{value:.10g}' for value in (*pose.R.ravel(), *pose.t.ravel())] if pose is not None and pose.found else [''] * 12
    return [a, b, f'{measured.found:d}', pose.reason if pose is not None else '', f'{len(measured.bits)}', f'{measured.agree.sum()}',
            f'{measured.rotation:.10g}', *numbers, *mark]


class _State(contextlib.AbstractContextManager['_State']):
    """Results that are not exported yet, by the pairs' names."""

    def __init__(self, path: str) -> None:
        self._path, self._db, self.exported = path, open_partial(path, 'iib_pairs'), False
        self._db.execute('CREATE TABLE IF NOT EXISTS iib_pairs (name TEXT PRIMARY KEY, row TEXT, content BLOB)')

    def rows(self) -> dict[str, Row]:
        return {name: json.loads(row) for name, row in self._db.execute('SELECT name, row FROM iib_pairs ORDER BY rowid')}

    def contents(self) -> Iterator[tuple[str, bytes]]:
        yield from self._db.execute('SELECT name, content FROM iib_pairs ORDER BY rowid')

    def put(self, name: str, row: Row, content: bytes) -> None:
        self._db.execute('REPLACE INTO iib_pairs VALUES (?, ?, ?)', (name, json.dumps(row), content))

    def forget(self, name: str) -> None:
        self._db.execute('DELETE FROM iib_pairs WHERE name=?', (name,))

    def __exit__(self, *exc: Any) -> None:
        close_partial(self._db, self._path, self.exported or not self.rows())


class _Folder(Results):
    """A CSV file a pair, ``A/B.csv``, and a table of all."""

    def __init__(self, table: str) -> None:
        super().__init__(os.path.dirname(table), 'match')
        for end in ('', PARTIAL, *(PARTIAL + log for log in LOGS)):
            self.place(TABLE + end)
        self.written |= self.old  # pairs of earlier lists stay
        self.rows: dict[str, Row] = {}
        with contextlib.suppress(FileNotFoundError, csv.Error, ValueError), open(table, encoding='utf-8', newline='') as file:
            head, *rows = csv.reader(file)
            self.rows = {pair_name(*row[:2]): row for row in rows if head == COLUMNS and len(row) == len(COLUMNS)}

    def has(self, name: str) -> bool:
        """Whether the pair's file exists. :raises OSError: for a name that is too long."""
        for part in (name + '.csv').split('/'):
            with contextlib.suppress(FileNotFoundError):
                os.lstat(os.path.join(self.folder, part))
        return name + '.csv' in self.written

    def content(self, measured: Measured) -> bytes:
        return measured.content()

    def export(self, state: _State, removed: Collection[str]) -> None:
        for name, content in state.contents():
            write_whole(self.place(name + '.csv'), content)
        rows = {**self.rows, **state.rows()}
        write_whole(self.place(TABLE), csv_bytes([COLUMNS, *(row for name, row in rows.items() if name not in removed)]))
        self.written -= {name + '.csv' for name in removed}


class _Hdf5:
    """A group a pair as in hloc's dense matches: keypoints0, keypoints1, scores; and covariances, agrees, and with cameras R and t."""

    def __init__(self, path: str) -> None:
        self._path, self.rows = path, dict[str, Row]()
        self._old: Any = {}
        h5py = import_h5py()
        remove_parts(path)
        if os.path.exists(path) and os.path.getsize(path):
            try:
                self._old = h5py.File(path, 'r')
            except BlockingIOError:
                raise BlockingIOError(f'{path} is being written by another process') from None
            except OSError as e:
                raise OSError(f'{path} is no HDF5 file that can be read: {e}') from None
            if 'opencv_iib' not in self._old.attrs:
                raise FileExistsError(f'{path} is there, and not of this command: choose another name')
            for name in self._names():
                known = self._old[name].attrs
                if 'mark' in known:
                    self.rows[name] = ['', '', f'{known["found"]:d}', *known['mark']]

    def _names(self) -> list[str]:
        """Names of pairs, and of groups that the user has added."""
        return [name for first, group in self._old.items() for name in ([f'{first}/{each}' for each in group] if hasattr(group, 'keys') else [first])]

    def has(self, name: str) -> bool:
        return name in self.rows

    def content(self, measured: Measured) -> bytes:
        arrays, pose = io.BytesIO(), measured.pose
        posed: dict[str, Any] = {'R': pose.R, 't': pose.t.ravel(), 'covariance': pose.covariance} if pose is not None and pose.found else {}
        np.savez(arrays, keypoints0=measured.matches.points1, keypoints1=measured.matches.points2,
                 scores=measured.matches.similarities.ravel().clip(0), covariances=measured.matches.covariances, agrees=measured.agree, **posed)
        return arrays.getvalue()

    def export(self, state: _State, removed: Collection[str]) -> None:
        rows = state.rows()
        with replaced(self._path) as (part,), new_hdf5(part) as file:
            file.attrs['opencv_iib'] = 'match'
            for name in self._names():
                if name not in rows and name not in removed:
                    self._old.copy(name, file.require_group(os.path.dirname(name) or '/'))
            for name, content in state.contents():
                group, row = file.create_group(name), dict(zip(COLUMNS, rows[name]))
                with np.load(io.BytesIO(content)) as arrays:
                    for array, values in arrays.items():
                        group[array] = values
                group.attrs.update(found=row['found'] == '1', reason=row['reason'], rotation=float(row['rotation']), mark=rows[name][MARK])


def match_list(pairs: Path, images: Path, out: Path, camera: Optional[AnyCamera] = None, options: FeatureOptions = FeatureOptions(),
               workers: Optional[int] = None, log: Callable[[str], None] = note) -> tuple[int, int]:
    """Matches pairs of a list as match_images does, and describes each image once. Finished pairs are kept in a file of SQLite,
    ``pairs.csv.partial`` in the folder or ``X.h5.partial``: a later call continues from there, and matches pairs that are new, were changed or were
    matched with other options. Pairs of images that cannot be read any more are removed.

    :param pairs: text file of two names a line, as COLMAP and hloc write it.
    :param images: folder that the names are relative to.
    :param out: folder for a CSV file a pair, ``A/B.csv`` (a / in names is a -), and ``pairs.csv``, with verdicts and poses; or a file in .h5
        or .hdf5, with a group a pair as in hloc's dense matches.
    :param camera: of all images, as in match_images.
    :param workers: threads; None for one a core.
    :param log: gets a line about each unreadable image and each line of the list that is not of two images, which are left out.
    :return: how many pairs show the same, and how many there are, including those that are left out.
    :raises ValueError: for a list without a pair of the folder's images.
    :raises FileExistsError: for another file or folder at `out`.
    :raises OSError: if another process is writing it."""
    options.check()
    pool, masks, features, folder, out = Threads(thread_count(workers)), Masks(options.mask), Features(options), os.fspath(images), os.fspath(out)
    lens = None if camera is None else as_camera(camera)
    check_is_folder(folder)
    is_hdf5 = out.lower().endswith(HDF5)
    names = find_images(folder, log)
    chosen, left_out = check_list(pairs, {name: number for number, name in enumerate(names)}, log)
    listed = {frozenset(pair): pair for pair in chosen}
    used = {names[number] for pair in listed.values() for number in pair}
    masked = masks.check(sorted(used))
    if is_hdf5:
        check_outputs([out], (pairs, *masked, *(os.path.join(folder, name) for name in used)))
    else:
        check_folder(out, others=f', and a file in {" or ".join(HDF5)}')
    check_sizes(folder, sorted(used), masks, lens)
    labels = {pair: pair_name(names[pair[0]], names[pair[1]]) for pair in listed.values()}
    (label, count), = collections.Counter(labels.values()).most_common(1) or [('', 0)]
    if count > 1:
        raise InvalidOption(f'{os.fspath(pairs)}: {count} pairs would write {label}, since / becomes -: rename an image')
    settings = json.dumps([*(str(value) for name, value in vars(options).items() if name != 'mask'), str(lens), __version__])
    stamps = {name: masks.stamp(os.path.join(folder, name), name) for name in used}
    marks = {pair: [f'{stamps[names[pair[0]]]} {stamps[names[pair[1]]]}', settings] for pair in labels}
    views, found, logged, removed, missing = _Views(folder, masks, features, lens), 0, set[str](), list[str](), []

    def fail(label: str, why: str) -> None:
        if why not in logged:
            log(why)
        logged.add(why)
        removed.append(label)

    file = output_file(out) if is_hdf5 else os.path.join(os.path.realpath(out), TABLE)
    with contextlib.ExitStack() as stack:
        if is_hdf5:
            stack.enter_context(only_writer(file + PARTIAL))
        target = _Hdf5(file) if is_hdf5 else _Folder(file)
        if isinstance(target, Results):
            stack.enter_context(target)
        state = stack.enter_context(_State(file + PARTIAL))
        measured = state.rows()
        known = {**target.rows, **measured}
        for pair, label in labels.items():
            row = known.get(label, [])
            try:
                if (target.has(label) or label in measured) and row[MARK] == marks[pair]:
                    found += row[FOUND] == '1'
                else:
                    missing.append(pair)
            except OSError as e:
                fail(label, f'{label}.csv cannot be written: {e.strerror}')
        ordered = [pair for tile in tiles(missing, IMAGES_HELD // 4) for pair in tile]  # so that images are held as long as they are needed
        results = in_parallel(lambda pair: measure(views.of(names[pair[0]]), views.of(names[pair[1]]), features), ordered, pool, (Exception,))
        for pair, result in with_progress(results, 'matching', len(listed), len(listed) - len(missing)):
            if isinstance(result, ImportError):
                raise result
            if isinstance(result, Exception):
                state.forget(labels[pair])
                fail(labels[pair], str(result) or type(result).__name__)
            else:
                state.put(labels[pair], _row(names[pair[0]], names[pair[1]], result, marks[pair]), target.content(result))
                found += result.found
        if state.rows() or not target.rows.keys().isdisjoint(removed) or not os.path.exists(file):
            target.export(state, removed)
            state.exported = True
    return found, len(listed) + left_out


class _Views:
    """Images, each described once. Threads may share it."""

    def __init__(self, folder: str, masks: Masks, features: Features, lens: Optional[Camera]) -> None:
        self._folder, self._arguments = folder, (masks, features, lens)
        self._locks: collections.defaultdict[str, threading.Lock] = collections.defaultdict(threading.Lock)
        self._described: dict[str, tuple[np.ndarray, np.ndarray]] = {}
        self._held: dict[str, View] = {}  # least recently used first

    def of(self, name: str) -> View:
        with self._locks[name]:
            view = self._held.pop(name, None) or View.of(os.path.join(self._folder, name), *self._arguments, name, self._described.get(name))
            self._described[name] = view.rows, view.codes
            self._held[name] = view
            while len(self._held) > IMAGES_HELD:
                with contextlib.suppress(KeyError, RuntimeError, StopIteration):  # another thread did
                    del self._held[next(iter(self._held))]
            return view
