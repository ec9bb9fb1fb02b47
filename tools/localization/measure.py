#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0

"""Localizes images under other lights in a map made at noon, by opencv_iib.localization and by SIFT: measure.py DATA OUT

DATA: output of tools/synthetic/localization.py. Photographs are read from OPENCV_TEST_DATA_PATH, if it is set. OUT receives
results.json, world.js, pictures and a video, from which tools/pages makes the page. A place is a folder with images/, cameras.txt
(COLMAP, one camera) and poses.txt (TUM: image, camera's centre, camera to world).
"""
import argparse
import csv
import datetime
import functools
import itertools
import json
import os
import pathlib
import resource
import subprocess
import sys
import tempfile
import time

import cv2
import numpy as np
import pycolmap

import opencv_iib
from opencv_iib.localization import Localizer, build, update
from sift import Location, Sift

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / 'evaluation'))
from datasets import pose_of, read_place, write_model  # noqa: E402

LIGHTS = ('night', 'dusk', 'winter', 'overcast', 'fog', 'morning', 'wet')
POINTS = 2000  # an image
FRAME, VIDEO, RATE = (400, 300), (640, 240), 4  # pixels of an image in a picture, of the small video; frames a second
UNKNOWN = 200  # number of photographs of other places
DRAWN = 6000  # approximate number of points of the map that are drawn
SEASONS = ('morning', 'overcast', 'dusk')  # updates, in the order of a day


def chain(folder, work, step=1):
    """A Localizer in the package's map of a place, in the folder work/map."""
    write_model(work / 'model', *read_place(folder, step))
    build(str(work / 'model'), str(folder / 'images'), str(work / 'map'), POINTS)
    return Localizer(work / 'map', POINTS)


def sift(folder, work, step=1, *, normalized, refine):
    """A Sift localizer in a map of a place."""
    write_model(work / 'model', *read_place(folder, step))
    return Sift(work / 'model', folder / 'images', POINTS, normalized, refine)


METHODS = {'recommended chain': chain,
           **{'SIFT, %s image%s' % (('plain', 'normalized')[normalized], ', refined' * refine): functools.partial(sift, normalized=normalized, refine=refine)
              for normalized, refine in itertools.product((True, False), (True, False))}}
PHOTOGRAPHED = 'as they are', 'relit'


def error(found, truth):
    """Errors of position and rotation, centimetres and degrees."""
    turn = np.linalg.norm(cv2.Rodrigues(found[:3, :3] @ truth[:3, :3].T)[0])
    return 100 * float(np.linalg.norm((np.linalg.inv(found) - np.linalg.inv(truth))[:3, 3])), float(np.degrees(turn))


def localize(localizer, folder, names=None, lit=lambda image, name: image):
    """Yields name, location, error or None, and milliseconds of processor time of each image of a place."""
    camera, poses = read_place(folder)
    for name in names or poses:
        image = lit(cv2.imread(str(folder / 'images' / name), cv2.IMREAD_GRAYSCALE), name)
        begin = time.process_time()
        location = localizer.localize(image, camera)
        used = 1000 * (time.process_time() - begin)
        pose = location.cam_from_world
        yield name, location, None if pose is None else error(pose, poses[name]), used


def relit(image, name):
    """Darkens an image by gamma 2.2, a ramp to a quarter and a factor of one half, and adds noise."""
    light = (image / 255) ** 2.2 * np.linspace(1, .25, image.shape[1]) * .5
    return np.clip(light * 255 + np.random.default_rng(sum(name.encode())).normal(0, 2, image.shape), 0, 255).astype(np.uint8)


def summary(located):
    """The page's statistics of images under one light; errors of found images are sorted."""
    errors = sorted(error for _, _, error, _ in located if error)
    within = {limit: sum(bool(cm <= limit and degrees <= turn) for cm, degrees in errors) for limit, turn in ((5, .5), (25, 2))}
    return {'images': len(located), 'found': len(errors), 'within_5': within[5], 'within_25': within[25],
            'median': float(np.median([cm for cm, _ in errors])) if errors else None, 'errors': [cm for cm, _ in errors],
            'inliers': float(np.median([location.inliers for _, location, _, _ in located])),
            'ms': float(np.median([used for _, _, _, used in located]))}


