"""Aligns a year of a webcam with one day of it: python webcam_year.py [REFERENCE FOLDER]"""
import sys
import tempfile
from pathlib import Path

import cv2
import numpy as np

import scene
from opencv_iib.align import align

# %% A folder of pictures: yours, or two for each month of a rendered street, in summer and winter, at other hours and in the wind.
if len(sys.argv) > 2:
    reference, folder = Path(sys.argv[1]), Path(sys.argv[2])
else:
    folder, random = Path(tempfile.mkdtemp()), np.random.default_rng(1)
    seasons = [scene.read(scene.FOLDER / f'street_{season}.jpg') for season in ('noon', 'winter')]
    height, width = seasons[0].shape[:2]
    for month in range(12):
        for hour in (8, 16):
            turn, shift = np.radians(random.normal(0, .4)), random.normal(0, 4, 2)
            moved = np.array([[np.cos(turn), -np.sin(turn), shift[0]], [np.sin(turn), np.cos(turn), shift[1]]])
            light = (seasons[month in (0, 1, 11)] / 255.) ** random.uniform(.6, 1.8) * np.linspace(.5, 1, width)[:: 1 if hour == 8 else -1, None]
            seen = cv2.warpAffine((light * 255).astype(np.uint8), moved, (width, height), borderMode=cv2.BORDER_REFLECT)
            cv2.imwrite(str(folder / f'{month + 1}-{hour}.jpg'), seen)
    reference = folder / '6-8.jpg'

# %% All pictures as the reference's camera would see them, and a page, index.html, with a slider for each. The same call adds new pictures.
done = align(reference, [folder], 'aligned', crop=True)
found = [each for each in done if each.file]
print(f'{len(found)} of {len(done)} pictures are aligned')

# %% How far the wind moved the camera, at the pictures' centres.
for each in found[:6]:
    x, y = np.array(each.size) / 2
    at = np.reshape(each.transform, (3, 3)) @ [x, y, 1]
    print(f'{Path(each.name).name}: {np.hypot(*(at[:2] / at[2] - (x, y))):.1f} pixels, the corners known to {max(each.errors):.2f}')

# %% The year in one picture, its median, in which only moving things vanish; on the left the median before alignment.
raw = [cv2.resize(scene.read(each.name), (480, 360)) for each in found]
laid = [cv2.resize(scene.read(Path('aligned', each.file)), (480, 360)) for each in found]
medians = [np.median(pictures, axis=0).astype(np.uint8) for pictures in (raw, laid)]
sharp = [cv2.Laplacian(cv2.cvtColor(median, cv2.COLOR_BGR2GRAY), cv2.CV_64F).var() for median in medians]
print(f'the median of the aligned pictures is {sharp[1] / sharp[0]:.1f} times as sharp as that of the camera\'s')
cv2.imwrite('webcam_year.jpg', np.hstack(medians), [cv2.IMWRITE_JPEG_QUALITY, 80])
