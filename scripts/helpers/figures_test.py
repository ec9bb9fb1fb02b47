#!/usr/bin/env python3
"""Tests of figures.py and summaries.py: which rows count, and how sure the means are."""
import collections
import csv
import pathlib
import tempfile
import unittest
from unittest import mock

import figures
import summaries


class Figures(unittest.TestCase):

    def test_no_preset_is_judged_by_scenes_that_it_was_trained_on(self):
        real = figures.grouped

        def of_trained_scenes(*arguments):
            found = collections.defaultdict(list)
            for key, rows in real(*arguments).items():
                found[key] = [{**row, 'place': 'trained'} for row in rows]
            return found
        for function in (figures.presets, figures.fixed_points, figures.poses, figures.pose_claim,
                         figures.pose_rules, figures.pose_by_rule):
            function()
            with mock.patch.object(figures, 'grouped', of_trained_scenes), self.assertRaisesRegex(SystemExit, 'trained'):
                function()

    def test_two_presets_have_seen_rendered_scenes(self):
        row = {'place': 'rendered', 'configuration': 'IIB SMALL', 'pairs': '1', 'recall': '1'}
        with self.assertRaisesRegex(SystemExit, 'trained'):
            figures.mean([row], 'recall')
        self.assertEqual(figures.mean([{**row, 'configuration': 'IIB TINY'}], 'recall'), 1)

    def test_poses_leave_out_walks_that_presets_were_trained_on(self):
        heads = 'task', 'set', 'detector', 'descriptor', 'matching', 'error'
        errors = {'strecha': (0, 5), 'walk_street': (10, 90), 'walk_facade': (2,), 'walk_room': (0,), 'walk_terrain': (0,)}
        with tempfile.TemporaryDirectory() as folder:
            source, target = pathlib.Path(folder, 'in.csv'), pathlib.Path(folder, 'out.csv')
            with open(source, 'w', newline='') as file:
                csv.writer(file).writerows([heads] + [('pose', name, 'Hessian', 'IIB', 'both', error)
                                                      for name, some in errors.items() for error in some])
            summaries.summarize(source, target, *summaries.PLANS['whole_tasks.csv'])
            with open(target, newline='') as file:
                found = {row['place']: row for row in csv.DictReader(file)}
        self.assertEqual({place: (row['pairs'], round(float(row['score']), 3)) for place, row in found.items()},
                         {'buildings': ('2', .75), 'street': ('2', 0), 'facade': ('1', .8)})
        self.assertEqual((found['buildings']['low'], found['buildings']['high']), ('0.5000', '1.0000'))

    def test_intervals(self):
        self.assertEqual(summaries.interval([.5] * 9), [.5, .5])
        low, high = summaries.interval([0, 1] * 50)
        self.assertAlmostEqual(low, .5 - 1.96 * .05, delta=.015)
        self.assertAlmostEqual(high, .5 + 1.96 * .05, delta=.015)

    def test_gains_are_of_the_same_pairs(self):
        rows = [('tilde_webcam', target, 'ORB', descriptor, 'light', correct)
                for descriptor, counts in (('ORB', (10, 30)), ('IIB', (20, 30, 99))) for target, correct in enumerate(counts)]
        heads = 'set', 'target', 'detector', 'descriptor', 'kind', 'correct', 'sequence'
        with tempfile.TemporaryDirectory() as folder:
            source, target = pathlib.Path(folder, 'in.csv'), pathlib.Path(folder, 'out.csv')
            with open(source, 'w', newline='') as file:
                csv.writer(file).writerows([heads, *((*row, 's') for row in rows), ('graf', 1, 'ORB', 'ORB', 'viewpoint', 9, 's')])
            summaries.summarize_gains(source, target)
            self.assertEqual(target.read_text().splitlines()[1:], ['ORB,2,1.2500,1.0000,2.0000'])


if __name__ == '__main__':
    unittest.main()