def street(data, work, lights):
    """Rows of all methods and lights, and of fewer keyframes; the chain's locations by light; the chain's localizer."""
    rows, seen, ours = [], {}, None
    for method, make in METHODS.items():
        localizer = make(data / 'map', work / method)
        ours = ours or localizer
        for light in lights:
            located = list(localize(localizer, data / light))
            seen.setdefault(light, located)
            rows.append({'place': 'street', 'method': method, 'light': light, **summary(located)})
    for step in (2, 4):
        localizer = chain(data / 'map', work / f'every {step}', step)
        for light in lights:
            rows.append({'place': f'every {step}', 'method': 'recommended chain', 'light': light, **summary(list(localize(localizer, data / light)))})
    return rows, seen, ours


def run_command(known, images, out, options=()):
    """The poses of a folder's images in a map by `opencv-iib localize`, by file name."""
    subprocess.run([sys.executable, '-m', 'opencv_iib', 'localize', '--map', known, '--images', images / 'images', '--out', out, *options],
                   check=False, stdout=subprocess.DEVNULL)
    names = {image.stem: image.name for image in (images / 'images').iterdir()}
    return {names[line.split()[0]]: pose_of(line.split()[1:]) for line in (out / 'trajectory.txt').read_text().splitlines()[1:]}


def command(data, work, lights):
    """Rows of `opencv-iib localize` in the chain's map, with and without IMU readings; milliseconds are of the whole run."""
    rows = []
    for light, imu in itertools.product(lights, ('', ' --imu')):
        readings, out, poses = data / light / 'imu.csv', work / (light + imu), read_place(data / light)[1]
        if imu and not readings.exists():
            continue
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        found = run_command(work / 'recommended chain/map', data / light, out, ('--imu', readings) if imu else ())
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        used = 1000 * (after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime) / len(poses)
        errors = {name: error(pose, poses[name]) for name, pose in found.items()}
        with open(out / 'frames.csv', encoding='utf-8', newline='') as file:
            located = [(row['name'], Location(inliers=int(row['inliers'])), errors.get(row['name']), used) for row in csv.DictReader(file)]
        rows.append({'place': 'street', 'method': 'opencv-iib localize' + imu, 'light': light, **summary(located)})
    return rows


def seasons(data, work, lights):
    """Night in a map of every fourth keyframe, and after updates with other lights."""
    rows, known = [], work / 'every 4/map'
    for light in ('noon', *(light for light in SEASONS if light in lights)):
        counts = {} if light == 'noon' else update(str(known), str(data / light / 'images'), read_place(data / light)[0])
        localizer = Localizer(known, POINTS)
        rows.append({'light': light, 'added': counts.get('added', 0), 'size': pycolmap.Reconstruction(known).num_images(),
                     'night': summary(list(localize(localizer, data / 'night')))})
    return rows


def photographs(data, work):
    """Rows of real photographs: every other image mapped, the others found as they are and relit."""
    rows = []
    for folder in sorted(path.parent for path in data.glob('*/poses.txt')):
        others = list(read_place(folder)[1])[1::2]
        for method, make in METHODS.items():
            localizer = make(folder, work / f'{folder.name} {method}', 2)
            for light, lit in zip(PHOTOGRAPHED, (lambda image, name: image, relit)):
                rows.append({'place': folder.name, 'method': method, 'light': light, **summary(list(localize(localizer, folder, others, lit)))})
    return rows


def unknown(localizer, camera, paths):
    """How many photographs of other places get a pose."""
    images = (cv2.resize(cv2.imread(str(path), cv2.IMREAD_GRAYSCALE), (camera.width, camera.height)) for path in paths)
    return sum(localizer.localize(image, camera).cam_from_world is not None for image in images)


