"""Codes of images in PostgreSQL, and a search for the place that a new image shows.

    import psycopg
    from postgres import Places
    with psycopg.connect('dbname=walks') as connection:
        places = Places(connection, 'walk', iib.descriptorSize())
        places.insert('noon/0001.jpg', codes)
        votes = places.vote(codes_by_night)  # [('noon/0001.jpg', 212), ...]

An example: copy it. It needs ``pip install 'psycopg[binary]'`` and PostgreSQL 14 or newer; an index, also pgvector 0.8.
"""
from __future__ import annotations

import re
from typing import Any

import numpy as np
from psycopg import Connection, rows

# The coarse levels of the default descriptor, 42 of its 170 bytes, have most of the information.
_PREFIX_BITS = 336


class Places:
    """Two tables: a row a place, ``NAME`` (id, name), and a row a code, ``NAME_codes`` (place, number, code).

    Codes are of the type ``bit(n)``, their first byte leftmost; they are deleted with their place. Each call is atomic, and commits only if
    the connection commits by itself.
    """

    def __init__(self, connection: Connection[Any], name: str, code_bytes: int) -> None:
        """Opens the tables, or makes them. Names have at most 40 small letters and underscores."""
        if not re.fullmatch('[a-z_]{1,40}', name):
            raise ValueError(f'name is {name!r}: 1 to 40 of the letters a to z and _ are needed')
        self._connection, self._bytes = connection, code_bytes
        self._names = {'places': name, 'codes': f'{name}_codes', 'code': f'bit({8 * code_bytes})',
                       'prefix': f'code::bit({min(8 * code_bytes, _PREFIX_BITS)})'}
        with self._transaction():
            # CREATE TABLE IF NOT EXISTS fails where two sessions run it at once.
            self._execute('SELECT pg_advisory_xact_lock(hashtext(%s))', name)
            self._execute('CREATE TABLE IF NOT EXISTS {places} (id bigserial PRIMARY KEY, name text UNIQUE NOT NULL)')
            self._execute('CREATE TABLE IF NOT EXISTS {codes} (place bigint NOT NULL REFERENCES {places} ON DELETE CASCADE, '
                          'number integer NOT NULL, code {code} NOT NULL, PRIMARY KEY (place, number))')

    def insert(self, name: str, codes: np.ndarray) -> None:
        """Adds a place with its codes, an N x bytes uint8 array.

        :raises psycopg.errors.UniqueViolation: if a place has this name.
        """
        bits = self._bits(codes)
        with self._transaction(), self._connection.cursor() as cursor:
            (place,), = self._execute('INSERT INTO {places} (name) VALUES (%s) RETURNING id', name)
            with cursor.copy('COPY {codes} (place, number, code) FROM STDIN'.format(**self._names)) as copy:
                for number, code in enumerate(bits):
                    copy.write_row((place, number, code))

    def delete(self, name: str) -> None:
        """Removes a place and its codes, if there is one of this name."""
        self._execute('DELETE FROM {places} WHERE name = %s', name)

    def create_index(self) -> None:
        """Makes pgvector's HNSW index over the first 42 bytes of the codes, also of later places."""
        with self._transaction():
            # Parallel builds overflow a buffer before pgvector 0.8.2 (CVE-2026-3172).
            self._execute('SET LOCAL max_parallel_maintenance_workers = 0')
            self._execute('CREATE INDEX IF NOT EXISTS {codes}_prefix ON {codes} USING hnsw (({prefix}) bit_hamming_ops) '
                          'WITH (ef_construction = 128)')

    def vote(self, codes: np.ndarray, count: int = 10, candidates: int = 0) -> list[tuple[str, int]]:
        """The places that look most like an image: each of its codes votes for the place of the code nearest to it.

        Ties among codes go to the place that was inserted first, and so do ties among places.

        :param candidates: 0: compare all codes. With an index, 1 to 1000: compare so many codes with the nearest prefixes, which may miss nearer
            ones.
        :return: at most `count` names and votes, most votes first.
        """
        searched = '{codes}' if candidates == 0 else ('(SELECT place, code FROM {codes} ORDER BY {prefix} <~> query.{prefix} '
                                                      f'LIMIT {int(candidates)})')
        bits = self._bits(codes)
        with self._connection.transaction(force_rollback=True):  # so that the settings end with this statement
            if candidates:
                self._execute(f'SET LOCAL hnsw.ef_search = {max(int(candidates), 40)}')
                self._execute('SET LOCAL hnsw.iterative_scan = relaxed_order')  # continues after deleted rows
            return [(name, votes) for name, votes in self._execute(
                'SELECT name, count(*) FROM unnest(%s::{code}[]) query(code) CROSS JOIN LATERAL '
                f'(SELECT place FROM {searched} searched ORDER BY bit_count(searched.code # query.code), place LIMIT 1) nearest '
                'JOIN {places} ON id = place GROUP BY id, name ORDER BY count(*) DESC, id LIMIT %s', bits, count)]

    def _transaction(self) -> Any:
        """A transaction that commits only if the connection commits by itself."""
        if not self._connection.autocommit:
            self._execute('SELECT')  # begins an outer transaction
        return self._connection.transaction()

    def _bits(self, codes: np.ndarray) -> list[str]:
        if codes.dtype != np.uint8 or codes.ndim != 2 or codes.shape[1] != self._bytes:
            raise ValueError(f'codes: rows of {self._bytes} bytes are needed, not {codes.dtype} of shape {codes.shape}')
        return [(row + ord('0')).tobytes().decode() for row in np.unpackbits(codes, axis=1)]

    def _execute(self, statement: str, *parameters: Any) -> list[tuple[Any, ...]]:
        with self._connection.cursor(row_factory=rows.tuple_row) as cursor:
            cursor.execute(statement.format(**self._names), parameters)  # type: ignore[arg-type,unused-ignore]
            return cursor.fetchall() if cursor.description else []
