#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0

"""Measures maps of many images, made by repetition: map.py PLACE... --out FILE [--images N...], from few images to many

PLACE: folders of tools/synthetic/views.py. Their views at noon are repeated, each copy of a place a hundred metres from the last, until the map
has N images. Then views under other lights are localized in it; since copies look alike, in any of them. Needs opencv_iib and cv2."""
import argparse
import datetime
import json
import multiprocessing
import os
import pathlib
import resource
import sys
import tempfile
import time

import cv2
import numpy as np

import opencv_iib
from opencv_iib import _core, localization

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / 'evaluation'))
from datasets import read_place  # noqa: E402

APART = 100.  # metres
KEYPOINTS, QUERIES = 1000, 12


def write_model(places, count, folder):
    """A COLMAP model of so many images without points, and links to the pictures."""
    (folder / 'images').mkdir()
    (folder / 'model').mkdir()
    images, copies = [], 0
    for copy in range(count):
        for place in places:
            camera, poses = read_place(place / 'map')
            for name, pose in poses.items():
                moved = pose.copy()
                moved[:3, 3] -= APART * copies * pose[:3, 0]
                if len(images) < count:
                    file = '%s_%d_%s' % (place.name, copy, name)
                    os.symlink((place / 'map/images' / name).resolve(), folder / 'images' / file)
                    images.append(_core.PosedImage(file, camera, moved, np.empty((0, 2))))
            copies += 1
    _core.writeModel(folder / 'model', images)


def looked(folder, queries):
    """Seconds to open a map, its memory, and median times of images that are found and that are not; in a process of its own."""
    def resident():
        return int(pathlib.Path('/proc/self/statm').read_text().split()[1]) * resource.getpagesize() / 2 ** 20
    opencv_iib.setNumThreads(1)
    cv2.setNumThreads(1)
    before, begin = resident(), time.process_time()
    localizer = localization.Localizer(folder)
    opened, took = time.process_time() - begin, {True: [], False: []}
    for file, camera in queries:
        image = cv2.imread(str(file), cv2.IMREAD_GRAYSCALE)
        begin = time.process_time()
        found = localizer.localize(image, camera).cam_from_world is not None
        took[found].append(time.process_time() - begin)
    times = {name: 1e3 * sorted(took[found])[len(took[found]) // 2] if took[found] else None for name, found in (('found_ms', True), ('refused_ms', False))}
    return {'open_seconds': opened, 'resident_mb': resident() - before, 'found': len(took[True]), 'queries': len(queries), **times}


def measured(places, count, queries):
    opencv_iib.setNumThreads(1)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        write_model(places, count, folder)
        begin = time.process_time()
        localization.build(folder / 'model', folder / 'images', folder / 'MAP', points=KEYPOINTS)
        seconds, peak = time.process_time() - begin, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
        with multiprocessing.get_context('spawn').Pool(1) as pool:
            answers = pool.apply(looked, (folder / 'MAP', queries))
        file = sum(part.stat().st_size for part in (folder / 'MAP').rglob('*') if part.is_file())
        points = int.from_bytes(next((folder / 'MAP').rglob('points3D.bin')).open('rb').read(8), 'little')
    return {'images': count, 'points': points, 'build_seconds': seconds, 'build_peak_mb': peak, 'file_mb': file / 2 ** 20, **answers}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('places', nargs='+', type=pathlib.Path)
    parser.add_argument('--out', required=True, type=pathlib.Path)
    parser.add_argument('--images', nargs='+', type=int, default=[100, 1000, 10000])
    options = parser.parse_args()
    queries = []
    for place in options.places:
        camera = read_place(place / 'map')[0]
        queries += [(file, camera) for light in ('night', 'dusk', 'winter') for file in sorted((place / light / 'images').glob('*.png'))]
    queries = queries[::max(1, len(queries) // QUERIES)]
    processor = next((line.partition(': ')[2] for line in open('/proc/cpuinfo') if line.startswith('model name')), '')
    result = {'date': str(datetime.date.today()), 'machine': processor.strip(), 'keypoints': KEYPOINTS,
              'size': list(reversed(cv2.imread(str(queries[0][0]), cv2.IMREAD_GRAYSCALE).shape)), 'rows': []}
    for count in options.images:
        result['rows'].append(measured(options.places, count, queries))
        print(result['rows'][-1], flush=True)
        options.out.write_text(json.dumps(result, indent=1) + '\n')


if __name__ == '__main__':
    main()
