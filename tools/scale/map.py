#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0

"""Measures maps of many images, made by repetition: map.py PLACE... --out FILE [--images N...]

PLACE: folders that tools/synthetic/views.py wrote. Their views at noon are repeated, each copy of a place a hundred metres from the last, until
the map has N images; the views of other lights are then looked for in it. The copies look alike, so that what is found may be in any of them."""
import argparse
import datetime
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time

import cv2
import numpy as np

APART = 100.  # metres
KEYPOINTS, QUERIES = 1000, 12


def poses(folder):
    """Names, and camera from world: quaternion w x y z and translation, of a folder in TUM's form."""
    for line in (folder / 'poses.txt').read_text().splitlines():
        if line and line[0] != '#':
            name, *numbers = line.split()
            yield name, np.array(numbers[:3], float), np.array(numbers[3:], float)


def write_model(places, count, folder):
    """A COLMAP model in text of so many images, without points, and links to the pictures."""
    (folder / 'images').mkdir()
    cameras, lines, links = {}, [], 0
    for copy in range(count):
        for place in places:
            camera = (place / 'map/cameras.txt').read_text().splitlines()[-1].split()
            cameras.setdefault(' '.join(camera[1:]), len(cameras) + 1)
            for name, centre, (x, y, z, w) in poses(place / 'map'):
                if len(lines) == 2 * count:
                    break
                rotation = np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)], [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])
                t = -rotation.T @ (centre + [APART * links, 0, 0])
                file = '%s_%d_%s.png' % (place.name, copy, name)
                os.symlink((place / 'map/images' / (name + '.png')).resolve(), folder / 'images' / file)
                lines += ['%d %.9f %.9f %.9f %.9f %.9f %.9f %.9f %d %s' % (len(lines) // 2 + 1, w, -x, -y, -z, *t, cameras[' '.join(camera[1:])], file), '']
            links += 1
    (folder / 'model').mkdir()
    (folder / 'model/cameras.txt').write_text(''.join('%d %s\n' % (number, camera) for camera, number in cameras.items()))
    (folder / 'model/images.txt').write_text('\n'.join(lines) + '\n')
    (folder / 'model/points3D.txt').write_text('')


LOOKING = '''
import json, resource, sys, time
import cv2
import opencv_iib
from opencv_iib.localization import Camera, Localizer
opencv_iib.setNumThreads(1)
cv2.setNumThreads(1)
def resident():
    return int(open('/proc/self/statm').read().split()[1]) * resource.getpagesize() / 2**20
before, begin = resident(), time.perf_counter()
localizer = Localizer(sys.argv[1])
opened, took = time.perf_counter() - begin, {True: [], False: []}
for line in sys.argv[2:]:
    file, _, camera = line.partition('|')
    image = cv2.imread(file, cv2.IMREAD_GRAYSCALE)
    begin = time.process_time()
    found = localizer.localize(image, Camera.parse(camera)).cam_from_world is not None
    took[found].append(time.process_time() - begin)
times = {name: 1e3 * sorted(took[found])[len(took[found]) // 2] if took[found] else None for name, found in (('found_ms', True), ('refused_ms', False))}
print(json.dumps({'open_seconds': opened, 'resident_mb': resident() - before, 'found': len(took[True]), 'queries': len(sys.argv) - 2, **times}))
'''


def measure(places, count, queries):
    import opencv_iib
    from opencv_iib import localization
    opencv_iib.setNumThreads(1)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        write_model(places, count, folder)
        begin = time.process_time()
        localization.build(folder / 'model', folder / 'images', folder / 'MAP', points=KEYPOINTS)
        seconds = time.process_time() - begin
        looked = json.loads(subprocess.run([sys.executable, '-c', LOOKING, str(folder / 'MAP'), *queries], check=True, capture_output=True, text=True).stdout)
        file = sum(part.stat().st_size for part in (folder / 'MAP').rglob('*') if part.is_file())
        points = int.from_bytes(next((folder / 'MAP').rglob('points3D.bin')).open('rb').read(8), 'little')
    return {'images': count, 'points': points, 'build_seconds': seconds, 'file_mb': file / 2 ** 20, **looked}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('places', nargs='+', type=pathlib.Path)
    parser.add_argument('--out', required=True, type=pathlib.Path)
    parser.add_argument('--images', nargs='+', type=int, default=[100, 1000, 10000])
    options = parser.parse_args()
    queries = []
    for place in options.places:
        camera = ','.join((place / 'map/cameras.txt').read_text().splitlines()[-1].split()[1:])
        queries += ['%s|%s' % (file, camera) for light in ('night', 'dusk', 'winter') for file in sorted((place / light / 'images').glob('*.png'))]
    queries = queries[::max(1, len(queries) // QUERIES)]
    processor = next((line.partition(': ')[2] for line in open('/proc/cpuinfo') if line.startswith('model name')), '')
    result = {'date': str(datetime.date.today()), 'machine': processor.strip(), 'keypoints': KEYPOINTS,
              'size': list(reversed(cv2.imread(queries[0].partition('|')[0], cv2.IMREAD_GRAYSCALE).shape)), 'rows': []}
    for count in options.images:
        result['rows'].append(measure(options.places, count, queries))
        print(result['rows'][-1], flush=True)
        options.out.write_text(json.dumps(result, indent=1) + '\n')


if __name__ == '__main__':
    main()
