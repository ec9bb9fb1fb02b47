#!/usr/bin/env python3
"""Summarizes an evaluation for tables and pages: summaries.py PAIRS OUT [COMMIT MACHINE]

PAIRS: folder of iib_evaluation's results, with a row for each pair of images. OUT gets one row per group: means over its pairs, their
number, and the 95 % confidence interval of the last mean (low, high; bootstrap over scenes).
With COMMIT (or several, of all rows) and MACHINE, runs.csv records the run of each file whose summary changed.
"""
import collections
import csv
import datetime
import math
import pathlib
import random
import re
import sys

TRAINED_ON = {'tilde_webcam', 'amos_daynight'}  # by the presets
RENDERED = {'lights'}
TRAINED_ON_RENDERED = {'IIB UNIVERSAL', 'IIB SMALL'}  # on walks through these scenes
UNSEEN_SCENES = {'street', 'facade'}  # rendered scenes without them
# Pairs in other light on which rules for matches and poses were chosen: sets, and seeds of places (tools/synthetic/views.py); 0 is that of
# the walks on which presets were trained.
CHOSEN_ON = {'strecha relit'}
CHOSEN_SEEDS = {'0', '1', '21', '22', '23', '31', '32'}
# Scenes that the constants of matchViews were chosen on, and one of the same place.
CHOSEN_VIEWS = {'Herz-Jesus-P8', 'entry-P10', 'chamonix', 'courbevoie', 'boat', 'bikes', 'cam01', 'cam04', 'scene'}
SAME_PLACE = {'iib_demo/scene', 'tilde_webcam/courbevoie'}
VISITS = {'dusk', 'fog', 'morning', 'night', 'overcast', 'snow', 'wet', 'winter'}  # sequences of one place in other lights
MODELS = ('TRANSLATION', 'SIMILARITY', 'AFFINE', 'HOMOGRAPHY')
DRAWS = 400  # of the bootstrap


def is_learned(name):
    """Whether images chose its bits: presets of IIB and selections, such as IIB S128 or IIB AdaBoost-128."""
    return bool(re.match('IIB [A-Z][A-Za-z]*-?[0-9]*$', name))


def places(row):
    """Groups that a pair counts in: `natural`, all photographs under changed light; `light`, those of them that nothing was
    trained on; `rendered` light; or what moved or blurred the image, by kind and by sequence. What was trained on some pairs is
    judged by the others alone."""
    name = row.get('configuration') or row.get('descriptor') or ''
    if row['set'] in RENDERED:
        return [] if name in TRAINED_ON_RENDERED else ['rendered']
    if row['kind'] != 'light':
        return [row['kind'], row['sequence']]
    return [] if row['set'] in TRAINED_ON and is_learned(name) else ['natural'] * (not is_learned(name)) + ['light'] * (row['set'] not in TRAINED_ON)


def curve_places(row):
    """Groups of curves, which share one picture: scenes that nothing was trained on."""
    if row['set'] in RENDERED:
        return ['rendered'] * (row['sequence'] in UNSEEN_SCENES)
    return ['light'] * (row['kind'] == 'light' and row['set'] not in TRAINED_ON)


def light_place(row):
    """The group of a pose: views in one light, in two, or of a list; none where something was chosen on them."""
    if row['set'] == 'strecha':
        return ['same light']
    if row['set'].startswith('list '):  # of pairs, by tools/evaluation/pair_list.py
        return [row['set'].partition(':')[0]]
    seed = re.fullmatch('[a-z]+_([0-9]+)', row['set'])
    chosen = row['set'] in CHOSEN_ON or seed and seed[1] in CHOSEN_SEEDS
    return [] if chosen or row['set'] in TRAINED_ON else ['other light']


def scene(row):
    """The unit that the bootstrap draws: a sequence, or a place."""
    return row['set'].partition(':')[0], '' if row.get('sequence') in VISITS else row.get('sequence')


def pose_area(limit):
    """1 without an error of the pose, falling to 0 at the limit in degrees; the mean is the area under the curve."""
    return lambda row: max(0, 1 - float(row['error']) / limit)


def alignment_place(row):
    """The group of an alignment; the demo's photographs show the same place as the webcam Courbevoie."""
    if row['image'].startswith('moved by a '):
        least, model = (MODELS.index(name) for name in (row['image'].rsplit(' ', 1)[1], row['model']))
        return ['models too simple' if model < least else row['set'] if least == MODELS.index('HOMOGRAPHY') else 'models of more freedom'
                if model > least else 'right models']
    if row['image'] == 'with noise':
        return ['with noise']
    logo, other = ' with a logo' * row['image'].startswith('logo '), row['image'].removeprefix('logo ')
    scenes = {row['set'] + '/' + row['sequence'], other.rsplit('/', 1)[0]}
    return ['other scenes' + logo] * (scenes != SAME_PLACE)


