#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0

"""Whether Localizer is as right as it says: uncertainty.py OUT.csv FOLDER...

Needs what measure.py needs. Places as measure.py has them are looked for below the folders: those beside one called `map` in it; others in maps
of their own images, each left out alone, with every other one and with every third. OUT.csv gets a row an image: the error, in the unit of
the poses and in degrees, and the squared error in standard deviations, of the centre and of the rotation: inside the estimated 95 % below
7.815 (chi-square; 2.366 for 50 %, 11.345 for 99 %). Where nothing was found these are empty.
"""
import csv
import pathlib
import sys
import tempfile

import cv2
import numpy as np

import measure
import opencv_iib
from opencv_iib.localization import Localizer, build


def searches(place):
    """Name of a map, its folder and image names, and the names of the images of the place that are looked for."""
    own, beside = list(measure.read_place(place)[1]), place.parent / 'map'
    if (beside / 'poses.txt').exists():
        if place != beside:
            yield 'map', beside, list(measure.read_place(beside)[1]), own
        return
    for step in (2, 3, len(own)):
        for part in range(step):
            yield '%s without %d of %d' % (place.name, part + 1, step), place, [n for i, n in enumerate(own) if i % step != part], own[part::step]


def judged(location, truth):
    """Errors and squared errors of the centre and of the rotation, in the world's axes."""
    found, true = np.linalg.inv(location.cam_from_world), np.linalg.inv(truth)
    centre, turn = found[:3, 3] - true[:3, 3], cv2.Rodrigues(found[:3, :3] @ true[:3, :3].T)[0].ravel()
    return [np.linalg.norm(centre), np.degrees(np.linalg.norm(turn)), *(
        error @ np.linalg.solve(location.covariance[part, part], error) for error, part in ((centre, slice(0, 3)), (turn, slice(3, 6))))]


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    out, *folders = map(pathlib.Path, sys.argv[1:])
    opencv_iib.setNumThreads(1)
    with open(out, 'w', encoding='utf-8', newline='') as file:
        table = csv.writer(file, lineterminator='\n')
        table.writerow(['set', 'map', 'light', 'query', 'inliers', 'centre', 'rotation', 'squared_centre', 'squared_rotation'])
        for place in sorted(path.parent for folder in folders for path in folder.rglob('poses.txt')):
            camera, poses = measure.read_place(place)
            for name, mapped, images, sought in searches(place):
                if len(images) < 2:
                    continue
                with tempfile.TemporaryDirectory() as work:
                    work, known = pathlib.Path(work), measure.read_place(mapped)
                    measure.write_model(work / 'model', known[0], {image: known[1][image] for image in images})
                    build(str(work / 'model'), str(mapped / 'images'), str(work / 'map'), measure.POINTS)
                    localizer = Localizer(work / 'map', measure.POINTS)
                for image in sought:
                    location = localizer.localize(cv2.imread(str(place / 'images' / image), cv2.IMREAD_GRAYSCALE), camera)
                    errors = [''] * 4 if location.cam_from_world is None else ['%.4g' % value for value in judged(location, poses[image])]
                    table.writerow([place.parent.name, name, place.name if name == 'map' else 'same', image, location.inliers, *errors])
                file.flush()


if __name__ == '__main__':
    main()
