#!/usr/bin/env python3
"""Reconstructs photographs with COLMAP (pycolmap), by the recommended chain and by SIFT.

    python photographs.py SCENE... [--methods chain,SIFT] [--relit] [--other 'PATTERN,...'] [--points 4000] [--work DIR]

prints CSV: the rows of doc/results/photographs.csv, from which tools/pages makes the tables of doc/colmap.md.

A SCENE is a folder with images/. Cameras are compared with poses.txt (TUM: name, camera's centre, camera to world), or without it those of
two methods with each other. After a robust similarity the rows have medians of the centres' distances, in per cent of the distance to what
the camera sees, medians of the angles, and how many images are within 5 % and 5 degrees.

Methods:
- `chain`: HessianDetector and UNIVERSAL;
- `searched` and `unsearched`: the same, verified by `opencv-iib colmap`, with and without its search for other views;
- `SIFT`: COLMAP's own;
- `normalized`: OpenCV's SIFT at points of NormalizedDetector.

All use the cameras that COLMAP infers, the pairs of the chain (each image with the twenty that its codes vote for), and COLMAP's mapper;
the largest component counts. --relit darkens every second image. --other makes a map of the images whose names match no PATTERN, with poses
of the chain's reconstruction, and localizes the others. Needs pycolmap. Finished work is kept.
"""
import argparse
import csv
import fnmatch
import itertools
import sys
from pathlib import Path

import cv2
import numpy as np
import pycolmap

import opencv_iib
from opencv_iib.colmap import FeatureOptions, Options, build_database
from opencv_iib.features import to_colmap
from opencv_iib.keypoints import keypoints_to_array
from opencv_iib.localization import Localizer, build

FASTER = {'ba_global_frames_ratio': 1.2, 'ba_global_points_ratio': 1.2, 'ba_global_max_refinements': 2}


def relit(image):
    """Darkens an image: gamma 2.2, and a ramp down to a quarter across it."""
    return np.rint(255 * (image / 255) ** 2.2 * np.linspace(1, .25, image.shape[1])[:, None]).astype(np.uint8)


def normalized_sift(image, points):
    """SIFT's descriptors as COLMAP stores them (RootSIFT): square roots of the shares, times 512."""
    sift = cv2.SIFT_create(points)
    found = sorted(opencv_iib.NormalizedDetector(sift).detect(image), key=lambda point: -point.response)[:points]
    found, floats = sift.compute(image, found)
    roots = 512 * np.sqrt(floats / np.maximum(floats.sum(1, keepdims=True), 1e-9))
    return to_colmap(keypoints_to_array(found)), np.rint(roots).clip(0, 255).astype(np.uint8)


def make_database(method, images, points, folder, chain):
    """Points, matches and two-view geometries; `chain` is the chain's database."""
    file = folder / 'database.db'
    if method in ('chain', 'searched', 'unsearched'):
        verify = 'none' if method == 'chain' else 'magsac'
        build_database(str(images), str(file), Options(FeatureOptions(points=points), pairs='retrieval', verify=verify, search=method == 'searched'))
        with pycolmap.Database.open(file) as database:
            for image in database.read_all_images():
                camera = pycolmap.infer_camera_from_image(images / image.name)
                camera.camera_id = image.camera_id
                database.update_camera(camera)
        if verify == 'none':
            pycolmap.geometric_verification(file)
        return
    with pycolmap.Database.open(chain) as database:
        names = {image.image_id: image.name for image in database.read_all_images()}
        listed = [pycolmap.pair_id_to_image_pair(pair) for pair in database.read_all_matches()[0]]
    (folder / 'pairs.txt').write_text('\n'.join(f'{names[a]} {names[b]}' for a, b in listed))
    if method == 'SIFT':
        pycolmap.extract_features(file, images, camera_mode=pycolmap.CameraMode.PER_IMAGE, device='cpu',
                                  extraction_options={'sift': {'max_num_features': points}})
    else:
        pycolmap.Database.open(file).close()
        pycolmap.import_images(file, images, pycolmap.CameraMode.PER_IMAGE)
        with pycolmap.Database.open(file) as database:
            for image in database.read_all_images():
                rows, floats = normalized_sift(cv2.imread(str(images / image.name), cv2.IMREAD_GRAYSCALE), points)
                database.write_keypoints(image.image_id, rows)
                database.write_descriptors(image.image_id, pycolmap.FeatureDescriptors(pycolmap.FeatureExtractorType.SIFT, floats))
    pycolmap.match_image_pairs(file, pairing_options={'match_list_path': folder / 'pairs.txt'}, device='cpu')


def reconstruct(method, images, points, work):
    """The largest component, a pycolmap.Reconstruction, and the number of images in the other ones."""
    folder = work / method
    if not (folder / 'model').exists():
        folder.mkdir(parents=True, exist_ok=True)
        if not (folder / 'database.db').exists():
            make_database(method, images, points, folder, work / 'chain' / 'database.db')
        found = pycolmap.incremental_mapping(folder / 'database.db', images, folder,
                                             {'random_seed': 1, 'extract_colors': False, **FASTER})
        (folder / 'model').mkdir()
        max(found.values(), key=lambda model: model.num_reg_images(), default=pycolmap.Reconstruction()).write(folder / 'model')
    sizes = sorted((pycolmap.Reconstruction(each).num_reg_images() for each in folder.iterdir() if each.name.isdigit()), reverse=True)
    return pycolmap.Reconstruction(folder / 'model'), sizes[1:]


