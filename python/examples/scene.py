"""Views of a drawn scene with known poses, for examples that run without images."""
import sys
from pathlib import Path

import cv2
import numpy as np


def read(path):
    """An image, BGR."""
    image = cv2.imread(str(path))
    if image is None:
        sys.exit(f'{path} is no image that can be read')
    return image


FOCAL = 400.
FOLDER = Path(__file__).parents[2] / 'tools/synthetic'
PICTURES = {light: read(FOLDER / f'{light}.png') for light in ('day', 'night')}


def camera(picture):
    """Camera matrix with whole coordinates at pixel centres."""
    return np.array([[FOCAL, 0, picture.shape[1] / 2 - .5], [0, FOCAL, picture.shape[0] / 2 - .5], [0, 0, 1]])


def view(light, centre, turn=0.):
    """The rendered street on two walls, 4 and 6 m away, by day or by night.

    :param centre: of the camera, x and y in metres; turn: to the right, in degrees.
    """
    picture, rotation = PICTURES[light], cv2.Rodrigues(np.array([0, -np.radians(turn), 0]))[0]
    height, width = picture.shape[:2]
    matrix, seen = camera(picture), np.zeros_like(picture)
    for depth, part in ((6, slice(width // 2, None)), (4, slice(0, width // 2))):
        wall, mask = np.zeros_like(picture), np.zeros((height, width), np.uint8)
        wall[:, part], mask[:, part] = picture[:, part], 255
        plane = np.eye(3)
        plane[:2, 2] = -np.array(centre) / depth
        moved = matrix @ rotation @ plane @ np.linalg.inv(matrix)
        inside = cv2.warpPerspective(mask, moved, (width, height)) > 0
        seen[inside] = cv2.warpPerspective(wall, moved, (width, height))[inside]
    return seen
