"""COLMAP's database file: the schema of COLMAP 3.8, which every later version upgrades when it opens it.

An unfinished one is called ``NAME.partial`` and has further tables: codes, stamps of the image files, and settings. finish() copies it
without the codes and gives it its name in one step. A later run extends that.
"""
from __future__ import annotations

import contextlib
import json
import os
import pathlib
import sqlite3
from typing import Any, Iterator, Optional, Sequence

import numpy as np

from opencv_iib._arguments import Path
from opencv_iib._files import replaced
from opencv_iib._image_names import in_order
from opencv_iib._partial import close_partial, open_partial

SCHEMA_VERSION = 3800
MAX_IMAGE_ID = 2147483647

SCHEMA = '''
CREATE TABLE IF NOT EXISTS iib_settings (settings TEXT NOT NULL);
CREATE TABLE IF NOT EXISTS cameras (camera_id INTEGER PRIMARY KEY AUTOINCREMENT NOT NULL, model INTEGER NOT NULL,
  width INTEGER NOT NULL, height INTEGER NOT NULL, params BLOB, prior_focal_length INTEGER NOT NULL);
CREATE TABLE IF NOT EXISTS images (image_id INTEGER PRIMARY KEY AUTOINCREMENT NOT NULL, name TEXT NOT NULL UNIQUE,
  camera_id INTEGER NOT NULL, prior_qw REAL, prior_qx REAL, prior_qy REAL, prior_qz REAL, prior_tx REAL,
  prior_ty REAL, prior_tz REAL,
  CONSTRAINT image_id_check CHECK(image_id >= 0 and image_id < 2147483647),
  FOREIGN KEY(camera_id) REFERENCES cameras(camera_id));
CREATE UNIQUE INDEX IF NOT EXISTS index_name ON images(name);
CREATE TABLE IF NOT EXISTS keypoints (image_id INTEGER PRIMARY KEY NOT NULL, rows INTEGER NOT NULL,
  cols INTEGER NOT NULL, data BLOB, FOREIGN KEY(image_id) REFERENCES images(image_id) ON DELETE CASCADE);
CREATE TABLE IF NOT EXISTS descriptors (image_id INTEGER PRIMARY KEY NOT NULL, rows INTEGER NOT NULL,
  cols INTEGER NOT NULL, data BLOB, FOREIGN KEY(image_id) REFERENCES images(image_id) ON DELETE CASCADE);
CREATE TABLE IF NOT EXISTS matches (pair_id INTEGER PRIMARY KEY NOT NULL, rows INTEGER NOT NULL,
  cols INTEGER NOT NULL, data BLOB);
CREATE TABLE IF NOT EXISTS two_view_geometries (pair_id INTEGER PRIMARY KEY NOT NULL, rows INTEGER NOT NULL,
  cols INTEGER NOT NULL, data BLOB, config INTEGER NOT NULL, F BLOB, E BLOB, H BLOB, qvec BLOB, tvec BLOB);
CREATE TABLE IF NOT EXISTS iib_codes (image_id INTEGER PRIMARY KEY NOT NULL, rows INTEGER NOT NULL,
  cols INTEGER NOT NULL, data BLOB);
CREATE TABLE IF NOT EXISTS iib_files (name TEXT PRIMARY KEY NOT NULL, stamp TEXT NOT NULL);
CREATE TABLE IF NOT EXISTS iib_searched (pair_id INTEGER PRIMARY KEY NOT NULL, found INTEGER NOT NULL);
'''

#: COLMAP's names of camera models, by their numbers.
MODELS = ('SIMPLE_PINHOLE', 'PINHOLE', 'SIMPLE_RADIAL', 'RADIAL', 'OPENCV', 'OPENCV_FISHEYE', 'FULL_OPENCV', 'FOV', 'SIMPLE_RADIAL_FISHEYE',
          'RADIAL_FISHEYE', 'THIN_PRISM_FISHEYE', 'RAD_TAN_THIN_PRISM_FISHEYE', 'SIMPLE_DIVISION', 'DIVISION', 'SIMPLE_FISHEYE', 'FISHEYE', 'EUCM')

#: COLMAP's camera models that a prior focal length alone fills: how many of these, and parameters after the centre.
CAMERA_MODELS = {'SIMPLE_PINHOLE': (1, 0), 'PINHOLE': (2, 0), 'SIMPLE_RADIAL': (1, 1), 'RADIAL': (1, 2), 'OPENCV': (2, 4)}

UNCALIBRATED = 3  # COLMAP's TwoViewGeometry::UNCALIBRATED


