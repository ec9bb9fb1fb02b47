"""Where an image was taken, in a map."""
from __future__ import annotations

import dataclasses
import os
from typing import Any, Optional, Union

import numpy as np
from numpy.typing import NDArray

from opencv_iib.functions import detect_and_describe
from opencv_iib.localization._pycolmap import pycolmap
from opencv_iib.localization.map import Map, read_map
from opencv_iib.localization.retrieval import Votes
from opencv_iib.matcher import HierarchicalMatcher

SHORTLIST, CANDIDATES = 20, 5  #: of the map's images: by votes, and of these by matches
NEAREST = 3  #: of the map's images, to a prior
RANKING = 200  #: strongest codes of an image, whose matches rank the shortlist
SUREST = 300  #: matches of the fewest different bits, among which the pose is looked for; it is refined with all
RANSAC = {'random_seed': 1}
GATE = .1  #: of the longer side: how far from where a prior has them points are looked for
MAX_ERROR = .006  #: of the longer side: an inlier's distance from where the pose has its point
LEAST_INLIERS, LEAST_SHARE = 15, .02  #: in an unknown place a few of many matches agree by chance
MAX_BOUND = .1  #: of the distance to the points: three standard deviations of the place
LEAST_DEVIATION = .2  #: pixels


@dataclasses.dataclass
class Location:
    """What Localizer.localize finds."""

    reason: str = ''  #: why there is no pose
    cam_from_world: Any = None  #: pycolmap.Rigid3d, or None
    #: 6 x 6, of the camera's centre (map's unit) and of a small turn about the world's axes (radians)
    covariance: Optional[NDArray[np.float64]] = None
    matches: int = 0
    inliers: int = 0
    pixels: NDArray[np.float64] = dataclasses.field(default_factory=lambda: np.empty((0, 2)))  #: inliers, COLMAP's pixels
    points: NDArray[np.float64] = dataclasses.field(default_factory=lambda: np.empty((0, 3)))  #: of the map that they see
    images: list[int] = dataclasses.field(default_factory=list)  #: ids of the map's images that it was compared with
    hits: list[tuple[int, int]] = dataclasses.field(default_factory=list)  #: image id and row of each inlier's code


