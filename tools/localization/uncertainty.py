#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0

"""Compares errors of Localizer with the reported covariances: uncertainty.py OUT.csv FOLDER...

Dependencies: those of measure.py. Reads places in measure.py's layout below the folders. Places beside a folder `map` are localized in it.
Other places are localized in maps of their own images: without the image itself, without every other image and without every third. OUT.csv
receives two rows per image, as iib_evaluation's uncertainty: errors of the centre, in the poses' unit, and of the rotation, radians; a count
of 0 if there is no pose.
"""
import csv
import math
import pathlib
import sys
import tempfile

import cv2
import numpy as np

import measure
import opencv_iib
from opencv_iib.localization import Localizer, build

LEVELS = .1, .25, .5, .75, .9, .95, .99  # of confidence


def searches(place):
    """Name of a map, its folder and image names, and the names of the images to localize."""
    own, beside = list(measure.read_place(place)[1]), place.parent / 'map'
    if (beside / 'poses.txt').exists():
        if place != beside:
            yield 'map', beside, list(measure.read_place(beside)[1]), own
        return
    for step in (2, 3, len(own)):
        for part in range(step):
            yield '%s without %d of %d' % (place.name, part + 1, step), place, [n for i, n in enumerate(own) if i % step != part], own[part::step]


def judged(error, covariance):
    """1, whether an error is within the limit of each level, and the logarithms of the reported standard deviation and of the density."""
    squared, limit = error @ np.linalg.solve(covariance, error), opencv_iib.confidenceLimit
    deviation, twice = np.linalg.slogdet(covariance)[1] / 6, limit(.5, 2)  # the scale matrix, in parts of the covariance
    score = math.lgamma(2.5) - 1.5 * math.log(math.pi * twice) - 3 * deviation - 2.5 * math.log1p(squared / twice)
    return [1, *(int(squared < limit(level, 3)) for level in LEVELS), deviation, score]


def errors(location, truth):
    """Errors of centre and rotation, in the world's axes, each with its covariance; nothing without a location."""
    if location.cam_from_world is None:
        return {}
    found, true = np.linalg.inv(location.cam_from_world), np.linalg.inv(truth)
    return {'centre': (found[:3, 3] - true[:3, 3], location.covariance[:3, :3]),
            'rotation': (cv2.Rodrigues(found[:3, :3] @ true[:3, :3].T)[0].ravel(), location.covariance[3:, 3:])}


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    out, *folders = map(pathlib.Path, sys.argv[1:])
    opencv_iib.setNumThreads(1)
    with open(out, 'w', encoding='utf-8', newline='') as file:
        table = csv.writer(file, lineterminator='\n')
        table.writerow(['set', 'map', 'light', 'query', 'quantity', 'count', *LEVELS, 'log_deviation', 'score'])
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
                    found = errors(location, poses[image])
                    for what in ('centre', 'rotation'):
                        numbers = judged(*found[what]) if found else [0] * (len(LEVELS) + 3)
                        table.writerow([place.parent.name, name, place.name if name == 'map' else 'same', image, what + ' of Localizer', *numbers])
                file.flush()


if __name__ == '__main__':
    main()
