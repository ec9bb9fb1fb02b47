"""Two images matched, as a picture."""
from __future__ import annotations

from typing import Any

from opencv_iib.colmap.features import FeatureOptions, Features
from opencv_iib.colmap.images import read_grey, write_picture
from opencv_iib.colmap.verify import magsac
from opencv_iib.functions import match
from opencv_iib.keypoints import array_to_keypoints


def demo(image_a: str, image_b: str, out: str, options: FeatureOptions = FeatureOptions(points=1000)) -> str:
    """Matches two images by the recommended chain and draws what agrees with one epipolar geometry, 100 at most.

    :param out: picture to write.
    :return: a line that says how many matches there are.
    :raises ValueError: for a file that is no image, or one that cannot be written.
    """
    import cv2
    features = Features(options)
    images, rows, codes = [], [], []
    for path in (image_a, image_b):
        try:
            images.append(read_grey(path))
        except ValueError as e:
            raise ValueError(f'{path}: {e}') from None
        keypoints, descriptors = features(images[-1])
        rows.append(keypoints)
        codes.append(descriptors)
    pairs, _ = match(codes[0], codes[1])
    agree, _ = magsac(rows[0][pairs[:, 0], :2], rows[1][pairs[:, 1], :2])
    good = [cv2.DMatch(a, b, 0) for a, b in pairs[agree].tolist()]
    picture: Any = cv2.drawMatches(  # type: ignore[call-overload,unused-ignore]
        images[0], array_to_keypoints(rows[0]), images[1], array_to_keypoints(rows[1]),
        good[::len(good) // 100 + 1], None, flags=2)
    write_picture(out, picture)
    return f'{out}: {len(pairs)} matches, {len(good)} agree with one epipolar geometry'
