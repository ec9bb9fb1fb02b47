#!/usr/bin/python3
"""Draws how the time to describe grows with pixels and keypoints."""
import argparse
import json


def draw(axis, xs, points, label):
    axis.plot(xs, [p["milliseconds"] for p in points], marker="o")
    axis.set_xlim(left=0)
    axis.locator_params(axis="x", nbins=6)
    axis.set_ylim(bottom=0)
    axis.set_xlabel(label)
    axis.set_ylabel("ms")
    axis.grid(True, linewidth=0.4)


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
    figure, (left, right) = plt.subplots(1, 2, figsize=(9, 3.2))
    draw(left, [p["megapixels"] for p in data["pixels"]], data["pixels"],
         f"megapixels ({data['pixels'][0]['keypoints']} keypoints)")
    draw(right, [p["keypoints"] for p in data["more_keypoints"]], data["more_keypoints"],
         f"keypoints ({data['more_keypoints'][0]['megapixels']:.2f} megapixels)")
    figure.tight_layout()
    figure.savefig(options.picture, metadata={"Date": None})


if __name__ == "__main__":
    main()
