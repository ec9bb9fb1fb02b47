"""Lays an image of other light onto a reference: python align.py [REFERENCE IMAGE]"""
import sys

import cv2
import numpy as np

import opencv_iib
import scene

# %% Two images of a camera that stayed where it is: yours, or a rendered street at noon and, the camera turned, at dusk.
reference, image = map(scene.read, sys.argv[1:3] if len(sys.argv) > 2 else [scene.FOLDER / f'view_{name}.jpg' for name in ('noon', 'panned')])

# %% Points, matches, refinement and a robust homography, in one call.
found = opencv_iib.alignImages(reference, image)
if not found.found:
    sys.exit(found.reason)
print(f'{len(found.matches)} matches agree; the corners are off by {found.error.max():.2f} pixels at most (standard deviation)')

# %% What the reference's camera would have seen; black where the image does not reach.
size = reference.shape[1::-1]
aligned = cv2.warpPerspective(image, found.transform, size)
inside = cv2.warpPerspective(np.ones(image.shape[:2], np.uint8), found.transform, size) > 0

# %% A picture: both images, and stripes of both by turns. Edges that run on across the stripes are aligned.
stripes = np.arange(size[0]) // 64 % 2 == 1
mixed = np.where((stripes & inside)[..., None], aligned, reference)
cv2.imwrite('align.jpg', np.hstack([reference, image, mixed]), [cv2.IMWRITE_JPEG_QUALITY, 80])
