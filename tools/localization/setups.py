#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0

"""Mean errors of `opencv-iib localize` under each light, with the paper's points, lines and an IMU: setups.py OUT.csv STREET

STREET: output of tools/synthetic/localization.py. Dependencies: those of measure.py.
"""
import collections
import csv
import pathlib
import sys
import tempfile

import cv2
import numpy as np

import measure
from opencv_iib.localization import build

SETUPS = ('', '--lines', '--orb-and-akaze', '--orb-and-akaze --lines')


def error(found, truth):
    """Errors to the right, ahead and down in the camera's axes, centimetres, and of rotation, degrees."""
    right, down, ahead = 100 * np.abs((truth @ np.linalg.inv(found))[:3, 3])
    return right, ahead, down, np.degrees(np.linalg.norm(cv2.Rodrigues(truth[:3, :3] @ found[:3, :3].T)[0]))


def write(out, counts, errors):
    with open(out, 'w', encoding='utf-8', newline='') as file:
        table = csv.writer(file, lineterminator='\n')
        table.writerow(['map', 'setup', 'light', 'images', 'found', 'within_5', 'lateral', 'longitudinal', 'altitude', 'orientation'])
        for key, count in counts.items():
            found = np.array(errors[key]).reshape(-1, 4)
            near = (np.linalg.norm(found[:, :3], axis=1) <= 5) & (found[:, 3] <= .5)
            means = found.mean(axis=0) if len(found) else [0] * 4
            table.writerow([*key, count, len(found), near.sum(), *('%.3f' % value for value in means)])


def main():
    out, street = map(pathlib.Path, sys.argv[1:])
    counts, errors = collections.Counter(), collections.defaultdict(list)
    for name, step in (('1.4 m apart', 1), ('5.6 m apart', 4)):
        with tempfile.TemporaryDirectory() as work:
            work = pathlib.Path(work)
            measure.write_model(work / 'model', *measure.read_place(street / 'map', step))
            for setup in SETUPS:
                build(str(work / 'model'), str(street / 'map/images'), str(work / f'map{setup}'), lines='--lines' in setup,
                      orb_and_akaze='--orb-and-akaze' in setup)
            for images in sorted((path.parent for path in street.glob('*/images') if path.parent.name != 'map'), key=lambda path: path.name != 'night'):
                readings = images / 'imu.csv'
                for setup in SETUPS + (('--orb-and-akaze --lines --imu',) if readings.exists() else ()):
                    options = ['--lines'] * ('--lines' in setup) + (['--imu', readings] if '--imu' in setup else [])
                    truth, known = measure.read_place(images)[1], work / f'map{setup.replace(" --imu", "")}'
                    with tempfile.TemporaryDirectory() as alone:
                        found = measure.run_command(known, images, pathlib.Path(alone), options)
                    counts[name, setup, images.name] += len(truth)
                    errors[name, setup, images.name] += [error(pose, truth[image]) for image, pose in found.items()]
                write(out, counts, errors)


if __name__ == '__main__':
    main()
