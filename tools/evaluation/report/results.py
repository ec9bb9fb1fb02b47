# SPDX-License-Identifier: Apache-2.0

"""Reads the evaluation's CSV files and forms means over image pairs, every pair with the same weight."""
import csv
import json
import math
import os
import pathlib

BENCHMARK = pathlib.Path(__file__).resolve().parents[3] / "doc/results/benchmark.json"  # of scripts/bench.sh

# Kinds of change that the evaluation calls otherwise.
KINDS = {"light": "illumination", "turn": "rotation"}


def file_name(name):
    return name + ".csv"


def read(folder, name):
    """Rows of an experiment's CSV file as dictionaries; empty if it has not been run."""
    path = os.path.join(folder, file_name(name))
    if not os.path.exists(path):
        return []
    with open(path, newline="") as file:
        rows = list(csv.DictReader(file))
    for row in rows:
        if "kind" in row:
            row["kind"] = KINDS.get(row["kind"], row["kind"])
    return rows


def describing_times():
    """Milliseconds for 1000 points, by the names of the evaluation's configurations."""
    rows = json.loads(BENCHMARK.read_text())["rows"]
    return {row["name"].replace("cv::", "").replace("default", "IIB").replace("PRESET_", "IIB "): row["milliseconds"][0]
            for row in rows}


def domain(row):
    """'rendered' for sets whose name begins with synthetic, lights or walk (tools/synthetic), 'natural' for all others."""
    return "rendered" if row["set"].startswith(("synthetic", "lights", "walk")) else "natural"


def mean(values):
    values = list(values)
    return sum(values) / len(values) if values else 0.0


def interval(values):
    """Half the width of the 95 % confidence interval of the mean."""
    values = list(values)
    if len(values) < 2:
        return 0.0
    centre = mean(values)
    return 1.96 * math.sqrt(sum((v - centre) ** 2 for v in values) / (len(values) - 1) / len(values))


def column(rows, name):
    return [float(r[name]) for r in rows]


def group(rows, *columns):
    """Rows by the values of columns, in the order of first appearance."""
    groups = {}
    for row in rows:
        groups.setdefault(tuple(row[c] for c in columns), []).append(row)
    return groups


def areas(errors, limit):
    """For each pair the part of 0 to the limit that lies above its error; their mean is the area under the curve."""
    return [max(0.0, limit - error) / limit for error in errors]


def mean_accuracy(errors, limits):
    """The share of pairs whose error is at most a limit, averaged over the limits."""
    return mean(mean(error <= limit for error in errors) for limit in limits)
