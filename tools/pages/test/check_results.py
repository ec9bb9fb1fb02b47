#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0

"""check_results.py RESULTS: the page of a reduced run has its sections and figures, fetches nothing from
elsewhere, and its links lead to files."""
import csv
import os
import pathlib
import re
import shutil
import subprocess
import sys

results, tools = sys.argv[1], pathlib.Path(__file__).resolve().parents[1]
with open(os.path.join(results, "fixed_points.csv")) as file:
    recalls = [float(r["recall"]) for r in csv.DictReader(file) if r["configuration"] == "IIB" and r["kind"] == "light"]
page = os.path.join(results, "page")
shutil.copytree(os.path.join(results, "pictures"), os.path.join(page, "pictures"), dirs_exist_ok=True)
subprocess.run([sys.executable, "-B", tools / "summaries.py", results, page], check=True)
subprocess.run([sys.executable, "-B", tools / "pages.py", "--results", page], check=True)
with open(os.path.join(page, "index.html")) as file:
    text = file.read()
assert re.search("<td>IIB</td>.*<td[^>]*>%.3f " % (sum(recalls) / len(recalls)), text), recalls
for section in ("all", "detectors", "curves", "pictures", "moved", "run"):
    assert 'id="%s"' % section in text, section
for name in ("IIB", "IIB BALANCED", "ORB", "SIFT", "AKAZE-486"):
    assert re.search(r'<td>%s( <span class="tag">learned</span>)?</td><td>\d+</td><td data-value="[\d.]+">' % name, text), name
for meaning in re.findall(r"<dd>(.*?)</dd>", text):
    assert meaning.endswith(".") and ". " not in meaning, meaning  # one sentence per metric
for method in ("recommended chain", "ORB"):
    assert '"name": "%s"' % method in text, method
for link in re.findall(r'(?:src|href)="([^"#]+)"', text):
    assert os.path.exists(os.path.join(page, link)), link
assert len(text) < 200000, len(text)

empty = subprocess.run([sys.executable, "-B", tools / "pages.py", "--results", os.path.join(results, "pictures")], stderr=subprocess.PIPE, text=True)
assert empty.returncode != 0 and "no results" in empty.stderr and len(empty.stderr.splitlines()) == 1
