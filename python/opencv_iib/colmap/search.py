"""Connects images that do not match as they are, because they were taken from nearer, rotated or from the side.

Pairs of images from different groups are matched by matchViews. Points that are not keypoints yet are appended to those of the image, so
matches of ordinary pairs, which refer to keypoints by number, stay as they are.
"""
from __future__ import annotations

import collections
import functools
import os
from typing import Iterable, NamedTuple, Optional

import numpy as np

from opencv_iib._image_file import ImageFile, Masks
from opencv_iib._images import reduced, resized_mask
from opencv_iib._parallel import Threads, in_parallel
from opencv_iib._progress import Progress
from opencv_iib._two_views import MIN_INLIERS, magsac
from opencv_iib.colmap.database import Database
from opencv_iib.descriptor import IIBDescriptorExtractor
from opencv_iib.detectors import detect_rows
from opencv_iib.enums import Orientation
from opencv_iib.features import FeatureOptions
from opencv_iib.matcher import HierarchicalMatcher
from opencv_iib.views import matchViews

Pair = tuple[int, int]

CONNECTED = 30  # verified matches of two images by which COLMAP registers one after the other
VOTERS, VOTING_SIZE = 100, 640  # strongest points of a view, which vote for images; pixels of the view's longer side
SCALES, ANGLES = (1, .5, .25), range(0, 360, 30)
MOST_TILT = 1  # steep views would take three times as long
LINKS, FAILURES = 2, 3  # an image is searched no more after so many pairs that matched, or did not
MOST, MOST_SHARE = 40, 1 / 60  # searches, or their share of the ordinary pairs; a search takes as long as 15 of these
MOST_FAILURES, SHARE_FAILURES = 16, 1 / 100  # searches without a match, or their share, that end the search
AT_ONCE = 8  # pairs a round, whose choice depends on the results of earlier rounds; the same for any number of workers
SAME_POINT = 1.5  # pixels of the image with less detail: nearer points are one


class SearchResult(NamedTuple):
    """Matches of two images that agree."""
    points: tuple[np.ndarray, np.ndarray]  #: N x 2 each, pixels as COLMAP has them
    pixels: tuple[float, float]  #: for each image, how many of its pixels are one of the image with less detail
    fundamental: np.ndarray


def _read(folder: str, options: FeatureOptions, name: str) -> tuple[np.ndarray, Optional[np.ndarray], np.ndarray]:
    """ImageFile.small of an image, of the size at which it is described."""
    return ImageFile(os.path.join(folder, name)).small(options.max_size, Masks(options.mask), name)


def describe_views(folder: str, options: FeatureOptions, job: tuple[str, bool]) -> list[np.ndarray]:
    """Codes of the strongest points of an image, for each of its views, or for the image as it is."""
    name, in_all = job
    image, mask, _ = _read(folder, options, name)
    extractor = IIBDescriptorExtractor.createRecommended(VOTERS)
    extractor.setOrientation(Orientation.KEYPOINT)
    codes = []
    for scale in SCALES if in_all else SCALES[:1]:
        view = reduced(image, round(scale * min(VOTING_SIZE, max(image.shape))))
        rows = detect_rows(extractor, view, resized_mask(mask, view))
        for angle in ANGLES if in_all else ANGLES[:1]:
            rows[:, 3] = angle
            codes.append(extractor.compute(view, rows)[1])
    return codes


def search_pair(folder: str, options: FeatureOptions, names: tuple[str, str]) -> Optional[SearchResult]:
    """The matches of two images in views of them; None if there are none."""
    (image_a, mask_a, scale_a), (image_b, mask_b, scale_b) = (_read(folder, options, name) for name in names)
    found = matchViews(image_a, image_b, options.points, MOST_TILT, mask1=mask_a, mask2=mask_b)
    a, b = (found.points1 + .5) * scale_a, (found.points2 + .5) * scale_b
    inliers, matrix = magsac(a, b)
    if found.view is None or matrix is None:
        return None
    zoom = float(np.sqrt(abs(np.linalg.det(found.view[:2, :2])) * scale_b.prod() / scale_a.prod()))
    return SearchResult((a[inliers], b[inliers]), (max(1, 1 / zoom), max(1, zoom)), matrix)


def groups(images: Iterable[int], pairs: Iterable[Pair]) -> dict[int, int]:
    """The group of each image: pairs connect the images of a group."""
    above = {image: image for image in images}

    def top(image: int) -> int:
        while above[image] != image:
            above[image] = image = above[above[image]]
        return image

    for a, b in pairs:
        above[top(a)] = top(b)
    return {image: top(image) for image in above}


