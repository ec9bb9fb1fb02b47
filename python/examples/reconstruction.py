"""A 3-D model of a folder of images, as COLMAP makes it: python reconstruction.py [IMAGES OUT]"""
import sys
import tempfile
from pathlib import Path

import cv2
import pycolmap

import scene
from opencv_iib.colmap import FeatureOptions, Options, build_database

# %% A folder of images: yours, or nine views of a drawn scene, every other one by night.
if len(sys.argv) > 2:
    images, out, options = Path(sys.argv[1]), Path(sys.argv[2]), Options(FeatureOptions(points=4000))
    out.mkdir(parents=True, exist_ok=True)
else:
    images = Path(tempfile.mkdtemp())
    out, options = images, Options(FeatureOptions(points=1000), focal=scene.FOCAL, share_cameras=True, verify='magsac')
    for k in range(9):
        cv2.imwrite(str(images / f'{k}.png'), scene.view(('day', 'night')[k % 2], (.25 * k - 1, .1 * (k % 3)), 1.5 * (k - 4)))

# %% Points, codes, and verified matches of all pairs, in a database for COLMAP and pycolmap. An interrupted run continues.
build_database(str(images), str(out / 'database.db'), options)

# %% Poses and points by pycolmap. The largest of the models is kept.
models = pycolmap.incremental_mapping(out / 'database.db', images, out / 'models', pycolmap.IncrementalPipelineOptions(random_seed=1))
model = max(models.values(), key=lambda m: m.num_reg_images())
print(model.summary())

# %% Where each image was taken, in the model's own unit.
for image in sorted(model.images.values(), key=lambda image: image.name):
    print(image.name, image.projection_center().round(2))
