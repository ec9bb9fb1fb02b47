#!/usr/bin/env python3
# This file is part of OpenCV project.
# It is subject to the license terms in the LICENSE file found in the top-level directory
# of this distribution and at http://opencv.org/license.html.

"""check_report.py REPORT RESULTS: the page of a reduced run has its tables, plots and pictures, and nothing
that a browser would have to fetch."""
import csv
import os
import re
import subprocess
import sys

report, results = sys.argv[1:]


def page(*options):
    subprocess.run([sys.executable, report, results, *options], check=True)
    with open(os.path.join(results, "index.html")) as file:
        return file.read()


text = page()
with open(os.path.join(results, "protocol_a.csv")) as file:
    light = [r for r in csv.DictReader(file) if r["configuration"] == "IIB" and r["kind"] == "light"]
mar = sum(float(r["recall"]) for r in light) / len(light)
assert "mAR <b>%.3f</b> over %d image pairs" % (mar, len(light)) in text
for section in "asbmrcp":
    assert 'id="%s"' % section in text, section
presets = text[text.index('id="s"'):text.index('id="b"')]
for name in ("S128", "S256", "S512", "ACCURATE", "COMPACT", "TINY", "BALANCED"):
    assert re.search(r"<td>IIB %s</td><td>\d+</td>(<td>[\d.]+ / [\d.]+</td>)+<td>[\d.]+</td>" % name, presets), name
assert text.count("<svg") >= 7, text.count("<svg")
assert "data:image/jpeg;base64," in text
assert not re.search(r'(src|href)="?(https?:|/|\.\.)', text.replace("xlink:href", "")), "not self-contained"
without = page("--no-pictures")
assert "data:image/jpeg" not in without and 'id="a"' in without

empty = subprocess.run([sys.executable, report, os.path.join(results, "pictures")], stderr=subprocess.PIPE, text=True)
assert empty.returncode != 0 and "no results" in empty.stderr and len(empty.stderr.splitlines()) == 1
