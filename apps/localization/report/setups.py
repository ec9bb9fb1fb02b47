#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0

"""Mean errors of iib_localize in each light, with the paper's points, with lines and with an IMU: setups.py IIB_LOCALIZE OUT.csv STREET VIEWS

STREET: what tools/synthetic/localization.py rendered; VIEWS: what views.py rendered, other places, whose images count together.
"""
import collections
import csv
import pathlib
import subprocess
import sys
import tempfile

import cv2
import numpy as np

SETUPS = ('', '--lines', '--orb-and-akaze', '--orb-and-akaze --lines')


def read_poses(path):
    """By file stem: the camera's centre, and the rotation to the world."""
    poses = {}
    for line in path.read_text().splitlines():
        name, *numbers = line.split()
        if name != '#':
            numbers = np.array(numbers, float)
            sine = np.linalg.norm(numbers[3:6])
            vector = numbers[3:6] * (2 * np.arctan2(sine, numbers[6]) / sine if sine else 2)
            poses[name] = numbers[:3], cv2.Rodrigues(vector)[0]
    return poses


def write_model(folder, place, step):
    """A COLMAP model without points, of every step-th image."""
    folder.mkdir()
    (folder / 'cameras.txt').write_text((place / 'cameras.txt').read_text())
    lines, poses = ['#'], read_poses(place / 'poses.txt')
    for number, path in enumerate(sorted((place / 'images').iterdir())[::step]):
        centre, turn = poses[path.stem]
        vector = cv2.Rodrigues(turn.T)[0].ravel()
        half = np.linalg.norm(vector) / 2
        numbers = [np.cos(half), *(vector * np.sinc(half / np.pi) / 2), *-turn.T @ centre]
        lines += ['%d %s 1 %s' % (number + 1, ' '.join('%.17g' % value for value in numbers), path.name), '']
    (folder / 'images.txt').write_text('\n'.join(lines) + '\n')


def error(found, truth):
    """Centimetres to the right, ahead and down as the camera looks, and degrees."""
    right, down, ahead = 100 * np.abs(truth[1].T @ (found[0] - truth[0]))
    return right, ahead, down, np.degrees(np.linalg.norm(cv2.Rodrigues(found[1].T @ truth[1])[0]))


def localize(program, model, place, images, options):
    """How many images there are, and the errors of those found."""
    truth = read_poses(images / 'poses.txt')
    with tempfile.TemporaryDirectory() as out:
        subprocess.run([program, '--model', model, '--photographs', place / 'map/images', '--images', images / 'images', '--out', out,
                        *options], check=False, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        found = read_poses(pathlib.Path(out, 'trajectory.txt'))
    return len(list((images / 'images').iterdir())), [error(pose, truth[stem]) for stem, pose in found.items()]


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
    program, out, street, views = map(pathlib.Path, sys.argv[1:])
    places = [('1.4 m apart', street, 1), *(('other places', place, 1) for place in sorted(views.iterdir())), ('5.6 m apart', street, 4)]
    counts, errors = collections.Counter(), collections.defaultdict(list)
    for name, place, step in places:
        with tempfile.TemporaryDirectory() as work:
            model = pathlib.Path(work, 'model')
            write_model(model, place / 'map', step)
            for images in sorted((path.parent for path in place.glob('*/images') if path.parent.name != 'map'), key=lambda path: path.name != 'night'):
                readings = images / 'imu.csv'
                for setup in SETUPS + (('--orb-and-akaze --lines --imu',) if readings.exists() else ()):
                    options = setup.replace('--imu', '--imu %s' % readings).split()
                    count, found = localize(program, model, place, images, options)
                    counts[name, setup, images.name] += count
                    errors[name, setup, images.name] += found
                write(out, counts, errors)


if __name__ == '__main__':
    main()