def view_place(row):
    """The group of a warped view: photographs, scenes that constants were chosen on, or pairs of different sets."""
    if row['kind'] == 'unrelated':
        one, other = row['sequence'].split(' and ')
        return ['unrelated'] * ({row['set'] + '/' + one.rsplit('/', 1)[0], other.rsplit('/', 1)[0]} != SAME_PLACE)
    if row['set'] in RENDERED or re.match('synthetic|[a-z]+_[0-9]+$', row['set']):
        return ['rendered']
    return ['chosen on' if row['sequence'] in CHOSEN_VIEWS else 'photographs']


def column(name):
    """None where it is empty."""
    return lambda row: float(row[name]) if row[name] else None


def within(pixels):
    """Whether the mean error of the corners is within the limit."""
    return lambda row: float(row['error'] or 'inf') <= pixels


def mean(values):
    return sum(values) / len(values)


def shown(values):
    """The mean of the values that are not None, as text."""
    known = [value for value in values if value is not None]
    return '%.5g' % mean(known) if known else ''


def interval(scenes, statistic=mean):
    """Ends of the 95 % confidence interval of a statistic of all values, by bootstrap. `scenes`: a list of values per scene."""
    chance, scenes = random.Random(1), list(scenes)
    drawn = sorted(statistic([v for scene in chance.choices(scenes, k=len(scenes)) for v in scene]) for _ in range(DRAWS))
    return [drawn[at] for at in (DRAWS // 40, DRAWS - 1 - DRAWS // 40)]


def columns(*names):
    return {name: column(name) for name in names}


# File: the groups of a row, further columns that make a group, averaged columns.
PLANS = {
    'fixed_points.csv': (places, ('configuration', 'bytes'), columns('precision', 'recall')),
    'detected_points.csv': (places, ('detector', 'descriptor', 'bytes'), columns('precision', 'recall', 'correct')),
    'matching.csv': (places, ('matcher',), columns('precision', 'cost', 'milliseconds', 'recall')),
    'robustness.csv': (lambda row: ['turned'] * (row['set'] not in TRAINED_ON), ('kind', 'configuration', 'target'),
                       columns('precision', 'recall')),
    'alignment.csv': (alignment_place, ('model',), {'found': column('found'), 'squares': column('squares'), 'within_1': within(1), 'within_3': within(3)}),
    'wxbs.csv': (lambda row: [row['set'], 'all'], ('method', 'points'), columns('found', 'matches', 'within_10', 'share')),
    'estimators.csv': (light_place, ('detector', 'descriptor', 'points', 'estimator'),
                       {'inliers': column('inliers'), 'at_10': pose_area(10), 'at_2': pose_area(2), 'at_20': pose_area(20), 'at_5': pose_area(5)}),
}


def read(file):
    """Rows of a CSV file as dictionaries; empty if there is none."""
    if not file.is_file():
        return []
    with open(file, newline='') as opened:
        return list(csv.DictReader(opened))


def group(rows, *names):
    """Rows by the values of columns, in the order of first appearance."""
    groups = {}
    for row in rows:
        groups.setdefault(tuple(row[name] for name in names), []).append(row)
    return groups


def table(head, lines):
    """A table in Markdown."""
    text = ['| ' + ' | '.join(head) + ' |', '|---' * len(head) + '|']
    return '\n'.join(text + ['| ' + ' | '.join(line) + ' |' for line in lines])


def by(rows, *names, **where):
    """The first row for each value, or combination of values, of the columns, among rows with the values of `where`."""
    chosen = [row for row in rows if all(row[name] == value for name, value in where.items())]
    return {key if len(names) > 1 else key[0]: members[0] for key, members in group(chosen, *names).items()}


def score(row):
    """The area up to 5 degrees with its interval."""
    return '%.2f (%.2f to %.2f)' % tuple(float(row[name]) for name in ('at_5', 'low', 'high'))


def write(file, heads, rows):
    with open(file, 'w', newline='') as opened:
        csv.writer(opened, lineterminator='\n').writerows([heads, *rows])


def pair_of(row, *more):
    return tuple(row[name] for name in ('set', 'sequence', 'target', *more))


def summarize(source, target, groups_of, keys, values):
    """Writes means of each group; of estimators, also of the pairs that findRelativePose answers."""
    groups, every_row = collections.defaultdict(lambda: collections.defaultdict(list)), read(source)
    method = 'detector', 'descriptor', 'points'
    refused = {pair_of(row, *method) for row in every_row if row.get('estimator') == 'findRelativePose' and row['error'] == 'inf'}
    for row in every_row:
        for place in groups_of(row) + [place + ', answered' for place in groups_of(row) if refused and pair_of(row, *method) not in refused]:
            groups[(place, *(row[key] for key in keys))][scene(row)].append([value(row) for value in values.values()])
    lines = []
    for key, scenes in sorted(groups.items()):
        every = [pair for scene in scenes.values() for pair in scene]
        ends = interval([[pair[-1] for pair in scene] for scene in scenes.values()])
        lines.append([*key, len(every), *(shown(of) for of in zip(*every)), *('%.4g' % end for end in ends)])
    write(target, ['place', *keys, 'pairs', *values, 'low', 'high'], lines)


def misled(row):
    """Whether most matches are wrong although the method calls them significant."""
    return float(row['found'] == '1' and 2 * int(row['right']) < int(row['matches']))


def summarize_views(source, target):
    """Matches of each method by the change of the view; also for the photographs that the slow method matched."""
    slow = {(row['set'], row['sequence']) for row in read(source) if row['method'] == 'AffineFeature'}

    def places(row):
        found = view_place(row)
        return found + ['some photographs'] * (found == ['photographs'] and (row['set'], row['sequence']) in slow)
    summarize(source, target, places, ('kind', 'amount', 'method'), {**columns('found', 'matches', 'milliseconds'), 'misled': misled, **columns('right')})


def gain(pairs):
    """The sum of the second counts over the sum of the first."""
    return sum(ours for _, ours in pairs) / max(1, sum(own for own, _ in pairs))


def summarize_gains(source, target):
    """Right matches of the default descriptor over those of a detector's own descriptor, at its points, for all pairs in changed light and for
    sets that nothing was trained on."""
    counts = collections.defaultdict(dict)
    for row in read(source):
        for place in {'natural', 'light'}.intersection(places(row)):
            counts[place, row['detector'], row['descriptor']][pair_of(row)] = int(row['correct'])
    lines = []
    for place, detector in sorted(key[:2] for key in counts if key[1] == key[2]):
        own, ours, scenes = counts[place, detector, detector], counts[place, detector, 'IIB'], collections.defaultdict(list)
        for pair in sorted(own.keys() & ours):
            scenes[pair[:2]].append((own[pair], ours[pair]))
        pairs = [pair for scene in scenes.values() for pair in scene]
        lines.append([place, detector, len(pairs), len(scenes)] + ['%.4f' % v for v in (gain(pairs), *interval(scenes.values(), gain))])
    write(target, ['place', 'detector', 'pairs', 'scenes', 'gain', 'low', 'high'], lines)


def summarize_curves(source, target):
    """Right matches, recall and 1 - precision against the threshold: a step is 1/32 of the distance of unrelated descriptors."""
    groups = collections.defaultdict(list)
    for row in read(source):
        if row['descriptor'] in (row['detector'], 'IIB', 'IIB UNIVERSAL'):
            for place in curve_places(row):
                steps = [[int(count) for count in step.split(':')] for step in row['curve'].split()]
                groups[place, row['detector'], row['descriptor']].append((steps, max(1, int(row['correspondences']))))
    lines = []
    for key, pairs in sorted(groups.items()):
        for step in range(len(pairs[0][0])):
            right = [steps[step][0] for steps, _ in pairs]
            wrong = [1 - steps[step][0] / steps[step][1] if steps[step][1] else 0 for steps, _ in pairs]
            recall = [steps[step][0] / correspondences for steps, correspondences in pairs]
            lines.append([*key, step + 1, len(pairs), *('%.4g' % mean(v) for v in (right, recall, wrong))])
    write(target, ['place', 'detector', 'descriptor', 'threshold', 'pairs', 'right', 'recall', 'one_minus_precision'], lines)


DRAWN = 10  # one in so many matches is drawn


def summarize_comparison(source, target):
    """Counts of right and wrong matches of each method, and every tenth match: x, y, x and y of the other image, whether it is right."""
    heads, lines = ('reference', 'target', 'detector', 'descriptor'), []
    for key, rows in sorted(group(read(source), *heads).items()):
        right = sum(row['correct'] == '1' for row in rows)
        drawn = (row[name] for row in rows[::DRAWN] for name in ('x', 'y', 'target_x', 'target_y', 'correct'))
        lines.append([*key, right, len(rows) - right, ' '.join(drawn)])
    write(target, [*heads, 'right', 'wrong', 'matches'], lines)


def summarize_learned(source, target):
    """Updates learned.csv: matches of IIB at the points of learned detectors, and of their own descriptors where files have them."""
    found, lines = collections.defaultdict(list), read(target)
    if not lines:
        return
    for row in read(source):
        if 'natural' in places(row):
            found[row['detector'].lower(), row['descriptor']].append(int(row['correct']))
    for line in lines:
        name = line['detector'].lower()
        own = next((counts for (detector, descriptor), counts in found.items() if detector == descriptor.lower() == name), None)
        if found[name, 'IIB']:
            line.update(iib='%.0f' % mean(found[name, 'IIB']), pairs=len(found[name, 'IIB']))
        if own:
            line.update(correct='%.0f' % mean(own), source='measured here')
    write(target, list(lines[0]), (line.values() for line in lines))


LEVELS = '0.1', '0.25', '0.5', '0.75', '0.9', '0.95', '0.99'
DATA = {'amos_daynight': 'webcams over a day', 'tilde_webcam': 'webcams over a year', 'mefb_exposure': 'other exposures',
        'photometric_stereo': 'other lamps', 'middlebury2014': 'other lamps and exposures (rooms)', 'iib_demo': "the authors' scene",
        'strangers': 'images of different places', 'oxford_affine': 'other exposures (leuven)', 'strecha rectified': 'the same photographs, rectified', 'strecha': "photographs with a laser's poses, one light"}
PLACES = {'night': 'rendered places, by night', 'dusk': 'rendered places, at dusk', 'winter': 'rendered places, in winter'}


def data_of(name, light):
    """The kind of data of a set."""
    return DATA.get(name) or PLACES.get(light, 'other data')


def summarize_uncertainty(source, target):
    """For each quantity and kind of data: number of pairs or images, those with a result, errors, the share of errors within the limit of each
    level, the geometric mean of the reported standard deviations, and the mean logarithmic score."""
    found = {}
    for row in read(source):
        count = int(row['count'])
        key = row['quantity'], data_of(row['set'], row['sequence'])
        found.setdefault(key, []).append([1, count > 0, count, *(int(row[level]) for level in LEVELS), float(row['log_deviation']), float(row['score'])])
    lines = []
    for key, counts in sorted(found.items(), key=lambda item: ('Localizer' in item[0][0], item[0])):
        pairs, answered, errors, *sums = map(sum, zip(*counts))
        *shares, deviation, score = (value / max(errors, 1) for value in sums)
        numbers = ['%.5g' % value for value in (*shares, math.exp(deviation), score)]
        lines.append([*key, pairs, answered, errors, *(numbers if errors else [''] * len(numbers))])
    write(target, ['quantity', 'data', 'pairs', 'found', 'errors', *LEVELS, 'deviation', 'score'], lines)


OTHERS = {'gains.csv': ('detected_points.csv', summarize_gains), 'curves.csv': ('detected_points.csv', summarize_curves),
          'learned.csv': ('detected_points.csv', summarize_learned), 'comparison.csv': ('comparison.csv', summarize_comparison),
          'uncertainty.csv': ('uncertainty.csv', summarize_uncertainty), 'views.csv': ('views.csv', summarize_views)}


def today():
    return str(datetime.date.today())


def remember(file, found):
    """Adds the runs (commit, date, machine) of files, by name, to the list of runs."""
    runs = {row['file']: list(row.values())[1:] for row in read(file)}
    runs.update(found)
    write(file, ['file', 'commit', 'date', 'machine'], ([name, *runs[name]] for name in sorted(runs)))


def text_of(file):
    return file.read_text() if file.is_file() else ''


def main():
    if len(sys.argv) not in (3, 5) or not pathlib.Path(sys.argv[1]).is_dir():
        print(__doc__.split('\n\n')[0] + '; PAIRS must be one', file=sys.stderr)
        return 2
    pairs, out = map(pathlib.Path, sys.argv[1:3])
    import controls  # which imports this, as do the others
    import orders
    import ways
    plans = {name: (name, lambda source, target: summarize(source, target, *PLANS[target.name])) for name in PLANS}
    of_modules = {'controls.csv': ('controls.csv', controls.summarize), 'neighbours.csv': ('neighbours.csv', controls.summarize_neighbours),
                'poses_by_time.csv': ('poses_by_time.csv', ways.summarize), 'orders.csv': ('fixed_points.csv', orders.summarize)}
    made = {name: how for name, how in {**plans, **OTHERS, **of_modules}.items() if (pairs / how[0]).is_file()}
    before = {name: text_of(out / name) for name in made}
    for name, (source, make) in made.items():
        make(pairs / source, out / name)
    if sys.argv[3:]:  # the networks' own counts are entered by hand
        remember(out / 'runs.csv', {name: [sys.argv[3], today(), sys.argv[4]] for name in made if text_of(out / name) != before[name] and name != 'learned.csv'})
    return 0


if __name__ == '__main__':
    sys.exit(main())
