#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0

"""Tests of the report: errors, sums and aims are right, and the page shows a missed one."""

import pathlib
import sys
import tempfile
import unittest

try:
    import cv2
    import jinja2
    import numpy as np
except ImportError as missing:
    sys.exit(f"{missing.name} is not installed")

import localization
import measure
import pictures

TURNED = np.array([0, np.sin(np.pi / 4), 0, np.cos(np.pi / 4)])  # a quarter to the right: ahead is the world's +x
LIGHTS = ["night", "dusk", "winter", "overcast"]


def row(error, degrees=0.0, **others):
    return {"name": "1", "found": "1", "bound_m": "0.03", "inliers": "9", "line_inliers": "3", "pose": (np.zeros(3), TURNED),
            "errors": np.array([error, 0, 0, degrees]), **others}


def street_row(kind, keyframes, light, **values):
    return {"data": "street", "map": kind, "keyframes": keyframes, "features": "iib", "light": light, "images": 4,
            "found": 4, "within_5cm": 100.0, "within_10cm": 100.0, "within_25cm": 100.0, "lateral_cm": 1.0,
            "longitudinal_cm": 1.0, "vertical_cm": 1.0, "mean_cm": 1.5, "median_cm": 1.5, **values}


def all_rows():
    kinds = [("depth", "1.4 m"), ("triangulated", "1.4 m"), ("depth", "2.8 m"), ("depth", "5.6 m"),
             ("depth, IMU", "1.4 m"), ("depth, IMU, one image of 4", "1.4 m")]
    return [street_row(*kind, light) for kind in kinds for light in LIGHTS]


TIMES = [{"threads": n, "processor": 90.0, "elapsed": 90.0, "features": 60.0, "retrieval": 10.0, "matching": 10.0,
          "pose": 10.0, "lines": 40.0 if lines else 0.0, "with_lines": lines} for lines in (False, True) for n in (1, 2)]


class Sums(unittest.TestCase):
    def test_errors_are_along_the_cameras_axes(self):
        angle = np.radians(30)  # to the right
        truth = (np.array([1.0, 2, 3]), np.array([0, np.sin(angle / 2), 0, np.cos(angle / 2)]))
        right, ahead = np.array([np.cos(angle), 0, -np.sin(angle)]), np.array([np.sin(angle), 0, np.cos(angle)])
        found = truth[0] + 0.1 * right + 0.2 * np.array([0, 1, 0]) + 0.3 * ahead
        np.testing.assert_allclose(measure.errors(truth, (found, truth[1])), [0.1, 0.2, 0.3, 0], atol=1e-9)
        np.testing.assert_allclose(measure.errors(truth, (truth[0], np.array([0, 0, 0, -1.0])))[3], 30)

    def test_recall_counts_images_without_a_pose(self):
        lost = {"name": "2", "found": "0", "bound_m": "0"}
        sums = measure.summary([row(0.02), row(0.04, 0.6), row(0.2, 1.0), lost])
        self.assertEqual([sums[f"within_{n}cm"] for n in (5, 10, 25)], [25, 50, 75])
        self.assertEqual((sums["images"], sums["found"]), (4, 3))
        self.assertAlmostEqual(sums["mean_cm"], 8.67)
        self.assertAlmostEqual(sums["within_bound"], 33.3)
        self.assertEqual(sums["line_inliers"], 3)
        self.assertEqual(measure.summary([lost])["within_25cm"], 0)


class Aims(unittest.TestCase):
    def test_each_light_counts(self):
        rows = all_rows()
        self.assertTrue(all(aim["reached"] for aim in localization.aims(rows, TIMES, {"images": 200, "found": 2})))
        for r in rows:
            if (r["map"], r["keyframes"], r["light"]) == ("depth", "2.8 m", "dusk"):
                r["within_5cm"] = 89.0
            if (r["map"], r["light"]) == ("depth, IMU, one image of 4", "winter"):
                r["found"] = 3
        missed = [aim for aim in localization.aims(rows, TIMES, {"images": 200, "found": 3}) if not aim["reached"]]
        self.assertEqual([aim["measured"] for aim in missed], ["89 %", "75 %", "1.5 %"])


class Page(unittest.TestCase):
    def test_drawings_have_a_scale(self):
        located = [row(0.05, name="1.0"), row(0.3, name="2.0"), {"name": "4.0"}]
        drawing = pictures.over_time(located, {"depth, IMU": located})
        width, height = drawing["size"]
        self.assertEqual(drawing["top_cm"], 50)
        self.assertEqual(drawing["dots"], [(width / 4, height * .9), (width / 2, height * .4)])
        self.assertEqual(pictures.over_time([row(0.011, name="1.0")], {})["top_cm"], 2)
        truth = {"a": (np.array([0, 0, 0.0]), TURNED), "b": (np.array([2, 0, 10.0]), TURNED)}
        above = pictures.from_above(truth, truth, [row(0)])
        self.assertAlmostEqual(above["found"][0][0], above["metre"])

    def test_shows_what_is_missed(self):
        rows = all_rows()
        rows[0]["within_5cm"] = 50.0
        aims = localization.aims(rows, TIMES, None)
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "index.html"
            localization.write_page(path, rows=rows, aims=aims, lights=[], unknown=None, times=TIMES, growth=[], info=[])
            text = path.read_text(encoding="utf-8")
        self.assertEqual(text.count('class="missed"'), 1)
        self.assertIn("<td>50.0</td>", text)

    def test_compares_points_only_with_lines(self):
        rows = [street_row(kind, "1.4 m", "night", mean_cm=mean, line_inliers=lines)
                for kind, mean, lines in (("depth", 0.71, 34.0), ("depth" + measure.POINTS_ONLY, 0.93, 0.0))]
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "index.html"
            localization.write_page(path, rows=rows, aims=[], lights=[], unknown=None, times=TIMES, growth=[], info=[])
            text = path.read_text(encoding="utf-8")
        section = text[text.index("<h2>With and without lines"):]
        table = section[:section.index("</table>")]
        self.assertEqual(table.count("<tr>"), 2)
        self.assertLess(table.index("<td>0.93</td>"), table.index("<td>0.71</td>"))
        self.assertIn("<td>34.0</td>", table)

    def test_video_can_be_read(self):
        frames = [(None, np.full((pictures.FRAME[1], 2 * pictures.FRAME[0], 3), grey, np.uint8)) for grey in (50, 200)]
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "a.webm"
            pictures.write_video(path, frames)
            video = cv2.VideoCapture(str(path))
            self.assertLess(abs(video.read()[1].mean() - 50), 5)
            self.assertLess(abs(video.read()[1].mean() - 200), 5)


if __name__ == "__main__":
    unittest.main()
