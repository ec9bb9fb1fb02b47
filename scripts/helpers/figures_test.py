#!/usr/bin/env python3
"""Tests of summaries.py: which rows count where, and how sure the means are."""
import csv
import pathlib
import tempfile
import unittest

import summaries


class Figures(unittest.TestCase):

    def test_nothing_is_judged_by_scenes_that_it_was_trained_on(self):
        def places(name, collection, sequence='s', kind='light'):
            return summaries.places({'configuration': name, 'set': collection, 'sequence': sequence, 'kind': kind})
        self.assertEqual(places('IIB', 'tilde_webcam'), ['natural'])
        self.assertEqual(places('IIB x+y', 'middlebury2014'), ['natural', 'light'])
        for name in ('IIB S128', 'IIB AdaBoost-512', 'IIB BALANCED'):
            self.assertEqual(places(name, 'tilde_webcam'), [], name)
            self.assertEqual(places(name, 'middlebury2014'), ['light'], name)
            self.assertEqual(places(name, 'oxford_affine', 'wall', 'viewpoint'), ['viewpoint', 'wall'])
        self.assertEqual(places('IIB BALANCED', 'lights', 'room'), ['rendered'])
        self.assertEqual(places('IIB SMALL', 'lights', 'street'), [])  # walks through rendered scenes were among its images
        self.assertEqual(places('SIFT', 'lights', 'room'), ['rendered'])

    def test_curves_are_of_scenes_that_nobody_was_trained_on(self):
        for row, places in ((('lights', 'street', 'light'), ['rendered']), (('lights', 'room', 'light'), []),
                            (('tilde_webcam', 's', 'light'), []), (('iib_demo', 's', 'light'), ['light']), (('o', 'wall', 'viewpoint'), [])):
            self.assertEqual(summaries.curve_places(dict(zip(('set', 'sequence', 'kind'), row))), places, row)
        with tempfile.TemporaryDirectory() as folder:
            source, target = pathlib.Path(folder, 'in.csv'), pathlib.Path(folder, 'out.csv')
            source.write_text('set,sequence,kind,detector,descriptor,correspondences,curve\n'
                              'd,s,light,ORB,ORB,10,1:1 4:8\nd,t,light,ORB,ORB,20,0:0 8:8\nd,s,light,ORB,IIB SMALL,10,1:1 4:8\n')
            summaries.summarize_curves(source, target)
            self.assertEqual(target.read_text().splitlines()[1:], ['light,ORB,ORB,1,2,0.5,0.05,0', 'light,ORB,ORB,2,2,6,0.4,0.25'])

    def test_poses_are_judged_where_nothing_was_trained_or_chosen(self):
        heads = 'set', 'detector', 'descriptor', 'points', 'estimator', 'sequence', 'error', 'inliers'
        errors = {'strecha': (0, 5), 'strecha relit': (10,), 'facade_2': (2,), 'facade_1': (0,), 'walk_facade': (5,), 'walk_room': (0,), 'walk_terrain': (0,)}
        with tempfile.TemporaryDirectory() as folder:
            source, target = pathlib.Path(folder, 'in.csv'), pathlib.Path(folder, 'out.csv')
            with open(source, 'w', newline='') as file:
                csv.writer(file).writerows([heads] + [(name, 'Hessian', 'IIB', 'plain', 'MAGSAC', error, error, 9)
                                                      for name, some in errors.items() for error in some])
            summaries.summarize(source, target, *summaries.PLANS['estimators.csv'])
            with open(target, newline='') as file:
                found = {row['place']: row for row in csv.DictReader(file)}
        self.assertEqual({place: (row['pairs'], *(round(float(row[area]), 3) for area in ('at_10', 'at_5', 'at_2'))) for place, row in found.items()},
                         {'same light': ('2', .75, .5, .5), 'other light': ('2', .4, .3, 0), 'chosen on': ('2', .75, .5, .5)})
        self.assertEqual((found['same light']['low'], found['same light']['high']), ('0', '1'))

    def test_intervals(self):
        self.assertEqual(summaries.interval([[.5]] * 9), [.5, .5])
        low, high = summaries.interval([[0], [1]] * 50)
        self.assertAlmostEqual(low, .5 - 1.96 * .05, delta=.015)
        self.assertAlmostEqual(high, .5 + 1.96 * .05, delta=.015)
        one = summaries.interval([[0] * 50, [1] * 50])  # whole scenes are drawn: two say little
        self.assertEqual(one, [0, 1])

    def test_gains_are_of_the_same_pairs(self):
        rows = [('tilde_webcam', target, 'ORB', descriptor, 'light', correct, target)
                for descriptor, counts in (('ORB', (10, 30)), ('IIB', (20, 30, 99))) for target, correct in enumerate(counts)]
        heads = 'set', 'target', 'detector', 'descriptor', 'kind', 'correct', 'sequence'
        with tempfile.TemporaryDirectory() as folder:
            source, target = pathlib.Path(folder, 'in.csv'), pathlib.Path(folder, 'out.csv')
            with open(source, 'w', newline='') as file:
                csv.writer(file).writerows([heads, *rows, ('graf', 1, 'ORB', 'ORB', 'viewpoint', 9, 's')])
            summaries.summarize_gains(source, target)
            self.assertEqual(target.read_text().splitlines()[1:], ['ORB,2,1.2500,1.0000,2.0000'])


if __name__ == '__main__':
    unittest.main()
