#!/usr/bin/python3
# This file is part of OpenCV project.
# It is subject to the license terms in the LICENSE file found in the top-level directory
# of this distribution and at http://opencv.org/license.html.

"""Maps and localizes what tools/synthetic/localization.py rendered, and real photographs if there are any, and writes
results.csv and a page."""

import argparse
import csv
import os
import pathlib
import subprocess

import cv2
import jinja2
import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
METHODS = {"iib": "IIB", "own": "ORB and AKAZE", "sift": "SIFT"}
LIMITS = [(0.05, 0.5), (0.10, 1.0), (0.25, 2.0)]  # metres, degrees
STAGES = ["features", "retrieval", "matching", "pose"]


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


class Programs:
    def __init__(self, folder, out):
        self.folder, self.out = folder, out

    def run(self, name, *arguments):
        subprocess.run([str(self.folder / name), *map(str, arguments)], check=True, stdout=subprocess.DEVNULL)

    def build(self, name, images, cameras, poses, features, depth=None):
        target = self.out / "maps" / name
        target.parent.mkdir(parents=True, exist_ok=True)
        self.run("iib_map", "build", "--images", images, "--cameras", cameras, "--poses", poses, "--features", features,
                 "--out", target, *(["--depth", depth] if depth else []))
        return target

    def localize(self, map_folder, images, cameras, truth, *options):
        """Rows of frames.csv with the errors of those that have a pose."""
        target = self.out / "located" / map_folder.name / f"{images.parent.name}-{images.name}"
        target.mkdir(parents=True, exist_ok=True)
        self.run("iib_localize", "--map", map_folder, "--images", images, "--cameras", cameras, "--out", target, *options)
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
    if not rows:
        return {}
    measured = np.array([row["errors"] for row in found]).reshape(-1, 4)
    distances = np.linalg.norm(measured[:, :3], axis=1)
    result = {"images": len(rows), "found": len(found)}
    for metres, degrees in LIMITS:
        within = np.count_nonzero((distances <= metres) & (measured[:, 3] <= degrees))
        result[f"within_{metres * 100:.0f}cm"] = round(100 * within / len(rows), 1)
    if found:
        for name, value in zip(("lateral", "vertical", "longitudinal"), measured[:, :3].mean(axis=0)):
            result[f"{name}_cm"] = round(100 * value, 2)
        result["median_cm"] = round(100 * float(np.median(distances)), 2)
        bounds = np.array([float(row["bound_m"]) for row in found])
        result["within_bound"] = round(100 * float(np.mean(distances <= bounds)), 1)
    for stage in STAGES:
        times = [float(row[f"{stage}_ms"]) for row in rows if row[f"{stage}_ms"]]
        result[f"{stage}_ms"] = round(float(np.median(times)), 1) if times else None
    return result


def every(poses, step, path):
    """A trajectory with every step-th pose: iib_map takes the images that have one."""
    lines = [line for line in poses.read_text().splitlines() if not line.startswith("#")]
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("\n".join(lines[::step]) + "\n")
    return path


def inertial(programs, data, lights, rows):
    """With the IMU: all images, and three of four dropped (files that are no images). Adds to the rows."""
    place = programs.out / "maps" / "iib-depth"
    for light in lights:
        source, dropped = data / light, programs.out / "dropped" / light / "images"
        dropped.mkdir(parents=True, exist_ok=True)
        truth = read_poses(source / "poses.txt")
        for k, path in enumerate(sorted((source / "images").iterdir())):
            (dropped / path.name).write_bytes(path.read_bytes() if k % 4 == 0 else b"")
        for name, images in (("depth, IMU", source / "images"), ("depth, IMU, one image of four", dropped)):
            located = programs.localize(place, images, source / "cameras.txt", truth, "--imu", source / "imu.csv")
            rows.append({"data": "street", "map": name, "features": "iib", "light": light, **summary(located)})


def walk(programs, data, rows):
    """The rendered street. Returns {light: rows of IIB with depth}."""
    mapped = data / "map"
    lights = sorted(p.parent.name for p in data.glob("*/images") if p.parent != mapped and any(p.iterdir()))
    shown = {}
    if not lights:
        return shown

    def measure(map_name, features, step=1, depth=True):
        poses = every(mapped / "poses.txt", step, programs.out / "maps" / f"every_{step}.txt")
        place = programs.build(f"{features}-{map_name}", mapped / "images", mapped / "cameras.txt", poses, features,
                               mapped / "depth" if depth else None)
        for light in lights:
            folder = data / light
            located = programs.localize(place, folder / "images", folder / "cameras.txt", read_poses(folder / "poses.txt"),
                                        *(["--pictures"] if (features, map_name) == ("iib", "depth") else []))
            rows.append({"data": "street", "map": map_name, "features": features, "light": light, **summary(located)})
            if (features, map_name) == ("iib", "depth"):
                shown[light] = located

    for features in METHODS:
        measure("depth", features)
        measure("triangulated", features, depth=False)
    inertial(programs, data, lights, rows)
    measure("every second keyframe", "iib", step=2)
    measure("every fourth keyframe", "iib", step=4)
    return shown


