"""Seasons: images that were found in a map add what they see in their light."""
from __future__ import annotations

import collections
import itertools
import os
from typing import Any, Iterator, Optional

import numpy as np
from numpy.typing import NDArray

from opencv_iib.colmap.images import read_grey
from opencv_iib.functions import detect_and_describe, match
from opencv_iib.localization.folders import new_folder
from opencv_iib.localization.geometry import fitting, graph_of, project, triangulate
from opencv_iib.localization.localizer import Localizer, Location
from opencv_iib.localization.map import OWN, Map, compact, read_map, write_map
from opencv_iib.localization.run import add_image, images_of, locate

APART = .1  #: two images at one place: their distance over that of what they see, plus the angle in radians
KNOWN = .5  #: share of the codes of one of the map's images at this place: with more inliers, the map knows the light
LIGHTS = 8  #: added images that a map keeps so near each other
PATIENCE = 8  #: updates in a row that look for a code and do not find it, before it is dropped
NEIGHBOURS = 10  #: added images that each is matched with
ADDED = 'updates/'  #: begins the names of added images

Found = tuple[str, Any, Location]


def _distance(pose: Any, other: Any, depth: float) -> float:
    moved = np.linalg.norm(pose.inverse().translation - other.inverse().translation) / depth
    return float(moved + np.arccos(np.clip(pose.rotation.matrix()[2] @ other.rotation.matrix()[2], -1, 1)))


def _depth(location: Location) -> float:
    return float(np.median(np.linalg.norm(project(location.cam_from_world, location.points), axis=1)))


class _Counter:
    """Which of the map's codes an update looked for, and which of them it found."""

    def __init__(self, map: Map) -> None:
        self.map = map
        self.looked = {i: np.zeros(len(codes), bool) for i, codes in map.codes.items()}
        self.found = {i: np.zeros(len(codes), bool) for i, codes in map.codes.items()}

    def add(self, camera: Any, location: Location) -> None:
        """Counts the codes that an image was compared with and that its pose has inside it."""
        for i in location.images:
            places = camera.img_from_cam(project(location.cam_from_world, self.map.places[self.map.sees[i]]))
            self.looked[i] |= ((places >= 0) & (places < (camera.width, camera.height))).all(1)
        for i, row in location.hits:
            self.found[i][row] = True

    def finish(self) -> int:
        """Drops the codes that nobody finds any more; how many."""
        dropped = 0
        for i, misses in self.map.misses.items():
            misses[self.looked[i] & (misses < PATIENCE)] += 1
            misses[self.found[i]] = 0
            if self.found[i].any():
                self.map.used[i] = self.map.updates
            for row in np.flatnonzero(misses >= PATIENCE):
                if self.map.model.image(i).points2D[int(row)].has_point3D():  # else its point has gone with another code
                    self.map.model.delete_observation(i, int(row))
                    dropped += 1
        return dropped


def _is_known(map: Map, location: Location) -> bool:
    inliers = collections.Counter(i for i, _ in location.hits)
    return any(count > KNOWN * len(map.codes[i]) and
               _distance(location.cam_from_world, map.model.image(i).cam_from_world(), _depth(location)) <= APART
               for i, count in inliers.items())


def _chosen(found: list[Found], map: Map) -> list[Found]:
    """Those in a light that the map does not know, APART from each other."""
    chosen: list[Found] = []
    for name, camera, location in found:
        if not _is_known(map, location) and all(
                _distance(location.cam_from_world, other.cam_from_world, _depth(location)) > APART for _, _, other in chosen):
            chosen.append((name, camera, location))
    return chosen


def _matches(map: Map, added: dict[int, Location]) -> Iterator[tuple[int, int, NDArray[Any]]]:
    pixels = {i: np.array([p.xy for p in map.model.image(i).points2D]).reshape(-1, 2)
              for i in {*added, *itertools.chain(*(location.images for location in added.values()))}}
    for i, location in added.items():
        near = sorted((_distance(location.cam_from_world, other.cam_from_world, _depth(location)), k)
                      for k, other in added.items() if k > i)[:NEIGHBOURS]
        for k in [*location.images, *(k for _, k in near)]:
            pairs = match(map.codes[i], map.codes[k]).pairs
            yield i, k, pairs[fitting(map.model, i, pixels[i][pairs[:, 0]], k, pixels[k][pairs[:, 1]])]


def _make_room(map: Map, added: dict[int, Location]) -> None:
    """Of more than LIGHTS added images at one place, removes the one that has not helped for longest."""
    model = map.model
    for location in added.values():
        here = [i for i in map.codes if model.image(i).has_pose and model.image(i).name.startswith(ADDED) and
                _distance(location.cam_from_world, model.image(i).cam_from_world(), _depth(location)) <= APART]
        for i in sorted(here, key=lambda i: map.used[i])[:max(0, len(here) - LIGHTS)]:
            model.deregister_frame(model.image(i).frame_id)


def update_map(map: str, images: str, camera: Any = None, out: Optional[str] = None, workers: Optional[int] = None
               ) -> dict[str, int]:
    """Localizes the images below a folder; those that show the map in a light that it does not know become a part of it.

    Their own points are matched with each other's and the map's and triangulated. Codes that eight updates in a row looked
    for and did not find are dropped, and of more than eight added images at one place the one that has not helped for
    longest, so that a map of a place does not grow for ever.

    :param map: folder of a map.
    :param camera: as localize_images takes it.
    :param out: folder for the new map; None to replace the old one.
    :return: counts of images, of those localized, of those added, and of codes dropped.
    """
    names = images_of(images)
    known = read_map(map)
    localizer = Localizer(known, known.points)
    with new_folder(out or map, OWN) as partial:
        found = [f for f in locate(localizer, images, names, camera, workers) if f[2].cam_from_world is not None]
        known.updates += 1
        counter = _Counter(known)
        for _, own, location in found:
            counter.add(own, location)
        dropped = counter.finish()
        chosen = _chosen(found, known)
        added: dict[int, Location] = {}
        for name, own, location in chosen:
            features = detect_and_describe(read_grey(os.path.join(images, name)), known.points)
            pixels = features.points.astype(np.float64) + .5
            i = add_image(known.model, f'{ADDED}{known.updates}/{name}', own, pixels, location.cam_from_world)
            added[i] = location
            known.codes[i], known.misses[i] = features.codes, np.zeros(len(features.codes), np.uint8)
            known.used[i] = known.updates
        if added:
            triangulate(known.model, graph_of(known.model, _matches(known, added)), sorted(added))
            _make_room(known, added)
        codes = {i: known.codes[i] for i in known.model.reg_image_ids()}
        kept = compact(known.model, codes)
        misses = {i: known.misses[i][rows] for i, rows in kept.items()}
        write_map(partial, known.model, codes, misses, known.used, known.points, known.updates)
    return {'images': len(names), 'localized': len(found), 'added': len(added), 'codes dropped': dropped}
