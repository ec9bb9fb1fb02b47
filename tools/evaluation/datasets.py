# SPDX-License-Identifier: Apache-2.0

"""The data sets of README.md, and experiments on them: their rows, by several processes."""
import concurrent.futures
import csv
import itertools
import multiprocessing
import os
import pathlib
import re
import sys
from typing import Any, NamedTuple

import cv2
import numpy as np
import opencv_iib
from opencv_iib import _core
from opencv_iib.localization import Camera

NO_LIGHT = {'bark', 'boat', 'graf', 'wall', 'bikes', 'trees', 'ubc'}  # Oxford's sequences of other changes
NEIGHBOURS, LEAST_BASELINE = 3, .5  # pairs an image in its own folder; metres, so that the direction of the translation is determined


class Random:
    """cv::RNG."""

    def __init__(self, seed):
        self.state = seed

    def next(self):
        self.state = (self.state & 0xffffffff) * 4164903690 + (self.state >> 32)
        return self.state & 0xffffffff

    def integer(self, below):
        return self.next() % below

    def real(self, low, high):
        return ((self.next() << 32) | self.next()) * 2. ** -64 * (high - low) + low


def noise(shape, sigma, seed, kind=np.float32):
    """Normal noise, the same as by cv::RNG(seed)."""
    cv2.setRNGSeed(seed)
    return cv2.randn(np.empty(shape, kind), 0, sigma)


def read_image(file):
    image = cv2.imread(str(file), cv2.IMREAD_GRAYSCALE)
    if image is None:
        raise RuntimeError('%s: not a readable image' % file)
    return image


def pose_of(numbers):
    """Camera from world, 4 x 4, by a centre and a quaternion x y z w from the camera to the world."""
    numbers = np.array(numbers, float)
    sine = np.linalg.norm(numbers[3:6])
    turn = cv2.Rodrigues(numbers[3:6] * (2 * np.arctan2(sine, numbers[6]) / sine if sine else 2))[0].T
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = turn, -turn @ numbers[:3]
    return pose


def read_place(folder, step=1):
    """The camera, and 4 x 4 poses (camera from world) of every step-th existing image, by file name."""
    lines = [line.split() for line in (folder / 'cameras.txt').read_text().splitlines() if not line.startswith('#')]
    if len(lines) != 1:
        raise RuntimeError('%s/cameras.txt: needs exactly one camera' % folder)
    poses = {}
    for number, line in enumerate((folder / 'poses.txt').read_text().splitlines(), 1):
        if line.strip() and not line.startswith('#'):
            stem, *numbers = line.split()
            if len(numbers) != 7 or abs(np.linalg.norm(np.array(numbers[3:], float)) - 1) > 1e-2:
                raise RuntimeError('%s/poses.txt, line %d: not a name, a place and a quaternion' % (folder, number))
            poses.update((path.name, pose_of(numbers)) for path in (folder / 'images').glob(stem + '.*'))
    return Camera.parse(','.join(lines[0][1:])), dict(sorted(poses.items())[::step])


def write_model(folder, camera, poses):
    """Writes a COLMAP model without points."""
    folder.mkdir(parents=True, exist_ok=True)
    _core.writeModel(folder, [_core.PosedImage(name, camera, pose, np.empty((0, 2))) for name, pose in poses.items()])


class ViewPair(NamedTuple):
    """Two images from known places."""

    set: str  # the folder above the views'
    sequence: str  # the second image's folder
    target: str  # the images' names, joined by a hyphen
    files: Any
    cameras: Any  # 3 x 3 matrices
    R: Any  # from the first camera's axes to the second's
    t: Any
    same_light: bool


class ImagePair(NamedTuple):
    """Two images of a sequence."""

    set: str
    sequence: str
    target: str
    files: Any
    H: Any  # from the first image's pixels to the second's
    light: bool  # whether the light alone changes

    @property
    def name(self):
        return '%s/%s/%s' % self[:3]


def below(folder, ends, depth=4):
    """A folder and those up to four levels below it, in the order of paths, but none below one that `ends` the search."""
    yield folder
    if depth and not ends(folder):
        for path in sorted(folder.iterdir()):
            if path.is_dir():
                yield from below(path, ends, depth - 1)


def holds_views(folder):
    return all((folder / name).exists() for name in ('cameras.txt', 'poses.txt', 'images'))


