# SPDX-License-Identifier: Apache-2.0

"""Runs iib_map and iib_localize on what tools/synthetic/localization.py rendered and on photographs, and sums up."""

import csv
import io
import os
import pathlib
import resource
import shutil
import subprocess
import time

import cv2
import numpy as np

METHODS = {"iib": "recommended chain", "own": "ORB and AKAZE, normalized", "sift": "SIFT, normalized"}
LIMITS = [(0.05, 0.5), (0.10, 1.0), (0.25, 2.0)]  # metres, degrees
STAGES = ["features", "retrieval", "matching", "pose", "lines"]
POINTS_ONLY = ", points only"  # after the kind of map, of a run without lines
SPACINGS = {1: "1.4 m", 2: "2.8 m", 4: "5.6 m"}  # between keyframes, by the step among the rendered ones
DROPPED = 4  # of so many images, one is kept
ROUNDS = 3  # of timing, of which the quickest counts
UNKNOWN = 200  # photographs of other places
NOTHING_FOUND = 3  # status of iib_localize
FIRST = 6  # images that iib_localize checks the focal length with


def read_poses(path):
    """{name: (position, quaternion)} of a trajectory in TUM's format."""
    poses = {}
    for line in path.read_text().splitlines():
        if line and not line.startswith("#"):
            name, *values = line.split()
            values = np.array(values, float)
            poses[name] = (values[:3], values[3:])
    return poses


def rotation(quaternion):
    x, y, z, w = quaternion
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])


def errors(truth, found):
    """Errors in metres to the right, down and ahead of the camera, and degrees."""
    ahead = rotation(truth[1]).T @ (found[0] - truth[0])
    turn = 2 * np.degrees(np.arccos(min(1.0, abs(np.dot(truth[1], found[1])))))
    return np.append(np.abs(ahead), turn)


