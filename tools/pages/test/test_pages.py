#!/usr/bin/env python3
"""Tests groups of rows, intervals, and figures of speed and localization; needs pandas."""
import pathlib
import sys
import tempfile
import unittest
import unittest.mock

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import charts  # noqa: E402
import controls  # noqa: E402
import localization  # noqa: E402
import orders  # noqa: E402
import speed  # noqa: E402
import summaries  # noqa: E402
import tables  # noqa: E402
import timings  # noqa: E402
import ways  # noqa: E402


def summarized(lines, make, *arguments):
    """The rows that a function writes for a file with these lines."""
    with tempfile.TemporaryDirectory() as folder:
        source, target = pathlib.Path(folder, 'in.csv'), pathlib.Path(folder, 'out.csv')
        source.write_text('\n'.join(line if isinstance(line, str) else ','.join(map(str, line)) for line in lines))
        make(source, target, *arguments)
        return summaries.read(target)


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

    def test_alignments_count_by_what_was_made_of_a_pair(self):
        for image, model, places in (('moved by a HOMOGRAPHY', 'HOMOGRAPHY', ['tilde_webcam']), ('moved by a HOMOGRAPHY', 'AFFINE', ['models too simple']),
                                     ('moved by a SIMILARITY', 'SIMILARITY', ['right models']), ('moved by a SIMILARITY', 'AFFINE', ['models of more freedom']),
                                     ('with noise', 'AFFINE', ['with noise']), ('d/s/2', 'AFFINE', ['other scenes']), ('iib_demo/scene/2', 'AFFINE', []),
                                     ('logo d/s/2', 'AFFINE', ['other scenes with a logo']), ('logo iib_demo/scene/2', 'AFFINE', [])):
            row = {'set': 'tilde_webcam', 'sequence': 'courbevoie', 'image': image, 'model': model}
            self.assertEqual(summaries.alignment_place(row), places, (image, model))

    def test_views_count_by_what_was_chosen_on_a_scene(self):
        lines = ['set,sequence,kind,amount,method,found,right,matches,milliseconds', 's,wall,tilt,2,SIFT,1,4,9,1', 's,graf,tilt,2,SIFT,1,8,9,1', 's,wall,tilt,2,AffineFeature,1,9,9,1',
                 's,boat,tilt,2,SIFT,1,0,9,1', 'tilde_webcam,courbevoie/2 and iib_demo/scene/2,unrelated,,SIFT,1,0,9,1', 's,wall/2 and t/u/2,unrelated,,SIFT,0,0,9,1']
        found = {(row['place'], row['method']): (row['pairs'], row['right'], row['found'], row['misled']) for row in summarized(lines, summaries.summarize_views)}
        self.assertEqual(found, {('photographs', 'SIFT'): ('2', '6', '1', '0.5'), ('photographs', 'AffineFeature'): ('1', '9', '1', '0'), ('some photographs', 'SIFT'): ('1', '4', '1', '1'),
                                 ('some photographs', 'AffineFeature'): ('1', '9', '1', '0'), ('chosen on', 'SIFT'): ('1', '0', '1', '1'), ('unrelated', 'SIFT'): ('1', '0', '0', '0')})

    def test_curves_are_of_scenes_that_nobody_was_trained_on(self):
        for row, places in ((('lights', 'street', 'light'), ['rendered']), (('lights', 'room', 'light'), []),
                            (('tilde_webcam', 's', 'light'), []), (('iib_demo', 's', 'light'), ['light']), (('o', 'wall', 'viewpoint'), [])):
            self.assertEqual(summaries.curve_places(dict(zip(('set', 'sequence', 'kind'), row))), places, row)
        found = summarized(['set,sequence,kind,detector,descriptor,correspondences,curve', 'd,s,light,ORB,ORB,10,1:1 4:8', 'd,t,light,ORB,ORB,20,0:0 8:8',
                            'd,s,light,ORB,IIB SMALL,10,1:1 4:8'], summaries.summarize_curves)
        self.assertEqual([','.join(row.values()) for row in found], ['light,ORB,ORB,1,2,0.5,0.05,0', 'light,ORB,ORB,2,2,6,0.4,0.25'])

    def test_poses_are_judged_where_nothing_was_trained_or_chosen(self):
        heads = 'set', 'detector', 'descriptor', 'points', 'estimator', 'sequence', 'error', 'inliers'
        errors = {'strecha': (0, 5), 'strecha relit': (10,), 'facade_2': (2,), 'facade_1': (0,), 'room_31': (3,), 'list pairs.txt: 7': (15,), 'room_0': (0,)}
        lines = [(name, 'Hessian', 'IIB', 'plain', 'MAGSAC', error, error, 9) for name, some in errors.items() for error in some]
        found = {row['place']: row for row in summarized([heads, *lines], summaries.summarize, *summaries.PLANS['estimators.csv'])}
        self.assertEqual({place: (row['pairs'], *(round(float(row[area]), 3) for area in ('at_20', 'at_10', 'at_5', 'at_2'))) for place, row in found.items()},
                         {'same light': ('2', .875, .75, .5, .5), 'other light': ('1', .9, .8, .6, 0), 'list pairs.txt': ('1', .25, 0, 0, 0)})
        self.assertEqual((found['same light']['low'], found['same light']['high']), ('0', '1'))

    def test_ways_to_a_pose_gain_on_the_same_pairs(self):
        heads = 'set,sequence,target,detector,points,matches,estimator,error,milliseconds'
        errors = {('recommended chain', 1000): (0, 5), ('recommended chain', 4000): (0, 0), ('ORB', 1000): (5, 0), ('ORB', 3000): (2.5, 5)}
        lines = ['%s,night,0-1,%s,%d,m,any,%g,7' % (place, *way, error) for way, of in errors.items() for place, error in zip(('yard_2', 'hall_2'), of)]
        found = summaries.by(summarized([heads, *lines, 'yard_1,night,0-1,ORB,1000,m,any,0,7'], ways.summarize), 'detector', 'points')
        self.assertEqual({key: (row['pairs'], row['at_5'], row['gain'], row['over_most'], row['over_most_low'], row['over_most_high']) for key, row in found.items() if key[0] == 'ORB'},
                         {('ORB', '1000'): ('2', '0.5', '0', '-0.5', '-1', '0'), ('ORB', '3000'): ('2', '0.25', '-0.75', '-0.75', '-1', '-0.5')})

    def test_a_detector_that_nobody_placed_is_drawn(self):
        row = {'milliseconds': '9', 'at_5': '.5', 'low': '.4', 'high': '.6'}
        with unittest.mock.patch.object(ways, 'found', lambda: {('new one', points, 'm'): {'plain': row, 'refined': row} for points in (9, 8)}):
            self.assertIn('<!-- 8, 9 -->', charts.cost())  # the text of a line in matplotlib's SVG

    def test_intervals(self):
        self.assertEqual(summaries.interval([[.5]] * 9), [.5, .5])
        low, high = summaries.interval([[0], [1]] * 50)
        self.assertAlmostEqual(low, .5 - 1.96 * .05, delta=.015)
        self.assertAlmostEqual(high, .5 + 1.96 * .05, delta=.015)
        one = summaries.interval([[0] * 50, [1] * 50])  # whole scenes are resampled, and two say little
        self.assertEqual(one, [0, 1])

    def test_a_ratio_is_chosen_on_other_places(self):
        heads = 'set,sequence,target,detector,descriptor,noise,ratio,error,matches'
        errors = {('yard_2', '0.8'): 0, ('yard_2', '0.9'): 5, ('room_2', '0.8'): 2.5, ('room_2', '0.9'): 1, ('court_2', '0.8'): 'inf', ('court_2', '0.9'): 2.5}
        lines = ['%s,night,1,%s,%s,0,%s,%s,9' % (place, *method, ratio, error if method[0] == 'ORB' else 0)
                 for (place, ratio), error in errors.items() for method in (controls.CHAIN, ('ORB', 'ORB'))]
        self.assertEqual(summarized([heads], controls.summarize), [])
        found = summaries.by(summarized([heads, *lines], controls.summarize), 'place', 'detector', ratio='best')
        # the best ratio is .9 without yard, and .8 without room or court
        self.assertEqual({place: (row['pairs'], row['at_5'], row['less'], row['poses'], row['wrong']) for (place, name), row in found.items() if name == 'ORB' and place in (
            'yard', 'room', 'court', 'other light')},
            {'yard': ('1', '0', '1', '1', '0'), 'room': ('1', '0.5', '0.5', '1', '0'), 'court': ('1', '0', '1', '0', '0'), 'other light': ('2', '0.25', '0.75', '2', '0')})

    def test_bounds_of_rates(self):
        self.assertAlmostEqual(controls.upper_bound(0, 446), 1 - .05 ** (1 / 446), delta=1e-9)
        self.assertAlmostEqual(controls.upper_bound(1, 10), .394, delta=.001)  # from Clopper and Pearson's tables

    def test_gains_are_of_the_same_pairs(self):
        rows = [('tilde_webcam' if target else 'iib_demo', target, 'ORB', descriptor, 'light', correct, target)
                for descriptor, counts in (('ORB', (10, 30)), ('IIB', (20, 30, 99))) for target, correct in enumerate(counts)]
        heads = 'set', 'target', 'detector', 'descriptor', 'kind', 'correct', 'sequence'
        found = summarized([heads, *rows, ('graf', 1, 'ORB', 'ORB', 'viewpoint', 9, 's')], summaries.summarize_gains)
        self.assertEqual([','.join(row.values()) for row in found], ['light,ORB,1,1,2.0000,2.0000,2.0000', 'natural,ORB,2,2,1.2500,1.0000,2.0000'])

    def test_orders_are_of_the_same_pairs(self):
        recalls = {'IIB': (.5, .7, .6), 'IIB sort': (.4, .5, .4), 'IIB max': (.5, .9, .5), 'IIB overlap': (.4, .6, .5)}
        lines = ['%s,%s,%d,light,%s,9,0.9,%g' % (data, scene, target, name, recall) for data in ('iib_demo', 'lights') for name in
                 {name for groups in orders.ORDERS.values() for group in groups for name in group}
                 for scene, target, recall in zip(('s', 's', 't'), (0, 1, 0), recalls.get(name, (.1, .2, .3)))]
        found = summarized(['set,sequence,target,kind,configuration,bytes,precision,recall', *lines], orders.summarize)
        steps = summaries.by(found, 'more', 'less', place='light')
        self.assertEqual([','.join(list(steps['IIB', name].values())[3:]) for name in ('IIB sort', 'IIB max')], ['3,2,0.1667,0.15,0.2', '3,2,-0.03333,-0.1,0.1'])
        means = [{'place': place, 'configuration': name, 'recall': summaries.mean(recalls.get(name, (.1, .2, .3))), 'precision': .5 if name == 'ORB' else .595, 'pairs': '3'}
                 for place in orders.GROUPS for name in {'ORB', *(row['more'] for row in found), *(row['less'] for row in found)}]
        with unittest.mock.patch.object(timings, 'rows', {'fixed_points.csv': means, 'orders.csv': found}.get):
            lines = dict(line[2:].split(' | ')[:2] for line in orders.table(['ORB']).splitlines()[2:])
        self.assertEqual({name: lines[name].partition(':')[0] for name in ('SORT below MEAN', 'MAX below MEAN', 'overlap above none', 'g5 above g4 above g3 above g2',
                                                                           '0.1 precision above every other descriptor')},
                         {'SORT below MEAN': 'yes', 'MAX below MEAN': 'level', 'overlap above none': '**no**', 'g5 above g4 above g3 above g2': '**no**',
                          '0.1 precision above every other descriptor': '**no**'})
        self.assertEqual(lines['overlap above none'], '**no**: overlap above IIB by -0.100 (-0.100 to -0.100)')

    def test_uncertainty(self):
        with tempfile.TemporaryDirectory() as folder:
            source, target = pathlib.Path(folder, 'uncertainty.csv'), pathlib.Path(folder, 'out.csv')
            source.write_text('set,sequence,quantity,count,0.1,0.25,0.5,0.75,0.9,0.95,0.99,log_deviation,score\nstrecha,a,points,4,0,0,1,2,3,4,4,0,8\n'
                              'strecha,b,points,4,0,0,1,2,3,4,4,0,0\nstrecha,a,points,0,0,0,0,0,0,0,0,0,0\nfacade_31,dusk,points,0,0,0,0,0,0,0,0,0,0\n'
                              'room_31,night,centre of Localizer,1,0,0,1,1,1,1,1,0,1\nroom_31,night,centre of Localizer,0,0,0,0,0,0,0,0,0,0\n')
            summaries.summarize_uncertainty(source, target)
            self.assertEqual([line.split(',')[-12:] for line in target.read_text().splitlines()[1:]], [
                ['3', '2', '8', '0', '0', '0.25', '0.5', '0.75', '1', '1', '1', '1'], ['1', '0', '0'] + 9 * [''],
                ['2', '1', '1', '0', '0', '1', '1', '1', '1', '1', '1', '1']])
            self.assertEqual(1, target.read_text().count('rendered places, by night'))
            with unittest.mock.patch.object(timings, 'RESULTS', pathlib.Path(folder)):
                target.replace(source)
                self.assertIn('| 3 | 2 | 8 | 25 | 100 | 100 | 1 | 1 |', tables.uncertainty())
                self.assertIn('| 1 | 0 | 0 | – | – | – | – | – |', tables.uncertainty())
                self.assertEqual(tables.inside('0.95', 'points'), '100 to 100')
                self.assertIn('<svg', charts.uncertainty())

    def test_the_least_time_of_each_instruction_set_counts(self):
        case = '<testcase classname="%s" name="%s" value_param="%s"><properties><property name="min" value="%d"/>' \
            '<property name="frequency" value="1000"/></properties></testcase>'
        with tempfile.TemporaryDirectory() as folder:
            files = []
            for n, (features, time) in enumerate((('SSE2 *SSE4.2 *AVX2', 9), ('SSE2 *SSE4.2 *AVX2', 7), ('SSE2 *SSE4.2 *AVX2?', 11))):
                files.append(pathlib.Path(folder, '%d.xml' % n))
                files[-1].write_text('<testsuites cv_version="4" cv_cpu_features="%s">%s%s</testsuites>' % (
                    features, case % ('A_b', 'b/0', '(HierarchicalMatcher::EXACT, &quot;x y&quot;, 3)', time), case % ('C', 'd', '', time)))
            with unittest.mock.patch.object(sys, 'argv', ['speed.py', folder + '/out.csv', 'a commit', 'a machine', *map(str, files)]), \
                    unittest.mock.patch.object(speed, 'today', lambda: '2001-01-01'):
                speed.main()
            self.assertEqual(pathlib.Path(folder, 'out.csv').read_text(), '# OpenCV 4, a machine, 2001-01-01\ntest,parameters,points,AVX2,SSE4.2\n'
                             'A_b,EXACT/x y/3,,7,11\nC_d,,,7,11\n')

    def test_the_worst_light_counts(self):
        rows = [{'place': place, 'method': 'recommended chain', 'light': light, 'images': 20, 'within_5': 20, 'within_25': 20}
                for place in ('street', 'every 2', 'every 4') for light in ('night', 'fog')]
        rows[3]['within_5'] = 17
        self.assertEqual([found for _, found in localization.worst({'rows': rows, 'unknown': (3, 200)})],
                         ['100 %', '100 %', '85 %', '100 %', localization.share(3, 200)])
        self.assertEqual([localization.share(20, 20), localization.share(0, 10)], ['100 % (84 to 100)', '0 % (0 to 28)'])

    def test_each_file_is_known_by_the_run_that_made_its_rows(self):
        heads = 'reference,target,detector,descriptor,x,y,target_x,target_y,correct\n'
        with tempfile.TemporaryDirectory() as folder:
            pairs, out = pathlib.Path(folder, 'pairs'), pathlib.Path(folder, 'out')
            pairs.mkdir(), out.mkdir()
            (out / 'runs.csv').write_text('file,commit,date,machine\ncomparison.csv,old,1999-01-01,m\nmatching.csv,old,1999-01-01,m\n')

            def runs(text, commit, today):
                (pairs / 'comparison.csv').write_text(text)
                with unittest.mock.patch.object(sys, 'argv', ['summaries.py', str(pairs), str(out), commit, 'on ' + commit]), \
                        unittest.mock.patch.object(summaries, 'today', lambda: today):
                    self.assertEqual(summaries.main(), 0)
                return [','.join(row.values()) for row in summaries.read(out / 'runs.csv')]
            other = 'matching.csv,old,1999-01-01,m'
            self.assertEqual(runs(heads, 'a', '2001-01-01'), ['comparison.csv,a,2001-01-01,on a', other])
            self.assertEqual(runs(heads, 'b', '2002-02-02'), ['comparison.csv,a,2001-01-01,on a', other])  # nothing was measured
            self.assertEqual(runs(heads + 'r,t,ORB,ORB,1,1,1,1,1\n', 'a;c', '2003-03-03'), ['comparison.csv,a;c,2003-03-03,on a;c', other])

    def test_without_poses_there_is_no_error(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder, 'setups.csv')
            file.write_text('map,setup,light,images,found,within_5,lateral,longitudinal,altitude,orientation\n'
                            'near,,fog,30,0,0,0,0,0,0\nnear,,dusk,30,10,5,1,2,3,.5\nfar,,fog,30,0,0,0,0,0,0\n')
            self.assertEqual(list(tables.setups(('map',), file)), [['near', '60', '10', '8 %', '1.0 cm', '2.0 cm', '3.0 cm', '0.50°'],
                                                                   ['far', '30', '0', '0 %', '–', '–', '–', '–']])


if __name__ == '__main__':
    unittest.main()