class SettingsChanged(ValueError):
    """A database cannot be extended: it was begun with other settings or images."""

    def __init__(self, path: str, differences: str) -> None:
        """:param differences: names of settings, each with both values."""
        super().__init__(f'{path} was begun with other settings ({differences}): use them again, or start a new database with force (--force)')


def _text(value: Any) -> str:
    """A setting as users write it."""
    if isinstance(value, bool):
        return 'on' if value else 'off'
    return ' '.join(value) or 'none' if isinstance(value, list) else str(value)


def check_settings(path: str, old: dict[str, Any], new: dict[str, Any]) -> None:
    """:raises SettingsChanged: if they differ."""
    known = {**old, **new} if old.get('version') == new.get('version') else ['version']  # versions have different settings
    different = [f'{name} {_text(old.get(name))}, now {_text(new.get(name))}' for name in known if old.get(name) != new.get(name)]
    if different:
        raise SettingsChanged(path, ', '.join(different))


def opened(path: Path) -> contextlib.closing[sqlite3.Connection]:
    """A finished database, to read."""
    return contextlib.closing(sqlite3.connect(f'{pathlib.Path(path).absolute().as_uri()}?mode=ro', uri=True))


def settings_of(path: str) -> Optional[dict[str, Any]]:
    """The settings of a finished database; None for another file."""
    try:
        with opened(path) as db:
            return dict(json.loads(db.execute('SELECT settings FROM iib_settings').fetchone()[0]))
    except (sqlite3.Error, TypeError, ValueError):
        return None


def pair_id(a: int, b: int) -> int:
    """COLMAP's number of a pair; images are numbered from 1."""
    return min(a, b) * MAX_IMAGE_ID + max(a, b)


