# SPDX-License-Identifier: Apache-2.0

"""Maps made by day and images found in them in other lights, by opencv_iib.localization and by SIFT in its place.

A place is a folder with images/, cameras.txt (COLMAP, one camera) and poses.txt (TUM: image, camera's centre, camera to world).
"""
import csv
import functools
import itertools
import resource
import subprocess
import time

import cv2
import numpy as np
import pycolmap

import opencv_iib
from opencv_iib.localization import Location, Localizer, build_map, parse_camera, update_map
from opencv_iib.localization.geometry import fitting, graph_of, triangulate

POINTS = 2000  # an image
RATIO = .8  # of SIFT's distances
COMPARED, MAX_ERROR, LEAST_INLIERS = 5, .006, 15  # of SIFT: images of the map; of the longer side; a pose
SEASONS = ('morning', 'overcast', 'dusk')  # updates, in the order of a day


def read_place(folder, step=1):
    """pycolmap.Camera, and Rigid3d (camera from world) of every step-th image that is there, by file name."""
    lines = [line.split() for line in (folder / 'cameras.txt').read_text().splitlines() if not line.startswith('#')]
    poses = {}
    for line in (folder / 'poses.txt').read_text().splitlines():
        stem, *numbers = line.split()
        for path in (folder / 'images').glob(stem + '.*') if stem != '#' else ():
            place, turn = np.array(numbers, float)[:3], np.array(numbers, float)[3:]
            poses[path.name] = pycolmap.Rigid3d(pycolmap.Rotation3d(turn), place).inverse()
    return parse_camera(','.join(lines[0][1:])), dict(sorted(poses.items())[::step])


def write_model(folder, camera, poses):
    """A COLMAP model without points."""
    model = pycolmap.Reconstruction()
    camera.camera_id = 1
    model.add_camera_with_trivial_rig(camera)
    for number, (name, pose) in enumerate(poses.items(), 1):
        model.add_image_with_trivial_frame(pycolmap.Image(name, np.zeros((0, 2)), 1, number), pose)
    folder.mkdir(parents=True, exist_ok=True)
    model.write(folder)
    return model


def chain(folder, work, step=1):
    """Localizer in a map of a place by the package, in the folder work/map."""
    write_model(work / 'model', *read_place(folder, step))
    build_map(str(work / 'model'), str(folder / 'images'), str(work / 'map'), POINTS)
    return Localizer(work / 'map', POINTS)


def matched(a, b):
    """Mutual nearest neighbours under the ratio test."""
    if min(len(a), len(b)) < 2:
        return np.zeros((0, 2), int)
    distances = (a * a).sum(1)[:, None] + (b * b).sum(1) - 2 * a @ b.T
    rows, nearest, back = np.arange(len(a)), distances.argmin(1), distances.argmin(0)
    first = distances[rows, nearest]
    distances[rows, nearest] = np.inf
    kept = (back[nearest] == rows) & (first <= RATIO ** 2 * distances.min(1))
    return np.stack([rows[kept], nearest[kept]], axis=1)


class Sift:
    """In the place of Localizer: all pairs of the map's images are matched, and an image with each of them."""

    def __init__(self, folder, work, normalized):
        self._sift = cv2.SIFT_create(POINTS)
        self._detector = opencv_iib.NormalizedDetector(self._sift) if normalized else self._sift
        model = write_model(work / 'model', *read_place(folder))
        found = {i: self._describe(cv2.imread(str(folder / 'images' / model.image(i).name))) for i in model.reg_image_ids()}
        for i, (places, _) in found.items():
            model.image(i).points2D = pycolmap.Point2DList([pycolmap.Point2D(place) for place in places])
        matches = []
        for a, b in itertools.combinations(found, 2):
            pairs = matched(found[a][1], found[b][1])
            fit = fitting(model, a, found[a][0][pairs[:, 0]], b, found[b][0][pairs[:, 1]])
            matches.append((a, b, pairs[fit]))
        triangulate(model, graph_of(model, matches), list(found))
        self._images = []
        for i, (_, codes) in found.items():
            seen = [(row, point.point3D_id) for row, point in enumerate(model.image(i).points2D) if point.has_point3D()]
            if len(seen) > 1:
                self._images.append((codes[[row for row, _ in seen]], np.array([model.point3D(p).xyz for _, p in seen])))

    def _describe(self, image):
        grey = cv2.cvtColor(image, cv2.COLOR_BGR2GRAY)
        keypoints, codes = self._sift.compute(grey, self._detector.detect(grey, None))
        return np.array([k.pt for k in keypoints]).reshape(-1, 2) + .5, np.zeros((0, 128)) if codes is None else codes

    def localize(self, image, camera):
        places, codes = self._describe(image)
        pairs = sorted(((matched(codes, known), points) for known, points in self._images), key=lambda m: -len(m[0]))[:COMPARED]
        seen = np.concatenate([places[found[:, 0]] for found, _ in pairs])
        points = np.concatenate([xyz[found[:, 1]] for found, xyz in pairs])
        limit = {'ransac': {'max_error': MAX_ERROR * max(camera.width, camera.height), 'random_seed': 1}}
        pose = pycolmap.estimate_and_refine_absolute_pose(seen, points, camera, limit) if len(seen) >= LEAST_INLIERS else None
        if pose is None or pose['num_inliers'] < LEAST_INLIERS:
            return Location('too few matches agree')
        return Location('', pose['cam_from_world'], inliers=pose['num_inliers'])


METHODS = {'recommended chain': chain, 'SIFT, normalized image': functools.partial(Sift, normalized=True),
           'SIFT, plain image': functools.partial(Sift, normalized=False)}


