"""The results of an unfinished run: a file of SQLite, which survives kills and full disks, and from which the next run continues."""
from __future__ import annotations

import contextlib
import os
import sqlite3
from typing import NoReturn

LOGS = ('-wal', '-shm', '-journal')  #: endings of the files that SQLite writes beside a database


def open_partial(path: str, table: str) -> sqlite3.Connection:
    """Opens such a file, or a new one. :raises FileExistsError: for a file without this table, which is not ours."""
    def refuse(log: str = '') -> NoReturn:
        raise FileExistsError(f'{path}{log} exists and is not of an unfinished run: remove it, or choose another name for the output')

    if not os.path.exists(path) or not os.path.getsize(path):
        for log in LOGS:
            if os.path.lexists(path + log):
                refuse(log)
    db = sqlite3.connect(os.fsencode(path), isolation_level=None)
    try:
        tables = {name for name, in db.execute('SELECT name FROM sqlite_master')}
        if tables and table not in tables:
            refuse()
        db.execute('PRAGMA journal_mode=WAL')
        db.execute('PRAGMA synchronous=NORMAL')
    except Exception as e:
        db.close()
        if type(e) is sqlite3.DatabaseError:  # not its subclasses, such as for a full disk
            refuse()
        raise
    return db


def close_partial(db: sqlite3.Connection, path: str, remove: bool) -> None:
    """:param remove: also delete the file, since no run has to continue from it."""
    db.close()
    for end in (*LOGS, '') if remove else ():
        with contextlib.suppress(FileNotFoundError):
            os.unlink(path + end)
