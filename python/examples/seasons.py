#!/usr/bin/env python3
"""What a map of noon finds in another light, before and after it learns lights between them.

    python seasons.py WALK... [--every 3] [--updates dusk,winter] [--rounds 10] [--asked night]

WALK/LIGHT holds ``images/``, ``poses.txt`` (TUM: an image's name without ending, camera's centre in metres, camera to world)
and ``cameras.txt`` (COLMAP's, one camera). Of WALK/map every third image becomes a map; the images of `asked` are localized in
it, and again after each update of the first round and after the last. Needs opencv_iib[localization].
"""
import argparse
import contextlib
import io
import os
import tempfile
from pathlib import Path

import cv2
import numpy as np
import pycolmap

from opencv_iib.localization import Localizer, build_map, parse_camera, read_map, update_map


def read_light(folder):
    """The camera, and cam_from_world by the name of each image."""
    rows = [line.split() for line in (folder / 'poses.txt').read_text().splitlines() if line[:1] not in ('', '#')]
    camera = [line for line in (folder / 'cameras.txt').read_text().splitlines() if line[:1] != '#'][0].split()
    numbers = {row[0]: np.array(row[1:], float) for row in rows}
    return parse_camera(','.join(camera[1:])), {
        path.name: pycolmap.Rigid3d(pycolmap.Rotation3d(numbers[path.stem][3:]), numbers[path.stem][:3]).inverse()
        for path in sorted((folder / 'images').iterdir())}


def make_map(folder, every, out):
    camera, poses = read_light(folder)
    camera.camera_id = 1
    model = pycolmap.Reconstruction()
    model.add_camera_with_trivial_rig(camera)
    for i, name in enumerate(sorted(poses)[::every], 1):
        model.add_image_with_trivial_frame(pycolmap.Image(name, np.zeros((0, 2)), 1, i), poses[name])
    with tempfile.TemporaryDirectory() as sparse:
        model.write(sparse)
        build_map(sparse, str(folder / 'images'), out)


def tell(walk, learned, asked, folder):
    """Prints a line of the table."""
    camera, poses = read_light(walk / asked)
    known = read_map(folder)
    localizer, errors, inliers = Localizer(known, known.points), [], []
    for name, truth in poses.items():
        found = localizer.localize(cv2.imread(str(walk / asked / 'images' / name)), camera)
        if found.cam_from_world is not None:
            errors.append(100 * np.linalg.norm(found.cam_from_world.inverse().translation - truth.inverse().translation))
            inliers.append(found.inliers)
    print(f'| {walk.name} | {learned} | {len(errors)} of {len(poses)} | {np.median(errors or np.nan):.1f} | '
          f'{np.median(inliers or np.nan):.0f} | {len(known.codes)} | {sum(map(len, known.codes.values()))} |', flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('walks', type=Path, nargs='+', metavar='WALK')
    parser.add_argument('--every', type=int, default=3)
    parser.add_argument('--updates', default='dusk,winter')
    parser.add_argument('--rounds', type=int, default=10)
    parser.add_argument('--asked', default='night')
    arguments = parser.parse_args()
    print('| walk | map of | found | median error, cm | inliers | images | codes |\n|---|---|---|---|---|---|---|')
    for walk in arguments.walks:
        with tempfile.TemporaryDirectory() as work, contextlib.redirect_stderr(io.StringIO()):
            folder, learned = os.path.join(work, 'MAP'), 'noon'
            make_map(walk / 'map', arguments.every, folder)
            tell(walk, learned, arguments.asked, folder)
            for n in range(arguments.rounds):
                for light in arguments.updates.split(','):
                    update_map(folder, str(walk / light / 'images'), read_light(walk / light)[0])
                    if n == 0:
                        learned += ', ' + light
                        tell(walk, learned, arguments.asked, folder)
            tell(walk, f'noon, {arguments.rounds} times the others', arguments.asked, folder)


if __name__ == '__main__':
    main()
