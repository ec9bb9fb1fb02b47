# SPDX-License-Identifier: Apache-2.0

"""Reads the summaries of an evaluation, as scripts/helpers/summaries.py writes them. Needs Python alone."""
import csv
import json
import pathlib

ROOT = pathlib.Path(__file__).resolve().parents[3]
RESULTS = ROOT / "doc/results"
# The figures of Lin et al., "Illumination-insensitive Binary Descriptor for Visual Measurement Based on Local Inter-patch
# Invariance", by the questions that its tables answer and the names of our results; those that it lacks are empty.
PAPER = pathlib.Path(__file__).with_name("paper.csv")


def read(file):
    """Rows of a CSV file as dictionaries; empty if there is none."""
    if not file.is_file():
        return []
    with open(file, newline="") as opened:
        return list(csv.DictReader(opened))


def group(rows, *columns):
    """Rows by the values of columns, in the order of first appearance."""
    groups = {}
    for row in rows:
        groups.setdefault(tuple(row[c] for c in columns), []).append(row)
    return groups


def by(rows, *columns, **where):
    """The one row of each value of the columns, or of each combination of theirs, among those with the values of `where`."""
    chosen = [row for row in rows if all(row[c] == v for c, v in where.items())]
    return {key if len(columns) > 1 else key[0]: members[0] for key, members in group(chosen, *columns).items()}


def describing_times(file=RESULTS / "benchmark.json"):
    """Milliseconds for 1000 points, by the names of the evaluation's configurations; of scripts/bench.sh."""
    return {row["name"].replace("cv::", "").replace("default", "IIB").replace("PRESET_", "IIB "): row["milliseconds"][0]
            for row in json.loads(file.read_text())["rows"]}


def paper_table(question, fixed):
    """Lines of one of the paper's tables: name, in plain words, our rows of photographs and of rendered scenes, and the paper's
    means (precision, recall) of natural and synthetic images. Where bits were learned, on scenes that they were not learned on."""
    natural, light, rendered = (by(fixed, "configuration", place=place) for place in ("natural", "light", "rendered"))
    natural = light if "learning" in question else {**light, **natural}
    return [(row["configuration"], row["plain"], natural.get(row["configuration"]), rendered.get(row["configuration"]),
             [[row[data + measure] for measure in ("_map", "_mar")] for data in ("natural", "synthetic")])
            for row in read(PAPER) if row["question"] == question]


def questions():
    return [question for question, in group(read(PAPER), "question")]
