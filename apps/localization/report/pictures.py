# SPDX-License-Identifier: Apache-2.0

"""What the page shows: paths from above and errors over time as SVG coordinates, a picture and a video."""

import cv2
import numpy as np

from measure import distance, read_poses

ABOVE = (720, 180)  # sizes of the drawings
OVER_TIME = (720, 200)
FRAME = (480, 360)  # size of an image in a picture
VIDEO = (640, 240)  # noise of the night is smoothed, or the file would be large
VIDEO_RATE = 4  # frames a second


def from_above(truth, keyframes, located):
    """True path, keyframes and places found: z to the right, x up, the same scale both ways."""
    places = np.array([p for p, _ in [*truth.values(), *keyframes.values()]])[:, [2, 0]]
    low, high = places.min(axis=0) - 1, places.max(axis=0) + 1
    scale = min(np.array(ABOVE) / (high - low))

    def at(p):
        x, y = (np.array([p[2], p[0]]) - low) * scale
        return round(float(x), 1), round(ABOVE[1] - float(y), 1)

    return {"size": ABOVE, "path": " ".join("%g,%g" % at(p) for p, _ in truth.values()),
            "keyframes": [at(p) for p, _ in keyframes.values()],
            "found": [at(row["pose"][0]) for row in located if "pose" in row], "metre": round(float(scale), 1)}


def over_time(single, inertial):
    """Errors of images alone as dots; with the IMU as lines, from all images and from some. Names are times. The top is
    the first of 1, 2, 5, 10, 20 ... cm that no error reaches."""
    largest = max((distance(row) for rows in [single, *inertial.values()] for row in rows if "pose" in row), default=0)
    top = next(m * 10.0 ** e for e in range(-2, 5) for m in (1, 2, 5) if m * 10.0 ** e > largest)
    end = max(float(row["name"]) for rows in [single, *inertial.values()] for row in rows) or 1.0

    def at(row):
        return (round(float(row["name"]) / end * OVER_TIME[0], 1),
                round(OVER_TIME[1] * (1 - distance(row) / top), 1))

    lines = {kind: " ".join("%g,%g" % at(row) for row in rows if "pose" in row) for kind, rows in inertial.items()}
    return {"size": OVER_TIME, "top_cm": round(100 * top), "seconds": end,
            "dots": [at(row) for row in single if "pose" in row], "lines": lines}


def pairs(street, overlays, light):
    """For each image with a pose, the nearest keyframe beside the image with the points that agree."""
    keyframes = read_poses(street.mapped / "poses.txt")
    for row in street.single[light]:
        if "pose" in row:
            nearest = min(keyframes, key=lambda name: np.linalg.norm(keyframes[name][0] - row["pose"][0]))
            day = cv2.imread(str(street.mapped / "images" / f"{nearest}.png"))
            now = cv2.imread(str(overlays / light / f"{row['name']}.matches.png"))
            pair = np.hstack([cv2.resize(p, FRAME, interpolation=cv2.INTER_AREA) for p in (day, now)])
            text = f"{light}, {row['inliers']} points agree, {100 * distance(row):.1f} cm off"
            cv2.putText(pair, text, (FRAME[0] + 8, 20), cv2.FONT_HERSHEY_SIMPLEX, 0.5, (255, 255, 255), 1, cv2.LINE_AA)
            yield row, pair


def write_picture(path, every_pair):
    """The pair of the image with the median number of points that agree."""
    in_order = sorted(every_pair, key=lambda pair: int(pair[0]["inliers"]))
    cv2.imwrite(str(path), in_order[len(in_order) // 2][1], [cv2.IMWRITE_JPEG_QUALITY, 75])


def write_video(path, every_pair):
    """VP9, which browsers play."""
    writer = cv2.VideoWriter(str(path), cv2.VideoWriter_fourcc(*"VP90"), VIDEO_RATE, VIDEO)
    if not writer.isOpened():
        raise RuntimeError(f"{path} cannot be written: this OpenCV has no VP9")
    for _, pair in every_pair:
        writer.write(cv2.resize(pair, VIDEO, interpolation=cv2.INTER_AREA))
    writer.release()
