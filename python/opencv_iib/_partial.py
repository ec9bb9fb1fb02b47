"""What an unfinished run leaves for the next one: a file of SQLite, which neither a kill nor a full disk harms."""
from __future__ import annotations

import contextlib
import os
import sqlite3
from typing import NoReturn

LOGS = ('-wal', '-shm', '-journal')  # that SQLite writes beside a file


def open_partial(path: str, table: str) -> sqlite3.Connection:
    """:param table: by which a file is known that is there.
    :raises FileExistsError: for a file that no such run has left."""
    def refuse(log: str = '') -> NoReturn:
        raise FileExistsError(f'{path}{log} is there and not of an unfinished run: remove it, or give what is written another name')

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
        if type(e) is sqlite3.DatabaseError:  # a full disk is a more special one
            refuse()
        raise
    return db


def close_partial(db: sqlite3.Connection, path: str, remove: bool) -> None:
    """:param remove: there is nothing to go on from."""
    db.close()
    for end in (*LOGS, '') if remove else ():
        with contextlib.suppress(FileNotFoundError):
            os.unlink(path + end)
