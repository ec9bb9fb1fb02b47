#!/usr/bin/env python3
"""COLMAP's SIFT, ORB and IIB on photographs with known poses, as they are and with every second one relit.

    python compare_colmap.py SCENE... [--points 4000] [--methods SIFT,ORB,IIB,UNIVERSAL/refined]

A SCENE holds ``images/`` and ``poses.txt`` (TUM: name or time, camera centre in metres, quaternion; in the order of the
images' names). Needs the program colmap (Debian's package) and opencv_iib[colmap]. Prints a table: registered images,
points, mean track length, reprojection error in pixels, and the median error of the camera centres after alignment,
in per cent of the distance between the outermost of them.

Methods: SIFT is COLMAP's own; ORB; IIB, or a preset's name, on ORB's keypoints; SIFT+IIB on those of cv2's SIFT,
HESSIAN+UNIVERSAL on HessianDetector's (the recommended chain); each but COLMAP's SIFT also as NAME/refined.
"""
import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import cv2
import numpy as np

HEAD = ('| scene | light | method | registered | points | track | reprojection | centres, % |\n'
        '|---|---|---|---|---|---|---|---|')


def relit(image, number):
    """One of four other lights: a camera's curve, a shade across, half the light, or noise."""
    values = image.astype(np.float64) / 255
    if number == 0:
        values = values ** 2.2
    elif number == 1:
        values = values * np.linspace(1, .25, image.shape[1])[None, :, None]
    elif number == 2:
        values = values / 2
    else:
        values = values + np.random.default_rng(1).normal(0, .04, image.shape)
    return np.clip(values * 255 + .5, 0, 255).astype(np.uint8)


def colmap(*arguments):
    done = subprocess.run(['colmap', *map(str, arguments)], capture_output=True, text=True,
                          env={**os.environ, 'QT_QPA_PLATFORM': 'offscreen'})
    if done.returncode:
        raise RuntimeError(f'colmap {arguments[0]}: {(done.stdout + done.stderr)[-500:]}')
    return done.stdout + done.stderr


def make_database(method, images, database, points):
    if method == 'SIFT':
        colmap('feature_extractor', '--database_path', database, '--image_path', images,
               '--SiftExtraction.use_gpu', 0, '--SiftExtraction.max_num_features', points)
        colmap('exhaustive_matcher', '--database_path', database, '--SiftMatching.use_gpu', 0)
        return
    described, _, refined = method.partition('/')
    detector, _, name = described.rpartition('+')
    preset = {'ORB': 'OWN', 'IIB': 'DEFAULT'}.get(name, name)
    from opencv_iib.colmap import FeatureOptions, Options, build_database  # so that --help works without it

    build_database(str(images), str(database), Options(FeatureOptions(detector or 'ORB', points, preset),
                                                       refine=refined == 'refined'))


def centres(model):
    """Camera centres by image name."""
    colmap('model_converter', '--input_path', model, '--output_path', model, '--output_type', 'TXT')
    found = {}
    lines = [line for line in (model / 'images.txt').read_text().splitlines() if not line.startswith('#')]
    for line in lines[::2]:
        fields = line.split()
        w, x, y, z = map(float, fields[1:5])
        rotation = np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                             [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                             [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])
        found[fields[9]] = -rotation.T @ np.array(list(map(float, fields[5:8])))
    return found


def aligned_error(found, truth):
    """Median distance in per cent of the extent, after the best similarity (Umeyama)."""
    names = sorted(set(found) & set(truth))
    if len(names) < 3:
        return float('nan')
    a, b = np.array([found[n] for n in names]), np.array([truth[n] for n in names])
    a0, b0 = a - a.mean(0), b - b.mean(0)
    u, s, vt = np.linalg.svd(b0.T @ a0)
    sign = np.diag([1, 1, np.sign(np.linalg.det(u @ vt))])
    scale = (s * np.diag(sign)).sum() / (a0 ** 2).sum()
    errors = np.linalg.norm(scale * a0 @ (u @ sign @ vt).T - b0, axis=1)
    return 100 * float(np.median(errors)) / float(np.linalg.norm(b[:, None] - b[None], axis=2).max())


def measure(method, images, truth, points, work):
    database, sparse = work / 'database.db', work / 'sparse'
    sparse.mkdir()
    make_database(method, images, database, points)
    try:
        colmap('mapper', '--database_path', database, '--image_path', images, '--output_path', sparse)
    except RuntimeError:  # no pair to begin with, for some versions
        pass
    best = ('0', '0', 'nan', 'nan', float('nan'))
    for model in sparse.iterdir():
        text = colmap('model_analyzer', '--path', model)
        values = [re.search(name + r': ([\d.]+)', text) for name in
                  ('Registered images', 'Points', 'Mean track length', 'Mean reprojection error')]
        row = tuple(v.group(1) if v else 'nan' for v in values)
        if int(row[0]) > int(best[0]):
            best = (*row, aligned_error(centres(model), truth))
    return best


def compare(scene, light, methods, points):
    """Lines of the table."""
    names = sorted(os.listdir(scene / 'images'))
    poses = [line.split() for line in (scene / 'poses.txt').read_text().splitlines()
             if line.strip() and not line.startswith('#')]
    with tempfile.TemporaryDirectory() as folder:
        images = Path(folder, 'images')
        images.mkdir()
        truth = {}
        for i, (name, pose) in enumerate(zip(names, poses)):
            image = cv2.imread(str(scene / 'images' / name))
            image = relit(image, i // 2 % 4) if light == 'relit' and i % 2 else image
            cv2.imwrite(str(images / (Path(name).stem + '.png')), image)
            truth[Path(name).stem + '.png'] = np.array(list(map(float, pose[1:4])))
        for method in methods:
            work = Path(folder, method.replace('/', '-'))
            work.mkdir()
            row = measure(method, images, truth, points, work)
            yield (f'| {scene.name} | {light} | {method} | {row[0]} of {len(names)} | {row[1]} | {float(row[2]):.2f} | '
                   f'{float(row[3]):.2f} | {row[4]:.2f} |')


def main():
    methods = 'SIFT,ORB,ORB/refined,IIB,IIB/refined,UNIVERSAL,UNIVERSAL/refined,SIFT+IIB,HESSIAN+UNIVERSAL,' \
              'HESSIAN+UNIVERSAL/refined'
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('scenes', type=Path, nargs='+', metavar='SCENE')
    parser.add_argument('--points', type=int, default=4000)
    parser.add_argument('--methods', default=methods, help='also any preset of opencv_iib (%(default)s)')
    arguments = parser.parse_args()
    if not shutil.which('colmap'):
        sys.exit('there is no program colmap: install it (Debian: apt-get install colmap)')
    print(HEAD)
    for scene in arguments.scenes:
        for light in ('plain', 'relit'):
            for line in compare(scene, light, arguments.methods.split(','), arguments.points):
                print(line, flush=True)


if __name__ == '__main__':
    main()
