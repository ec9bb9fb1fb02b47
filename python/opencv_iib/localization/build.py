"""From a COLMAP model and its images to a map."""
from __future__ import annotations

import collections
import functools
import hashlib
import itertools
import os
import sys
from typing import Any, Callable, Iterator, Optional

import numpy as np
from numpy.typing import NDArray

import opencv_iib
from opencv_iib.colmap.database import Database
from opencv_iib.colmap.features import FeatureOptions, Features
from opencv_iib.colmap.parallel import Threads
from opencv_iib.colmap.pipeline import Options, describe_images, match_pairs
from opencv_iib.colmap.progress import Progress
from opencv_iib.localization._pycolmap import pycolmap
from opencv_iib.localization.folders import new_folder
from opencv_iib.localization.geometry import fitting, graph_of, triangulate
from opencv_iib.localization.map import OWN, Map, compact, read_map, read_model, write_map

NEIGHBOURS = 20  #: images that each is matched with
MAX_TRACK = 30  #: images of a point that count as seeing the same
WORK = 'work.db'  #: in the unfinished map: what is described and matched
LEAST_FITTING = .1  #: of all matches; poses that contradict the images leave less


def covisible(model: Any) -> list[tuple[int, int]]:
    """Pairs of image ids that see the same: each image with those with which it shares most points.

    Images that share none are paired with the nearest that look the same way within 60 degrees.
    """
    ids = sorted(model.reg_image_ids())
    shared: dict[int, collections.Counter[int]] = {i: collections.Counter() for i in ids}
    for point in model.points3D.values():
        seen = sorted({element.image_id for element in point.track.elements})[:MAX_TRACK]
        for a, b in itertools.permutations(seen, 2):
            shared[a][b] += 1
    centres = np.array([model.image(i).projection_center() for i in ids])
    directions = np.array([model.image(i).viewing_direction() for i in ids])
    pairs: set[tuple[int, int]] = set()
    for n, i in enumerate(ids):
        best = [other for other, _ in shared[i].most_common(NEIGHBOURS)]
        if not best:
            distances = np.linalg.norm(centres - centres[n], axis=1)
            distances[directions @ directions[n] < .5] = np.inf
            distances[n] = np.inf
            best = [ids[other] for other in np.argsort(distances, kind='stable')[:NEIGHBOURS] if distances[other] < np.inf]
        pairs.update((min(i, other), max(i, other)) for other in best)
    return sorted(pairs)


def _match(model: Any, names: dict[str, int], images: str, database: Database, threads: int, points: int,
           log: Callable[[str], None]) -> int:
    """Describes and matches what an interrupted run has not; bytes of a code."""
    options = Options(FeatureOptions(points=points), focal=1)  # the cameras of the database are not used
    crew = Threads(threads)
    describe_images(database, images, sorted(names), options, crew, log)
    numbers = database.image_ids()
    known = {names[name]: number for name, number in numbers.items()}
    pairs = [(known[a], known[b]) for a, b in covisible(model) if a in known and b in known]
    sizes = Features(options.features).level_sizes()
    match_pairs(database, (pairs, len(pairs)), options.ratio, sizes, 'none', crew)
    return sum(sizes)


def _check_sizes(model: Any, database: Database, names: dict[str, int]) -> None:
    for name, width, height in database.sizes():
        camera = model.image(names[name]).camera
        if (camera.width, camera.height) != (width, height):
            raise ValueError(f'{name} has {width} x {height} pixels and its camera in the model {camera.width} x '
                             f'{camera.height}: give the images of which the model was made')


def _fitting_matches(model: Any, names: dict[str, int], database: Database) -> Iterator[tuple[int, int, NDArray[Any]]]:
    """Those that fit the poses, by the model's ids.

    :raises ValueError: at the end, if hardly any did.
    """
    numbers = {number: names[name] for name, number in database.image_ids().items()}
    keypoints = functools.lru_cache(1000)(lambda i: database.load_keypoints(i)[:, :2].astype(np.float64))
    all_matches = fit = 0
    for a in sorted(numbers):
        for b, pairs in database.matches_with_later(a).items():
            kept = pairs[fitting(model, numbers[a], keypoints(a)[pairs[:, 0]], numbers[b], keypoints(b)[pairs[:, 1]])]
            all_matches, fit = all_matches + len(pairs), fit + len(kept)
            yield numbers[a], numbers[b], kept
    if fit <= LEAST_FITTING * all_matches:
        raise ValueError(f'only {fit} of {all_matches} matches fit the poses: is this the model of these images?')


def build_map(model: str, images: str, out: str, points: int = 2000, workers: Optional[int] = None,
              log: Callable[[str], None] = lambda line: print(line, file=sys.stderr)) -> Map:
    """Finds and describes points in the images of a COLMAP model, triangulates them with its poses, and writes a map.

    :param model: folder of a model, binary or text; its poses and cameras are taken as they are, in any unit.
    :param images: folder that the names of the model's images are relative to.
    :param out: folder of the map. Until it is complete it is ``out.partial``; a call after an interrupted one goes on
        from there. A map that is there is replaced.
    :param points: at most so many keypoints an image.
    :param workers: threads; None for one a core.
    :param log: told of each image that cannot be read; the map is made without it.
    :raises ValueError: for a model that is damaged or not that of the images.
    :raises FileNotFoundError: naming an image that is missing.
    """
    known = read_model(model)
    names = {known.image(i).name: i for i in known.reg_image_ids()}
    missing = [name for name in sorted(names) if not os.path.isfile(os.path.join(images, name))]
    if missing:
        raise FileNotFoundError(f'{os.path.join(images, missing[0])} is missing, one of {len(missing)} of the '
                                f"model's {len(names)} images")
    poses = hashlib.sha256(repr([(n, known.image(i).cam_from_world().params.tolist()) for n, i in sorted(names.items())]
                                ).encode()).hexdigest()
    settings = {'images': os.path.abspath(images), 'points': points, 'model': poses, 'version': opencv_iib.__version__}
    with new_folder(out, OWN, resume=True) as partial:
        work = os.path.join(partial, WORK)
        with Database(work, settings, force=True) as database:
            width = _match(known, names, images, database, workers or os.cpu_count() or 1, points, log)
            _check_sizes(known, database, names)
            known.delete_all_points2D_and_points3D()
            numbers = database.image_ids()
            for name, i in names.items():
                if name in numbers:  # else it could not be read
                    places = database.load_keypoints(numbers[name])[:, :2].astype(np.float64)
                    known.image(i).points2D = pycolmap.Point2DList([pycolmap.Point2D(xy) for xy in places])
            graph = graph_of(known, _fitting_matches(known, names, database))
            progress = Progress('triangulating', len(numbers))
            triangulate(known, graph, sorted(known.reg_image_ids()), progress.step)
            progress.close()
            codes = {i: database.load_codes(numbers[name]) if name in numbers else np.empty((0, width), np.uint8)
                     for name, i in names.items()}
        if not known.num_points3D():
            raise ValueError(f'{model}: no point was seen from two places')
        compact(known, codes)
        write_map(partial, known, codes, {i: np.zeros(len(c), np.uint8) for i, c in codes.items()}, dict.fromkeys(codes, 0),
                  points)
        for name in os.listdir(partial):
            if name.startswith(WORK):
                os.unlink(os.path.join(partial, name))
    return read_map(out)
