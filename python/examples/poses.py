"""Finds the pose of the second camera relative to the first: python poses.py [A B FOCAL_LENGTH_IN_PIXELS]"""
import sys

import cv2
import numpy as np

import opencv_iib
import scene

# %% Two images and a camera: yours, or a drawn scene by day, and by night from 0.6 m to the right, turned to the left by 5 degrees.
if len(sys.argv) > 3:
    a, b = map(scene.read, sys.argv[1:3])
    scene.FOCAL = float(sys.argv[3])
else:
    a, b = scene.view('day', (0, 0)), scene.view('night', (.6, 0), -5)
matrix = scene.camera(a)

# %% Points and matches by the recommended chain, propagated to further matches, and refined to a fraction of a pixel.
points_a, sizes_a, codes_a = opencv_iib.detect_and_describe(a, 4000)
points_b, sizes_b, codes_b = opencv_iib.detect_and_describe(b, 4000)
pairs, _ = opencv_iib.match(codes_a, codes_b)
rows_a, rows_b = np.column_stack([points_a, sizes_a]), np.column_stack([points_b, sizes_b])
found = opencv_iib.propagateMatches(a, rows_a, b, rows_b, pairs)

# %% Wrong matches of a repeating pattern propagate too: propagate a second time, from the inliers of a first pose alone.
first = opencv_iib.findRelativePose(found.points1[:len(pairs)], found.points2[:len(pairs)], matrix, matrix)
again = opencv_iib.propagateMatches(a, rows_a, b, rows_b, pairs[first.inliers.ravel() > 0])

# %% The pose with more inliers, at one scale, since a larger scale has more inliers. The matrices of two cameras may differ.


def pose_of(tried, scale=0):
    return opencv_iib.findRelativePose(tried.points1, tried.points2, matrix, matrix, scale)


pose, matches = max(((pose_of(tried), tried) for tried in (found, again)),
                    key=lambda both: (both[0].found, int(pose_of(both[1], .25).inliers.sum())))
if not pose.found:
    sys.exit(pose.reason)

# %% The direction of the movement in the axes of the first camera: right, down, ahead. Its length cannot be found from two images.
direction = (-pose.R.T @ pose.t).ravel()
turn = np.degrees(cv2.Rodrigues(pose.R)[0].ravel())
errors = np.degrees(np.sqrt(np.diag(pose.covariance)))
print(f'{len(matches.matches)} matches, {pose.inliers.sum()} agree: moved towards', direction.round(2), 'turned by', -turn.round(2), 'degrees,',
      f'with standard deviations of {np.linalg.norm(errors[3:]):.2f} and {np.linalg.norm(errors[:3]):.2f} degrees')