def scene(model, folder, seen):
    """The map in 3-D: points with grey values, and the pyramids of the keyframes' and the found images' cameras."""
    model.extract_colors_for_all_images(str(folder / 'images'))
    points = [[*(round(float(v), 2) for v in p.xyz), int(p.color.mean())] for p in model.points3D.values() if p.track.length() > 2]
    cameras = []

    def add(light, name, pose, text):
        inverse, corners = np.linalg.inv(pose), np.array([[0, 0, 0], [-.4, -.3, .5], [.4, -.3, .5], [.4, .3, .5], [-.4, .3, .5]])
        cameras.append({'light': light, 'text': '%s, %s' % (name, text), 'corners': (corners @ inverse[:3, :3].T + inverse[:3, 3]).round(2).tolist()})

    for image in model.images.values():
        add('noon', image.name, np.concatenate([image.cam_from_world().matrix(), [[0, 0, 0, 1]]]), 'of the map')
    for light, located in seen.items():
        for name, location, error, _ in located:
            if error:
                add(light, name, location.cam_from_world, '%s: %.1f cm off, %d points agree' % (light, error[0], location.inliers))
    return {'points': points[::len(points) // DRAWN + 1], 'cameras': cameras, 'lights': ['noon', *seen]}


def pairs(model, folder, data, located):
    """Yields the number of inliers of each found image, and a picture of it beside the nearest keyframe."""
    camera = read_place(data)[0]
    for name, location, error, _ in located:
        if not error:
            continue
        image = cv2.imread(str(data / 'images' / name))
        pose = location.cam_from_world
        places = camera.project(location.points @ pose[:3, :3].T + pose[:3, 3])
        for seen, mapped in zip(location.pixels, places):
            begin, end = (tuple(int(v) for v in place) for place in (seen, mapped))
            cv2.line(image, begin, end, (0, 0, 255), 2, cv2.LINE_AA)
            cv2.circle(image, begin, 3, (0, 220, 0), 1, cv2.LINE_AA)
        centre = np.linalg.inv(pose)[:3, 3]
        nearest = min(model.images.values(), key=lambda i: np.linalg.norm(i.projection_center() - centre)).name
        pair = [cv2.resize(p, FRAME, interpolation=cv2.INTER_AREA) for p in (cv2.imread(str(folder / 'images' / nearest)), image)]
        text = '%d points agree, %.1f cm off' % (location.inliers, error[0])
        cv2.putText(pair[1], text, (8, 20), cv2.FONT_HERSHEY_SIMPLEX, .5, (255, 255, 255), 1, cv2.LINE_AA)
        yield location.inliers, np.hstack(pair)


def write_pictures(out, light, drawn):
    """Writes the pair with the median number of inliers; for the night also a VP9 video of all pairs."""
    in_order = sorted(drawn, key=lambda pair: pair[0])
    cv2.imwrite(str(out / (light + '.jpg')), in_order[len(in_order) // 2][1], [cv2.IMWRITE_JPEG_QUALITY, 70])
    if light == 'night':
        writer = cv2.VideoWriter(str(out / 'night.webm'), cv2.VideoWriter_fourcc(*'VP90'), RATE, VIDEO)
        for _, picture in drawn:
            writer.write(cv2.resize(picture, VIDEO, interpolation=cv2.INTER_AREA))
        writer.release()


def write_results(out, results):
    lines = ',\n'.join('"%s": %s' % (name, json.dumps(value)) for name, value in results.items())
    (out / 'results.json').write_text('{\n%s\n}\n' % lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('data', type=pathlib.Path)
    parser.add_argument('out', type=pathlib.Path)
    parser.add_argument('--photographs', action='store_true', help='measure them alone, and replace their rows in OUT/results.json')
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    opencv_iib.setNumThreads(1)
    cv2.setNumThreads(1)
    lights = [light for light in LIGHTS if any((options.data / light / 'images').glob('[0-9]*.png'))]
    folder, given = options.data / 'map', os.environ.get('OPENCV_TEST_DATA_PATH')
    with tempfile.TemporaryDirectory() as work:
        work = pathlib.Path(work)
        if options.photographs:
            results = json.loads((options.out / 'results.json').read_text())
            kept = [row for row in results['rows'] if row['light'] not in PHOTOGRAPHED]
            return write_results(options.out, {**results, 'rows': kept + photographs(pathlib.Path(given) / 'strecha', work)})
        rows, seen, ours = street(options.data, work, lights)
        rows += command(options.data, work, lights)
        results = {'rows': rows, 'lights': lights, 'seasons': seasons(options.data, work, lights), 'unknown': None,
                   'date': datetime.date.today().isoformat(), 'opencv': cv2.__version__}
        if given:
            rows += photographs(pathlib.Path(given) / 'strecha', work)
            paths = sorted(pathlib.Path(given).glob('illumination/*/*/*.png'))
            paths = paths[::len(paths) // UNKNOWN + 1]
            results['unknown'] = unknown(ours, read_place(folder)[0], paths), len(paths)
        model = pycolmap.Reconstruction(work / 'recommended chain/map')
        (options.out / 'world.js').write_text('const world = %s;\n' % json.dumps(scene(model, folder, seen), separators=(',', ':')))
        results['pictures'] = []
        for light in lights:
            drawn = list(pairs(model, folder, options.data / light, seen[light]))
            if drawn:
                write_pictures(options.out, light, drawn)
                results['pictures'].append(light)
    write_results(options.out, results)


if __name__ == '__main__':
    main()
