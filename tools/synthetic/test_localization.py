#!/usr/bin/python3
"""Tests of localization.py: poses, cameras and IMU readings are consistent, and an interrupted run covers the whole walk."""

import pathlib
import sys
import tempfile
import unittest

try:
    import cv2
    import numpy as np
except ImportError as missing:
    sys.exit(f"{missing.name} is not installed")

import localization
from scenes import extrinsics


def rotation(x, y, z, w):
    axis = np.array([x, y, z])
    angle = 2 * np.arctan2(np.linalg.norm(axis), w)
    return cv2.Rodrigues(axis / max(np.linalg.norm(axis), 1e-12) * angle)[0]


class Poses(unittest.TestCase):
    def test_tum_is_the_inverse_of_the_extrinsics(self):
        poses = localization.visit(np.array([0.0, 3.7, 14.5]))
        lines = localization.tum(["a", "b", "c"], poses).splitlines()
        self.assertEqual([line.split()[0] for line in lines[1:]], ["a", "b", "c"])
        for line, pose in zip(lines[1:], poses):
            values = [float(value) for value in line.split()[1:]]
            turn, centre = rotation(*values[3:]), np.array(values[:3])
            back = extrinsics(pose)
            np.testing.assert_allclose(back[:, :3] @ turn, np.eye(3), atol=1e-7)
            np.testing.assert_allclose(back[:, :3] @ centre + back[:, 3], 0, atol=1e-6)

    def test_imu_readings_integrate_to_the_path(self):
        rows = np.loadtxt(localization.imu(4).splitlines()[1:], delimiter=",")
        times = rows[:, 0] * 1e-9
        for start in range(0, len(rows) - 200, 200):  # integrates each second from the path's exact state
            before, here, after = (localization.camera_to_world(pose) for pose in localization.visit(times[start] + np.array([-1e-4, 0, 1e-4])))
            place, velocity, turn = here[:3, 3].copy(), (after - before)[:3, 3] / 2e-4, here[:3, :3].copy()
            for k in range(start, start + 200):
                step = times[k + 1] - times[k]
                rate = rows[k:k + 2, 1:4].mean(axis=0) - localization.GYRO_BIAS
                force = rows[k:k + 2, 4:7].mean(axis=0) - localization.ACCEL_BIAS
                acceleration = turn @ cv2.Rodrigues(rate * step / 2)[0] @ force + [0, 9.81, 0]
                place += velocity * step + acceleration * step ** 2 / 2
                velocity += acceleration * step
                turn = turn @ cv2.Rodrigues(rate * step)[0]
            end = localization.camera_to_world(localization.visit(times[start + 200:start + 201])[0])
            self.assertLess(np.linalg.norm(place - end[:3, 3]), 0.02)  # the noise of a second leaves about 2 mm
            self.assertLess(np.linalg.norm(turn - end[:3, :3]), 0.002)


class Plan(unittest.TestCase):
    def test_spread_is_a_permutation_with_coarse_steps_first(self):
        for count in (2, 7, 30):
            self.assertEqual(sorted(localization.spread(count)), list(range(count)))
        self.assertEqual(localization.spread(8)[:4], [0, 4, 2, 6])

    def test_files_and_tasks(self):
        with tempfile.TemporaryDirectory() as folder:
            out = pathlib.Path(folder)
            tasks = list(localization.plan(out, 3, 5, ["night", "fog"], (64, 48)))
            targets = {str(task.target.relative_to(out)) for task in tasks}
            self.assertEqual(len(targets), len(tasks))
            self.assertEqual(len(tasks), 3 + 5 * 2)
            names = [line.split()[0] for line in (out / "night" / "poses.txt").read_text().splitlines()[1:]]
            for name in names:
                self.assertIn(f"night/images/{name}.png", targets)
            self.assertEqual(float(names[-1]), localization.DURATION)
            # the centre of 64 x 48 pixels in COLMAP's convention
            self.assertEqual((out / "map" / "cameras.txt").read_text().split()[-2:], ["32", "24"])
            with self.assertRaisesRegex(RuntimeError, "choose another folder"):
                list(localization.plan(out, 3, 5, ["night"], (32, 24)))


if __name__ == "__main__":
    unittest.main()
