"""A wall by day, its map, and images of it in the dark."""
import atexit
import functools
import os
import shutil
import tempfile
import unittest
from pathlib import Path

import numpy as np

from opencv_iib import _core
from opencv_iib.localization import Camera
from support import Commands, cv2, run_command, texture

SIZE = WIDTH, HEIGHT = 320, 240
CAMERA = f'PINHOLE,{WIDTH},{HEIGHT},300,300,160,120'
PLACES = [(-1.5, 0), (-1, .3), (-.5, 0), (0, .3), (.5, 0), (1, .3)]  #: x and y in front of a wall at z = 5


def wall(seed):
    """The wall's texture, 1200 x 900, a hundred pixels a metre."""
    return cv2.resize(texture(240, 180, seed=seed), (1200, 900), interpolation=cv2.INTER_CUBIC)


def rigid(turn, place):
    """Camera from world, 4 x 4, of a camera at a place."""
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = turn, -turn @ np.array(place)
    return pose


def pose(x, y):
    """Camera from world, turned towards the middle of the wall."""
    return rigid(cv2.Rodrigues(np.array([.05 * y, .1 * x, 0]))[0], [x, y, 0])


def photograph(picture, cam_from_world, lit=lambda grey: grey):
    camera = np.array([[300, 0, 159.5], [0, 300, 119.5], [0, 0, 1]])
    matrix = cam_from_world[:3]
    from_wall = camera @ (np.stack([matrix[:, 0], matrix[:, 1], 5 * matrix[:, 2] + matrix[:, 3]], axis=1))
    from_pixels = np.array([[.01, 0, -6], [0, .01, -4.5], [0, 0, 1]])  # to metres
    return lit(cv2.warpPerspective(picture, from_wall @ from_pixels, SIZE))


def evening(grey, noise=2):
    shade = np.linspace(10, 40, WIDTH) * (grey / 255) ** 1.5
    return np.clip(shade + np.random.default_rng(1).normal(5, noise, grey.shape), 0, 255).astype(np.uint8)


def write_model(folder, poses, camera=CAMERA):
    """Writes a COLMAP model without points. :param poses: by name."""
    os.makedirs(folder, exist_ok=True)
    _core.writeModel(folder, [_core.PosedImage(name, Camera.parse(camera), pose, np.empty((0, 2))) for name, pose in poses.items()])


def trajectory(folder, name='trajectory.txt'):
    """Poses by names without blanks: centre, quaternion x y z w."""
    lines = [line.split() for line in Path(folder, name).read_text().splitlines() if line[0] != '#']
    return {line[0]: np.array(line[1:], float) for line in lines}


NAMES = [*(f'left side/{i} of 6.png' for i in range(3)), '0.png', '1.png', '2.png']  #: places of the map's images
TRUTH = {'a/b': (-.8, .1), 'a-b': (-.2, .2), 'c': (.3, .1)}  #: places of the images in the dark


@functools.lru_cache(maxsize=None)
def mapped():
    """A folder with `images` of the wall, their `model`, its `map`, and other images in the `dark`."""
    folder = tempfile.mkdtemp()
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    images, model, picture = os.path.join(folder, 'images'), os.path.join(folder, 'model'), wall(3)
    for name in ('images/left side', 'dark/a'):
        os.makedirs(os.path.join(folder, name))
    for name, place in zip(NAMES, PLACES):
        cv2.imwrite(os.path.join(images, name), photograph(picture, pose(*place)))
    for name, place in TRUTH.items():
        cv2.imwrite(os.path.join(folder, 'dark', name + '.png'), photograph(picture, pose(*place), evening))
    write_model(model, {name: pose(*place) for name, place in zip(NAMES, PLACES)})
    status, _, errors = run_command('map', '--model', model, '--images', images, '--out', os.path.join(folder, 'map'), '--points', '400')
    assert status == 0, errors
    return folder


@unittest.skipIf(cv2 is None, 'no cv2')
class OnWall(Commands):
    """Base of tests that use the wall's map and the images in the dark."""

    @classmethod
    def setUpClass(cls):
        cls.folder, cls.truth = mapped(), TRUTH
        cls.images, cls.model, cls.map, cls.dark = (os.path.join(cls.folder, name) for name in ('images', 'model', 'map', 'dark'))
        cls.poses = {name: pose(*place) for name, place in zip(NAMES, PLACES)}

    def path(self, name):
        return os.path.join(tempfile.mkdtemp(dir=self.folder), name)

    def grey(self, name='c'):
        return cv2.imread(os.path.join(self.dark, name + '.png'), cv2.IMREAD_GRAYSCALE)

    def check(self, location, name='c'):
        self.assertEqual(location.reason, '')
        error = location.cam_from_world @ np.linalg.inv(pose(*self.truth[name]))
        self.assertLess(np.linalg.norm(error[:3, 3]), .05)
        self.assertLess(np.linalg.norm(error[:3, :3] - np.eye(3)), .02)

    def localize(self, out, *arguments, map=None, images=None):
        return run_command('localize', '--map', map or self.map, '--images', images or self.dark, '--out', out, *arguments)[::2]
