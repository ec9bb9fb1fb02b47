#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0

"""Measures localization across lights and writes OUT/index.html with pictures, a video and results.json: page.py DATA OUT

DATA: what tools/synthetic/localization.py rendered. Photographs, of other places too, are in the folder that
OPENCV_TEST_DATA_PATH names, if it is set. Shows what setups.py wrote to OUT/localization_setups.csv, if that is there, or the
project's own file.
"""
import argparse
import datetime
import json
import math
import os
import pathlib
import sys
import tempfile

import cv2
import jinja2
import numpy as np
import pycolmap

import measure
import opencv_iib

HERE = pathlib.Path(__file__).resolve().parent
sys.path.append(str(HERE.parents[2] / 'scripts/helpers'))
import figures  # noqa: E402

LIGHTS = ('night', 'dusk', 'winter', 'overcast', 'fog', 'morning', 'wet')
FRAME, VIDEO, RATE = (400, 300), (640, 240), 4  # pixels of an image in a picture, of the video (noise makes it large); frames a second
UNKNOWN = 200  # photographs of other places
DRAWN = 6000  # points of the map
CHART = (300, 150)


def share(count, of):
    """Per cent with its 95 % confidence interval (Wilson)."""
    p, z = count / of, 1.96
    middle, half = (p + z * z / (2 * of)) / (1 + z * z / of), z * math.sqrt(p * (1 - p) / of + z * z / (4 * of * of)) / (1 + z * z / of)
    return '%.0f %% (%.0f to %.0f)' % (100 * p, 100 * max(0, middle - half), 100 * min(1, middle + half))


def chart(rows):
    """Share of images by error, a line a method: SVG places, and marks at the tenfold centimetres that the data span."""
    errors = [e for row in rows for e in row['errors']]
    if not errors:
        return None
    low, high = (f(math.log10(f2(errors) or 1)) for f, f2 in ((math.floor, min), (math.ceil, max)))

    def at(cm, part):
        return '%.1f,%.1f' % ((math.log10(max(cm, 10. ** low)) - low) / (high - low or 1) * CHART[0], CHART[1] * (1 - part))

    lines = {}
    for row in rows:
        if row['method'] not in measure.METHODS:
            continue
        steps = [at(e, (n + k) / row['images']) for n, e in enumerate(row['errors']) for k in (0, 1)]
        lines[row['method']] = ' '.join([*steps, *([at(10. ** high, len(row['errors']) / row['images'])] if steps else [])])
    return {'light': rows[0]['light'], 'lines': lines, 'marks': [('%g' % 10. ** e, (e - low) / (high - low or 1) * CHART[0])
                                                                 for e in range(low, high + 1)]}


def worst(results):
    """Of every light the worst one: how many images are how near."""
    def within(place, limit):
        rows = [row for row in results['rows'] if (row['place'], row['method']) == (place, 'recommended chain')]
        return min(100 * row['within_%d' % limit] / row['images'] for row in rows)

    found = [('%s, within %s' % (what, near), '%.0f %%' % within(place, limit))
             for what, place, limit, near in (('keyframes 1.4 m apart', 'street', 5, '5 cm and 0.5°'),
                                              ('keyframes 1.4 m apart', 'street', 25, '25 cm and 2°'),
                                              ('keyframes 2.8 m apart', 'every 2', 5, '5 cm and 0.5°'),
                                              ('keyframes 5.6 m apart', 'every 4', 5, '5 cm and 0.5°'))]
    if results['unknown']:
        found.append(('photographs of other places that get a pose', share(*results['unknown'])))
    return found


