#!/usr/bin/python3
"""Draws how the time to describe grows with pixels and keypoints, and the time to match with codes, beside OpenCV's."""
import argparse
import json

# Of each chart: what is measured, its title, the label below, and names with their labels.
CHARTS = (("megapixels", "Describe: larger images", "megapixels (1000 keypoints)", {"default": "IIB", "cv::ORB": "ORB"}),
          ("describe", "Describe: more points", "keypoints (1280 x 720)",
           {"default": "IIB", "PRESET_UNIVERSAL": "IIB UNIVERSAL", "cv::ORB": "ORB", "BEBLID-512": "BEBLID-512"}),
          # On logarithmic axes: a line parallel to another takes so many times as long for any number of codes.
          ("cross-check", "Match", "codes on either side, cross-check", {"EXACT": "IIB's matcher", "BFMatcher": "BFMatcher"}))


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("source", help="what iib_benchmark wrote, such as iib_benchmark.json")
    parser.add_argument("picture", help="SVG file to write")
    options = parser.parse_args()

    import matplotlib  # after --help, which needs no package
    matplotlib.use("svg")
    import matplotlib.pyplot as plt

    with open(options.source, encoding="utf-8") as file:
        rows = [row for row in json.load(file)["rows"] if row["threads"] == 1]
    figure, axes = plt.subplots(1, len(CHARTS), figsize=(12, 3.4))
    for (what, title, label, names), axis in zip(CHARTS, axes):
        for name, shown in names.items():
            found = sorted((row["size"], row["milliseconds"]) for row in rows if (row["what"], row["name"]) == (what, name))
            axis.plot(*zip(*found), marker="o", label=shown)
        if what == "cross-check":
            axis.set(xscale="log", yscale="log")
        else:
            axis.set(xlim=(0, None), ylim=(0, None))
        axis.set(title=title, xlabel=label, ylabel="ms")
        axis.grid(True, linewidth=0.4)
        axis.legend()
    figure.tight_layout()
    figure.savefig(options.picture, metadata={"Date": None})


if __name__ == "__main__":
    main()