def candidates(folder: str, options: FeatureOptions, names: dict[int, str], group: dict[int, int], workers: Threads) -> list[Pair]:
    """Pairs of images from different groups, ordered by how many codes of a view of one vote for the other."""
    sizes = IIBDescriptorExtractor.createRecommended().levelSizes()
    progress = Progress('comparing views', 2 * len(names))
    upright: dict[int, np.ndarray] = {}
    scores: dict[Pair, float] = {}

    @functools.lru_cache(maxsize=1)
    def matcher_of_others(of: int) -> tuple[list[int], HierarchicalMatcher]:
        others, matcher = [image for image in names if group[image] != of], HierarchicalMatcher.create(sizes)
        matcher.add([upright[image] for image in others])
        return others, matcher

    images = sorted(names, key=lambda image: (group[image], image))
    for in_all in (False, True):
        jobs = ((names[image], in_all) for image in images)
        for image, (_, views) in zip(images, in_parallel(functools.partial(describe_views, folder, options), jobs, workers)):
            progress.step()
            if not in_all:
                upright[image] = views[0]
                continue
            others, matcher = matcher_of_others(group[image])
            for codes in views:
                voted = matcher.knnMatchArrays(codes)[2]
                votes, expected = np.bincount(voted[voted >= 0], minlength=len(others)), max(len(codes), 1) / len(others)
                for i in np.nonzero(votes)[0]:
                    pair = min(image, others[i]), max(image, others[i])
                    scores[pair] = max(scores.get(pair, -np.inf), (votes[i] - expected) / expected ** .5)
    progress.close()
    return sorted(scores, key=lambda pair: (-scores[pair], pair))


def _same_points(points: np.ndarray, keypoints: np.ndarray, radius: float) -> np.ndarray:
    """Numbers of the M x 2 keypoints within this radius of N x 2 points; new numbers, from M on, for points without one."""
    import cv2
    matches = cv2.BFMatcher(cv2.NORM_L2).match(np.ascontiguousarray(points, np.float32), np.ascontiguousarray(keypoints, np.float32))
    return np.array([match.trainIdx if match.distance <= radius else len(keypoints) + i for i, match in enumerate(matches)])


def add_found(database: Database, pair: Pair, found: SearchResult) -> bool:
    """Writes the matches, with new keypoints where the image may get some; False if too few matches are left."""
    sets = [database.load_keypoints(image) for image in pair]
    if not all(map(len, sets)):
        return False
    matches = np.stack([_same_points(points, keypoints[:, :2], SAME_POINT * pixels)
                        for points, keypoints, pixels in zip(found.points, sets, found.pixels)], axis=1)
    first_a, first_b = (np.unique(column, return_index=True)[1] for column in matches.T)
    kept = np.intersect1d(first_a, first_b)
    most = [len(keypoints) if image in database.finished else np.inf for image, keypoints in zip(pair, sets)]
    kept = kept[(matches[kept] < most).all(axis=1)]
    matches = matches[kept]
    if len(matches) < MIN_INLIERS:
        return False
    for k, points in enumerate(found.points):
        new = matches[:, k] >= len(sets[k])
        matches[new, k] = len(sets[k]) + np.arange(new.sum())
        rows = np.column_stack([points[kept][new], np.full((new.sum(), 2), (np.median(sets[k][:, 2]) * found.pixels[k], 0))])
        sets[k] = np.concatenate([sets[k], rows.astype(np.float32)])
    database.add_found(pair, sets, matches, found.fundamental)
    return True


def search_pairs(database: Database, folder: str, options: FeatureOptions, any_pair: bool, workers: Threads) -> None:
    """Matches pairs of images from groups that no verified pair connects, and writes their matches. An interrupted run continues.
    :param any_pair: also pairs that were not matched before."""
    names, folder = {number: name for name, number in database.image_ids().items()}, os.path.abspath(folder)
    group = groups(names, database.verified_pairs(CONNECTED))
    if len(set(group.values())) < 2 or not (any_pair or any(group[a] != group[b] for a, b in database.pairs(least=0))):
        return
    largest = collections.Counter(group.values()).most_common(1)[0][0]
    waiting = [pair for pair in candidates(folder, options, names, group, workers) if any_pair or database.has_pair(*pair)]
    links, failures = collections.Counter[int](), collections.Counter[int]()
    outside, ordinary = sum(of != largest for of in group.values()), database.counts()['pairs']
    left, failures_left = max(MOST, MOST_SHARE * ordinary, outside), max(MOST_FAILURES, SHARE_FAILURES * ordinary)
    progress = Progress('searching', None)

    def unconnected(pair: Pair) -> set[int]:
        return {image for image in pair if group[image] != largest and links[image] < LINKS and failures[image] < FAILURES}

    while left > 0 and failures_left > 0:
        chosen: list[Pair] = []
        busy: set[int] = set()
        waiting = sorted(filter(unconnected, waiting), key=lambda pair: min(links[image] for image in unconnected(pair)))
        for pair in waiting:
            if len(chosen) < AT_ONCE and not unconnected(pair) & busy:
                chosen.append(pair)
                busy |= unconnected(pair)
        if not chosen:
            break
        waiting = [pair for pair in waiting if pair not in chosen]
        new = [pair for pair in chosen if database.was_found(*pair) is None]
        jobs = ((names[a], names[b]) for a, b in new)
        for pair, (_, found) in zip(new, in_parallel(functools.partial(search_pair, folder, options), jobs, workers)):
            if found is None or not add_found(database, pair, found):
                database.add_not_found(*pair)
            progress.step()
        for pair in chosen:
            was_found = database.was_found(*pair)
            (links if was_found else failures).update(pair)
            left, failures_left = left - 1, failures_left - (not was_found)
    progress.close()
