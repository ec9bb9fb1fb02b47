"""Aligns an image under changed illumination with a reference: python align.py [REFERENCE IMAGE]"""
import sys

import cv2
import numpy as np

import opencv_iib
import scene

# %% Two images from one place: yours, or a rendered street at noon and, with the camera turned, at dusk.
reference, image = map(scene.read, sys.argv[1:3] if len(sys.argv) > 2 else [scene.FOLDER / f'view_{name}.jpg' for name in ('noon', 'panned')])

# %% Points, matches, refinement and a robust homography, in one call.
found = opencv_iib.alignImages(reference, image)
if not found.found:
    sys.exit(found.reason)
print(f'{len(found.matches)} matches agree; the corners are off by {found.error.max():.2f} pixels at most (standard deviation)')

# %% The image as the reference's camera would have seen it, black outside the image.
size = reference.shape[1::-1]
aligned = cv2.warpPerspective(image, found.transform, size)
inside = cv2.warpPerspective(np.ones(image.shape[:2], np.uint8), found.transform, size) > 0

# %% A picture of both images, and of alternating stripes of both: edges that continue across the stripes are aligned.
stripes = np.arange(size[0]) // 64 % 2 == 1
mixed = np.where((stripes & inside)[..., None], aligned, reference)
picture = np.hstack([reference, cv2.resize(image, size), mixed])
for n, title in enumerate(('Reference', 'Image', 'Stripes of both, aligned')):
    for colour, width in (((0, 0, 0), 5), ((255, 255, 255), 1)):
        cv2.putText(picture, title, (n * size[0] + 14, 36), cv2.FONT_HERSHEY_DUPLEX, 1, colour, width, cv2.LINE_AA)
cv2.imwrite('align.jpg', picture, [cv2.IMWRITE_JPEG_QUALITY, 80])