def view_folders(roots):
    """Folders of views by the folder above."""
    places = {}
    for folder in itertools.chain(*(below(pathlib.Path(root).resolve(), holds_views) for root in roots)):
        if holds_views(folder):
            places.setdefault(folder.parent, []).append(folder)
    return dict(sorted(places.items(), key=lambda item: str(item[0])))


def view_pairs(roots):
    """Each image with the next three of its folder; beside a folder `map`, with the nearest image there, at least half a metre away."""
    pairs = []
    for place, folders in view_folders(roots).items():
        views = {folder: read_place(folder) for folder in folders}

        def add(one, a, other, b):
            (camera1, poses1), (camera2, poses2) = views[one], views[other]
            relative = poses2[b] @ np.linalg.inv(poses1[a])
            pairs.append(ViewPair(place.name, other.name, '%s-%s' % (pathlib.Path(a).stem, pathlib.Path(b).stem), (one / 'images' / a, other / 'images' / b),
                                  (camera1.matrix, camera2.matrix), relative[:3, :3], relative[:3, 3], one == other))
        mapped = place / 'map'
        for folder, (_, poses) in views.items():
            if mapped not in views or len(views) == 1:
                for i, name in enumerate(poses):
                    for other in list(poses)[i + 1:i + 1 + NEIGHBOURS]:
                        add(folder, name, folder, other)
            elif folder != mapped:
                for name, pose in poses.items():
                    far = {other: np.linalg.norm(np.linalg.inv(each)[:3, 3] - np.linalg.inv(pose)[:3, 3]) for other, each in views[mapped][1].items()}
                    near = [other for other, distance in far.items() if distance >= LEAST_BASELINE]
                    if near:
                        add(mapped, min(near, key=far.get), folder, name)
    return pairs


def sequence_of(folder):
    """The images of a sequence by number, and the pattern of its homographies' names; nothing without the first image."""
    for prefix, name in (('', 'H_1_%d'), ('img', 'H1to%dp')):
        found = ((re.fullmatch(prefix + r'(\d{1,6})\.(?:png|ppm|pgm|jpe?g|tiff?)', path.name), path) for path in folder.iterdir())
        images = {int(match[1]): path for match, path in sorted(found, key=lambda item: str(item[1])) if match}
        if 1 in images:
            return images, name
    return {}, ''


def image_pairs(roots):
    """Pairs of the first image of a sequence with each other one."""
    pairs = []
    for folder in itertools.chain(*(below(pathlib.Path(root).resolve(), lambda folder: holds_views(folder) or sequence_of(folder)[0]) for root in roots)):
        images, name = sequence_of(folder)
        still = not list(folder.glob(name.split('%d')[0] + '*')) if images else True
        for k in sorted(images)[1:] if not holds_views(folder) else ():
            try:
                H = np.eye(3) if still else np.loadtxt(folder / (name % k)).reshape(3, 3)
            except (OSError, ValueError) as error:
                print('skipped: %s: %s' % (folder / (name % k), error), file=sys.stderr)
                continue
            pairs.append(ImagePair(folder.parent.name, folder.name, str(k), (images[1], images[k]), H, not (folder.name in NO_LIGHT or folder.name.startswith('v_'))))
    return pairs


def _alone():
    cv2.setNumThreads(1)
    opencv_iib.setNumThreads(1)


def write(file, head, rows):
    """Writes rows of texts and numbers, sorted; numbers have six digits at most."""
    texts = sorted([value if isinstance(value, str) else '%.6g' % value for value in row] for row in rows)
    with open(file, 'w', encoding='utf-8', newline='') as opened:
        csv.writer(opened, lineterminator='\n').writerows([head, *texts])


def rows_of(tasks):
    """The lists of rows that tasks (a function and its arguments) return, joined. A task that fails is reported and left out."""
    rows = []
    with concurrent.futures.ProcessPoolExecutor(os.cpu_count(), multiprocessing.get_context('spawn'), _alone) as pool:
        for done, future in enumerate([pool.submit(*task) for task in tasks], 1):
            try:
                rows += future.result()
            except (RuntimeError, ValueError, cv2.error, opencv_iib.error) as error:
                print('skipped: %s' % error, file=sys.stderr)
            if done * 10 // len(tasks) > (done - 1) * 10 // len(tasks):  # every tenth
                print('%s: %d/%d' % (tasks[done - 1][0].__name__, done, len(tasks)), file=sys.stderr)
    return rows
