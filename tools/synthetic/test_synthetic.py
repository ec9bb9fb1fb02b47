#!/usr/bin/python3
"""Tests of the renderer against known geometry: depth, labels, cameras, files, repeatability."""

import importlib.util
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest
import unittest.mock

for needed in ("cv2", "numpy", "povray"):
    if not (shutil.which(needed) or importlib.util.find_spec(needed)):
        sys.exit(f"{needed} is not installed: nothing can be rendered")

import cv2
import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
import render
import scenes
import views

SIZE = (160, 120)
WALL, WINDOW, LAMP = 3, 4, 8


def setUpModule():
    scenes.SCENES["plane"] = scenes.Scene(0.8, (0, 1, 0, 0, 0), [], ["noon"])


def render_plane(mode, pose):
    return render.povray("plane", mode, "noon", pose, SIZE)


def project(point, pose):
    """Pixel and depth of a point in the scene file's axes, by the camera of scenes.py."""
    camera = scenes.extrinsics(pose) @ [point[0], -point[1], point[2], 1]
    return (scenes.intrinsics("plane", *SIZE) @ camera)[:2] / camera[2], camera[2]


class KnownGeometry(unittest.TestCase):
    poses = [(0, 1, 0, 0, 0), (0.3, 0.7, 1.0, -8.0, -3.0), (-3.0, 2.0, 0.5, 25.0, -9.0, 20.0)]

    def test_depth_of_a_plane_is_its_distance_along_the_axis(self):
        for pose in self.poses:
            depth = render_plane(render.DEPTH, pose)
            self.assertEqual(depth.dtype, np.uint16)
            wall = render_plane(render.LABELS, pose) == WALL
            # the intersection of each pixel's ray with z = 10
            inverse = np.linalg.inv(scenes.intrinsics("plane", *SIZE))
            x, y = np.meshgrid(range(SIZE[0]), range(SIZE[1]))
            rays = np.stack([x, y, np.ones_like(x)], axis=-1) @ inverse.T
            rotation = scenes.extrinsics(pose)[:, :3]
            expected = (10 - pose[2]) / (rays @ rotation[:, 2])
            self.assertGreater(wall.sum(), 0.5 * wall.size)
            error = np.abs(depth * render.DEPTH_SCALE - expected)[wall]
            self.assertLess(error.max(), render.DEPTH_SCALE)

    def test_a_point_appears_where_the_camera_projects_it(self):
        for pose in self.poses:
            pixel, distance = project((-2, 1, 6), pose)
            lamp = render_plane(render.LABELS, pose) == LAMP
            rows, columns = np.nonzero(lamp)
            self.assertGreater(len(rows), 0)
            np.testing.assert_allclose([columns.mean(), rows.mean()], pixel, atol=0.35)
            nearest = render_plane(render.DEPTH, pose)[lamp].min() * render.DEPTH_SCALE
            self.assertAlmostEqual(nearest, distance - 0.1, delta=0.015)

    def test_rendering_is_repeated_after_a_crash(self):
        with tempfile.TemporaryDirectory() as folder:
            program, crashed = pathlib.Path(folder) / "povray", pathlib.Path(folder) / "crashed"
            program.write_text(f'#!/bin/sh\n[ -e {crashed} ] || {{ touch {crashed}; kill -SEGV $$; }}\n' f'exec {shutil.which("povray")} "$@"\n')
            program.chmod(0o755)
            with unittest.mock.patch.dict("os.environ", PATH=f"{folder}:/usr/bin:/bin"):
                depth = render_plane(render.DEPTH, (0, 1, 0, 0, 0))
            self.assertTrue(crashed.exists())
        self.assertEqual(depth.shape, SIZE[::-1])

    def test_label_areas(self):
        pose = self.poses[0]
        labels = render_plane(render.LABELS, pose)
        self.assertEqual(set(np.unique(labels)), {WALL, WINDOW, LAMP})
        focal = scenes.intrinsics("plane", *SIZE)[0, 0]
        # the front of the box, 2 m x 1 m at 9 m, and the visible part of its left side
        front = 2 * focal / 9 * 1 * focal / 9
        side = (1 / 9 - 1 / 10) * focal * 0.5 * (1 / 9 + 1 / 10) * focal
        self.assertAlmostEqual((labels == WINDOW).sum(), front + side, delta=0.03 * front)
        ball = np.pi * (0.1 * focal) ** 2 / 36
        self.assertAlmostEqual((labels == LAMP).sum(), ball, delta=3)


