"""Reconstructs two flights over one place, in the morning and in the evening, together: python two_flights.py [PHOTOS OUT], a folder a flight"""
import sys
import tempfile
from pathlib import Path

import cv2
import numpy as np
import pycolmap

import scene
from opencv_iib.colmap import FeatureOptions, Options, build_database

# %% The morning's photographs: yours, or seven of a drawn scene by day. The camera is known.
photos, out = map(Path, sys.argv[1:3] if len(sys.argv) > 2 else [tempfile.mkdtemp(), tempfile.mkdtemp()])
height, width = scene.PICTURES['day'].shape[:2]
camera = f'PINHOLE,{width},{height},{scene.FOCAL},{scene.FOCAL},{width / 2},{height / 2}'
options = Options(FeatureOptions(points=1500), camera=None if len(sys.argv) > 2 else camera, verify='magsac')


def fly(flight, light, shift):
    (photos / flight).mkdir()
    for k in range(7):
        cv2.imwrite(str(photos / flight / f'{k}.png'), scene.view(light, (.3 * k - 1 + shift, .1 * (k % 3)), 1.5 * (k - 3)))


if len(sys.argv) <= 2:
    fly('morning', 'day', 0)

# %% Their database.
counts = build_database(photos, out / 'database.db', options)
print(f'morning: {counts["images"]} images, {counts["verified pairs"]} pairs')

# %% In the evening: the same call adds the new images and their pairs, and keeps those of the morning.
if len(sys.argv) <= 2:
    fly('evening', 'night', .15)
counts = build_database(photos, out / 'database.db', options)
print(f'and evening: {counts["images"]} images, {counts["verified pairs"]} pairs')

# %% One model of both by pycolmap: its images of each flight, and the points that both flights saw.
models = pycolmap.incremental_mapping(out / 'database.db', photos, out, pycolmap.IncrementalPipelineOptions(random_seed=1))
model = max(models.values(), key=lambda m: m.num_reg_images())
flights = {number: image.name.split('/')[0] for number, image in model.images.items()}
seen = [{flights[element.image_id] for element in point.track.elements} for point in model.points3D.values()]
print(f'{model.num_reg_images()} images in one model; of {len(seen)} points {sum(len(each) > 1 for each in seen)} are seen by both flights')

# %% The model from above: points of both flights are white, cameras of the morning yellow, of the evening blue.
picture = np.full((480, 640, 3), 40, np.uint8)
centres = np.array([image.projection_center() for image in model.images.values()])
points = np.array([point.xyz for point in model.points3D.values()])
low = np.minimum(np.percentile(points, 1, axis=0), centres.min(axis=0))
unit = 400 / (np.maximum(np.percentile(points, 99, axis=0), centres.max(axis=0)) - low).max()
for places, colours, size in (
        (points, [(255, 255, 255) if len(each) > 1 else (120, 120, 120) for each in seen], 1),
        (centres, [(0, 200, 255) if flight == 'morning' else (255, 140, 60) for flight in flights.values()], 6)):
    for (x, _, z), colour in zip((places - low) * unit, colours):
        cv2.circle(picture, (int(40 + x), int(440 - z)), size, colour, -1, cv2.LINE_AA)
cv2.imwrite('two_flights.png', picture)
