#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0

"""check_report.py REPORT RESULTS: the page of a reduced run has its sections and figures, fetches nothing from
elsewhere, and its links lead to files."""
import csv
import os
import re
import subprocess
import sys

report, results = sys.argv[1:]
subprocess.run([sys.executable, "-B", report, results], check=True, stdout=subprocess.DEVNULL)
with open(os.path.join(results, "index.html")) as file:
    text = file.read()
with open(os.path.join(results, "fixed_points.csv")) as file:
    rows = [r for r in csv.DictReader(file) if r["configuration"] == "IIB" and r["kind"] == "light" and
            not r["set"].startswith("lights")]
recall = sum(float(r["recall"]) for r in rows) / len(rows)
assert "recall %.3f</b>" % recall in text, recall
for section in ("all", "detectors", "pictures", "moved", "tasks", "paper", "scenes", "run"):
    assert 'id="%s"' % section in text, section
for name in ("IIB", "IIB BALANCED", "ORB", "SIFT", "AKAZE-486"):
    assert re.search(r'<td>%s( <span class="tag">learned</span>)?</td><td>\d+</td><td data-value="[\d.]+">' % name,
                     text), name
for meaning in re.findall(r"<dd>(.*?)</dd>", text):
    assert meaning.endswith(".") and ". " not in meaning, meaning  # a metric is told in one sentence
for method in ("recommended chain", "ORB"):
    assert '"name": "%s"' % method in text, method
for link in re.findall(r'(?:src|href)="([^"#]+)"', text):
    assert os.path.exists(os.path.join(results, link)), link
assert len(text) < 200000, len(text)

empty = subprocess.run([sys.executable, "-B", report, os.path.join(results, "pictures")], stderr=subprocess.PIPE,
                       text=True)
assert empty.returncode != 0 and "no results" in empty.stderr and len(empty.stderr.splitlines()) == 1
