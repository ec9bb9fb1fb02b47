#!/usr/bin/env python3
"""Summaries of an evaluation for doc/results, from which figures.py makes its tables: summaries.py FOLDER

FOLDER: results of scripts/evaluate.sh, with a row for each pair of images. Written are means over the pairs of a group, one
row each, with their number; of poses also the ends of the mean's 95 % confidence interval (low, high; bootstrap over the
pairs).
"""
import collections
import csv
import pathlib
import random
import sys

OUT = pathlib.Path(__file__).resolve().parents[2] / 'doc/results'
TRAINED_ON = {'tilde_webcam', 'amos_daynight', 'walk_room', 'walk_terrain'}  # by the presets
RENDERED = {'lights'}
DRAWS = 1000  # of the bootstrap


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


def pose_place(row):
    """Photographs of buildings by day, or what a rendered walk in two lights passes: a facade is nearly a plane, from which
    the pose is hardly known."""
    return 'buildings' if row['set'] == 'strecha' else 'facade' if row['set'] == 'walk_facade' else 'street'


def column(name):
    return lambda row: float(row[name])


def mean(values):
    return sum(values) / len(values)


def interval(values, statistic=mean):
    """Ends of the 95 % confidence interval of the mean, or of another statistic."""
    chance = random.Random(1)
    drawn = sorted(statistic(chance.choices(values, k=len(values))) for _ in range(DRAWS))
    return [drawn[at] for at in (DRAWS // 40, DRAWS - 1 - DRAWS // 40)]


# File: which rows count, what makes a group, what is averaged.
PLANS = {
    'detected_points.csv': (lambda row: True, {'place': place, 'detector': None, 'descriptor': None},
                            {'correct': column('correct'), 'precision': column('precision')}),
    'fixed_points.csv': (lambda row: True, {'place': place, 'configuration': None, 'bytes': None},
                         {'precision': column('precision'), 'recall': column('recall')}),
    'robustness.csv': (lambda row: row['kind'] == 'turn' and row['set'] not in TRAINED_ON,
                       {'configuration': None, 'target': None},
                       {'precision': column('precision'), 'recall': column('recall')}),
    'whole_tasks.csv': (lambda row: row['task'] == 'pose' and row['set'] not in TRAINED_ON,
                        {'place': pose_place, 'detector': None, 'descriptor': None, 'matching': None},
                        {'score': pose_score}),
}


def summarize(source, target, chosen, keys, values):
    groups = collections.defaultdict(list)
    with open(source, newline='') as file:
        for row in csv.DictReader(file):
            if chosen(row):
                groups[tuple(key(row) if key else row[name] for name, key in keys.items())].append(row)
    with open(target, 'w', newline='') as file:
        writer = csv.writer(file, lineterminator='\n')
        writer.writerow(list(keys) + ['pairs'] + list(values) + (['low', 'high'] if 'score' in values else []))
        for group, rows in sorted(groups.items()):
            found = [[value(row) for row in rows] for value in values.values()]
            ends = ['%.4f' % end for end in interval(found[0])] if 'score' in values else []
            writer.writerow(list(group) + [len(rows)] + [repr(sum(of) / len(rows)) for of in found] + ends)


def gain(pairs):
    """How many times as many right matches the second of each pair of counts is, of all."""
    return sum(ours for _, ours in pairs) / sum(own for own, _ in pairs)


def summarize_gains(source, target):
    """Right matches of the default descriptor over those of a detector's own, at its points, of pairs in changed light."""
    counts = collections.defaultdict(dict)
    with open(source, newline='') as file:
        for row in csv.DictReader(file):
            if place(row) in ('light', 'trained'):
                counts[row['detector'], row['descriptor']][row['set'], row['sequence'], row['target']] = int(row['correct'])
    with open(target, 'w', newline='') as file:
        writer = csv.writer(file, lineterminator='\n')
        writer.writerow(['detector', 'pairs', 'gain', 'low', 'high'])
        for detector in sorted(detector for detector, descriptor in counts if detector == descriptor):
            own, ours = counts[detector, detector], counts[detector, 'IIB']
            pairs = [(own[pair], ours[pair]) for pair in sorted(own) if pair in ours]
            writer.writerow([detector, len(pairs)] + ['%.4f' % v for v in (gain(pairs), *interval(pairs, gain))])


def main():
    if len(sys.argv) != 2 or not pathlib.Path(sys.argv[1]).is_dir():
        print(__doc__.split('\n\n')[0] + '; FOLDER must be one', file=sys.stderr)
        return 2
    folder = pathlib.Path(sys.argv[1])
    for name, plan in PLANS.items():
        if (folder / name).is_file():
            summarize(folder / name, OUT / name, *plan)
            print('doc/results/' + name)
    if (folder / 'detected_points.csv').is_file():
        summarize_gains(folder / 'detected_points.csv', OUT / 'gains.csv')
    return 0


if __name__ == '__main__':
    sys.exit(main())