def relit(image, seed):
    """Darkened by gamma 2.2, a ramp to a quarter, half the light, noise."""
    light = (image / 255.0) ** 2.2 * np.linspace(1, 0.25, image.shape[1])[None, :, None] * 0.5
    noise = np.random.default_rng(seed).normal(0, 2, image.shape)
    return np.clip(light * 255 + noise, 0, 255).astype(np.uint8)


def photographs(programs, data, rows):
    """Real photographs (`strecha`): every other image in the map; the others as they are and relit. Each set's images
    are also looked for in the other set's map, where none belongs."""
    sets = sorted(p.name for p in data.iterdir() if (p / "poses.txt").exists())
    for name in sets:
        for k, path in enumerate(sorted((data / name / "images").iterdir())):
            image = cv2.imread(str(path))
            for kind, pixels in ([("map", image)] if k % 2 == 0 else [("plain", image), ("relit", relit(image, k))]):
                target = programs.out / "photographs" / name / kind / f"{path.stem}.png"
                target.parent.mkdir(parents=True, exist_ok=True)
                cv2.imwrite(str(target), pixels)
    unknown = []
    for features in METHODS:
        for name in sets:
            source, ours = data / name, programs.out / "photographs" / name
            place = programs.build(f"{features}-{name}", ours / "map", source / "cameras.txt", source / "poses.txt", features)
            for kind in ("plain", "relit"):
                located = programs.localize(place, ours / kind, source / "cameras.txt", read_poses(source / "poses.txt"))
                rows.append({"data": name, "map": "triangulated", "features": features, "light": kind, **summary(located)})
            for other in sets:
                for kind in ("map", "plain", "relit") if other != name and features == "iib" else ():
                    unknown += programs.localize(place, programs.out / "photographs" / other / kind,
                                                 data / other / "cameras.txt", None)
    return {"images": len(unknown), "found": sum("pose" in row for row in unknown)}


def from_above(truth, located, size=(720, 260)):
    """Paths and places found as SVG coordinates: z to the right, x up."""
    places = np.array([p for p, _ in truth.values()])[:, [2, 0]]
    low, high = places.min(axis=0) - 1, places.max(axis=0) + 1
    scale = np.array(size) / (high - low)

    def at(p):
        x, y = (np.array([p[2], p[0]]) - low) * scale
        return round(float(x), 1), round(size[1] - float(y), 1)

    return {"size": size, "path": " ".join("%g,%g" % at(p) for p, _ in truth.values()),
            "found": [at(row["pose"][0]) for row in located if "pose" in row]}


def side_by_side(programs, data, out, light, located):
    """A picture: the nearest keyframe by day, and the image with what agrees. None if nothing was found."""
    found = sorted((row for row in located if "pose" in row), key=lambda row: -int(row["inliers"]))
    if not found:
        return None
    keyframes = read_poses(data / "map" / "poses.txt")
    best = found[len(found) // 2]
    nearest = min(keyframes, key=lambda name: np.linalg.norm(keyframes[name][0] - best["pose"][0]))
    day = cv2.imread(str(data / "map" / "images" / f"{nearest}.png"))
    night = cv2.imread(str(programs.out / "located" / "iib-depth" / f"{light}-images" / f"{best['name']}.png"))
    name = f"{light}.jpg"
    cv2.imwrite(str(out / name), np.hstack([day, night]), [cv2.IMWRITE_JPEG_QUALITY, 80])
    return name


def write_csv(path, rows):
    with open(path, "w", newline="", encoding="utf-8") as stream:
        names = list(dict.fromkeys(name for row in rows for name in row))
        writer = csv.DictWriter(stream, names, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("programs", type=pathlib.Path, help="folder of iib_map and iib_localize")
    parser.add_argument("data", type=pathlib.Path, help="what tools/synthetic/localization.py rendered")
    parser.add_argument("out", type=pathlib.Path)
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    programs = Programs(options.programs, options.out / "work")
    rows = []
    shown = walk(programs, options.data, rows)
    real = pathlib.Path(os.environ.get("OPENCV_TEST_DATA_PATH", "")) / "strecha"
    unknown = photographs(programs, real, rows) if real.is_dir() else None
    write_csv(options.out / "results.csv", rows)
    lights = [{"light": light, "above": from_above(read_poses(options.data / light / "poses.txt"), located),
               "picture": side_by_side(programs, options.data, options.out, light, located)} for light, located in shown.items()]
    environment = jinja2.Environment(loader=jinja2.FileSystemLoader(HERE), autoescape=True, trim_blocks=True)
    page = environment.get_template("page.html.j2").render(rows=rows, lights=lights, unknown=unknown, methods=METHODS,
                                                           stages=STAGES)
    (options.out / "index.html").write_text(page, encoding="utf-8")
    print(options.out / "index.html")


if __name__ == "__main__":
    main()
