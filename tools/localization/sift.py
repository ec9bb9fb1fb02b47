# SPDX-License-Identifier: Apache-2.0

"""A baseline for opencv_iib.localization: SIFT with the geometry of pycolmap."""
import collections
import dataclasses
import itertools
import tempfile
from typing import Any

import cv2
import numpy as np
import pycolmap

import opencv_iib

RATIO = .8  # of the ratio test
COMPARED, MAX_ERROR, LEAST_INLIERS = 5, .006, 15  # images of the map; share of the longer side; of a pose


@dataclasses.dataclass
class Location:
    """The pose of an image: camera from world, 4 x 4, or None."""

    cam_from_world: Any = None
    inliers: int = 0


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


def triangulated(model, places, matches):
    """The model with points that pycolmap triangulates. Arguments: keypoints by image; ids of two images and M x 2 indices of matches."""
    with tempfile.TemporaryDirectory() as folder:
        with pycolmap.Database.open(folder + '/database.db') as database:
            for camera in model.cameras.values():
                database.write_camera(camera, use_camera_id=True)
            for rig in model.rigs.values():
                database.write_rig(rig, use_rig_id=True)
            for frame in model.frames.values():
                database.write_frame(frame, use_frame_id=True)
            for i, rows in places.items():
                database.write_image(model.image(i), use_image_id=True)
                database.write_keypoints(i, rows)
            for a, b, pairs in matches:
                geometry = pycolmap.TwoViewGeometry()
                geometry.config, geometry.inlier_matches = pycolmap.TwoViewGeometryConfiguration.CALIBRATED, np.ascontiguousarray(pairs, np.uint32)
                database.write_two_view_geometry(a, b, geometry)
        options = pycolmap.IncrementalPipelineOptions(random_seed=1, extract_colors=False, min_num_matches=1)
        options.triangulation.ignore_two_view_tracks = False
        return pycolmap.triangulate_points(model, folder + '/database.db', folder, folder, options=options)


def refined_tracks(model, greys, rows):
    """Keypoints by image: each is moved to where its surroundings agree best with those of the first keypoint of its point."""
    pairs, moved = collections.defaultdict(list), {i: each.copy() for i, each in rows.items()}
    for point in model.points3D.values():
        first, *others = point.track.elements
        for other in others:
            pairs[first.image_id, other.image_id].append((first.point2D_idx, other.point2D_idx))
    for (a, b), each in pairs.items():
        if a != b:
            each = np.array(each, np.int32)
            moved[b][each[:, 1], :2] = opencv_iib.refineMatches(greys[a], rows[a], greys[b], rows[b], each).points2
    return moved


class Sift:
    """Has the interface of Localizer. Matches all pairs of the map's images, and a query image with each of them. With `refine` the points of
    the map, and then those of the query image, are moved by refineMatches."""

    def __init__(self, model, images, points, normalized, refine):
        """Makes a map from the folder of a COLMAP model."""
        self._sift, self._refine = cv2.SIFT_create(points), refine
        self._detector = opencv_iib.NormalizedDetector(self._sift) if normalized else self._sift
        posed = pycolmap.Reconstruction(model)
        greys = {i: cv2.imread(str(images / posed.image(i).name), cv2.IMREAD_GRAYSCALE) for i in posed.reg_image_ids()}
        found = {i: self._describe(grey) for i, grey in greys.items()}
        rows = {i: each for i, (each, _) in found.items()}
        matches = [(a, b, matched(found[a][1], found[b][1])) for a, b in itertools.combinations(found, 2)]
        mapped = triangulated(posed, {i: each[:, :2] + .5 for i, each in rows.items()}, matches)
        if refine:
            rows = refined_tracks(mapped, greys, rows)
            mapped = triangulated(pycolmap.Reconstruction(model), {i: each[:, :2] + .5 for i, each in rows.items()}, matches)
        self._images = []
        for i, (_, codes) in found.items():
            seen = [(row, point.point3D_id) for row, point in enumerate(mapped.image(i).points2D) if point.has_point3D()]
            if len(seen) > 1:
                chosen = [row for row, _ in seen]
                self._images.append((codes[chosen], np.array([mapped.point3D(p).xyz for _, p in seen]), greys[i], rows[i][chosen]))

    def _describe(self, grey):
        """Rows of x, y, size and angle, and descriptors."""
        keypoints, codes = self._sift.compute(grey, self._detector.detect(grey, None))
        return np.array([(*k.pt, k.size, k.angle) for k in keypoints], np.float32).reshape(-1, 4), np.zeros((0, 128)) if codes is None else codes

    def _places(self, image, rows, pairs, mapped, known):
        """Where the image has the matched points, as COLMAP counts pixels."""
        if not self._refine or not len(pairs):
            return rows[pairs[:, 0], :2] + .5
        return opencv_iib.refineMatches(mapped, known, image, rows, pairs[:, ::-1].astype(np.int32)).points2 + .5

    def localize(self, image, camera):
        rows, codes = self._describe(image)
        pairs = sorted(((matched(codes, known[0]), known) for known in self._images), key=lambda m: -len(m[0]))[:COMPARED]
        seen = np.concatenate([self._places(image, rows, found, *known[2:]) for found, known in pairs])
        points = np.concatenate([known[1][found[:, 1]] for found, known in pairs])
        limit = {'ransac': {'max_error': MAX_ERROR * max(camera.width, camera.height), 'random_seed': 1}}
        taken = pycolmap.Camera(model=camera.model, width=camera.width, height=camera.height, params=camera.params)
        pose = pycolmap.estimate_and_refine_absolute_pose(seen, points, taken, limit) if len(seen) >= LEAST_INLIERS else None
        if pose is None or pose['num_inliers'] < LEAST_INLIERS:
            return Location()
        return Location(np.concatenate([pose['cam_from_world'].matrix(), [[0, 0, 0, 1]]]), pose['num_inliers'])
