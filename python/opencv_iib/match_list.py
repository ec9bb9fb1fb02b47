"""Many pairs of images, each matched as by match_images: a folder of tables, or a file as hloc reads it."""
from __future__ import annotations

import collections
import contextlib
import csv
import io
import json
import os
import threading
from typing import Any, Callable, Optional

import numpy as np

from opencv_iib import __version__, error
from opencv_iib._arguments import InvalidOption, Path
from opencv_iib._files import check_folder, check_is_folder, check_outputs, only_writer, output_file, write_whole
from opencv_iib._images import Masks, check_sizes, find_images
from opencv_iib._parallel import Threads, in_parallel, thread_count
from opencv_iib._progress import Progress
from opencv_iib._streams import note
from opencv_iib.colmap.hloc import pair_name
from opencv_iib.colmap.pairs import from_file, tiles
from opencv_iib.features import FeatureOptions, Features
from opencv_iib.localization.localizer import AnyCamera, Camera, as_camera
from opencv_iib.measure import Measured, View, measure

HDF5 = ('.h5', '.hdf5')
TABLE = 'pairs.csv'
NUMBERS = [*(f'r{row}{column}' for row in '123' for column in '123'), 't1', 't2', 't3']
COLUMNS = ['image_a', 'image_b', 'found', 'reason', 'matches', 'agree', 'rotation', *NUMBERS, 'files', 'settings']
IMAGES_HELD = 32  # whose pixels are kept, of those that were described


class _Folder(contextlib.AbstractContextManager[Any]):
    """A CSV file a pair, ``A/B.csv``, and a table of all, to which each pair adds a line when it is done."""

    def __init__(self, path: str) -> None:
        self._path = path = os.path.realpath(path)
        table = os.path.join(path, TABLE)
        os.makedirs(path, exist_ok=True)
        self._lock = contextlib.ExitStack()
        self._lock.enter_context(only_writer(path, is_folder=True))
        self._done: dict[tuple[str, str], list[str]] = {}
        if os.path.exists(table):
            with open(table, encoding='utf-8', newline='') as file:
                head, *rows = csv.reader(file)
            if head != COLUMNS:
                raise FileExistsError(f'{table} is there, and not of this command: choose another folder')
            self._done = {(row[0], row[1]): row for row in rows if len(row) == len(COLUMNS)}  # the last one may be cut off
        elif os.listdir(path):
            raise FileExistsError(f'{path} holds other files: choose another folder')
        text = io.StringIO(newline='')
        csv.writer(text).writerows([COLUMNS, *self._done.values()])
        write_whole(table, text.getvalue().encode())
        self._file = open(table, 'a', encoding='utf-8', newline='')

    def found(self, a: str, b: str, mark: list[str]) -> Optional[bool]:
        """Whether a pair that was matched of the same files with the same settings has been found; None for another.

        :raises FileExistsError: where a file that is of no pair would be replaced.
        """
        if (a, b) not in self._done and os.path.lexists(self._name(a, b)):
            raise FileExistsError(f'{self._name(a, b)} is there, and of no pair of {TABLE}: move it away, or choose another folder')
        row = self._done.get((a, b), [])
        return row[2] == '1' if row[-2:] == mark and os.path.exists(self._name(a, b)) else None

    def put(self, a: str, b: str, mark: list[str], measured: Measured) -> None:
        os.makedirs(os.path.dirname(self._name(a, b)), exist_ok=True)
        with contextlib.suppress(FileNotFoundError):
            os.unlink(self._name(a, b))
        pose = measured.pose
        numbers = [f'{value:.10g}' for value in (*pose.R.ravel(), *pose.t.ravel())] if pose is not None and pose.found else [''] * len(NUMBERS)
        csv.writer(self._file).writerow([a, b, int(measured.found), pose.reason if pose is not None else '', len(measured.bits),
                                         int(measured.agree.sum()), f'{measured.rotation:.10g}', *numbers, *mark])
        self._file.flush()
        measured.save(self._name(a, b))  # last: without it the pair is matched again

    def _name(self, a: str, b: str) -> str:
        return os.path.join(self._path, pair_name(a, b) + '.csv')

    def __exit__(self, *exc: Any) -> None:
        self._file.close()
        self._lock.close()


class _Hdf5(contextlib.AbstractContextManager[Any]):
    """A group a pair as in hloc's dense matches: keypoints0, keypoints1, scores; and covariances, agrees, and with cameras R and t."""

    def __init__(self, path: str) -> None:
        try:
            import h5py  # type: ignore[import-untyped,unused-ignore]
        except ImportError as e:
            raise ImportError(f'{e}: {path} needs pip install h5py; a folder does not') from None
        new = not os.path.exists(path) or not os.path.getsize(path)
        try:
            self._file = h5py.File(path, 'w' if new else 'a')
        except BlockingIOError:
            raise BlockingIOError(f'{path} is being read or written by another process') from None
        except OSError as e:
            raise OSError(f'{path} is no HDF5 file that can be written: {e}') from None
        if new:
            self._file.attrs['opencv_iib'] = 'match'
        elif 'opencv_iib' not in self._file.attrs:
            self._file.close()
            raise FileExistsError(f'{path} is there, and not of this command: choose another name')

    def found(self, a: str, b: str, mark: list[str]) -> Optional[bool]:
        """As of _Folder."""
        group = self._file.get(pair_name(a, b))
        return bool(group.attrs['found']) if group is not None and list(group.attrs.get('mark', [])) == mark else None

    def put(self, a: str, b: str, mark: list[str], measured: Measured) -> None:
        if pair_name(a, b) in self._file:
            del self._file[pair_name(a, b)]
        group, pose = self._file.create_group(pair_name(a, b)), measured.pose
        for name, values in (('keypoints0', measured.matches.points1), ('keypoints1', measured.matches.points2),
                             ('scores', measured.matches.similarities.ravel().clip(0)), ('covariances', measured.matches.covariances),
                             ('agrees', measured.agree)):
            group[name] = values
        if pose is not None and pose.found:
            group['R'], group['t'], group['covariance'] = pose.R, pose.t.ravel(), pose.covariance
        group.attrs['found'], group.attrs['reason'] = measured.found, pose.reason if pose is not None else ''
        group.attrs['rotation'] = measured.rotation
        group.attrs['mark'] = mark  # last: without it the pair is matched again
        self._file.flush()

    def __exit__(self, *exc: Any) -> None:
        self._file.close()