class Localizer:
    """Finds images in a map. Threads may share one."""

    def __init__(self, map: Union[str, os.PathLike[str], Map], points: Optional[int] = None) -> None:
        """
        :param map: its folder, or what read_map gave.
        :param points: keypoints that are looked for in an image; None for as many as in the map's images.
        """
        self.map = map if isinstance(map, Map) else read_map(os.fspath(map))
        self.points = points or self.map.points
        model, self._ids = self.map.model, sorted(self.map.codes)
        xyz = {number: point.xyz for number, point in model.points3D.items()}
        self._numbers = [np.array([p.point3D_id for p in model.image(i).points2D], np.int64) for i in self._ids]
        self._points = [np.array([xyz[number] for number in numbers]).reshape(-1, 3) for numbers in self._numbers]
        self._codes = [np.asarray(self.map.codes[i]) for i in self._ids]
        self._centres = np.array([model.image(i).projection_center() for i in self._ids])
        self._directions = np.array([model.image(i).viewing_direction() for i in self._ids])
        self._depths = np.array([np.median(np.linalg.norm(points - centre, axis=1)) if len(points) else 1.
                                 for points, centre in zip(self._points, self._centres)])
        self._votes = Votes(self._codes)
        self._matcher = HierarchicalMatcher.createRecommended()

    def localize(self, image: NDArray[np.uint8], camera: Any, prior: Any = None) -> Location:
        """Where an image was taken.

        :param image: H x W (x 3, BGR) uint8.
        :param camera: pycolmap.Camera, of the image's size.
        :param prior: pycolmap.Rigid3d, camera from world, such as the last image's: points are first looked for near where
            it has them, and everywhere only if that gives no pose.
        """
        height, width = image.shape[:2]
        if (width, height) != (camera.width, camera.height):
            raise ValueError(f'the image has {width} x {height} pixels and the camera {camera.width} x {camera.height}')
        features = detect_and_describe(image, self.points)
        pixels = features.points.astype(np.float64) + .5
        location = Location('too few matches')
        if len(pixels) and prior is not None:
            location = self._locate(pixels, features.codes, camera, self.near(prior)[:NEAREST], prior)
        if len(pixels) and location.cam_from_world is None:
            location = self._locate(pixels, features.codes, camera, self._similar(features.codes), None)
        return location

    def distances(self, cam_from_world: Any) -> NDArray[np.float64]:
        """Of a pose from the map's images, by id: the distance over that of what they see, plus the angle in radians."""
        moved = np.linalg.norm(self._centres - cam_from_world.inverse().translation, axis=1) / self._depths
        turned = np.arccos(np.clip(self._directions @ cam_from_world.rotation.matrix()[2], -1, 1))
        return np.asarray(moved + turned)

    def near(self, cam_from_world: Any) -> list[int]:
        """Indices of the map's images, the nearest pose first."""
        return list(np.argsort(self.distances(cam_from_world), kind='stable'))

    def _similar(self, codes: NDArray[np.uint8]) -> list[int]:
        votes = self._votes(codes)
        best = np.argsort(-votes, kind='stable')[:SHORTLIST]
        counts = [np.count_nonzero(self._matcher.knnMatchArrays(codes[:RANKING], self._codes[k])[0] >= 0)
                  if votes[k] and len(self._codes[k]) else 0 for k in best]
        return [best[n] for n in np.argsort(-np.array(counts), kind='stable')[:CANDIDATES] if counts[n]]

    def _matched(self, pixels: NDArray[np.float64], codes: NDArray[np.uint8], camera: Any, k: int, prior: Any
                 ) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int32]]:
        """Keypoints, the rows of the map's image that they match, and bits that differ."""
        rows, mask = np.arange(len(self._codes[k])), None
        if prior is not None:
            gate = round(GATE * max(camera.width, camera.height))
            places = camera.img_from_cam(project(prior, self._points[k]))  # NaN behind the camera
            rows = np.flatnonzero(((places > -gate) & (places < (camera.width + gate, camera.height + gate))).all(1))
            seen, first = pixels.T.astype(np.int16), (places[rows].T - gate).astype(np.int16, order='C')
            near = [(seen[axis, :, None] - first[axis]).view(np.uint16) < 2 * gate for axis in (0, 1)]  # negative is large
            mask = (near[0] & near[1]).view(np.uint8)
        if not len(rows):
            return rows, rows, rows.astype(np.int32)
        nearest, bits = (a[:, 0] for a in self._matcher.knnMatchArrays(codes, self._codes[k][rows], mask=mask))
        queries = np.flatnonzero(nearest >= 0)
        return queries, rows[nearest[queries]], bits[queries]

    def _locate(self, pixels: NDArray[np.float64], codes: NDArray[np.uint8], camera: Any, candidates: list[int], prior: Any
                ) -> Location:
        location = Location('too few matches', images=[self._ids[k] for k in candidates])
        matched = [self._matched(pixels, codes, camera, k, prior) for k in candidates]
        queries = np.concatenate([np.empty(0, np.int64), *(m[0] for m in matched)])
        if len(queries) < LEAST_INLIERS:
            return location
        # A keypoint that matches a point in several images of the map counts once.
        numbers = np.concatenate([self._numbers[k][m[1]] for k, m in zip(candidates, matched)])
        _, first, match = np.unique(np.stack([queries, numbers]), axis=1, return_index=True, return_inverse=True)
        queries = queries[first]
        location.matches = len(queries)
        xy, xyz = pixels[queries], np.concatenate([self._points[k][m[1]] for k, m in zip(candidates, matched)])[first]
        limit = MAX_ERROR * max(camera.width, camera.height)
        surest = np.argsort(np.concatenate([m[2] for m in matched])[first], kind='stable')[:SUREST]
        found = pycolmap.estimate_absolute_pose(xy[surest], xyz[surest], camera, {'ransac': {**RANSAC, 'max_error': limit}})
        location.reason = 'too few matches agree'
        if found is None:
            return location
        pose = found['cam_from_world']
        inliers = np.zeros(len(xy), bool)
        for n in range(3):
            if n:
                refined = pycolmap.refine_absolute_pose(pose, xy, xyz, inliers, camera, return_covariance=n == 2)
                if refined is None:
                    location.reason = 'the points do not determine the pose'
                    return location
                pose = refined['cam_from_world']
            errors = np.linalg.norm(camera.img_from_cam(project(pose, xyz)) - xy, axis=1)
            inliers = errors < limit  # False for NaN, behind the camera
            location.inliers = len(set(queries[inliers]))
            if location.inliers < LEAST_INLIERS + LEAST_SHARE * len(queries):
                return location
        deviation = max(LEAST_DEVIATION, np.median(errors[inliers]) / 1.1774)  # of a Rayleigh distribution
        location.covariance = deviation ** 2 * camera_covariance(pose, refined['covariance'])
        depth = np.median(np.linalg.norm(project(pose, xyz[inliers]), axis=1))
        if not 3 * np.sqrt(np.linalg.eigvalsh(location.covariance[:3, :3])[2]) <= MAX_BOUND * depth:
            location.reason = 'the pose is uncertain'
            return location
        location.reason, location.cam_from_world = '', pose
        location.pixels, location.points = xy[inliers], xyz[inliers]
        owners = [(self._ids[k], int(row)) for k, m in zip(candidates, matched) for row in m[1]]
        location.hits = [owners[n] for n in np.flatnonzero(inliers[match.ravel()])]
        return location


def project(cam_from_world: Any, points: NDArray[np.float64]) -> NDArray[np.float64]:
    """N x 3 points of the world in a camera's axes."""
    matrix = cam_from_world.matrix()
    return np.asarray(points @ matrix[:, :3].T + matrix[:, 3])


def camera_covariance(cam_from_world: Any, covariance: NDArray[np.float64]) -> NDArray[np.float64]:
    """As in Location, from what pycolmap's refine_absolute_pose gives: a turn in half angles, then the translation."""
    rotation, (x, y, z) = cam_from_world.rotation.matrix(), cam_from_world.translation
    back = -rotation.T
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    jacobian = np.block([[2 * back @ cross, back], [2 * back, np.zeros((3, 3))]])
    return np.asarray(jacobian @ covariance @ jacobian.T)
