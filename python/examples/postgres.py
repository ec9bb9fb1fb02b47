"""Places in PostgreSQL: codes of images beside whatever else a database knows of them, and which image a new one shows.

    import psycopg
    from postgres import Places
    with psycopg.connect('dbname=walks') as connection:
        places = Places(connection, 'walk', iib.descriptorSize())
        places.insert('noon/0001.jpg', codes)
        votes = places.vote(codes_by_night)  # [('noon/0001.jpg', 212), ...]

An example: copy it. It needs ``pip install 'psycopg[binary]'``. All statements run in the transaction of the connection that
was given: nothing is committed here, unless the connection commits by itself.

Where the database has pgvector (``CREATE EXTENSION vector``), :meth:`Places.create_index` makes votes faster.
"""
from __future__ import annotations

import contextlib
from typing import Any, Optional

import numpy as np
from psycopg import Connection, rows, sql

# The coarse levels of the default descriptor, 42 of its 170 bytes, which tell most of the distance.
_PREFIX_BITS = 336
_EF_CONSTRUCTION = 128
_LONGEST_NAME = 63 - len('_codes_prefix')  # PostgreSQL cuts longer ones off
# Parallel builds of an index overflow a buffer before this version of pgvector (CVE-2026-3172).
_PARALLEL_BUILDS_FROM = (0, 8, 2)


