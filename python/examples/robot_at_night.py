"""Localizes a robot by night in a map that was made by day: python robot_at_night.py"""
import tempfile
from pathlib import Path

import cv2
import numpy as np
import pycolmap

import scene
from opencv_iib.colmap import FeatureOptions, Options, build_database
from opencv_iib.localization import Camera, Localizer, build

# %% By day: images of a drawn street, and their places in metres, right and down.
folder = Path(tempfile.mkdtemp())
images = folder / 'images'
height, width = scene.PICTURES['day'].shape[:2]
camera = Camera('PINHOLE', width, height, (scene.FOCAL, scene.FOCAL, width / 2, height / 2))
way = {f'{k}.png': (.25 * k - 1, .1 * (k % 3)) for k in range(9)}
images.mkdir()
for name, place in way.items():
    cv2.imwrite(str(images / name), scene.view('day', place))

# %% Poses by pycolmap, from our matches, and its unit in metres, from the known places.
text = ','.join(map(str, (camera.model, width, height, *camera.params)))
build_database(images, folder / 'database.db', Options(FeatureOptions(points=1500), camera=text, verify='magsac'))
models = pycolmap.incremental_mapping(folder / 'database.db', images, folder, pycolmap.IncrementalPipelineOptions(random_seed=1))
number, model = max(models.items(), key=lambda item: item[1].num_reg_images())
centres = np.array([[*image.projection_center(), 1] for image in model.images.values()])
to_metres = np.linalg.lstsq(centres, np.array([way[image.name] for image in model.images.values()]), rcond=None)[0]
unit = np.linalg.norm(to_metres[:3], axis=0).mean()

# %% A map with codes that the night does not change.
print(build(folder / str(number), images, folder / 'map'))

# %% By night: each image is first searched near the last one.
localizer, last, errors, places = Localizer(folder / 'map'), None, [], []
for k in range(20):
    at = (.09 * k - .9, .05)
    location = localizer.localize(scene.view('night', at), camera, last)
    last = location.cam_from_world
    if last is None or location.covariance is None:
        print(f'{k}: {location.reason}')
        continue
    places.append([*(-last[:3, :3].T @ last[:3, 3]), 1] @ to_metres)
    errors.append(np.linalg.norm(places[-1] - at))
    sigma = unit * np.sqrt(np.trace(location.covariance[:3, :3]))
    if k % 5 == 0:
        print(f'{k}: {location.inliers} matches agree, off by {100 * errors[-1]:.1f} cm, estimated +-{100 * sigma:.1f} cm')

# %% Errors.
print(f'{len(errors)} of 20 places are found, half of them within {100 * np.median(errors):.1f} cm')

# %% The last image with the map's points, and the path: found places as circles of five centimetres, the true path as a line.
picture = np.vstack([scene.view('night', at), np.full((120, width, 3), 40, np.uint8)])
for x, y in location.pixels:
    cv2.circle(picture, (round(x), round(y)), 3, (80, 220, 80), 1, cv2.LINE_AA)
per_metre = .9 * width / 1.8
for x, y in places:
    cv2.circle(picture, (round(width / 2 + x * per_metre), round(height + 60 + (y - .05) * per_metre)), round(.05 * per_metre), (80, 220, 80), 1, cv2.LINE_AA)
cv2.line(picture, (round(.05 * width), height + 60), (round(width / 2 + at[0] * per_metre), height + 60), (255, 255, 255), 1)
cv2.imwrite('robot_at_night.jpg', picture)
