# SPDX-License-Identifier: Apache-2.0

"""The experiment `alignment` of README.md."""
import math

import cv2
import numpy as np
import opencv_iib
from datasets import Random, image_pairs, read_image, rows_of, write

OTHER_SCENES, WITH_LOGO = 520, 36  # pairs of images of different sets; of these, pairs that also get a common part
LOGO = 100  # side of the common part, pixels
MOST_MOVED = .06  # of a corner, as a share of the image's size
NOISE, SHIFT = 8, (17, -9)  # grey levels; pixels between noisy images
MODELS = TRANSLATION, SIMILARITY, AFFINE, HOMOGRAPHY = 'TRANSLATION', 'SIMILARITY', 'AFFINE', 'HOMOGRAPHY'


def corners(image):
    right, bottom = image.shape[1] - 1, image.shape[0] - 1
    return np.array([[0, 0], [right, 0], [right, bottom], [0, bottom]], float)


def random_transform(random, image, model=HOMOGRAPHY):
    """A transform of a model that moves corners by MOST_MOVED at most."""
    start = corners(image)
    end = np.float32(start + [[random.real(-MOST_MOVED, MOST_MOVED) * image.shape[1 - axis] for axis in (0, 1)] for _ in start])
    if model == HOMOGRAPHY:
        return cv2.getPerspectiveTransform(np.float32(start), end)
    moved = np.eye(3)
    moved[:2, 2] = end[0]
    if model == AFFINE:
        moved[:2] = cv2.getAffineTransform(np.float32(start[:3]), end[:3])
    elif model == SIMILARITY:  # by two corners
        ratio = complex(*(end[2] - end[0])) / complex(*start[2])
        moved[:2, :2] = [[ratio.real, -ratio.imag], [ratio.imag, ratio.real]]
    return moved


def mapped(points, transform):
    return cv2.perspectiveTransform(points[None], transform)[0]


def aligned(key, reference, image, truth=None):
    """A row for each model: mean error of the image's corners, pixels, and mean of (error / estimated deviation)^2; none without a truth."""
    rows = []
    for model in MODELS:
        found = opencv_iib.alignImages(reference, image, opencv_iib.AlignmentModel[model])
        errors = ('', '') if truth is None else (math.inf, '')
        if found.found and truth is not None:
            error = np.linalg.norm(mapped(corners(image), found.transform) - mapped(corners(image), truth), axis=1)
            errors = error.mean(), ((error / found.error.ravel()) ** 2).mean()
        rows.append([*key, model, int(found.found), len(found.matches), *errors])
    return rows


def align_moved(pair, model, seed):
    """A pair whose second image is moved by a transform."""
    reference, target = map(read_image, pair.files)
    transform = random_transform(Random(seed), target, model)
    image = cv2.warpPerspective(target, transform, target.shape[::-1], flags=cv2.INTER_CUBIC, borderMode=cv2.BORDER_REFLECT)
    return aligned((*pair[:3], 'moved by a ' + model), reference, image, np.linalg.inv(transform @ pair.H))


def align_noisy(pair, seed):
    """Two parts of one image, SHIFT apart, each with its own noise."""
    whole, (x, y) = read_image(pair.files[0]), np.abs(SHIFT)
    height, width = whole.shape[0] - 2 * y, whole.shape[1] - 2 * x
    cv2.setRNGSeed(seed)
    parts = (whole[y + v:y + v + height, x + u:x + u + width] for u, v in ((0, 0), SHIFT))
    images = [cv2.add(part, cv2.randn(np.empty(part.shape, np.int16), 0, NOISE), dtype=cv2.CV_8U) for part in parts]
    return aligned((*pair[:3], 'with noise'), *images, np.array([[1., 0, SHIFT[0]], [0, 1, SHIFT[1]], [0, 0, 1]]))


def align_others(pair, other, third=None):
    """Images of different scenes; with a part of a third image in both upper left corners."""
    images = read_image(pair.files[0]), read_image(other.files[1])
    if third:
        logo = read_image(third.files[0])
        y, x = ((n - LOGO) // 2 for n in logo.shape)
        for image in images:
            image[20:20 + LOGO, 20:20 + LOGO] = logo[y:y + LOGO, x:x + LOGO]
    return aligned((*pair[:3], 'logo ' * bool(third) + other.name), *images)


def alignment(options):
    """alignImages with each model."""
    pairs = [pair for pair in image_pairs(options.data) if pair.light]
    tasks = []
    for seed, pair in enumerate(pairs, 1):
        tasks += [(align_moved, pair, model, seed) for model in MODELS if model == HOMOGRAPHY or (pair.H == np.eye(3)).all()]
        tasks.append((align_noisy, pair, seed))
    random, others = Random(1), set()
    for drawn in range(10 * OTHER_SCENES if pairs else 0):
        one, two = random.integer(len(pairs)), random.integer(len(pairs))
        pair, other = pairs[one], pairs[two]
        if len(others) < OTHER_SCENES and pair.set != other.set and (one, two) not in others:  # two sequences of a set may be of one camera
            others.add((one, two))
            tasks.append((align_others, pair, other))
            if len(others) <= WITH_LOGO:
                tasks.append((align_others, pair, other, pairs[drawn % len(pairs)]))
    write(options.out / 'alignment.csv', ['set', 'sequence', 'target', 'image', 'model', 'found', 'matches', 'error', 'squares'], rows_of(tasks))
