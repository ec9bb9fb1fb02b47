"""Draws two images side by side, with lines between their matches."""
from __future__ import annotations

from typing import Any, Sequence

import numpy as np

from opencv_iib._images import import_cv2

HALF_WIDTH, MAX_HEIGHT, MAX_DRAWN, CAPTION_HEIGHT = 640, 1280, 100, 44  # pixels of the picture; at most so many lines
GOOD, OTHER, PAPER, INK = (150, 220, 60), (40, 90, 255), (32, 28, 26), (235, 235, 235)  # distinct for colour-blind eyes too
Caption = list[tuple[str, tuple[int, int, int]]]  # texts and their colours


def draw(images: Sequence[np.ndarray], points_a: np.ndarray, points_b: np.ndarray, good: np.ndarray, caption: Caption) -> np.ndarray:
    """Both images side by side under a caption, with a line for each match, good ones above the others."""
    cv2 = import_cv2()
    scales = [min(HALF_WIDTH / image.shape[1], MAX_HEIGHT / image.shape[0]) for image in images]
    halves = [cv2.resize(image, [max(1, round(side * scale)) for side in image.shape[1::-1]], interpolation=cv2.INTER_AREA)
              for image, scale in zip(images, scales)]
    canvas: Any = np.full((CAPTION_HEIGHT + max(map(len, halves)), 2 * HALF_WIDTH, 3), PAPER, np.uint8)
    for side, half in enumerate(halves):
        canvas[CAPTION_HEIGHT:CAPTION_HEIGHT + len(half), side * HALF_WIDTH:side * HALF_WIDTH + half.shape[1]] = half
    drawn = np.linspace(0, len(good), min(len(good), MAX_DRAWN), endpoint=False).astype(int)  # evenly, since matches are ordered by strength
    ends = [np.rint(points * scale + (side * HALF_WIDTH, CAPTION_HEIGHT)).astype(int)
            for side, (points, scale) in enumerate(zip((points_a, points_b), scales))]
    for colour, opacity, wanted in ((OTHER, .6, False), (GOOD, .8, True)):
        lines = canvas.copy()
        for k in drawn[good[drawn] == wanted]:
            a, b = (tuple(map(int, end[k])) for end in ends)
            cv2.line(lines, a, b, colour, 1, cv2.LINE_AA)
            cv2.circle(canvas, a, 2, colour, cv2.FILLED, cv2.LINE_AA)
            cv2.circle(canvas, b, 2, colour, cv2.FILLED, cv2.LINE_AA)
        canvas = cv2.addWeighted(lines, opacity, canvas, 1 - opacity, 0)  # so that the images stay visible
    at = 14
    for text, colour in caption:
        cv2.putText(canvas, text, (at, CAPTION_HEIGHT - 15), cv2.FONT_HERSHEY_DUPLEX, .68, colour, 1, cv2.LINE_AA)
        at += cv2.getTextSize(text, cv2.FONT_HERSHEY_DUPLEX, .68, 1)[0][0]
    return canvas
