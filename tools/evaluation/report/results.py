# SPDX-License-Identifier: Apache-2.0

"""Reads the summaries of an evaluation, as scripts/helpers/summaries.py writes them. Needs Python alone."""
import csv
import json
import pathlib

ROOT = pathlib.Path(__file__).resolve().parents[3]
RESULTS = ROOT / "doc/results"


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
    return {row["name"].replace("cv::", "").replace("default", "IIB").replace("PRESET_", "IIB "): row["milliseconds"]
            for row in json.loads(file.read_text())["rows"] if (row["what"], row["size"], row["threads"]) == ("describe", 1000, 1)}