def match_list(pairs: Path, images: Path, out: Path, camera: Optional[AnyCamera] = None, options: FeatureOptions = FeatureOptions(),
               workers: Optional[int] = None, log: Callable[[str], None] = note) -> tuple[int, int]:
    """Matches pairs of a list as match_images does, and describes each image once. Each pair is written when it is done: a later call goes on
    from there, and does what is new or was changed, or was matched with other options.

    :param pairs: text file of two names a line, as COLMAP and hloc write it.
    :param images: folder that the names are relative to.
    :param out: folder for a CSV file a pair, ``A/B.csv`` (a / in names is a -), and ``pairs.csv``, with verdicts and poses; or a name in .h5,
        of a group a pair as in hloc's dense matches.
    :param camera: of all images, as match_images takes it.
    :param workers: threads; None for one a core.
    :param log: told of each image that cannot be read, whose pairs are left out.
    :return: how many pairs show the same, and of how many.
    :raises ValueError: for a list that is none of the folder's images.
    :raises FileExistsError: for a file or a folder that is of something else.
    :raises BlockingIOError: if another process is writing it.
    """
    options.check()
    crew, masks, features, folder, out = Threads(thread_count(workers)), Masks(options.mask), Features(options), os.fspath(images), os.fspath(out)
    lens = None if camera is None else as_camera(camera)
    check_is_folder(folder)
    names = find_images(folder, log)
    listed = {frozenset(pair): pair for pair in from_file(pairs, {name: number for number, name in enumerate(names)})}
    used = {names[number] for pair in listed.values() for number in pair}
    masked = masks.check(sorted(used))
    if out.lower().endswith(HDF5):
        check_outputs([out], (pairs, *masked, *(os.path.join(folder, name) for name in used)))
    else:
        check_folder(out)
    check_sizes(folder, sorted(used), masks, lens)
    if len({pair_name(names[a], names[b]) for a, b in listed.values()}) < len(listed):
        raise InvalidOption(f'{os.fspath(pairs)}: two pairs would have one name, with - in place of /')
    settings = json.dumps([*map(str, vars(options).values()), str(lens), __version__])
    stamps = {name: masks.stamp(os.path.join(folder, name), name) for name in used}
    views, found, failed = _Views(folder, masks, features, lens), 0, set[str]()
    with _Hdf5(output_file(out)) if out.lower().endswith(HDF5) else _Folder(out) as target:
        missing = []
        for a, b in listed.values():
            known = target.found(names[a], names[b], [f'{stamps[names[a]]} {stamps[names[b]]}', settings])
            found += known or 0
            if known is None:
                missing.append((a, b))
        progress = Progress('matching', len(listed), len(listed) - len(missing))
        ordered = [pair for tile in tiles(missing, IMAGES_HELD // 4) for pair in tile]  # so that images are held as long as they are needed
        for (a, b), result in in_parallel(lambda pair: measure(views.of(names[pair[0]]), views.of(names[pair[1]]), features), ordered, crew):
            if isinstance(result, Exception) and not isinstance(result, (ValueError, OSError, error)):
                raise result
            if isinstance(result, Exception):
                if str(result) not in failed:
                    log(str(result))
                failed.add(str(result))
            else:
                target.put(names[a], names[b], [f'{stamps[names[a]]} {stamps[names[b]]}', settings], result)
                found += result.found
            progress.step()
        progress.close()
    return found, len(listed)


class _Views:
    """Images, each described once. Threads share it."""

    def __init__(self, folder: str, masks: Masks, features: Features, lens: Optional[Camera]) -> None:
        self._folder, self._arguments = folder, (masks, features, lens)
        self._locks: collections.defaultdict[str, threading.Lock] = collections.defaultdict(threading.Lock)
        self._described: dict[str, tuple[np.ndarray, np.ndarray]] = {}
        self._held: dict[str, View] = {}  # the last ones, in the order of their use

    def of(self, name: str) -> View:
        """Raises as View.of."""
        with self._locks[name]:
            view = self._held.pop(name, None) or View.of(os.path.join(self._folder, name), *self._arguments, name, self._described.get(name))
            self._described[name] = view.rows, view.codes
            self._held[name] = view
            while len(self._held) > IMAGES_HELD:
                with contextlib.suppress(KeyError, RuntimeError, StopIteration):  # another thread did
                    del self._held[next(iter(self._held))]
            return view
