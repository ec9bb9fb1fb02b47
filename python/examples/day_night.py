"""Matches two images of a place under different illumination: python day_night.py [A B]"""
import sys

import cv2
import numpy as np

import opencv_iib
import scene

# %% Two images: yours, or a rendered street by day and by night.
a, b = map(scene.read, sys.argv[1:3]) if len(sys.argv) > 2 else scene.PICTURES.values()

# %% 1000 points each, described by 128 bytes. All three results are arrays with a row a point.
points_a, sizes_a, codes_a = opencv_iib.detect_and_describe(a, 1000)
points_b, sizes_b, codes_b = opencv_iib.detect_and_describe(b, 1000)

# %% Mutual nearest codes that are clearly nearer than the second nearest; `distances` count different bits.
pairs, distances = opencv_iib.match(codes_a, codes_b)
from_a, from_b = points_a[pairs[:, 0]], points_b[pairs[:, 1]]

# %% Matches that agree with one geometry of the two cameras, since some matches are always wrong.
if len(pairs) < 8:
    sys.exit(f'only {len(pairs)} matches')
_, mask = cv2.findFundamentalMat(from_a, from_b, cv2.USAC_MAGSAC, .75, .999, 10000)
agree = np.ravel(mask) > 0
print(f'{len(pairs)} matches, {agree.sum()} agree')

# %% A picture of every fifth inlier.
picture = np.hstack([a, b])
for (xa, ya), (xb, yb) in zip(from_a[agree][::5], from_b[agree][::5]):
    cv2.line(picture, (round(float(xa)), round(float(ya))), (round(float(xb)) + a.shape[1], round(float(yb))), (80, 220, 40), 1, cv2.LINE_AA)
cv2.imwrite('day_night.jpg', picture)