class Database(contextlib.AbstractContextManager['Database']):
    """An unfinished database, for one thread of one process at a time."""

    def __init__(self, path: str, settings: dict[str, Any], force: bool = False) -> None:
        """Opens ``path.partial``, which an interrupted run left, or a new one with the content of the finished database.
        :param force: start empty, also where settings differ.
        :raises SettingsChanged: if one of them had other settings.
        :raises FileExistsError: for a file that is not of an interrupted run."""
        self.path, self.partial, self.force, self._finished = path, path + '.partial', force, False
        self.changed = True  #: whether it may hold other images or pairs than the finished database
        self.finished: set[int] = set()  #: its images, whose number of keypoints existing reconstructions rely on
        self._db = open_partial(self.partial, 'iib_settings')
        try:
            self._begin(settings)
        except Exception:
            self._db.close()
            raise
        if not force and os.path.exists(path):
            self._db.execute('ATTACH ? AS old', (os.fsencode(path),))
            if not self.stamps():
                self._grow()
            self.finished = {image for image, in self._db.execute('SELECT image_id FROM old.images')}
            self._db.execute('DETACH old')

    def _begin(self, settings: dict[str, Any]) -> None:
        self._db.executescript(SCHEMA)
        if self._db.execute('PRAGMA user_version').fetchone()[0] == 0:  # 4000 and more after a newer COLMAP has opened it
            self._db.execute(f'PRAGMA user_version={SCHEMA_VERSION}')
        old = [json.loads(row) for row, in self._db.execute('SELECT settings FROM iib_settings')]
        if old and not self.force:
            check_settings(self.partial, old[0], settings)
        elif old != [settings]:
            for table, in self._db.execute("SELECT name FROM sqlite_master WHERE type='table'").fetchall():
                self._db.execute(f'DELETE FROM {table}')
            self._insert('iib_settings', json.dumps(settings, sort_keys=True))

    def _grow(self) -> None:
        """Copies what the finished database holds, without the columns that a newer COLMAP has added."""
        with self._transaction():
            for table, columns in (('cameras', 'camera_id, model, width, height, params, prior_focal_length'), ('images', 'image_id, name, camera_id'),
                                   ('keypoints', 'image_id, rows, cols, data'), ('matches', 'pair_id, rows, cols, data'),
                                   ('two_view_geometries', 'pair_id, rows, cols, data, config, F, E, H, qvec, tvec'), ('iib_files', 'name, stamp'),
                                   ('iib_searched', 'pair_id, found')):
                self._db.execute(f'INSERT INTO {table} ({columns}) SELECT {columns} FROM old.{table}')
        self.changed = False

    def __exit__(self, *exc: Any) -> None:
        close_partial(self._db, self.partial, self._finished or not self.stamps())

    def finish(self) -> None:
        """Writes the finished file, without the codes."""
        with replaced(self.path) as (new,):
            with contextlib.closing(sqlite3.connect(os.fsencode(new), isolation_level=None)) as db:
                self._db.backup(db)
                db.execute('PRAGMA journal_mode=DELETE')
                db.execute('DROP TABLE iib_codes')
                db.execute('VACUUM')
        self._finished = True

    @contextlib.contextmanager
    def _transaction(self) -> Iterator[None]:
        with self._db:  # commits, or rolls back after an error, unless that has done so, as a full disk does
            self._db.execute('BEGIN')
            yield

    def _insert(self, table: str, *values: Any, verb: str = 'INSERT') -> Optional[int]:
        """Adds a row. :param table: its name, perhaps with columns. :param verb: REPLACE if the key may be there. :return: the key."""
        return self._db.execute(f'{verb} INTO {table} VALUES ({", ".join("?" * len(values))})', values).lastrowid

    # Images

    def stamps(self) -> dict[str, str]:
        """Stamps of the described images' files, by name."""
        return dict(self._db.execute('SELECT name, stamp FROM iib_files'))

    def forget(self, name: str) -> None:
        """Removes an image and its pairs."""
        self.changed = True
        with self._transaction():
            self._remove(name)

    def _remove(self, name: str) -> tuple[Optional[int], Optional[int]]:
        """:return: the numbers of the image, and of its camera if no other image has that."""
        image, camera = self._db.execute('SELECT image_id, camera_id FROM images WHERE name=?', (name,)).fetchone() or (None, None)
        self._db.execute('DELETE FROM iib_files WHERE name=?', (name,))
        for table in ('images', 'keypoints', 'iib_codes'):
            self._db.execute(f'DELETE FROM {table} WHERE image_id=?', (image,))
        for table in ('matches', 'two_view_geometries', 'iib_searched'):
            self._db.execute(f'DELETE FROM {table} WHERE ? IN (pair_id / {MAX_IMAGE_ID}, pair_id % {MAX_IMAGE_ID})', (image,))
        free = self._db.execute('DELETE FROM cameras WHERE camera_id=? AND camera_id NOT IN (SELECT camera_id FROM images)', (camera,)).rowcount
        return image, camera if free else None

    def image_ids(self, without_codes: bool = False) -> dict[str, int]:
        """Numbers of all images by name, in_order, or of those whose codes an earlier run has dropped."""
        where = 'WHERE image_id NOT IN (SELECT image_id FROM iib_codes)' if without_codes else ''
        return dict(sorted(self._db.execute(f'SELECT name, image_id FROM images {where}'), key=lambda row: in_order(row[0])))

    def add_codes(self, image: int, keypoints: np.ndarray, codes: np.ndarray) -> bool:
        """Adds the codes of an image that an earlier run has described, or returns False if its keypoints differ."""
        same = np.array_equal(self.load_keypoints(image)[:len(keypoints)], keypoints)  # points of searches follow them
        if same:
            self._insert('iib_codes', image, *codes.shape, codes.tobytes())
        return same

    def add_image(self, name: str, stamp: str, width: int, height: int, model: str, params: Sequence[float], prior: bool,
                  shared: bool, keypoints: np.ndarray, codes: np.ndarray) -> None:
        """Adds an image with its camera, keypoints and codes, in one transaction, or replaces one of this name, which keeps its numbers.
        :param stamp: of the file, to recognize it in a later run.
        :param model: one of MODELS.
        :param shared: use an equal camera of the database, if there is one.
        :param keypoints: N x 4 float32: x, y (pixels; the centre of the first pixel is .5), scale, angle (radians).
        :param codes: N x bytes uint8."""
        self.changed = True
        values = MODELS.index(model), width, height, np.array(params, np.float64).tobytes(), int(prior)
        with self._transaction():
            number, free = self._remove(name)
            same = self._db.execute('SELECT camera_id FROM cameras WHERE (model, width, height, params, prior_focal_length) = '
                                    '(?, ?, ?, ?, ?)', values).fetchone() if shared else None
            camera = same[0] if same else self._insert('cameras (camera_id, model, width, height, params, prior_focal_length)', free, *values)
            image = self._insert('images (image_id, name, camera_id)', number, name, camera)
            self._insert('keypoints', image, *keypoints.shape, np.ascontiguousarray(keypoints, np.float32).tobytes())
            self._insert('iib_codes', image, *codes.shape, codes.tobytes())
            self._insert('iib_files', name, stamp)

    def load_codes(self, image: int) -> np.ndarray:
        """N x bytes uint8."""
        return self._load('iib_codes', image, np.uint8)

    def load_keypoints(self, image: int) -> np.ndarray:
        """N x 4 float32."""
        return self._load('keypoints', image, np.float32)

    def _load(self, table: str, image: int, dtype: Any) -> np.ndarray:
        rows, cols, data = self._db.execute(f'SELECT rows, cols, data FROM {table} WHERE image_id=?', (image,)).fetchone()
        return np.frombuffer(data, dtype).reshape(rows, cols)

    # Pairs

    def has_pair(self, a: int, b: int) -> bool:
        """Whether the pair was matched, also without a match."""
        return self._db.execute('SELECT 1 FROM matches WHERE pair_id=?', (pair_id(a, b),)).fetchone() is not None

    def pairs(self, least: int = 1, where: str = 'matches WHERE rows >= ?') -> Iterator[tuple[int, int]]:
        """Image ids of the pairs that have at least so many matches."""
        for key, in self._db.execute(f'SELECT pair_id FROM {where} ORDER BY pair_id', (least,)):
            yield divmod(key, MAX_IMAGE_ID)

    def verified_pairs(self, least: int) -> Iterator[tuple[int, int]]:
        """The same of verified matches of pairs that were not searched."""
        return self.pairs(least, 'two_view_geometries WHERE rows >= ? AND pair_id NOT IN (SELECT pair_id FROM iib_searched)')

    def add_pair(self, a: int, b: int, matches: np.ndarray, inliers: Optional[np.ndarray] = None,
                 fundamental: Optional[np.ndarray] = None) -> None:
        """Adds the matches of a pair and, if they were verified here, its geometry, in one transaction.
        :param matches: M x 2 indices of keypoints of a and b.
        :param inliers: M' x 2, the matches that agree; None if COLMAP verifies.
        :param fundamental: 3 x 3, from a to b."""
        if a > b:
            a, b, matches = b, a, matches[:, ::-1]
            inliers = None if inliers is None else inliers[:, ::-1]
            fundamental = None if fundamental is None else fundamental.T
        self.changed = True
        with self._transaction():
            self._write_pair(pair_id(a, b), matches, inliers, fundamental)

    def _write_pair(self, key: int, matches: np.ndarray, inliers: Optional[np.ndarray], fundamental: Optional[np.ndarray]) -> None:
        self._insert('matches', key, len(matches), 2, np.ascontiguousarray(matches, np.uint32).tobytes(), verb='REPLACE')
        if inliers is not None:
            zero = np.zeros((3, 3))
            matrix = zero if fundamental is None else np.ascontiguousarray(fundamental, np.float64)
            self._insert('two_view_geometries (pair_id, rows, cols, data, config, F, E, H, qvec, tvec)', key, len(inliers), 2,
                         np.ascontiguousarray(inliers, np.uint32).tobytes(), UNCALIBRATED if len(inliers) else 0,
                         *(array.tobytes() for array in (matrix, zero, zero, np.array([1., 0, 0, 0]), np.zeros(3))), verb='REPLACE')

    # Pairs that were searched

    def was_found(self, a: int, b: int) -> Optional[bool]:
        """Whether a search has matched the pair; None: it was not searched."""
        row = self._db.execute('SELECT found FROM iib_searched WHERE pair_id=?', (pair_id(a, b),)).fetchone()
        return row and bool(row[0])

    def add_not_found(self, a: int, b: int) -> None:
        """Marks a pair as searched, and keeps the matches that it has."""
        self._insert('iib_searched', pair_id(a, b), 0)

    def add_found(self, pair: tuple[int, int], keypoints: Sequence[np.ndarray], matches: np.ndarray, fundamental: np.ndarray) -> None:
        """Replaces the matches of a pair by those of a search, in one transaction.
        :param pair: the smaller number first.
        :param keypoints: of both images: the old ones, then new ones."""
        with self._transaction():
            for image, rows in zip(pair, keypoints):
                self._db.execute('UPDATE keypoints SET rows=?, data=? WHERE image_id=?', (len(rows), rows.tobytes(), image))
            self._write_pair(pair_id(*pair), matches, matches, fundamental)
            self._insert('iib_searched', pair_id(*pair), 1)

    def counts(self) -> dict[str, int]:
        """Images, keypoints, pairs that were matched, those with matches, matches, verified pairs and verified matches."""
        wanted = {'images': 'COUNT(*) FROM images', 'keypoints': 'SUM(rows) FROM keypoints', 'pairs': 'COUNT(*) FROM matches',
                  'pairs with matches': 'COUNT(*) FROM matches WHERE rows > 0', 'matches': 'SUM(rows) FROM matches',
                  'verified pairs': 'COUNT(*) FROM two_view_geometries WHERE rows > 0', 'verified matches': 'SUM(rows) FROM two_view_geometries'}
        return {name: self._db.execute(f'SELECT {what}').fetchone()[0] or 0 for name, what in wanted.items()}
