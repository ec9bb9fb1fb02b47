# This file is part of OpenCV project.
# It is subject to the license terms in the LICENSE file found in the top-level directory
# of this distribution and at http://opencv.org/license.html.

"""Reads the evaluation's CSV files and forms means over image pairs, every pair with the same weight."""
import csv
import os
from collections import defaultdict


def read(folder, name):
    """Rows of <folder>/<name>.csv as dictionaries; empty if the experiment has not been run."""
    path = os.path.join(folder, name + ".csv")
    if not os.path.exists(path):
        return []
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def domain(row):
    """'synthetic' for sets whose name begins so and for what tools/synthetic renders, 'natural' for all others."""
    return "synthetic" if row["set"].startswith(("synthetic", "lights")) else "natural"


def mean(values):
    values = list(values)
    return sum(values) / len(values) if values else 0.0


def scores(rows):
    """(mAP, mAR, number of pairs) of rows with precision and recall."""
    return mean(float(r["precision"]) for r in rows), mean(float(r["recall"]) for r in rows), len(rows)


def group(rows, *columns):
    """Rows by the values of columns, in the order of first appearance."""
    groups = defaultdict(list)
    for row in rows:
        groups[tuple(row[c] for c in columns)].append(row)
    return dict(groups)


def curve(rows):
    """Recall and 1-precision at each threshold, counts summed over the pairs."""
    correspondences = sum(int(r["correspondences"]) for r in rows)
    sums = None
    for row in rows:
        points = [tuple(map(int, p.split(":"))) for p in row["curve"].split()]
        sums = points if sums is None else [(a + c, b + d) for (a, b), (c, d) in zip(sums, points)]
    points = [(1 - c / p, c / correspondences) for c, p in sums or [] if p > 0 and correspondences > 0]
    return [x for x, _ in points], [y for _, y in points]
