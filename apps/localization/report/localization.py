#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0

"""Maps and localizes what tools/synthetic/localization.py rendered, and real photographs if there are any, and writes
results.csv, growth.csv and a page with pictures and a video."""

import argparse
import csv
import os
import pathlib
import sys

import jinja2

import measure
import pictures

HERE = pathlib.Path(__file__).resolve().parent
HARD = ["night", "dusk", "winter", "overcast"]  # what the aims are for


def write_csv(path, rows):
    with open(path, "w", newline="", encoding="utf-8") as stream:
        names = list(dict.fromkeys(name for row in rows for name in row))
        writer = csv.DictWriter(stream, names, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def aims(rows, times, unknown):
    """Rows of the table of aims: what, wanted, measured (the worst of the lights), reached."""
    def of(kind, keyframes="1.4 m"):
        return [row for row in rows if (row["data"], row["map"], row["keyframes"], row["features"]) ==
                ("street", kind, keyframes, "iib") and row["light"] in HARD]

    def at_least(what, wanted, found, column):
        worst = min(row[column] for row in found)
        return {"what": what, "wanted": f"at least {wanted} %", "measured": f"{worst:g} %", "reached": worst >= wanted}

    def at_most(what, wanted, value, unit):
        return {"what": what, "wanted": f"at most {wanted} {unit}", "measured": f"{value:g} {unit}",
                "reached": value <= wanted}

    depth = of("depth")
    result = [at_least("map with depth, within 5 cm and 0.5°", 95, depth, "within_5cm"),
              at_least("map with depth, within 25 cm and 2°", 100, depth, "within_25cm"),
              at_least("triangulated map, within 5 cm and 0.5°", 85, of("triangulated"), "within_5cm"),
              at_least("triangulated map, within 25 cm and 2°", 100, of("triangulated"), "within_25cm"),
              at_least("keyframes 2.8 m apart, within 5 cm", 90, of("depth", "2.8 m"), "within_5cm"),
              at_least("keyframes 5.6 m apart, within 5 cm", 75, of("depth", "5.6 m"), "within_5cm")]
    for name, wanted in (("lateral", 2), ("longitudinal", 2), ("vertical", 1.5)):
        result.append(at_most(f"mean error, {name}", wanted, max(row.get(f"{name}_cm", 1e3) for row in depth), "cm"))
    inertial = of(f"depth, IMU, one image of {measure.DROPPED}")
    result.append(at_least("three of four images dropped, with IMU: with a pose", 100, [
        {"share": 100 * row["found"] / row["images"]} for row in inertial], "share"))
    result.append(at_most("their mean error", 3, max(row.get("mean_cm", 1e3) for row in inertial), "cm"))
    one, two = (row for row in times if not row["with_lines"])
    for row, limit, threads in ((one, 150, "one thread"), (two, 100, "two threads")):
        result.append(at_most(f"an image of 640 x 480 without lines, {threads}", limit, row["elapsed"], "ms"))
    if unknown:
        result.append(at_most("images of other places that get a pose", 1,
                              round(100 * unknown["found"] / unknown["images"], 2), "%"))
    return result


def write_page(path, **content):
    environment = jinja2.Environment(loader=jinja2.FileSystemLoader(HERE), autoescape=True, trim_blocks=True)
    template = environment.get_template("page.html.j2")
    path.write_text(template.render(methods=measure.METHODS, stages=measure.STAGES, rounds=measure.ROUNDS,
                                    points_only=measure.POINTS_ONLY, **content),
                    encoding="utf-8")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("programs", type=pathlib.Path, help="folder of iib_map and iib_localize")
    parser.add_argument("data", type=pathlib.Path, help="what tools/synthetic/localization.py rendered")
    parser.add_argument("out", type=pathlib.Path)
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    programs = measure.Programs(options.programs, options.out / "work")
    rows = []
    street = measure.Street(programs, options.data, rows)
    if not set(HARD) <= set(street.lights):
        sys.exit(f"{options.data} has no images of one of {', '.join(HARD)}: let tools/synthetic/localization.py finish")
    street.measure()
    given = os.environ.get("OPENCV_TEST_DATA_PATH")
    unknown = None
    if given:
        measure.photographs(programs, pathlib.Path(given) / "strecha", rows)
        unknown = measure.unknown_places(programs, street, pathlib.Path(given))
    times, growth = street.times(), street.growth()
    write_csv(options.out / "results.csv", rows)
    write_csv(options.out / "growth.csv", growth)

    keyframes = measure.read_poses(street.mapped / "poses.txt")
    lights = []
    for light in street.lights:
        pairs = list(pictures.pairs(street, programs.out / "located" / "iib-1-depth", light))
        if pairs:
            pictures.write_picture(options.out / f"{light}.jpg", pairs)
        if light == street.lights[0]:
            pictures.write_video(options.out / f"{light}.webm", pairs)
        truth = measure.read_poses(street.data / light / "poses.txt")
        lights.append({"light": light, "picture": bool(pairs),
                       "above": pictures.from_above(truth, keyframes, street.single[light]),
                       "time": pictures.over_time(street.single[light], street.inertial[light])})
    write_page(options.out / "index.html", rows=rows, aims=aims(rows, times, unknown), lights=lights, unknown=unknown,
               times=times, growth=growth, info=street.info())
    print(options.out / "index.html")


if __name__ == "__main__":
    main()
