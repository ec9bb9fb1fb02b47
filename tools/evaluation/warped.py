# SPDX-License-Identifier: Apache-2.0

"""The experiment `views` of README.md."""
import functools
import math
import time

import cv2
import numpy as np
from datasets import Random, image_pairs, noise, read_image, read_place, rows_of, view_folders, write
from methods import WAYS

WIDTH = 640  # pixels of the longer side, at most
UNRELATED = 500  # pairs of images of different sets
SLOW, SLOW_EVERY = 'AffineFeature', 6  # matches one photograph in so many
LONGITUDE = 20  # degrees: the axis that a tilt shortens
GAMMA, NOISE = 1.8, 4  # of the second image's light; grey levels
# Kind, amount, scale, degrees and tilt of a change that makes the second image from the first, and whether the slow method matches it.
WARPS = [('zoom and rotation', '0.5 and 45', .5, 45, 1, True), ('tilt and rotation', '2 and 60', 1, 60, 2, True),
         *(('zoom', '%g' % zoom, zoom, 0, 1, zoom in (.25, .5, 1, 2)) for zoom in (.25, .35, .5, .66, .8, 1, 1.25, 1.5, 2)),
         *(('rotation', '%g' % degrees, 1, degrees, 1, degrees in (45, 180)) for degrees in (10, 18, 30, 45, 60, 90, 120, 150, 180)),
         *(('tilt', '%g' % tilt, 1, 0, tilt, tilt in (2, 4)) for tilt in (1.5, 2, 2.5, 3, 4))]


def rotation(degrees):
    c, s = math.cos(degrees * math.pi / 180), math.sin(degrees * math.pi / 180)
    return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])


def product(a, b):
    """The same on every machine: rounding decides whether a corner at 0 needs a further pixel."""
    return np.array([[sum(a[i, k] * b[k, j] for k in range(3)) for j in range(3)] for i in range(3)])


def translation(x, y):
    return np.array([[1, 0, x], [0, 1, y], [0, 0, 1.]])


def warped(image, scale, degrees, tilt, seed):
    """Shortens an axis by the tilt, scales, rotates, darkens and adds noise; all of the image, or the middle of the same size if it is enlarged.
    Supersamples, since a sensor averages over the area of a pixel. Returns the image, and the map from the first one's pixels."""
    height, width = image.shape
    shape = functools.reduce(product, (rotation(degrees), rotation(LONGITUDE), np.diag([scale / tilt, scale, 1]), rotation(-LONGITUDE)))
    ends = cv2.perspectiveTransform(np.array([[[0, 0], [width - 1, 0], [0, height - 1], [width - 1, height - 1]]], float), shape)
    x, y, *whole = cv2.boundingRect(np.float32(ends[0]))
    canvas = (width, height) if scale > 1 else tuple(whole)
    truth = product(translation(-(x + (whole[0] - canvas[0]) // 2), -(y + (whole[1] - canvas[1]) // 2)), shape)
    finer = max(2, int(np.ceil(2 * tilt / scale)))
    larger = np.array([[finer, 0, (finer - 1) / 2], [0, finer, (finer - 1) / 2], [0, 0, 1]])
    fine = cv2.warpPerspective(image, product(larger, truth), (canvas[0] * finer, canvas[1] * finer), borderValue=128)
    result = cv2.resize(fine, canvas, interpolation=cv2.INTER_AREA)
    dark = cv2.pow(result * np.float32(1 / 255), GAMMA)
    return cv2.add(dark * np.float32(255) + noise(dark.shape, NOISE, seed), 0, dtype=cv2.CV_8U), truth


def read_reduced(file):
    image = read_image(file)
    scale = WIDTH / max(image.shape)
    return cv2.resize(image, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA) if scale < 1 else image


def measured(key, images, truth, ways, points, tolerance):
    """A row for each way to match: whether the matches are significant, right ones, all, and milliseconds of processor time."""
    rows = []
    for name in ways:
        start = time.thread_time()
        found, (first, second) = WAYS[name](images, points)
        taken = 1e3 * (time.thread_time() - start)
        right = truth is not None and len(first) and (np.linalg.norm(cv2.perspectiveTransform(first[None], truth)[0] - second, axis=1) < tolerance).sum()
        rows.append([*key, name, int(found), int(right), len(first), taken])
    return rows


def photograph(key, file, warp, seed, slow, points, tolerance):
    """Rows of a photograph and the same warped."""
    image = read_reduced(file)
    other, truth = warped(image, *warp[2:5], seed)
    return measured((*key, *warp[:2]), (image, other), truth, [name for name in WAYS if name != SLOW or slow], points, tolerance)


def unrelated(one, other, points, tolerance):
    """Rows of images of different sets; no match is right."""
    return measured((one.set, '%s/%s and %s' % (one.sequence, one.target, other.name), 'unrelated', ''), (read_reduced(one.files[0]), read_reduced(other.files[1])),
                    None, ('matchViews', 'SIFT'), points, tolerance)


def views(options):
    """Photographs and the same zoomed, rotated and tilted."""
    pairs, limits = image_pairs(options.data), (options.points, options.tolerance)
    found = dict.fromkeys((pair.set, pair.sequence, pair.files[0]) for pair in pairs)
    for place, folders in view_folders(options.data).items():
        names = {folder: list(read_place(folder)[1]) for folder in folders}
        found.update(dict.fromkeys((place.name, folder.name, folder / 'images' / images[0]) for folder, images in names.items() if images))
    tasks = [(photograph, (set_, sequence), file, warp, i + 1, warp[5] and i % SLOW_EVERY == 0, *limits)
             for i, (set_, sequence, file) in enumerate(found) for warp in WARPS]
    random, drawn = Random(1), set()
    for _ in range(10 * UNRELATED if pairs else 0):
        one, other = random.integer(len(pairs)), random.integer(len(pairs))
        if len(drawn) < UNRELATED and pairs[one].set != pairs[other].set and (one, other) not in drawn:
            drawn.add((one, other))
            tasks.append((unrelated, pairs[one], pairs[other], *limits))
    write(options.out / 'views.csv', ['set', 'sequence', 'kind', 'amount', 'method', 'found', 'right', 'matches', 'milliseconds'], rows_of(tasks))
