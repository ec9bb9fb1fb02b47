# SPDX-License-Identifier: Apache-2.0

"""The experiment `uncertainty` of README.md: errors beside their reported covariances."""
import math
import pathlib
import tempfile

import cv2
import numpy as np
import opencv_iib
from alignment import MOST_MOVED, corners, mapped
from datasets import Random, image_pairs, read_image, read_place, rows_of, view_folders, view_pairs, write, write_model
from opencv_iib.localization import Localizer, build

LEVELS = .1, .25, .5, .75, .9, .95, .99  # of confidence
STRANGERS = 3  # views of other places for each pair
BORDER = 20  # pixels along a rectified image's border without keypoints
FAR = 3  # pixels from the truth: a wrong match, which no deviation describes
MAPPED = 2000  # points of an image of a map
HEAD = ['quantity', 'count', *LEVELS, 'log_deviation', 'score']


def judged(quantity, errors, covariances):
    """The errors, N x D, within the limit of each level, and sums of logarithms: of the reported deviations (geometric means), and of the reported
    density, Student's t as of confidenceLimit, at the errors."""
    count, size = np.shape(errors)
    squared = np.einsum('ni,ni->n', errors, np.linalg.solve(covariances, np.expand_dims(errors, 2))[..., 0])
    deviations, twice = np.linalg.slogdet(covariances)[1] / (2 * size), opencv_iib.confidenceLimit(.5, 2)  # the scale matrix, in parts of the covariance
    scores = math.lgamma((size + 2) / 2) - size / 2 * math.log(math.pi * twice) - size * deviations - (size + 2) / 2 * np.log1p(squared / twice)
    return [quantity, count, *((squared < opencv_iib.confidenceLimit(level, size)).sum() for level in LEVELS), deviations.sum(), scores.sum()]


def nothing(quantity, count=0):
    """A row without an answer, or of an answer where none is right."""
    return [quantity, count, *[0] * (len(LEVELS) + 2)]


def full(covariances):
    """N x 2 x 2, of rows xx, xy, yy."""
    return np.asarray(covariances, float)[:, [[0, 1], [1, 2]]]


def matched(images, points, masks=(None, None)):
    """The recommended chain's keypoints, as rows, and pairs."""
    features = [opencv_iib.detect_and_describe(image, points, mask) for image, mask in zip(images, masks)]
    return [np.column_stack(each[:2]) for each in features], opencv_iib.match(features[0].codes, features[1].codes).pairs


def along_tangents(found, truth):
    """The error of a direction as angles about the axes of findRelativePose's documentation."""
    b = np.cross(found, np.eye(3)[np.abs(found).argmin()])
    b /= np.linalg.norm(b)
    along = np.array([b @ truth, np.cross(found, b) @ truth])
    sine = np.linalg.norm(along)
    angle = math.atan2(sine, found @ truth)
    return along * (angle / sine) if sine > 0 else np.array([angle, 0])  # opposite: any axis


def rectification(R, t):
    """Rotations of two cameras that do not look along their baseline, after which R = I and t is along the x axis, and that t."""
    way = -R.T @ t / np.linalg.norm(t)
    side = -1 if way[0] < 0 else 1
    x = side * way
    y = np.cross([0, 0, 1] + R.T[:, 2], x)
    y /= np.linalg.norm(y)
    turn = np.array([x, y, np.cross(x, y)])
    return turn, turn @ R.T, np.array([-side, 0., 0.])


def rectified(pair, images):
    """Both views as one camera would see them, rotated to look across the baseline, and masks."""
    K, (first, second, t) = pair.cameras[0], rectification(pair.R, pair.t)
    seen, masks, size = [], [], images[0].shape[::-1]
    for image, turn, camera in zip(images, (first, second), pair.cameras):
        view = K @ turn @ np.linalg.inv(camera)
        seen.append(cv2.warpPerspective(image, view, size, flags=cv2.INTER_CUBIC))
        mask = cv2.warpPerspective(np.full_like(image, 255), view, size)
        masks.append(cv2.erode(mask, None, iterations=BORDER, borderType=cv2.BORDER_CONSTANT, borderValue=0))
    return pair._replace(set=pair.set + ' rectified', cameras=(K, K), R=np.eye(3), t=t), seen, masks


def across_lines(pair, found):
    """Errors of refined points of the second image across the true epipolar lines, and their variances, without wrong matches."""
    inverse, (x, y, z) = [np.linalg.inv(K) for K in pair.cameras], pair.t
    F = inverse[1].T @ np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]]) @ pair.R @ inverse[0]
    lines = np.insert(found.points1.astype(float), 2, 1, axis=1) @ F.T
    lines /= np.linalg.norm(lines[:, :2], axis=1, keepdims=True)
    errors = (lines[:, :2] * found.points2).sum(axis=1) + lines[:, 2]
    variances = np.einsum('ni,nij,nj->n', lines[:, :2], full(found.covariances), lines[:, :2])
    kept = (found.similarities >= 0) & (abs(errors) < FAR)
    return errors[kept, None], variances[kept, None, None]


