#!/usr/bin/env python3
"""Measures searches among many codes, beside faiss: measure.py --out FILE [--images FOLDER] [--codes N,...] [--mapped N]

Writes JSON: exact search at several widths, approximate indices of faiss at a recall of .95, the folder of a MappedIndex
of --mapped codes, and Dask's workers on it. Everything that is compared takes turns, and the least time counts. --flat
prints the exact search alone.
"""
import argparse
import json
import pathlib
import subprocess
import sys
import tempfile
import time

import cv2
import faiss
import numpy as np
import opencv_iib
from opencv_iib import HierarchicalMatcher, IIB, MappedIndex, shards

WIDTHS = (16, 32, 64, 128, 170)
BYTES = 64
RECALL = .95
PATIENCE = 60  # seconds: no parameter is raised further once a search of all queries takes longer


def random_codes(seed, rows, width=BYTES):
    return np.random.default_rng(seed).integers(0, 256, (rows, width), np.uint8)


def flipped(codes, share, seed):
    """The codes with that share of their bits changed."""
    random = np.random.default_rng(seed)
    return codes ^ np.packbits(random.random((len(codes), codes.shape[1] * 8)) < share, axis=1)


def least_seconds(calls, rounds):
    """Of each call, which take turns."""
    seconds = [float('inf')] * len(calls)
    for _ in range(rounds):
        for i, call in enumerate(calls):
            begin = time.perf_counter()
            call()
            seconds[i] = min(seconds[i], time.perf_counter() - begin)
    return seconds


def set_threads(threads):
    opencv_iib.setNumThreads(threads)
    faiss.omp_set_num_threads(threads)


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
            for threads in (1, 2):
                set_threads(threads)
                ours, *theirs = least_seconds([lambda: matcher.knnMatchArrays(query, k=k), lambda: heap.search(query, k),
                                               lambda: counting.search(query, k)], rounds)
                pairs = 1e-9 * trains * queries
                rows.append({'bytes': width, 'k': k, 'threads': threads, 'iib_ns': ours / pairs,
                             'faiss_ns': min(theirs) / pairs})
                print(rows[-1], flush=True)
    return {'codes': trains, 'queries': queries, 'rows': rows}


def photographs(folder, count, queries):
    """Codes of images, turned and zoomed until there are enough, and of the same places in other light."""
    iib = IIB.createPreset(IIB.PRESET_COMPACT)
    random = np.random.default_rng(3)

    def describe(image, points):
        found = cv2.goodFeaturesToTrack(image, points, .0001, 3)[:, 0]
        return iib.compute(image, np.column_stack([found, np.full(len(found), 32)]).astype(np.float32))[1]

    sequences = [sorted(sequence.glob('*.png'), key=lambda path: int(path.stem))
                 for sequence in sorted(pathlib.Path(folder).glob('*/*')) if (sequence / '1.png').exists()]
    trains, total = [], 0
    while total < count:
        for images in sequences:
            image = cv2.imread(str(images[0]), cv2.IMREAD_GRAYSCALE)
            height, width = image.shape
            if trains and total >= len(sequences) * 2000:  # the first round is of the images as they are
                turn = cv2.getRotationMatrix2D((width / 2, height / 2), random.uniform(0, 360), random.uniform(.7, 1.4))
                image = cv2.warpAffine(image, turn, (width, height), borderMode=cv2.BORDER_REFLECT)
            trains.append(describe(image, 2000))
            total += len(trains[-1])
    others = np.concatenate([describe(cv2.imread(str(images[-1]), cv2.IMREAD_GRAYSCALE), 200) for images in sequences])
    return np.concatenate(trains)[:count], others[random.permutation(len(others))[:queries]]


def settings(codes):
    """Approximate indices of faiss: name, how to make one, and values of the parameter that trades time for recall. No
    graph of more than a million codes: it would be slower to build and to search than all others, as it is with fewer."""
    bits = 8 * BYTES
    power = round(np.log2(2 * codes ** .5))

    def ivf():
        return faiss.IndexBinaryIVF(faiss.IndexBinaryFlat(bits), bits, 2 ** power)

    def hash_index():
        return faiss.IndexBinaryMultiHash(bits, 16, 18)
    indices = [('IndexBinaryIVF, %d lists' % 2 ** power, ivf, 'nprobe', [2 ** i for i in range(power + 1)]),
               ('IndexBinaryMultiHash, 16 of 18 bits', hash_index, 'nflip', [0, 1, 2, 3])]
    if codes <= 10**6:
        indices.insert(1, ('IndexBinaryHNSW, M 16', lambda: faiss.IndexBinaryHNSW(bits, 16), 'efSearch',
                           [2 ** i for i in range(3, 12)]))
    return indices