class Places:
    """A table with a row a place, ``NAME`` (id, name), and one of their codes, ``NAME_codes`` (place, number, code).

    Codes are of the type ``bit(n)``, their first byte leftmost; a place's codes go when its row is deleted. Searches are
    exact, ``bit_count(a # b)`` of every pair (PostgreSQL 14 or newer), until :meth:`create_index` was called.
    """

    def __init__(self, connection: Connection[Any], name: str, code_bytes: int) -> None:
        """Takes the tables, or makes them if they are missing.

        :raises ValueError: if the table that is there holds codes of another width, the width is not at least 1, or the name
            is longer than 50 bytes or has a %.
        """
        if code_bytes < 1:
            raise ValueError(f'code_bytes is {code_bytes}: at least 1 is needed')
        if not 1 <= len(name.encode()) <= _LONGEST_NAME or '%' in name:
            raise ValueError(f'name is {name!r}: 1 to {_LONGEST_NAME} bytes without % are needed')
        self._connection = connection
        self._bytes = code_bytes
        self._names = {'places': sql.Identifier(name), 'codes': sql.Identifier(f'{name}_codes'),
                       'index': sql.Identifier(f'{name}_codes_prefix'), 'code': sql.SQL(f'bit({8 * code_bytes})'),
                       'prefix': sql.SQL(f'bit({min(8 * code_bytes, _PREFIX_BITS)})')}
        with self._transaction():
            # CREATE TABLE IF NOT EXISTS fails where two sessions run it at once.
            self._execute('SELECT pg_advisory_xact_lock(hashtext(%s))', name)
            self._execute('CREATE TABLE IF NOT EXISTS {places} (id bigserial PRIMARY KEY, name text UNIQUE NOT NULL)')
            self._execute('CREATE TABLE IF NOT EXISTS {codes} (place bigint NOT NULL REFERENCES {places} ON DELETE CASCADE, '
                          'number integer NOT NULL, code {code} NOT NULL, PRIMARY KEY (place, number))')
        (bits,), = self._execute("SELECT atttypmod FROM pg_attribute WHERE attrelid = %s::regclass AND attname = 'code'",
                                 self._names['codes'].as_string(connection))
        if bits != 8 * code_bytes:
            raise ValueError(f'{name}_codes holds codes of {bits // 8} bytes, not {code_bytes}: choose another name')

    def insert(self, name: str, codes: Any) -> None:
        """Adds a place with its codes, an N x bytes uint8 array.

        :raises psycopg.errors.UniqueViolation: if a place of this name is there.
        """
        bits = self._bits(codes)
        with self._transaction():
            (place,), = self._execute('INSERT INTO {places} (name) VALUES (%s) RETURNING id', name)
            statement = sql.SQL('COPY {codes} (place, number, code) FROM STDIN').format(**self._names)
            with self._connection.cursor() as cursor, cursor.copy(statement) as copy:
                for number, code in enumerate(bits):
                    copy.write_row((place, number, code))

    def delete(self, name: str) -> None:
        """Removes a place and its codes; nothing happens if there is none of this name."""
        self._execute('DELETE FROM {places} WHERE name = %s', name)

    def pgvector(self) -> Optional[tuple[int, ...]]:
        """Version of pgvector in this database, such as (0, 8, 0); None without it."""
        version = self._execute("SELECT extversion FROM pg_extension WHERE extname = 'vector'")
        return tuple(int(part) for part in version[0][0].split('.')) if version else None

    def create_index(self) -> None:
        """Makes an HNSW index over the first 42 bytes of the codes (all, where they are shorter), unless it is there.

        It is made faster after places were inserted than before, and fastest if it fits into ``maintenance_work_mem``.
        What is inserted or deleted later is found or not found as without it.

        :raises ValueError: if the database has no pgvector of version 0.8 or newer.
        """
        version = self.pgvector()
        if version is None or version < (0, 8):
            found = 'no pgvector' if version is None else f'pgvector {".".join(map(str, version))}'
            raise ValueError(f'this database has {found}, 0.8 or newer is needed: install it and CREATE EXTENSION vector, '
                             'or do without an index')
        (workers,), = self._execute("SELECT current_setting('max_parallel_maintenance_workers')")
        if version < _PARALLEL_BUILDS_FROM:
            self._set('max_parallel_maintenance_workers', 0)
        self._execute('CREATE INDEX IF NOT EXISTS {index} ON {codes} USING hnsw ((code::{prefix}) bit_hamming_ops) '
                      f'WITH (ef_construction = {_EF_CONSTRUCTION})')
        self._set('max_parallel_maintenance_workers', workers)

    def has_index(self) -> bool:
        """Whether :meth:`create_index` was called for these tables."""
        name = self._names['index'].as_string(self._connection)
        return bool(self._execute('SELECT to_regclass(%s) IS NOT NULL', name)[0][0])

    def vote(self, codes: Any, count: int = 10, candidates: int = 100) -> list[tuple[str, int]]:
        """The places that look most like an image: each of its codes votes for the place of the code nearest to it.

        Ties among codes go to the place that was inserted first, and so do ties among places.

        :param codes: of the image, N x bytes.
        :param count: at most so many places.
        :param candidates: with an index, so many codes of the nearest prefixes are compared whole, at most 1000, and
            nearer ones may be missed; 0, or no index: all codes are compared.
        :return: names and votes, most votes first; only places that have any.
        """
        if not 0 <= candidates <= 1000:
            raise ValueError(f'candidates is {candidates}: it has to be 0 to 1000')
        bits = self._bits(codes)
        if not candidates or not self.has_index():
            return self._votes('{codes}', bits, count)
        # Settings of this statement alone: they are rolled back, and nothing else is there to be.
        with self._connection.transaction(force_rollback=True):
            self._set('hnsw.ef_search', max(candidates, 40))
            self._set('hnsw.iterative_scan', 'relaxed_order')  # goes on behind rows that were deleted
            return self._votes('(SELECT place, code FROM {codes} ORDER BY code::{prefix} <~> query.code::{prefix} '
                               f'LIMIT {candidates})', bits, count)

    def _votes(self, searched: str, bits: list[str], count: int) -> list[tuple[str, int]]:
        return [(name, votes) for name, votes in self._execute(
            'SELECT name, count(*) FROM unnest(%s::{code}[]) query(code) CROSS JOIN LATERAL '
            f'(SELECT place FROM {searched} searched ORDER BY bit_count(searched.code # query.code), place LIMIT 1) nearest '
            'JOIN {places} ON id = place GROUP BY id, name ORDER BY count(*) DESC, id LIMIT %s', bits, count)]

    def _transaction(self) -> Any:
        """All or nothing, on a connection that commits by itself too."""
        return self._connection.transaction() if self._connection.autocommit else contextlib.nullcontext()

    def _set(self, name: str, value: Any) -> None:
        """A setting of PostgreSQL until the transaction ends."""
        self._execute('SELECT set_config(%s, %s, true)', name, str(value))

    def _bits(self, codes: Any) -> list[str]:
        array = np.asarray(codes)
        if array.dtype != np.uint8 or array.ndim != 2 or array.shape[1] != self._bytes:
            raise ValueError(f'codes: rows of {self._bytes} bytes are needed, not {array.dtype} of shape {array.shape}')
        return [(row + ord('0')).tobytes().decode() for row in np.unpackbits(array, axis=1)]

    def _execute(self, statement: str, *parameters: Any) -> list[tuple[Any, ...]]:
        with self._connection.cursor(row_factory=rows.tuple_row) as cursor:
            cursor.execute(sql.SQL(statement).format(**self._names), parameters)  # type: ignore[arg-type,unused-ignore]
            return cursor.fetchall() if cursor.description else []