def judge_pose(pair, points, rectify):
    """Rows of the pose of two views."""
    images, masks = [read_image(file) for file in pair.files], (None, None)
    if rectify:
        pair, images, masks = rectified(pair, images)
    rows, pairs = matched(images, points, masks)
    found = opencv_iib.propagateMatches(images[0], rows[0], images[1], rows[1], pairs)
    pose = opencv_iib.findRelativePose(found.points1, found.points2, *pair.cameras)
    names = 'rotation of findRelativePose', 'direction of findRelativePose'
    judgements = [judged('propagated points across epipolar lines', *across_lines(pair, found))]
    if pose.found:
        errors = cv2.Rodrigues(pair.R @ pose.R.T)[0].ravel(), along_tangents(pose.t.ravel(), pair.t / np.linalg.norm(pair.t))
        parts = pose.covariance[:3, :3], pose.covariance[3:, 3:]
        judgements += [judged(name, error[None], part[None]) for name, error, part in zip(names, errors, parts)]
    else:
        judgements += map(nothing, names)
    return [[*pair[:3], *row] for row in judgements]


def judge_strangers(key, pair, other, points):
    """A row of images of different places, where no pose is true."""
    images = read_image(pair.files[0]), read_image(other.files[1])
    rows, pairs = matched(images, points)
    found = opencv_iib.propagateMatches(images[0], rows[0], images[1], rows[1], pairs)
    pose = opencv_iib.findRelativePose(found.points1, found.points2, pair.cameras[0], other.cameras[1])
    return [[*key, *nothing('pose of findRelativePose', int(pose.found))]]


def judge_images(pair, points, seed):
    """Rows of refined points, and of corners of an alignment whose second image is moved."""
    images = [read_image(file) for file in pair.files]
    rows, pairs = matched(images, points)
    found = opencv_iib.refineMatches(images[0], rows[0], images[1], rows[1], pairs)
    errors = found.points2 - mapped(found.points1.astype(float), pair.H) if len(pairs) else np.empty((0, 2))
    kept = (found.similarities >= 0) & (np.linalg.norm(errors, axis=1) < FAR)
    judgements = [judged('points of refineMatches', errors[kept], full(found.covariances[kept]))]
    random, target, start = Random(seed), images[1], corners(images[1])
    steps = [[random.real(-MOST_MOVED, MOST_MOVED) * target.shape[axis] for axis in (0, 1)][::-1] for _ in start]
    transform = cv2.getPerspectiveTransform(np.float32(start), np.float32(start) + np.float32(steps))
    image = cv2.warpPerspective(target, transform, target.shape[::-1], flags=cv2.INTER_CUBIC, borderMode=cv2.BORDER_REFLECT)
    aligned = opencv_iib.alignImages(images[0], image)
    if aligned.found:  # reported is the deviation of a length, of two coordinates
        errors = mapped(start, aligned.transform) - mapped(start, np.linalg.inv(transform @ pair.H))
        judgements.append(judged('corners of alignImages', errors, np.eye(2) * (aligned.error.ravel() ** 2 / 2)[:, None, None]))
    else:
        judgements.append(nothing('corners of alignImages'))
    return [[*pair[:3], *row] for row in judgements]


def searches(place):
    """Name of a map, its folder and image names, and the names of the images to localize."""
    own, beside = list(read_place(place)[1]), place.parent / 'map'
    if (beside / 'poses.txt').exists():
        return [('map', beside, list(read_place(beside)[1]), own)] if place != beside else []
    return [('%s without %d of %d' % (place.name, part + 1, step), place, [n for i, n in enumerate(own) if i % step != part], own[part::step])
            for step in (2, 3, len(own)) for part in range(step)]


def judge_locations(place, name, folder, images, sought):
    """Two rows of each image: errors of the centre, in the poses' unit, and of the rotation, in the world's axes."""
    (camera, poses), (mapping, known), rows = read_place(place), read_place(folder), []
    with tempfile.TemporaryDirectory() as work:
        work = pathlib.Path(work)
        write_model(work / 'model', mapping, {image: known[image] for image in images})
        build(str(work / 'model'), str(folder / 'images'), str(work / 'map'), MAPPED)
        localizer = Localizer(work / 'map', MAPPED)
    for image in sought:
        location = localizer.localize(read_image(place / 'images' / image), camera)
        key, names = (place.parent.name, place.name if name == 'map' else 'same', '%s, %s' % (image, name)), ('centre of Localizer', 'rotation of Localizer')
        if location.cam_from_world is None:
            rows += [[*key, *nothing(what)] for what in names]
            continue
        found, true = np.linalg.inv(location.cam_from_world), np.linalg.inv(poses[image])
        errors = found[:3, 3] - true[:3, 3], cv2.Rodrigues(found[:3, :3] @ true[:3, :3].T)[0].ravel()
        parts = location.covariance[:3, :3], location.covariance[3:, 3:]
        rows += [[*key, *judged(what, error[None], part[None])] for what, error, part in zip(names, errors, parts)]
    return rows


def uncertainty(options):
    """How many errors are within their confidence limits."""
    views, random, points = view_pairs(options.data), Random(1), options.points
    tasks = []
    for i in range(STRANGERS * len(views)):
        pair, other = views[i % len(views)], views[random.integer(len(views))]
        if pair.set.rpartition('_')[0] != other.set.rpartition('_')[0]:  # of another kind: rooms share furniture, and facades windows
            tasks.append((judge_strangers, ('strangers', '%s %d' % (pair.set, i), '%s %s' % (other.set, other.target)), pair, other, points))
    tasks += [(judge_pose, pair, points, rectify) for pair in views for rectify in (False, True) if pair.same_light or not rectify]
    tasks += [(judge_images, pair, points, seed) for seed, pair in enumerate(image_pairs(options.data), 1) if pair.light]
    places = [folder for folders in view_folders(options.data).values() for folder in folders]
    tasks += [(judge_locations, place, *search) for place in places for search in searches(place) if len(search[2]) > 1]
    write(options.out / 'uncertainty.csv', ['set', 'sequence', 'target', *map(str, HEAD)], rows_of(tasks))