def scene(model, folder, seen):
    """The map in 3-D: points with grey values, and the pyramids of the keyframes' and the found images' cameras."""
    model.extract_colors_for_all_images(str(folder / 'images'))
    points = [[*(round(float(v), 2) for v in p.xyz), int(p.color.mean())] for p in model.points3D.values() if p.track.length() > 2]
    cameras = []

    def add(light, name, pose, told):
        inverse, corners = np.linalg.inv(pose), np.array([[0, 0, 0], [-.4, -.3, .5], [.4, -.3, .5], [.4, .3, .5], [-.4, .3, .5]])
        cameras.append({'light': light, 'told': '%s, %s' % (name, told), 'corners': (
            corners @ inverse[:3, :3].T + inverse[:3, 3]).round(2).tolist()})

    for image in model.images.values():
        add('noon', image.name, np.concatenate([image.cam_from_world().matrix(), [[0, 0, 0, 1]]]), 'of the map')
    for light, located in seen.items():
        for name, location, error, _ in located:
            if error:
                add(light, name, location.cam_from_world, '%s: %.1f cm off, %d points agree' % (light, error[0], location.inliers))
    return {'points': points[::len(points) // DRAWN + 1], 'cameras': cameras, 'lights': ['noon', *seen]}


def pairs(model, folder, data, located):
    """Of each image that was found: its number of inliers, and a picture of the nearest keyframe beside it."""
    camera = measure.read_place(data)[0]
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
    """The pair with the median number of inliers; of the night also all, as VP9, which browsers play."""
    in_order = sorted(drawn, key=lambda pair: pair[0])
    cv2.imwrite(str(out / (light + '.jpg')), in_order[len(in_order) // 2][1], [cv2.IMWRITE_JPEG_QUALITY, 70])
    if light == 'night':
        writer = cv2.VideoWriter(str(out / 'night.webm'), cv2.VideoWriter_fourcc(*'VP90'), RATE, VIDEO)
        for _, picture in drawn:
            writer.write(cv2.resize(picture, VIDEO, interpolation=cv2.INTER_AREA))
        writer.release()


def write_page(out, results, world, pictures):
    environment = jinja2.Environment(loader=jinja2.FileSystemLoader(HERE), autoescape=True, trim_blocks=True, lstrip_blocks=True,
                                     undefined=jinja2.StrictUndefined)
    rows = sorted((row for row in results['rows'] if row['place'] == 'street'), key=lambda row: row['method'].startswith('SIFT'))
    by_light = [[row for row in rows if row['light'] == light] for light in results['lights']]
    setups = [file for file in [out / 'localization_setups.csv'] if file.exists()]
    text = environment.get_template('page.html.j2').render(
        results, by_light=by_light, charts=[c for c in map(chart, by_light) if c], worst=worst(results), share=share, world=world,
        pictures=pictures, size=CHART, setups=figures.localization_lights(*setups),
        photographs=sorted({row['place'] for row in results['rows']} - {'street', 'every 2', 'every 4'}))
    (out / 'index.html').write_text(text, encoding='utf-8')


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('data', type=pathlib.Path)
    parser.add_argument('out', type=pathlib.Path)
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    opencv_iib.setNumThreads(1)
    cv2.setNumThreads(1)
    lights = [light for light in LIGHTS if any((options.data / light / 'images').glob('[0-9]*.png'))]
    folder, given = options.data / 'map', os.environ.get('OPENCV_TEST_DATA_PATH')
    with tempfile.TemporaryDirectory() as work:
        work = pathlib.Path(work)
        rows, seen, ours = measure.street(options.data, work, lights)
        rows += measure.command(options.data, work, lights)
        results = {'rows': rows, 'lights': lights, 'seasons': measure.seasons(options.data, work, lights), 'unknown': None,
                   'date': datetime.date.today().isoformat(), 'opencv': cv2.__version__}
        if given:
            rows += measure.photographs(pathlib.Path(given) / 'strecha', work)
            paths = sorted(pathlib.Path(given).glob('illumination/*/*/*.png'))
            paths = paths[::len(paths) // UNKNOWN + 1]
            results['unknown'] = measure.unknown(ours, measure.read_place(folder)[0], paths), len(paths)
        (options.out / 'results.json').write_text(json.dumps(results, indent=1))
        model, pictures = pycolmap.Reconstruction(work / 'recommended chain/map'), []
        for light in lights:
            drawn = list(pairs(model, folder, options.data / light, seen[light]))
            if drawn:
                write_pictures(options.out, light, drawn)
                pictures.append(light)
        write_page(options.out, results, scene(model, folder, seen), pictures)
    print(options.out / 'index.html')


if __name__ == '__main__':
    main()