class Scenes(unittest.TestCase):
    """Random details must be the same under every light and in every mode."""

    def test_light_changes_no_geometry_and_the_sky_has_no_depth_or_label(self):
        for name in ("street", "room", "facade", "terrain"):
            scene = scenes.SCENES[name]
            self.assertGreaterEqual(len(scene.lights), 8)
            self.assertEqual(scene.lights[0], "noon")
            depth, labels = (render.povray(name, mode, "noon", scene.still, (80, 60)) for mode in (render.DEPTH, render.LABELS))
            for light in ("night", scene.lights[-1]):
                again = render.povray(name, render.DEPTH, light, scene.still, (80, 60))
                np.testing.assert_array_equal(depth, again, f"{name}, {light}")
            np.testing.assert_array_equal(depth == 0, labels == 0, name)
            self.assertGreater(len(np.unique(labels)), 8)
            self.assertGreater(len(np.unique(depth)), 300)

    def test_a_seed_makes_a_different_but_repeatable_instance(self):
        for name in scenes.SCENES.keys() - {"plane"}:
            still = scenes.SCENES[name].path[1]
            first, second, again = (render.povray(name, render.LABELS, "noon", still, (80, 60), seed=seed) for seed in (0, 1, 1))
            np.testing.assert_array_equal(second, again, name)
            self.assertGreater((first != second).mean(), 0.02, name)

    def test_views_are_near_the_walk_in_the_evaluations_layout(self):
        with tempfile.TemporaryDirectory() as folder:
            out = pathlib.Path(folder)
            tasks, alone = (list(views.plan(out, ["room"], [1, 2], (64, 48), depth=depth)) for depth in (True, False))
            self.assertEqual(len(alone), 2 * (views.MAP_VIEWS + views.VIEWS * len(views.LIGHTS)))
            for image, depth in zip(tasks[::2], tasks[1::2]):  # of each image the depth at its place
                self.assertEqual((depth.mode, depth.pose.tolist(), depth.seed), (render.DEPTH, image.pose.tolist(), image.seed))
                self.assertEqual(depth.target, image.target.parents[1] / "depth" / image.target.name)
            walked = scenes.walk(scenes.SCENES["room"].path, 100)
            for task in tasks:
                self.assertLess(np.abs(walked[:, :3] - task.pose[:3]).max(axis=1).min(), 0.41)
                self.assertTrue((task.target.parents[1] / "poses.txt").exists())
            self.assertNotEqual(alone[-1].pose.tolist(), alone[len(alone) // 2 - 1].pose.tolist())
            steps = [task.pose.tolist() for task in views.plan(out / "walk", ["room"], [0], (64, 48), steps=4)]
            self.assertEqual(steps, scenes.walk(scenes.SCENES["room"].path, 4).tolist() * (1 + len(views.LIGHTS)))


class Command(unittest.TestCase):
    """The command with one scene of 24 x 18 pixels."""

    def render(self, folder, *options):
        return subprocess.run([sys.executable, HERE / "render.py", folder, "--scenes", "facade",
                               "--size", "24", "18", "--jobs", "1", *options], capture_output=True, text=True)

    def test_layout_cameras_resuming_and_repeatability(self):
        with tempfile.TemporaryDirectory() as folder:
            out = pathlib.Path(folder)
            done = self.render(out)
            self.assertEqual(done.returncode, 0, done.stderr)
            still = out / "lights" / "facade"
            lights = scenes.SCENES["facade"].lights
            first = cv2.imread(str(still / "1.png"))
            for k in range(2, len(lights) + 1):
                other = cv2.imread(str(still / f"{k}.png"))
                self.assertEqual(other.shape, (18, 24, 3))
                difference = np.abs(other.astype(int) - first).mean()
                self.assertGreater(difference, 8, f"{lights[k - 1]} looks like noon")
                np.testing.assert_array_equal(np.loadtxt(still / f"H_1_{k}"), np.eye(3))
            count = len(lights)
            depth = cv2.imread(str(still / "depth" / f"{count}.png"), cv2.IMREAD_UNCHANGED)
            self.assertEqual((depth.dtype, depth.shape), (np.uint16, (18, 24)))
            labels = cv2.imread(str(still / "labels" / f"{count}.png"), cv2.IMREAD_UNCHANGED)
            self.assertEqual((labels.dtype, labels.shape), (np.uint8, (18, 24)))
            self.assertIn("PINHOLE 24 18", (still / "cameras.txt").read_text())
            self.assertEqual(len((still / "poses.txt").read_text().splitlines()), 1 + count)
            # missing files are rendered again with the same bytes; existing files are unchanged
            bytes_before = (still / "4.png").read_bytes()
            (still / "4.png").unlink()
            stamp = (still / "1.png").stat().st_mtime_ns
            self.assertEqual(self.render(out).returncode, 0)
            self.assertEqual((still / "4.png").read_bytes(), bytes_before)
            self.assertEqual((still / "1.png").stat().st_mtime_ns, stamp)
            # another size is refused, since it would mix two sets in one folder
            mixed = self.render(out, "--size", "32", "24")
            self.assertEqual(mixed.returncode, 1)
            self.assertIn("choose another folder", mixed.stderr)
            self.assertNotIn("Traceback", mixed.stderr)


if __name__ == "__main__":
    unittest.main()
