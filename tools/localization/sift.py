# SPDX-License-Identifier: Apache-2.0

"""A baseline for opencv_iib.localization: SIFT with the geometry of pycolmap."""
import dataclasses
import itertools
from typing import Any

import cv2
import numpy as np
import pycolmap

import opencv_iib

RATIO = .8  # of the ratio test
COMPARED, MAX_ERROR, LEAST_INLIERS = 5, .006, 15  # images of the map; share of the longer side; of a pose
MAX_PIXELS = 4.  # of a match from its epipolar line, and of a keypoint from its projected point
FAR = .01  # radians: more parallel rays may meet on either side within the noise
MIN_ANGLE = 1.5  # degrees between the rays of a point


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


def consistent(model, a, points_a, b, points_b):
    """Which matches of two images satisfy the epipolar constraint of their poses, with rays that meet before both cameras.

    :param points_a: M x 2, COLMAP's pixels of image a; points_b: the matched pixels of image b.
    """
    image_a, image_b = model.image(a), model.image(b)
    b_from_a = image_b.cam_from_world() * image_a.cam_from_world().inverse()
    if not len(points_a) or not np.linalg.norm(b_from_a.translation):
        return np.zeros(len(points_a), bool)
    essential = pycolmap.essential_matrix_from_pose(b_from_a)
    rays_a, rays_b = image_a.camera.cam_ray_from_img(points_a), image_b.camera.cam_ray_from_img(points_b)
    planes_a, planes_b = rays_b @ essential, rays_a @ essential.T
    product = np.abs((rays_a * planes_a).sum(1))
    limit_a, limit_b = (image.camera.cam_from_img_threshold(MAX_PIXELS) for image in (image_a, image_b))
    in_plane = (product < limit_a * np.linalg.norm(planes_a, axis=1)) & (product < limit_b * np.linalg.norm(planes_b, axis=1))
    turned = rays_a @ b_from_a.rotation.matrix().T
    normals = np.cross(turned, rays_b)
    ahead_a, ahead_b = ((np.cross(rays, b_from_a.translation) * normals).sum(1) > 0 for rays in (rays_b, turned))
    far = np.linalg.norm(normals, axis=1) < FAR
    return np.asarray(in_plane & (far | (ahead_a & ahead_b)))  # False for NaN: pixels that a camera cannot see


def graph_of(model, matches):
    """pycolmap.CorrespondenceGraph of the model's images.

    :param matches: ids of two images and M x 2 indices of their keypoints.
    """
    graph = pycolmap.CorrespondenceGraph()
    for i in model.reg_image_ids():
        graph.add_image(i, model.image(i).num_points2D())
    for a, b, pairs in matches:
        geometry = pycolmap.TwoViewGeometry()
        geometry.config = pycolmap.TwoViewGeometryConfiguration.CALIBRATED
        geometry.inlier_matches = np.ascontiguousarray(pairs, np.uint32)
        graph.add_two_view_geometry(a, b, geometry)
    graph.finalize()
    return graph


def triangulate(model, graph):
    """Triangulates points from matches and refines them; poses and cameras stay fixed."""
    manager = pycolmap.ObservationManager(model, graph)
    triangulator = pycolmap.IncrementalTriangulator(graph, model, manager)
    options = pycolmap.IncrementalTriangulatorOptions(ignore_two_view_tracks=False, min_angle=MIN_ANGLE, random_seed=1)
    for i in model.reg_image_ids():
        triangulator.triangulate_image(options, i)
    triangulator.complete_all_tracks(options)
    triangulator.merge_all_tracks(options)
    refinement = pycolmap.BundleAdjustmentOptions(
        refine_focal_length=False, refine_extra_params=False, refine_rig_from_world=False, refine_sensor_from_rig=False,
        print_summary=False)
    refinement.ceres.loss_function_type = pycolmap.LossFunctionType.CAUCHY
    everything = pycolmap.BundleAdjustmentConfig()
    for i in model.reg_image_ids():
        everything.add_image(i)
    for _ in range(2):
        manager.filter_all_points3D(MAX_PIXELS, MIN_ANGLE)
        if model.num_points3D():
            pycolmap.create_default_bundle_adjuster(refinement, everything, model).solve()
    manager.filter_all_points3D(MAX_PIXELS, MIN_ANGLE)


class Sift:
    """Has the interface of Localizer. Matches all pairs of the map's images, and a query image with each of them."""

    def __init__(self, model, images, points, normalized):
        """Makes a map from the folder of a COLMAP model."""
        self._sift = cv2.SIFT_create(points)
        self._detector = opencv_iib.NormalizedDetector(self._sift) if normalized else self._sift
        model = pycolmap.Reconstruction(model)
        found = {i: self._describe(cv2.imread(str(images / model.image(i).name), cv2.IMREAD_GRAYSCALE)) for i in model.reg_image_ids()}
        for i, (places, _) in found.items():
            model.image(i).points2D = pycolmap.Point2DList([pycolmap.Point2D(place) for place in places])
        matches = []
        for a, b in itertools.combinations(found, 2):
            pairs = matched(found[a][1], found[b][1])
            fit = consistent(model, a, found[a][0][pairs[:, 0]], b, found[b][0][pairs[:, 1]])
            matches.append((a, b, pairs[fit]))
        triangulate(model, graph_of(model, matches))
        self._images = []
        for i, (_, codes) in found.items():
            seen = [(row, point.point3D_id) for row, point in enumerate(model.image(i).points2D) if point.has_point3D()]
            if len(seen) > 1:
                self._images.append((codes[[row for row, _ in seen]], np.array([model.point3D(p).xyz for _, p in seen])))

    def _describe(self, grey):
        keypoints, codes = self._sift.compute(grey, self._detector.detect(grey, None))
        return np.array([k.pt for k in keypoints]).reshape(-1, 2) + .5, np.zeros((0, 128)) if codes is None else codes

    def localize(self, image, camera):
        places, codes = self._describe(image)
        pairs = sorted(((matched(codes, known), points) for known, points in self._images), key=lambda m: -len(m[0]))[:COMPARED]
        seen = np.concatenate([places[found[:, 0]] for found, _ in pairs])
        points = np.concatenate([xyz[found[:, 1]] for found, xyz in pairs])
        limit = {'ransac': {'max_error': MAX_ERROR * max(camera.width, camera.height), 'random_seed': 1}}
        taken = pycolmap.Camera(model=camera.model, width=camera.width, height=camera.height, params=camera.params)
        pose = pycolmap.estimate_and_refine_absolute_pose(seen, points, taken, limit) if len(seen) >= LEAST_INLIERS else None
        if pose is None or pose['num_inliers'] < LEAST_INLIERS:
            return Location()
        return Location(np.concatenate([pose['cam_from_world'].matrix(), [[0, 0, 0, 1]]]), pose['num_inliers'])
