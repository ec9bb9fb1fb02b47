#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0

"""Writes a list of pairs of images with cameras and poses as views that iib_evaluation reads: pair_list.py LIST IMAGES OUT

LIST has the form of SuperGlue's `scannet_test_pairs_with_gt.txt` (README.md), with paths below IMAGES. OUT gets a place for each pair, `list NAME:
NUMBER`, where its images are upright and in grey. The distance of the cameras becomes 1, since it counts for nothing.
"""
import pathlib
import sys

import cv2
import numpy as np

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / 'synthetic'))
from scenes import quaternion  # noqa: E402

QUARTER = np.array([[0, 1, 0], [-1, 0, 0], [0, 0, 1]])  # from a camera's axes to those after its image is rotated counter-clockwise


def parsed(line):
    """Names, numbers of quarter turns, camera matrices and 4 x 4 pose of a pair; None for any other line."""
    words = line.split()
    try:
        turns, numbers = [int(word) for word in words[2:4]], np.array(words[4:], float)
        cameras, pose = numbers[:18].reshape(2, 3, 3), numbers[18:].reshape(4, 4)
    except ValueError:
        return None
    R = pose[:3, :3]
    right = [K[0, 0] > 0 and K[1, 1] > 0 and (K[[0, 1, 2, 2, 2], [1, 0, 0, 1, 2]] == (0, 0, 0, 0, 1)).all() for K in cameras]  # no skew
    right += [set(turns) <= {0, 1, 2, 3}, np.linalg.norm(R @ R.T - np.eye(3)) < 1e-2, np.linalg.det(R) > 0, pose[:3, 3].any(),
              (pose[3] == (0, 0, 0, 1)).all(), ',' not in words[0] + words[1]]
    return (words[:2], turns, cameras, pose) if all(right) else None


def upright(image, K, quarters):
    """An image rotated counter-clockwise, its camera's matrix, and the rotation of the camera's axes."""
    turned = np.eye(3)
    for _ in range(quarters):
        K = np.array([[K[1, 1], 0, K[1, 2]], [0, K[0, 0], image.shape[1] - 1 - K[0, 2]], [0, 0, 1]])
        image, turned = cv2.rotate(image, cv2.ROTATE_90_COUNTERCLOCKWISE), QUARTER @ turned
    return image, K, turned


def write_view(folder, image, K, R, t):
    """A folder with one view; R and t from the world to the camera."""
    (folder / 'images').mkdir(parents=True, exist_ok=True)
    cv2.imwrite(str(folder / 'images/a.png'), image)
    numbers = image.shape[1], image.shape[0], K[0, 0], K[1, 1], K[0, 2] + .5, K[1, 2] + .5
    (folder / 'cameras.txt').write_text('1 PINHOLE %d %d %.12g %.12g %.12g %.12g\n' % numbers)
    (folder / 'poses.txt').write_text('a' + ' %.12g' * 7 % (*(-R.T @ t), *quaternion(R.T)) + '\n')


def write_pair(pair, images, place):
    """The first image as a map, the second in a folder that has the name of the first one's, so that intervals are over these."""
    names, turns, cameras, pose = pair
    found = [cv2.imread(str(images / name), cv2.IMREAD_GRAYSCALE) for name in names]
    if any(image is None for image in found):
        return print('skipped: %s or %s is not a readable image' % tuple(names), file=sys.stderr)
    (first, K1, turned1), (second, K2, turned2) = map(upright, found, cameras, turns)
    write_view(place / 'map', first, K1, np.eye(3), np.zeros(3))
    write_view(place / ('of ' + str(pathlib.Path(names[0]).parent).replace('/', ' ')), second, K2, turned2 @ pose[:3, :3] @ turned1.T,
               turned2 @ pose[:3, 3] / np.linalg.norm(pose[:3, 3]))


def main():
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    file, images, out = map(pathlib.Path, sys.argv[1:])
    for number, line in enumerate(file.read_text().splitlines(), 1):
        pair = parsed(line) or sys.exit('%s, line %d: not two images, their turns, cameras and pose, 38 words' % (file, number))
        write_pair(pair, images, out / ('list %s: %d' % (file.name, number)))


if __name__ == '__main__':
    main()
