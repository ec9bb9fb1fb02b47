#!/usr/bin/python3
"""Draws how the time to describe grows with pixels and keypoints, and the time to match with codes, beside OpenCV's."""
import argparse
import json


def finish(axis, title, label):
    axis.set_title(title)
    axis.set_xlabel(label)
    axis.set_ylabel("ms")
    axis.grid(True, linewidth=0.4)
    axis.legend()


def draw_pixels(axis, data):
    points = data["pixels"]
    for key, label in (("milliseconds", "IIB"), ("orb_milliseconds", "ORB")):
        axis.plot([p["megapixels"] for p in points], [p[key] for p in points], marker="o", label=label)
    axis.set_xlim(left=0)
    axis.set_ylim(bottom=0)
    finish(axis, "Describe: larger images", f"megapixels ({points[0]['keypoints']} keypoints)")


def draw_keypoints(axis, data):
    for name, label in (("default", "IIB"), ("PRESET_UNIVERSAL", "IIB UNIVERSAL"), ("cv::ORB", "ORB"), ("BEBLID-512", "BEBLID-512")):
        row = next(r for r in data["rows"] if r["name"] == name)
        axis.plot(data["keypoints"], row["milliseconds"], marker="o", label=label)
    axis.set_xlim(left=0)
    axis.set_ylim(bottom=0)
    finish(axis, "Describe: more points", f"keypoints ({data['width']} x {data['height']})")


def draw_codes(axis, data):
    """On logarithmic axes: a line parallel to another takes so many times as long for any number of codes."""
    for name, label in (("EXACT", "IIB's matcher"), ("BFMatcher", "BFMatcher")):
        found = [m for m in data["matching"] if m["name"] == name and m["cross_check"]]
        axis.plot([m["codes"] for m in found], [m["milliseconds"] for m in found], marker="o", label=label)
    axis.set_xscale("log")
    axis.set_yscale("log")
    finish(axis, "Match", "codes on either side, cross-check")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("source", help="what iib_benchmark wrote, such as iib_benchmark.json")
    parser.add_argument("picture", help="SVG file to write")
    options = parser.parse_args()

    import matplotlib  # after --help, which needs no package
    matplotlib.use("svg")
    import matplotlib.pyplot as plt

    with open(options.source, encoding="utf-8") as file:
        data = json.load(file)
    figure, axes = plt.subplots(1, 3, figsize=(12, 3.4))
    for draw, axis in zip((draw_pixels, draw_keypoints, draw_codes), axes):
        draw(axis, data)
    figure.tight_layout()
    figure.savefig(options.picture, metadata={"Date": None})


if __name__ == "__main__":
    main()