def approximate(name, train, query, rounds):
    """Each index with the least parameter that has the recall; without one that has it, with the greatest."""
    set_threads(2)
    matcher = HierarchicalMatcher([BYTES])
    matcher.add(train)
    exact = matcher.knnMatchArrays(query)[1].ravel()
    seconds, = least_seconds([lambda: matcher.knnMatchArrays(query)], rounds)
    rows = [{'data': name, 'index': 'exact (HierarchicalMatcher)', 'setting': '', 'recall': 1, 'build_seconds': 0,
             'queries_a_second': len(query) / seconds, 'bytes_a_code': BYTES}]
    print(rows[-1], flush=True)
    for label, make, parameter, values in settings(len(train)):
        begin = time.perf_counter()
        index = make()
        if not index.is_trained:
            index.train(train[np.random.default_rng(4).permutation(len(train))[:min(40 * index.nlist, 100000)]])
        index.add(train)
        build = time.perf_counter() - begin
        for value in values:
            setattr(index.hnsw if parameter == 'efSearch' else index, parameter, value)
            begin = time.perf_counter()
            recall = float(np.mean(index.search(query, 1)[0].ravel() == exact))
            if recall >= RECALL or time.perf_counter() - begin > PATIENCE:
                break
        seconds, = least_seconds([lambda: index.search(query, 1)], rounds)
        rows.append({'data': name, 'index': label, 'setting': f'{parameter} {value}', 'recall': recall,
                     'build_seconds': build, 'queries_a_second': len(query) / seconds,
                     'bytes_a_code': faiss.serialize_index_binary(index).nbytes / len(train)})
        print(rows[-1], flush=True)
    return rows


def all_approximate(codes, images, rounds):
    train = random_codes(1, codes)
    rows = approximate('random, a tenth of the bits flipped', train, flipped(train[::len(train) // 1000][:1000], .1, 5),
                       rounds)
    if images:
        rows += approximate('photographs', *photographs(images, codes, 1000), rounds)
    return {'codes': codes, 'rows': rows}


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
    import distributed  # which the exact search alone does not need
    query, calls, clusters = random_codes(2, queries), [], []
    for count in (1, 2):
        cluster = distributed.LocalCluster(n_workers=count, threads_per_worker=1, dashboard_address=None, silence_logs=50)
        client = distributed.Client(cluster)
        client.run(opencv_iib.setNumThreads, 1)
        clusters += [client, cluster]
        shards.search(folder, query[:1], 1, client)  # maps and checks
        calls.append(lambda client=client: shards.search(folder, query, 5, client))
    one, two = least_seconds(calls, rounds)
    for each in clusters:
        each.close()
    result = {'queries': queries, 'one_worker_seconds': one, 'two_workers_seconds': two}
    print(result, flush=True)
    return result


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    wanted = parser.add_mutually_exclusive_group(required=True)
    wanted.add_argument('--out', metavar='FILE')
    wanted.add_argument('--flat', action='store_true')
    parser.add_argument('--images', help='folder of SET/SEQUENCE/1.png and so on; none: random codes alone')
    parser.add_argument('--codes', default='300000,1000000,10000000', help='in approximate indices (%(default)s)')
    parser.add_argument('--mapped', type=int, default=10**7, help='in the MappedIndex (%(default)s)')
    parser.add_argument('--rounds', type=int, default=4, help='(%(default)s)')
    arguments = parser.parse_args()
    if arguments.flat:
        flat(100000, 512, arguments.rounds)
        return
    result = {'faiss': faiss.__version__, 'faiss_options': faiss.get_compile_options().strip(),
              'flat': flat(100000, 512, arguments.rounds),
              'approximate': [all_approximate(int(codes), arguments.images, arguments.rounds)
                              for codes in arguments.codes.split(',')]}
    with tempfile.TemporaryDirectory() as folder:
        name = str(pathlib.Path(folder) / 'codes')
        result['mapped'] = mapped(name, arguments.mapped)
        result['workers'] = workers(name, 1000, arguments.rounds)
    pathlib.Path(arguments.out).write_text(json.dumps(result, indent=1) + '\n')


if __name__ == '__main__':
    main()
