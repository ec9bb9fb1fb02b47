"""Where an image was taken, in a map."""
from __future__ import annotations

import dataclasses
import os
from typing import Any, Optional, Union

import numpy as np
from numpy.typing import NDArray

from opencv_iib.descriptor import IIBDescriptorExtractor
from opencv_iib.detectors import detect_rows
from opencv_iib.localization._pycolmap import pycolmap
from opencv_iib.localization.geometry import project, refine_pose
from opencv_iib.localization.map import Map, read_map
from opencv_iib.localization.retrieval import Votes
from opencv_iib.matcher import HierarchicalMatcher

SHORTLIST, CANDIDATES = 20, 5  #: of the map's images: by votes, and of these by matches
NEAREST = 2  #: of the map's images, to a prior
RANKING = 200  #: strongest codes of an image, whose matches rank the shortlist
SUREST = 300  #: matches of the fewest different bits, among which the pose is looked for; it is refined with all
RANSAC = {'random_seed': 1, 'confidence': .9999, 'max_num_trials': 3000, 'dyn_num_trials_multiplier': 1.}
GATE = .1  #: of the longer side: how far from where a prior has them points are looked for
WINDOW = 4  #: gates a side: points in such a square are searched for together
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

    def __init__(self, map: Union[str, os.PathLike[str], Map], points: int = 1000) -> None:
        """
        :param map: its folder, or what read_map gave.
        :param points: keypoints that are looked for in an image; as many as in the map's images (2000, see map.points) take
            twice the time and find more in hard light.
        """
        self.map = map if isinstance(map, Map) else read_map(os.fspath(map))
        self._ids = sorted(self.map.codes)
        self._codes = [np.asarray(self.map.codes[i]) for i in self._ids]
        self._votes = Votes(self._codes)
        self._iib = IIBDescriptorExtractor.createRecommended(points)
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
        rows, codes = self._iib.compute(image, detect_rows(self._iib, image, None))
        pixels = rows[:, :2].astype(np.float64) + .5
        location = Location('too few matches')
        if len(pixels) and prior is not None:
            location = self._locate(pixels, codes, camera, self._near(prior), prior)
        if len(pixels) and location.cam_from_world is None:
            location = self._locate(pixels, codes, camera, self._similar(codes), None)
        return location

    def _near(self, cam_from_world: Any) -> list[int]:
        """Indices of the map's images from the nearest: distance over that of what they see, plus the angle in radians."""
        views = self.map.views
        moved = np.linalg.norm(views[:, :3] - cam_from_world.inverse().translation, axis=1) / views[:, 6]
        turned = np.arccos(np.clip(views[:, 3:6] @ cam_from_world.rotation.matrix()[2], -1, 1))
        return list(np.argsort(moved + turned, kind='stable')[:NEAREST])

    def _similar(self, codes: NDArray[np.uint8]) -> list[int]:
        votes = self._votes(codes)
        best = np.argsort(-votes, kind='stable')[:SHORTLIST]
        counts = [np.count_nonzero(self._matcher.knnMatchArrays(codes[:RANKING], self._codes[k])[0] >= 0)
                  if votes[k] and len(self._codes[k]) else 0 for k in best]
        return [best[n] for n in np.argsort(-np.array(counts), kind='stable')[:CANDIDATES] if counts[n]]

    def _matched(self, codes: NDArray[np.uint8], mapped: NDArray[np.uint8]) -> NDArray[np.int64]:
        """3 x M: rows of both, and bits that differ."""
        nearest, bits = (a[:, 0] for a in self._matcher.knnMatchArrays(codes, mapped))
        queries = np.flatnonzero(nearest >= 0)
        return np.stack([queries, nearest[queries], bits[queries]])

    def _gated(self, pixels: NDArray[np.float64], codes: NDArray[np.uint8], camera: Any, k: int, prior: Any
               ) -> NDArray[np.int64]:
        """As _matched, within a gate of where the prior has the points of image k."""
        gate = GATE * max(camera.width, camera.height)
        places = camera.img_from_cam(project(prior, self.map.places[self.map.sees[self._ids[k]]]))  # NaN behind the camera
        inside = np.flatnonzero(((places > -gate) & (places < (camera.width + gate, camera.height + gate))).all(1))
        windows = np.floor(places[inside] / (WINDOW * gate)) @ (1, 1000)  # a number each: there are fewer in a row
        found = [np.empty((3, 0), np.int64)]
        for window in np.unique(windows):
            rows = inside[windows == window]
            low, high = places[rows].min(0) - gate, places[rows].max(0) + gate
            queries = np.flatnonzero(((pixels > low) & (pixels < high)).all(1))
            a, b, bits = self._matched(codes[queries], self._codes[k][rows])
            found.append(np.stack([queries[a], rows[b], bits]))
        matches = np.concatenate(found, axis=1)
        return matches[:, (np.abs(pixels[matches[0]] - places[matches[1]]) < gate).all(1)]

    def _locate(self, pixels: NDArray[np.float64], codes: NDArray[np.uint8], camera: Any, candidates: list[int], prior: Any
                ) -> Location:
        location = Location('too few matches', images=[self._ids[k] for k in candidates])
        matches = [self._matched(codes, self._codes[k]) if prior is None else self._gated(pixels, codes, camera, k, prior)
                   for k in candidates]
        queries, rows, bits = np.concatenate([np.empty((3, 0), np.int64), *matches], axis=1)
        if len(queries) < LEAST_INLIERS:
            return location
        owners = np.repeat(location.images, [m.shape[1] for m in matches])
        seen = np.concatenate([self.map.sees[self._ids[k]][m[1]] for k, m in zip(candidates, matches)])
        # A keypoint that matches a point in several images of the map counts once.
        _, first, match = np.unique(queries << 32 | seen, return_index=True, return_inverse=True)
        queries, xy, xyz = queries[first], pixels[queries[first]], self.map.places[seen[first]]
        location.matches = len(queries)
        limit = MAX_ERROR * max(camera.width, camera.height)
        surest = np.argsort(bits[first], kind='stable')[:SUREST]
        found = pycolmap.estimate_absolute_pose(xy[surest], xyz[surest], camera, {'ransac': {**RANSAC, 'max_error': limit}})
        location.reason = 'too few matches agree'
        if found is None:
            return location
        pose = found['cam_from_world']
        inliers = np.zeros(len(xy), bool)
        for n in range(3):
            if n:
                refined = refine_pose(pose, camera, xy[inliers], xyz[inliers])
                if refined is None:
                    location.reason = 'the points do not determine the pose'
                    return location
                pose, covariance = refined
            errors = np.linalg.norm(camera.img_from_cam(project(pose, xyz)) - xy, axis=1)
            inliers = errors < limit  # False for NaN, behind the camera
            location.inliers = len(np.unique(queries[inliers]))
            if location.inliers < LEAST_INLIERS + LEAST_SHARE * len(queries):
                return location
        deviation = max(LEAST_DEVIATION, np.median(errors[inliers]) / 1.1774)  # of a Rayleigh distribution
        location.covariance = deviation ** 2 * covariance
        depth = np.median(np.linalg.norm(project(pose, xyz[inliers]), axis=1))
        if not 3 * np.sqrt(np.linalg.eigvalsh(location.covariance[:3, :3])[2]) <= MAX_BOUND * depth:
            location.reason = 'the pose is uncertain'
            return location
        location.reason, location.cam_from_world = '', pose
        location.pixels, location.points = xy[inliers], xyz[inliers]
        kept = inliers[match.ravel()]
        location.hits = list(zip(owners[kept].tolist(), rows[kept].tolist()))
        return location