def poses(model):
    """World from camera, and the median distance of the points seen, by name."""
    found = {}
    for image in map(model.image, model.reg_image_ids()):
        seen = np.array([model.point3D(p.point3D_id).xyz for p in image.get_observation_points2D()]).reshape(-1, 3)
        away = np.linalg.norm(seen - image.projection_center(), axis=1)
        found[image.name] = image.cam_from_world().inverse(), np.median(away) if len(away) else np.nan
    return found


def true_poses(file):
    rows = [line.split() for line in file.read_text().splitlines() if line.strip() and line[0] != '#']
    return {name: pycolmap.Rigid3d(pycolmap.Rotation3d(np.array(v[3:], float)), np.array(v[:3], float)) for name, *v in rows}


def pose_errors(found, truth):
    """Errors of the poses `found` after the best similarity to `truth`: medians of centres in per cent and of angles in degrees, and how many
    are close."""
    both = sorted(set(found) & set(truth))
    true, seen = np.array([truth[n].translation for n in both]), np.array([found[n][0].translation for n in both])
    depths = np.array([found[name][1] for name in both])
    limit = {'max_error': .02 * np.median(depths) if both else 1, 'random_seed': 1}
    similarity = pycolmap.estimate_sim3d_robust(true, seen, limit) if both else None
    if similarity is None:
        return ['', '', f'0 of {len(both)}']
    moved = similarity['tgt_from_src']
    away = np.linalg.norm(moved.scale * true @ moved.rotation.matrix().T + moved.translation - seen, axis=1) / depths
    turned = np.degrees([(moved.rotation * truth[n].rotation).angle_to(found[n][0].rotation) for n in both])
    return [f'{100 * np.median(away):.2f}', f'{np.median(turned):.2f}', f'{np.count_nonzero((away < .05) & (turned < 5))} of {len(both)}']


def find_others(images, other, model, points, work):
    """A sentence about the images under changed illumination."""
    queries = [(image.name, image.camera, image.cam_from_world().inverse()) for image in map(model.image, model.reg_image_ids())
             if image.name in other]
    depths = {name: depth for name, (_, depth) in poses(model).items()}
    for image in list(map(model.image, model.reg_image_ids())):
        if image.name in other:
            model.deregister_frame(image.frame_id)
    if not (work / 'MAP').exists():
        (work / 'rest').mkdir(exist_ok=True)
        model.write(work / 'rest')
        build(str(work / 'rest'), str(images), str(work / 'MAP'), points)
    localizer, errors = Localizer(work / 'MAP', points), []
    for name, camera, truth in queries:
        found = localizer.localize(cv2.imread(str(images / name)), camera).cam_from_world
        if found is not None:
            pose = pycolmap.Rigid3d(found[:3]).inverse()
            away = np.linalg.norm(pose.translation - truth.translation)
            errors.append((away / depths[name], np.degrees(pose.rotation.angle_to(truth.rotation))))
    moved, turned = np.array(errors).reshape(-1, 2).T
    return (f'Of {len(other)} images in other light {len(queries)} are in the reconstruction, and {len(errors)} are found in a map of '
            f'the {model.num_reg_images()} others there: medians {100 * np.median(moved):.2f} % and {np.median(turned):.2f} degrees '
            f'from where it has them, {np.count_nonzero((moved < .05) & (turned < 5))} within 5 % and 5 degrees')


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('scenes', type=Path, nargs='+', metavar='SCENE')
    parser.add_argument('--methods', default='chain,SIFT,normalized', help='the chain first (%(default)s)')
    parser.add_argument('--relit', action='store_true')
    parser.add_argument('--other', help='names of the images in other light: patterns, separated by commas')
    parser.add_argument('--points', type=int, default=4000)
    parser.add_argument('--work', type=Path, default=Path('photographs'), help='folder for the results (%(default)s)')
    arguments = parser.parse_args()
    pycolmap.logging.minloglevel = pycolmap.logging.WARNING.value
    pycolmap.set_random_seed(1)
    table = csv.writer(sys.stdout, lineterminator='\n')
    table.writerow(['scene', 'method', 'registered', 'others', 'points', 'track', 'reprojection', 'centres', 'degrees', 'close'])
    for scene in arguments.scenes:
        images, work = scene / 'images', arguments.work / (scene.name + ' relit' * arguments.relit)
        if arguments.relit:
            (work / 'images').mkdir(parents=True, exist_ok=True)
            for n, path in enumerate(sorted(images.iterdir())):
                cv2.imwrite(str(work / 'images' / (path.stem + '.png')), (relit if n % 2 else np.copy)(cv2.imread(str(path))))
            images = work / 'images'
        truth, models = scene / 'poses.txt', {}
        for method in arguments.methods.split(','):
            models[method], others = reconstruct(method, images, arguments.points, work)
            model, errors = models[method], [''] * 3
            if truth.exists():
                errors = pose_errors({Path(name).stem: pose for name, pose in poses(model).items()}, true_poses(truth))
            table.writerow([work.name, method, f'{model.num_reg_images()} of {len(list(images.iterdir()))}', ' '.join(map(str, others)), model.num_points3D(),
                            f'{model.compute_mean_track_length():.2f}', f'{model.compute_mean_reprojection_error():.2f}', *errors])
            sys.stdout.flush()
        if not truth.exists():
            for a, b in itertools.combinations(models, 2):
                other = {name: pose for name, (pose, _) in poses(models[b]).items()}
                table.writerow([work.name, f'{a} and {b}', '', '', '', '', '', *pose_errors(poses(models[a]), other)])
        if arguments.other:
            other = {path.name for path in images.iterdir()
                     if any(fnmatch.fnmatch(path.name, pattern) for pattern in arguments.other.split(','))}
            print(find_others(images, other, models['chain'], arguments.points, work), file=sys.stderr)


if __name__ == '__main__':
    sys.exit(main())
