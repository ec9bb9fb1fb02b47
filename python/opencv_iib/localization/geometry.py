"""Points from matches of images whose poses are known."""
from __future__ import annotations

from typing import Any, Callable, Iterable, Optional

import numpy as np
from numpy.typing import NDArray

from opencv_iib.localization._pycolmap import pycolmap

MAX_ERROR = 4.  #: pixels, of a match from its epipolar line and of a keypoint from its point
FAR = .01  #: radians between rays that do not tell on which side they meet
MIN_ANGLE = 1.5  #: degrees between the rays of a point
STEPS = 10  #: of a pose's refinement
SETTLED = .05  #: pixels that a step moves the points, after which there is none
YZX, ZXY = [1, 2, 0], [2, 0, 1]


def fitting(model: Any, a: int, points_a: NDArray[np.float64], b: int, points_b: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Which matches of two images fit their poses: their rays lie in one plane with both cameras, and meet before them.

    :param points_a: M x 2, COLMAP's pixels of image a; points_b: those that they match.
    """
    image_a, image_b = model.image(a), model.image(b)
    b_from_a = image_b.cam_from_world() * image_a.cam_from_world().inverse()
    if not len(points_a) or not np.linalg.norm(b_from_a.translation):
        return np.zeros(len(points_a), bool)
    essential = pycolmap.essential_matrix_from_pose(b_from_a)
    rays_a, rays_b = image_a.camera.cam_ray_from_img(points_a), image_b.camera.cam_ray_from_img(points_b)
    planes_a, planes_b = rays_b @ essential, rays_a @ essential.T
    product = np.abs((rays_a * planes_a).sum(1))
    limit_a, limit_b = (image.camera.cam_from_img_threshold(MAX_ERROR) for image in (image_a, image_b))
    in_plane = (product < limit_a * np.linalg.norm(planes_a, axis=1)) & (product < limit_b * np.linalg.norm(planes_b, axis=1))
    turned = rays_a @ b_from_a.rotation.matrix().T
    normals = np.cross(turned, rays_b)
    ahead_a, ahead_b = ((np.cross(rays, b_from_a.translation) * normals).sum(1) > 0 for rays in (rays_b, turned))
    far = np.linalg.norm(normals, axis=1) < FAR
    return np.asarray(in_plane & (far | (ahead_a & ahead_b)))  # False for NaN: what a camera cannot see


def graph_of(model: Any, matches: Iterable[tuple[int, int, NDArray[Any]]]) -> Any:
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


def triangulate(model: Any, graph: Any, images: Iterable[int], step: Callable[[], None] = lambda: None) -> None:
    """Points from the matches of some images, and the tracks that they prolong; then all points are refined.

    Poses and cameras stay.

    :param step: called after each image.
    """
    manager = pycolmap.ObservationManager(model, graph)
    triangulator = pycolmap.IncrementalTriangulator(graph, model, manager)
    options = pycolmap.IncrementalTriangulatorOptions(ignore_two_view_tracks=False, min_angle=MIN_ANGLE, random_seed=1)
    for i in images:
        triangulator.triangulate_image(options, i)
        step()
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
        manager.filter_all_points3D(MAX_ERROR, MIN_ANGLE)
        if model.num_points3D():
            pycolmap.create_default_bundle_adjuster(refinement, everything, model).solve()
    manager.filter_all_points3D(MAX_ERROR, MIN_ANGLE)


def project(cam_from_world: Any, points: NDArray[np.float64]) -> NDArray[np.float64]:
    """N x 3 points of the world in a camera's axes."""
    matrix = cam_from_world.matrix()
    return np.asarray(points @ matrix[:, :3].T + matrix[:, 3])


def _slopes(camera: Any, places: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Pixels of N x 3 places in the camera's axes, and their N x 2 x 3 derivatives by central differences."""
    step = 1e-6 * np.linalg.norm(places, axis=1, keepdims=True)
    moves = np.concatenate([np.zeros((1, 3)), np.eye(3), -np.eye(3)])[:, None]
    pixels = camera.img_from_cam((places + step * moves).reshape(-1, 3)).reshape(7, -1, 2)
    return pixels[0], ((pixels[1:4] - pixels[4:]) / (2 * step)).transpose(1, 2, 0)


def refine_pose(cam_from_world: Any, camera: Any, pixels: NDArray[np.float64], points: NDArray[np.float64]
                ) -> Optional[tuple[Any, NDArray[np.float64]]]:
    """The pose that fits N pixels to the N points that they see: Gauss and Newton's steps, Cauchy's loss of one pixel.

    :return: the pose, and 6 x 6 covariances of the camera's centre and of a small turn about the world's axes, for
        pixels with a deviation of 1; None if the points do not determine them.
    """
    rotation, centre = cam_from_world.rotation.matrix(), cam_from_world.inverse().translation
    for _ in range(STEPS):
        rays = points - centre
        seen, slopes = _slopes(camera, rays @ rotation.T)
        errors = np.nan_to_num(seen - pixels)  # NaN behind the camera
        by_ray, rays = np.nan_to_num(slopes) @ rotation, rays[:, None]
        cross = by_ray[..., YZX] * rays[..., ZXY] - by_ray[..., ZXY] * rays[..., YZX]  # a turn w moves the ray r by r x w
        jacobian = np.concatenate([-by_ray, cross], axis=2).reshape(-1, 6)
        weighted = jacobian * np.repeat(1 / (1 + (errors ** 2).sum(1)), 2)[:, None]
        try:
            covariance = np.linalg.inv(weighted.T @ jacobian)
        except np.linalg.LinAlgError:
            return None
        step = -covariance @ (weighted.T @ errors.ravel())
        centre = centre + step[:3]
        rotation = rotation @ pycolmap.Rotation3d(-step[3:]).matrix()
        if np.abs(jacobian @ step).max() < SETTLED:
            break
    return pycolmap.Rigid3d(pycolmap.Rotation3d(rotation), -rotation @ centre), covariance
