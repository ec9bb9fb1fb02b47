#!/usr/bin/python3
"""The least time of each test in several runs of opencv_perf_iib and opencv_perf_iib_geometry: speed.py OUT.csv COMMIT MACHINE XML...

OUT.csv gets milliseconds, one column per instruction set, which OpenCV names in the XML. Its first line has MACHINE. If OUT.csv is that of
doc/results, runs.csv gets COMMIT and MACHINE.
"""
import pathlib
import re
import sys
import xml.etree.ElementTree

import pandas as pd

from summaries import remember, today
from timings import RESULTS

SETS = {'AVX-512': 'AVX512-SKX', 'AVX2': 'AVX2', 'SSE4.2': 'SSE4.2', 'baseline': 'SSE2', 'NEON': 'NEON'}


def tests(file):
    """Rows of one run: test, its parameters, the points it counted, instruction set and milliseconds."""
    run = xml.etree.ElementTree.parse(file).getroot()
    there = {name.strip('*') for name in run.get('cv_cpu_features').split() if not name.endswith('?')}
    widest = next(name for name, feature in SETS.items() if feature in there)
    for case in run.iter('testcase'):
        found = {each.get('name'): each.get('value') for each in case.iter('property')}
        if 'min' in found:
            parameters = re.sub(r'^\(|\)$|"|HierarchicalMatcher::', '', case.get('value_param', '')).replace(', ', '/')
            name = case.get('classname') + ('' if '/' in case.get('name') else '_' + case.get('name'))
            yield name, parameters, found.get('points', ''), widest, 1e3 * float(found['min']) / float(found['frequency'])


def main():
    if len(sys.argv) < 5:
        sys.exit(__doc__)
    out, commit, machine, *files = sys.argv[1:]
    rows = pd.DataFrame([row for file in files for row in tests(file)], columns=['test', 'parameters', 'points', 'set', 'ms'])
    table = rows.pivot_table('ms', ['test', 'parameters', 'points'], 'set', 'min', sort=False)
    version = xml.etree.ElementTree.parse(files[0]).getroot().get('cv_version')
    with open(out, 'w', encoding='utf-8') as file:
        file.write('# OpenCV %s, %s, %s\n' % (version, machine, today()))
        table[[name for name in SETS if name in table]].to_csv(file, float_format='%.4g')
    if pathlib.Path(out).resolve() == RESULTS / 'speed.csv':
        remember(RESULTS / 'runs.csv', {'speed.csv': [commit, today(), machine]})


if __name__ == '__main__':
    main()
