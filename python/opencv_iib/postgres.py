"""Places in PostgreSQL: codes of images beside whatever else a database knows of them, and which image a new one shows.

    import psycopg
    from opencv_iib.postgres import Places
    with psycopg.connect('dbname=walks') as connection:
        places = Places(connection, 'walk', iib.descriptorSize())
        places.insert('noon/0001.jpg', codes)
        votes = places.vote(codes_by_night)  # [('noon/0001.jpg', 212), ...]

All statements run in the transaction of the connection that was given: nothing is committed here.
"""
from __future__ import annotations

from typing import Any

import numpy as np
from psycopg import Connection, sql

from opencv_iib._arrays import as_array


class Places:
    """A table with a row a place, ``NAME`` (id, name), and one of their codes, ``NAME_codes`` (place, number, code).

    Codes are of the type ``bit(n)``, their first byte leftmost; a place's codes go when its row is deleted. Searches are
    exact: ``bit_count(a # b)`` of every pair (PostgreSQL 14 or newer).
    """

    def __init__(self, connection: Connection[Any], name: str, code_bytes: int) -> None:
        """Takes the tables, or makes them if they are missing.

        :raises ValueError: if the table that is there holds codes of another width, or the width is not at least 1.
        """
        if code_bytes < 1:
            raise ValueError(f'code_bytes is {code_bytes}: at least 1 is needed')
        self._connection = connection
        self._bytes = code_bytes
        self._names = {'places': sql.Identifier(name), 'codes': sql.Identifier(f'{name}_codes'),
                       'code': sql.SQL(f'bit({8 * code_bytes})')}
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
        (place,), = self._execute('INSERT INTO {places} (name) VALUES (%s) RETURNING id', name)
        statement = sql.SQL('COPY {codes} (place, number, code) FROM STDIN').format(**self._names)
        with self._connection.cursor() as cursor, cursor.copy(statement) as copy:
            for number, code in enumerate(bits):
                copy.write_row((place, number, code))

    def delete(self, name: str) -> None:
        """Removes a place and its codes; nothing happens if there is none of this name."""
        self._execute('DELETE FROM {places} WHERE name = %s', name)

    def vote(self, codes: Any, count: int = 10) -> list[tuple[str, int]]:
        """The places that look most like an image: each of its codes votes for the place of the code nearest to it.

        Ties among codes go to the place that was inserted first, and so do ties among places.

        :param codes: of the image, N x bytes.
        :param count: at most so many places.
        :return: names and votes, most votes first; only places that have any.
        """
        return [(name, votes) for name, votes in self._execute(
            'SELECT name, count(*) FROM unnest(%s::{code}[]) query(code) CROSS JOIN LATERAL '
            '(SELECT place FROM {codes} ORDER BY bit_count({codes}.code # query.code), place LIMIT 1) nearest '
            'JOIN {places} ON id = place GROUP BY id, name ORDER BY count(*) DESC, id LIMIT %s', self._bits(codes), count)]

    def _bits(self, codes: Any) -> list[str]:
        array = as_array(codes, 'codes')
        if array.dtype != np.uint8 or array.ndim != 2 or array.shape[1] != self._bytes:
            raise ValueError(f'codes: rows of {self._bytes} bytes are needed, not {array.dtype} of shape {array.shape}')
        return [(row + ord('0')).tobytes().decode() for row in np.unpackbits(array, axis=1)]

    def _execute(self, statement: str, *parameters: Any) -> list[tuple[Any, ...]]:
        with self._connection.cursor() as cursor:
            cursor.execute(sql.SQL(statement).format(**self._names), parameters)  # type: ignore[arg-type,unused-ignore]
            return cursor.fetchall() if cursor.description else []
