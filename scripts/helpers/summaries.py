#!/usr/bin/env python3
"""Summaries of an evaluation for doc/results, from which figures.py makes its tables: summaries.py FOLDER

FOLDER: results of scripts/evaluate.sh and, as ratios.csv, of iib_ratios, with a row for each pair of images. Written are
means over the pairs of a group, one row each, with their number.
"""
import collections
import csv
import pathlib
import sys

OUT = pathlib.Path(__file__).resolve().parents[2] / 'doc/results'
TRAINED_ON = {'tilde_webcam', 'amos_daynight'}  # by the presets
RENDERED = {'lights'}


def place(row):
    """What a pair shows: light of scenes that presets were trained on or not, rendered light, or the moved camera."""
    if row['set'] in RENDERED:
        return 'rendered'
    if row['kind'] != 'light':
        return row['sequence']
    return 'trained' if row['set'] in TRAINED_ON else 'light'


def pose_score(row):
    """1 for no error of a relative pose, 0 from 10 degrees on: its mean is the area under the curve."""
    return max(0, 1 - float(row['error']) / 10)


def column(name):
    return lambda row: float(row[name])


# File: which rows count, what makes a group, what is averaged.
PLANS = {
    'detected_points.csv': (lambda row: True, {'place': place, 'detector': None, 'descriptor': None},
                            {'correct': column('correct'), 'precision': column('precision')}),
    'fixed_points.csv': (lambda row: True, {'place': place, 'configuration': None, 'bytes': None},
                         {'precision': column('precision'), 'recall': column('recall')}),
    'robustness.csv': (lambda row: row['kind'] == 'turn' and row['set'] not in TRAINED_ON,
                       {'configuration': None, 'target': None},
                       {'precision': column('precision'), 'recall': column('recall')}),
    'whole_tasks.csv': (lambda row: row['task'] == 'pose',
                        {'set': None, 'detector': None, 'descriptor': None, 'matching': None}, {'score': pose_score}),
    'ratios.csv': (lambda row: True, {'place': place, 'descriptor': None, 'rule': None},
                   {'correct': column('correct'), 'given': column('given')}),
}


def summarize(source, target, chosen, keys, values):
    groups = collections.defaultdict(list)
    with open(source, newline='') as file:
        for row in csv.DictReader(file):
            if chosen(row):
                groups[tuple(key(row) if key else row[name] for name, key in keys.items())].append(row)
    with open(target, 'w', newline='') as file:
        writer = csv.writer(file, lineterminator='\n')
        writer.writerow(list(keys) + ['pairs'] + list(values))
        for group, rows in sorted(groups.items()):
            writer.writerow(list(group) + [len(rows)] +
                            [repr(sum(value(row) for row in rows) / len(rows)) for value in values.values()])


def main():
    if len(sys.argv) != 2 or not pathlib.Path(sys.argv[1]).is_dir():
        print(__doc__.split('\n\n')[0] + '; FOLDER must be one', file=sys.stderr)
        return 2
    folder = pathlib.Path(sys.argv[1])
    for name, plan in PLANS.items():
        if (folder / name).is_file():
            summarize(folder / name, OUT / name, *plan)
            print('doc/results/' + name)
    return 0


if __name__ == '__main__':
    sys.exit(main())
