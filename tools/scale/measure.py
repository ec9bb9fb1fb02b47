#!/usr/bin/env python3
"""Measures searches among many codes, beside faiss: measure.py --out FILE [--mapped N]

Writes JSON: exact search at several widths, the folder of a MappedIndex of --mapped codes, and Dask's workers on it.
Everything that is compared takes turns, with one thread and with two; the median counts. A result in which two threads
are more than twice as fast as one is refused: the machine was not idle.
"""
import argparse
import datetime
import json
import os
import pathlib
import platform
import statistics
import subprocess
import sys
import tempfile
import time

import distributed
import faiss
import numpy as np
import opencv_iib
from opencv_iib import HierarchicalMatcher, MappedIndex, shards

WIDTHS = (16, 32, 64, 128, 170)
BYTES = 64


def random_codes(seed, rows, width=BYTES):
    return np.random.default_rng(seed).integers(0, 256, (rows, width), np.uint8)


def median_seconds(calls, rounds):
    """Of each call, which take turns."""
    seconds = [[] for _ in calls]
    for _ in range(rounds):
        for call, times in zip(calls, seconds):
            begin = time.perf_counter()
            call()
            times.append(time.perf_counter() - begin)
    return [statistics.median(times) for times in seconds]


def set_threads(threads):
    opencv_iib.setNumThreads(threads)
    faiss.omp_set_num_threads(threads)


def refuse_more_than_threads(times, threads):
    """Two threads are no faster than twice one, but for what a median is unsure of."""
    if times > 1.05 * threads:
        sys.exit('%.1f times as fast by %d threads: the machine was not idle, measure again' % (times, threads))


def flat(trains, queries, rounds):
    """Exact search beside faiss.IndexBinaryFlat in its faster way, by a heap or by counting."""
    rows = []
    for width in WIDTHS:
        train, query = random_codes(1, trains, width), random_codes(2, queries, width)
        matcher, heap, counting = (HierarchicalMatcher([width]), faiss.IndexBinaryFlat(8 * width),
                                   faiss.IndexBinaryFlat(8 * width))
        counting.use_heap = False
        for index in (matcher, heap, counting):
            index.add(train)
        for k in (1, 5):
            np.testing.assert_array_equal(matcher.knnMatchArrays(query, k=k)[1], heap.search(query, k)[0])
            calls = []
            for threads in (1, 2):
                for search in (lambda: matcher.knnMatchArrays(query, k=k), lambda: heap.search(query, k),
                               lambda: counting.search(query, k)):
                    calls.append(lambda search=search, threads=threads: (set_threads(threads), search()))
            seconds = median_seconds(calls, rounds)
            pairs = 1e-9 * trains * queries
            for threads, (ours, *theirs) in ((1, seconds[:3]), (2, seconds[3:])):
                rows.append({'bytes': width, 'k': k, 'threads': threads, 'iib_ns': ours / pairs, 'faiss_ns': min(theirs) / pairs})
                print(rows[-1], flush=True)
            refuse_more_than_threads(seconds[0] / seconds[3], 2)
    return {'codes': trains, 'queries': queries, 'rows': rows}


def machine():
    """The processor, how many of its threads are there, and the instructions that count bits or look them up."""
    lines = pathlib.Path('/proc/cpuinfo').read_text().splitlines()
    name, flags = (next((line.partition(': ')[2] for line in lines if line.startswith(key)), '') for key in ('model name', 'flags'))
    widest = 'AVX-512 with VPOPCNTDQ' if 'avx512_vpopcntdq' in flags else 'AVX2' if 'avx2' in flags else 'no AVX2'
    return '%s, %d threads, %s' % (name.strip() or platform.machine(), os.cpu_count(), widest)


OPENING = '''
import json, resource, sys, time
import numpy as np
from opencv_iib import MappedIndex
def resident():
    return int(open('/proc/self/statm').read().split()[1]) * resource.getpagesize() / 2**20
queries = np.random.default_rng(2).integers(0, 256, (100, int(sys.argv[2])), np.uint8)
before = resident(); begin = time.perf_counter()
index = MappedIndex(sys.argv[1])
opened = time.perf_counter(); after = resident()
index.search(queries[:1]); first = time.perf_counter()
index.search(queries[:1]); second = time.perf_counter()
print(json.dumps({'open_ms': 1e3 * (opened - begin), 'open_resident_mb': after - before,
                  'first_search_ms': 1e3 * (first - opened), 'second_search_ms': 1e3 * (second - first),
                  'searched_resident_mb': resident() - before}))
'''


def mapped(folder, codes):
    """Writing, opening in a fresh process, and searching a MappedIndex."""
    step = 1 << 20
    begin = time.perf_counter()
    shards.write(folder, (random_codes(first, min(step, codes - first)) for first in range(0, codes, step)), step)
    write = time.perf_counter() - begin
    runs = [json.loads(subprocess.run([sys.executable, '-c', OPENING, folder, str(BYTES)], check=True, capture_output=True,
                                      text=True).stdout) for _ in range(3)]
    result = {name: min(run[name] for run in runs) for name in runs[0]}
    result.update(codes=codes, bytes=BYTES, shards=MappedIndex(folder).segments(), write_seconds=write)
    print(result, flush=True)
    return result


def workers(folder, queries, rounds):
    """The same search by one worker and by two, each of one thread."""
    query, calls, clusters = random_codes(2, queries), [], []
    for count in (1, 2):
        cluster = distributed.LocalCluster(n_workers=count, threads_per_worker=1, dashboard_address=None, silence_logs=50)
        client = distributed.Client(cluster)
        client.run(opencv_iib.setNumThreads, 1)
        clusters += [client, cluster]
        shards.search(folder, query[:1], 1, client)  # maps and checks
        calls.append(lambda client=client: shards.search(folder, query, 5, client))
    one, two = median_seconds(calls, rounds)
    for each in clusters:
        each.close()
    refuse_more_than_threads(one / two, 2)
    result = {'queries': queries, 'one_worker_seconds': one, 'two_workers_seconds': two}
    print(result, flush=True)
    return result


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--out', required=True, metavar='FILE')
    parser.add_argument('--mapped', type=int, default=10**7, help='in the MappedIndex (%(default)s)')
    parser.add_argument('--rounds', type=int, default=15, help='(%(default)s)')
    arguments = parser.parse_args()
    result = {'date': str(datetime.date.today()), 'machine': machine(), 'rounds': arguments.rounds, 'faiss': faiss.__version__, 'faiss_options': faiss.get_compile_options().strip(),
              'flat': flat(100000, 512, arguments.rounds)}
    with tempfile.TemporaryDirectory() as folder:
        name = str(pathlib.Path(folder) / 'codes')
        result['mapped'] = mapped(name, arguments.mapped)
        result['workers'] = workers(name, 1000, arguments.rounds)
    pathlib.Path(arguments.out).write_text(json.dumps(result, indent=1) + '\n')


if __name__ == '__main__':
    main()