def seconds():
    """Now, and the processor time of the programs that have ended."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return np.array([time.perf_counter(), used.ru_utime + used.ru_stime])


def distance(row):
    """The error of a position in metres."""
    return float(np.linalg.norm(row["errors"][:3]))


class Programs:
    def __init__(self, folder, out):
        self.folder, self.out = folder, out

    def run(self, name, *arguments, threads=None):
        """What the program prints. Threads are as many as the processors that it may use."""
        processors = sorted(os.sched_getaffinity(0))[:threads]
        done = subprocess.run([str(self.folder / name), *map(str, arguments)], stdout=subprocess.PIPE,
                              text=True, preexec_fn=lambda: os.sched_setaffinity(0, processors))
        if done.returncode not in (0, NOTHING_FOUND):
            done.check_returncode()
        return done.stdout

    def build(self, name, images, cameras, poses, features, depth=None):
        target = self.out / "maps" / name
        target.parent.mkdir(parents=True, exist_ok=True)
        self.run("iib_map", "build", "--images", images, "--cameras", cameras, "--poses", poses, "--features", features,
                 "--out", target, *(["--depth", depth] if depth else []))
        return target

    def localize(self, map_folder, name, images, cameras, truth, *options, threads=None):
        """Rows of frames.csv with the errors of those that have a pose. The name is that of a folder for the results."""
        target = self.out / "located" / map_folder.name / name
        target.mkdir(parents=True, exist_ok=True)
        self.run("iib_localize", "--map", map_folder, "--images", images, "--cameras", cameras, "--out", target, *options,
                 threads=threads)
        found = read_poses(target / "trajectory.txt")
        with open(target / "frames.csv", encoding="utf-8") as stream:
            rows = list(csv.DictReader(stream))
        for row in rows:
            if row["name"] in found:
                row["pose"] = found[row["name"]]
                row["errors"] = errors(truth[row["name"]], found[row["name"]]) if truth else None
        return rows


def summary(rows):
    """What the page tells of one set of images in one map."""
    found = [row for row in rows if "pose" in row]
    measured = np.array([row["errors"] for row in found]).reshape(-1, 4)
    distances = np.linalg.norm(measured[:, :3], axis=1)
    result = {"images": len(rows), "found": len(found)}
    for metres, degrees in LIMITS:
        within = np.count_nonzero((distances <= metres) & (measured[:, 3] <= degrees))
        result[f"within_{metres * 100:.0f}cm"] = round(100 * within / len(rows), 1)
    if found:
        for name, value in zip(("lateral", "vertical", "longitudinal"), measured[:, :3].mean(axis=0)):
            result[f"{name}_cm"] = round(100 * value, 2)
        result["mean_cm"] = round(100 * float(np.mean(distances)), 2)
        result["median_cm"] = round(100 * float(np.median(distances)), 2)
        result["line_inliers"] = round(float(np.mean([int(row["line_inliers"]) for row in found])), 1)
    alone = [(distance(row), float(row["bound_m"])) for row in found if row["found"] == "1"]
    if alone:
        result["within_bound"] = round(100 * float(np.mean([error <= bound for error, bound in alone])), 1)
    return result


class Street:
    """The rendered street: its map, and images in other lights."""

    def __init__(self, programs, data, rows):
        self.programs, self.data, self.rows = programs, data, rows
        self.mapped = data / "map"
        self.lights = [light for light in ("night", "dusk", "winter", "overcast", "fog", "morning", "wet")
                       if any((data / light / "images").glob("[0-9]*.png"))]
        self.single, self.inertial = {}, {}  # rows of frames.csv by light: IIB with depth; with IMU: {map: rows}

    def every(self, step):
        """A trajectory with every step-th pose: iib_map takes the images that have one."""
        lines = [line for line in (self.mapped / "poses.txt").read_text().splitlines() if not line.startswith("#")]
        path = self.programs.out / "maps" / f"every_{step}.txt"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("\n".join(lines[::step]) + "\n")
        return path

    def place(self, features="iib", step=1, depth=True):
        return self.programs.build(f"{features}-{step}-{'depth' if depth else 'triangulated'}", self.mapped / "images",
                                   self.mapped / "cameras.txt", self.every(step), features,
                                   self.mapped / "depth" if depth else None)

    def localize(self, place, light, *options, name="", images=None, threads=None):
        folder = self.data / light
        return self.programs.localize(place, light + name, images or folder / "images", folder / "cameras.txt",
                                      read_poses(folder / "poses.txt"), *options, threads=threads)

    def add(self, kind, features, light, located, step=1):
        self.rows.append({"data": "street", "map": kind, "keyframes": SPACINGS[step], "features": features, "light": light,
                          **summary(located)})

    def measure(self):
        self.measure_images("iib", pictures=True)
        self.measure_images("iib", depth=False)
        for step in list(SPACINGS)[1:]:
            self.measure_images("iib", step=step)
        self.measure_imu()
        for features in list(METHODS)[1:]:
            self.measure_images(features)

    def measure_images(self, features, step=1, depth=True, pictures=False):
        place = self.place(features, step, depth)
        for light in self.lights:
            located = self.localize(place, light, *(["--pictures"] if pictures else []))
            kind = "depth" if depth else "triangulated"
            self.add(kind, features, light, located, step)
            if features == "iib" and step == 1:
                self.add(kind + POINTS_ONLY, features, light, self.localize(place, light, "--no-lines", name="-points"))
            if pictures:
                self.single[light] = located

    def measure_imu(self):
        """All images with the IMU, and one of four (the others are files that are no images)."""
        place = self.programs.out / "maps" / "iib-1-depth"
        for light in self.lights:
            source, kept = self.data / light, self.programs.out / "dropped" / light / "images"
            kept.mkdir(parents=True, exist_ok=True)
            for k, name in enumerate(read_poses(source / "poses.txt")):
                image = (source / "images" / f"{name}.png").read_bytes() if k % DROPPED == 0 else b""
                (kept / f"{name}.png").write_bytes(image)
            self.inertial[light] = {}
            for kind, name, images in (("depth, IMU", "-imu", None),
                                       (f"depth, IMU, one image of {DROPPED}", "-dropped", kept)):
                located = self.localize(place, light, "--imu", source / "imu.csv", name=name, images=images)
                self.add(kind, "iib", light, located)
                self.inertial[light][kind] = located

    def times(self):
        """Milliseconds an image by the number of threads, without and with lines. From start to end, and of processor time:
        the least of some rounds, less that of a run with the first images, which iib_localize also checks the focal length
        with. Of each stage: medians of the images' quickest rounds."""
        place, light, result = self.programs.out / "maps" / "iib-1-depth", self.lights[0], []
        first = self.programs.out / "first" / light / "images"
        first.mkdir(parents=True, exist_ok=True)
        for path in sorted((self.data / light / "images").glob("[0-9]*.png"))[:FIRST]:
            shutil.copy(path, first)
        for threads, options in ((1, ["--no-lines"]), (2, ["--no-lines"]), (1, []), (2, [])):
            begins, whole, rounds = [], [], []
            for _ in range(ROUNDS):
                used = seconds()
                self.localize(place, light, *options, name="-first", images=first, threads=threads)
                begins.append(seconds() - used)
                used = seconds()
                located = self.localize(place, light, *options, name="-times", threads=threads)
                whole.append(seconds() - used)
                rounds.append([[float(row[f"{stage}_ms"] or 0) for stage in STAGES] for row in located])
            image = 1e3 * (np.min(whole, axis=0) - np.min(begins, axis=0)) / (len(located) - FIRST)
            rounds = np.array(rounds)
            quickest = np.take_along_axis(rounds, rounds.sum(axis=2).argmin(axis=0)[None, :, None], axis=0)[0]
            result.append({"threads": threads, "with_lines": not options, "elapsed": round(image[0], 1),
                           "processor": round(image[1], 1),
                           **dict(zip(STAGES, np.median(quickest, axis=0).round(1).tolist()))})
        return result

    def growth(self):
        """Rows of iib_map_growth: the same images in maps of up to 10,000 keyframes."""
        light = self.data / self.lights[0]
        return list(csv.DictReader(io.StringIO(self.programs.run(
            "iib_map_growth", "--map", self.programs.out / "maps" / "iib-1-depth", "--images", light / "images",
            "--cameras", light / "cameras.txt"))))

    def info(self):
        return self.programs.run("iib_map", "info", self.programs.out / "maps" / "iib-1-depth").split("\n")


