"""Where was the second image taken, seen from the first? python poses.py [A B FOCAL_LENGTH_IN_PIXELS]"""
import sys

import cv2
import numpy as np

import opencv_iib
import scene

# %% Two images and a camera: yours, or a drawn scene by day, and by night from 0.6 m to the right, turned to the left by 5 degrees.
if len(sys.argv) > 3:
    a, b = map(cv2.imread, sys.argv[1:3])
    scene.FOCAL = float(sys.argv[3])
else:
    a, b = scene.view('day', (0, 0)), scene.view('night', (.6, 0), -5)
matrix = scene.camera(a)

# %% Points and matches by the recommended chain.
points_a, _, codes_a = opencv_iib.detect_and_describe(a, 2000)
points_b, _, codes_b = opencv_iib.detect_and_describe(b, 2000)
pairs, _ = opencv_iib.match(codes_a, codes_b)
from_a, from_b = points_a[pairs[:, 0]], points_b[pairs[:, 1]]

# %% The essential matrix that most matches agree with within .75 pixels, and of its four poses the one with points in front.
essential, agree = cv2.findEssentialMat(from_a, from_b, matrix, cv2.USAC_MAGSAC, .999, .75)
count, rotation, translation, _ = cv2.recoverPose(essential, from_a, from_b, matrix, mask=agree)

# %% Two images do not tell how far the camera moved, but whereto, in the axes of the first camera: right, down, ahead.
direction = (-rotation.T @ translation).ravel()
turn = np.degrees(cv2.Rodrigues(rotation)[0].ravel())
print(f'{len(pairs)} matches, {count} agree: moved towards', direction.round(2), 'turned by', -turn.round(1), 'degrees')