def error(found, truth):
    """Centimetres and degrees."""
    turn = (found.rotation * truth.rotation.inverse()).angle()
    return 100 * float(np.linalg.norm(found.inverse().translation - truth.inverse().translation)), float(np.degrees(turn))


def localize(localizer, folder, names=None, lit=lambda image, name: image):
    """Of each image of a place: its name, location, error or None, and milliseconds of processor time."""
    camera, poses = read_place(folder)
    for name in names or poses:
        image = lit(cv2.imread(str(folder / 'images' / name)), name)
        begin = time.process_time()
        location = localizer.localize(image, camera)
        used = 1000 * (time.process_time() - begin)
        yield name, location, location.cam_from_world and error(location.cam_from_world, poses[name]), used


def relit(image, name):
    """Darkened by gamma 2.2, a ramp to a quarter, half the light, noise."""
    light = (image / 255) ** 2.2 * np.linspace(1, .25, image.shape[1])[None, :, None] * .5
    return np.clip(light * 255 + np.random.default_rng(sum(name.encode())).normal(0, 2, image.shape), 0, 255).astype(np.uint8)


def summary(located):
    """What the page tells of images in one light; the errors of those found are in order."""
    errors = sorted(error for _, _, error, _ in located if error)
    within = {limit: sum(bool(cm <= limit and degrees <= turn) for cm, degrees in errors) for limit, turn in ((5, .5), (25, 2))}
    return {'images': len(located), 'found': len(errors), 'within_5': within[5], 'within_25': within[25],
            'median': float(np.median([cm for cm, _ in errors])) if errors else None, 'errors': [cm for cm, _ in errors],
            'inliers': float(np.median([location.inliers for _, location, _, _ in located])),
            'ms': float(np.median([used for _, _, _, used in located]))}


def street(data, work, lights):
    """Rows of all methods and lights, and of fewer keyframes; what the chain located, by light; its localizer."""
    rows, seen, ours = [], {}, None
    for method, make in METHODS.items():
        localizer = make(data / 'map', work / method)
        ours = ours or localizer
        for light in lights:
            located = list(localize(localizer, data / light))
            seen.setdefault(light, located)
            rows.append({'place': 'street', 'method': method, 'light': light, **summary(located)})
    for step in (2, 4):
        localizer = chain(data / 'map', work / f'every {step}', step)
        for light in lights:
            rows.append({'place': f'every {step}', 'method': 'recommended chain', 'light': light,
                         **summary(list(localize(localizer, data / light)))})
    return rows, seen, ours


def program(path, data, work, lights):
    """Rows of iib_localize in the chain's map, alone and where there is an IMU also with it; milliseconds of the whole run."""
    rows = []
    for light, imu in itertools.product(lights, ('', ' --imu')):
        readings, out, poses = data / light / 'imu.csv', work / (light + imu), read_place(data / light)[1]
        if imu and not readings.exists():
            continue
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        subprocess.run([path, '--model', work / 'recommended chain/model', '--photographs', data / 'map/images', '--images', data / light / 'images', '--out', out,
                        *(('--imu', readings) if imu else ())], check=False, stdout=subprocess.DEVNULL)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        used = 1000 * (after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime) / len(poses)
        errors = {}
        for line in (out / 'trajectory.txt').read_text().splitlines()[1:]:
            stem, *numbers = line.split()
            place, turn = np.array(numbers, float)[:3], np.array(numbers, float)[3:]
            name = next(name for name in poses if name.rpartition('.')[0] == stem)
            errors[name] = error(pycolmap.Rigid3d(pycolmap.Rotation3d(turn), place).inverse(), poses[name])
        with open(out / 'frames.csv', encoding='utf-8', newline='') as file:
            located = [(row['name'], Location(inliers=int(row['inliers'])), errors.get(row['name']), used) for row in csv.DictReader(file)]
        rows.append({'place': 'program', 'method': 'iib_localize' + imu, 'light': light, **summary(located)})
    return rows


def seasons(data, work, lights):
    """Night in a map of every fourth keyframe, and after updates with other lights."""
    rows = []
    for light in ('noon', *(light for light in SEASONS if light in lights)):
        counts = {} if light == 'noon' else update_map(str(work / 'every 4/map'), str(data / light / 'images'),
                                                       read_place(data / light)[0])
        localizer = Localizer(work / 'every 4/map', POINTS)
        rows.append({'light': light, 'added': counts.get('added', 0), 'size': len(localizer.map.codes),
                     'night': summary(list(localize(localizer, data / 'night')))})
    return rows


def photographs(data, work):
    """Rows of real photographs: every other image mapped, the others found as they are and relit."""
    rows = []
    for folder in sorted(path.parent for path in data.glob('*/poses.txt')):
        names = sorted(path.name for path in (folder / 'images').iterdir())
        mapped = work / folder.name
        (mapped / 'images').mkdir(parents=True, exist_ok=True)
        for name in names[::2]:
            (mapped / 'images' / name).write_bytes((folder / 'images' / name).read_bytes())
        for text in ('cameras.txt', 'poses.txt'):
            (mapped / text).write_bytes((folder / text).read_bytes())
        for method, make in METHODS.items():
            localizer = make(mapped, work / f'{folder.name} {method}')
            for light, lit in (('as they are', lambda image, name: image), ('relit', relit)):
                rows.append({'place': folder.name, 'method': method, 'light': light,
                             **summary(list(localize(localizer, folder, names[1::2], lit)))})
    return rows


def unknown(localizer, camera, paths):
    """How many photographs of other places get a pose."""
    images = (cv2.resize(cv2.imread(str(path)), (camera.width, camera.height)) for path in paths)
    return sum(localizer.localize(image, camera).cam_from_world is not None for image in images)
