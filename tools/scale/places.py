#!/usr/bin/env python3
"""Measures place recognition in PostgreSQL: places.py --out FILE --images FOLDER, with $IIB_POSTGRES naming a server.

FOLDER/SET/SEQUENCE holds 1.png, 2.png and so on of one place in changing light: the first of each is inserted, the last
is the query. Writes JSON: recall and time of the index at several numbers of candidates, beside the plain scan.
"""
import argparse
import json
import os
import pathlib
import sys
import time

import cv2
import numpy as np
import psycopg
from opencv_iib import IIB

sys.path.append(str(pathlib.Path(__file__).parents[2] / 'python/examples'))
from postgres import Places  # noqa: E402

CANDIDATES = (0, 10, 100, 400)
AT = (1, 5, 10)


def described(iib, path, points):
    image = cv2.imread(str(path), cv2.IMREAD_GRAYSCALE)
    found = cv2.goodFeaturesToTrack(image, points, .0001, 3)[:, 0]
    return iib.compute(image, np.column_stack([found, np.full(len(found), 32)]).astype(np.float32))[1]


def searched(places, queries, candidates):
    """Recall at each of AT, and the time of an image."""
    ranks, begin = [], time.perf_counter()
    for name, codes in queries.items():
        found = [place for place, _ in places.vote(codes, max(AT), candidates)]
        ranks.append(found.index(name) if name in found else max(AT))
    seconds = (time.perf_counter() - begin) / len(queries)
    row = {'candidates': candidates, 'recall': [float(np.mean(np.less(ranks, at))) for at in AT], 'seconds_an_image': seconds}
    print(row, flush=True)
    return row


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--out', required=True)
    parser.add_argument('--images', required=True, help='folder of SET/SEQUENCE/1.png and so on')
    parser.add_argument('--codes', type=int, default=1000, help='of a place, at most (%(default)s)')
    parser.add_argument('--queries', type=int, default=100, help='codes of a query, at most (%(default)s)')
    arguments = parser.parse_args()
    iib = IIB.create()
    walk, queries = {}, {}
    for sequence in sorted(pathlib.Path(arguments.images).glob('*/*')):
        images = sorted(sequence.glob('*.png'), key=lambda path: int(path.stem)) if (sequence / '1.png').exists() else []
        if len(images) > 1:
            name = '%s/%s' % (sequence.parent.name, sequence.name)
            walk[name] = described(iib, images[0], arguments.codes)
            queries[name] = described(iib, images[-1], arguments.queries)
    with psycopg.connect(os.environ['IIB_POSTGRES'], autocommit=True) as connection:
        connection.execute('CREATE EXTENSION vector')
        pgvector, = connection.execute("SELECT extversion FROM pg_extension WHERE extname = 'vector'").fetchone()
        server, = connection.execute('SHOW server_version').fetchone()
        places = Places(connection, 'walk', iib.descriptorSize())
        for name, codes in walk.items():
            places.insert(name, codes)
        begin = time.perf_counter()
        places.create_index()
        built = time.perf_counter() - begin
        connection.execute('VACUUM ANALYZE')
        table, index = connection.execute("SELECT pg_table_size('walk_codes'), pg_relation_size('walk_codes_prefix')").fetchone()
        count = sum(len(codes) for codes in walk.values())
        result = {'server': server.split()[0], 'pgvector': pgvector, 'places': len(walk),
                  'codes': count, 'queries': arguments.queries, 'at': AT, 'index_seconds': built,
                  'table_bytes_a_code': table / count, 'index_bytes_a_code': index / count}
        print(result, flush=True)
        result['rows'] = [searched(places, queries, candidates) for candidates in CANDIDATES]
    pathlib.Path(arguments.out).write_text(json.dumps(result, indent=1) + '\n')


if __name__ == '__main__':
    main()