def relit(image, seed):
    """Darkened by gamma 2.2, a ramp to a quarter, half the light, noise."""
    light = (image / 255.0) ** 2.2 * np.linspace(1, 0.25, image.shape[1])[None, :, None] * 0.5
    noise = np.random.default_rng(seed).normal(0, 2, image.shape)
    return np.clip(light * 255 + noise, 0, 255).astype(np.uint8)


def photographs(programs, data, rows):
    """Real photographs (`strecha`): every other image in the map; the others as they are and relit."""
    for source in sorted(p.parent for p in data.glob("*/poses.txt")):
        ours = programs.out / "photographs" / source.name
        for k, path in enumerate(sorted((source / "images").iterdir())):
            image = cv2.imread(str(path))
            for kind, pixels in ([("map", image)] if k % 2 == 0 else [("plain", image), ("relit", relit(image, k))]):
                target = ours / kind / f"{path.stem}.png"
                target.parent.mkdir(parents=True, exist_ok=True)
                cv2.imwrite(str(target), pixels)
        for features in METHODS:
            place = programs.build(f"{features}-{source.name}", ours / "map", source / "cameras.txt", source / "poses.txt",
                                   features)
            for kind in ("plain", "relit"):
                located = programs.localize(place, kind, ours / kind, source / "cameras.txt", read_poses(source / "poses.txt"))
                row = {"data": source.name, "map": "triangulated", "keyframes": "every other image", "features": features,
                       "light": kind}
                rows.append({**row, **summary(located)})
                if features == "iib":
                    located = programs.localize(place, f"{kind}-points", ours / kind, source / "cameras.txt",
                                                read_poses(source / "poses.txt"), "--no-lines")
                    rows.append({**row, "map": row["map"] + POINTS_ONLY, **summary(located)})


def unknown_places(programs, street, data):
    """Photographs of other places, and their mirror images, in the street's map with depth. Their sizes are changed to the
    camera's."""
    paths = sorted([*data.glob("illumination/*/*/*.png"), *data.glob("strecha/*/images/*")])
    cameras = street.mapped / "cameras.txt"
    size = tuple(map(int, [line for line in cameras.read_text().splitlines() if line[0] != "#"][0].split()[2:4]))
    target = programs.out / "unknown" / "images"
    target.mkdir(parents=True, exist_ok=True)
    for k, path in enumerate(paths[::max(1, len(paths) // UNKNOWN)]):
        image = cv2.imread(str(path), cv2.IMREAD_GRAYSCALE)
        resized = cv2.resize(image, size, interpolation=cv2.INTER_AREA)
        cv2.imwrite(str(target / f"{k:04d}.png"), resized)
        cv2.imwrite(str(target / f"{k:04d}_mirrored.png"), cv2.flip(resized, 1))
    located = programs.localize(programs.out / "maps" / "iib-1-depth", "unknown", target, cameras, None)
    return {"images": len(located), "found": sum("pose" in row for row in located)}
