"""Tables and sentences of figures in README.md and in pages of doc, of the results in doc/results, as Markdown.

They stand between the lines `<!-- figures NAME -->` and `<!-- end of figures -->`, NAME being a function below or one of the paper's
tables. ALL has them.
"""
import functools
import itertools
import json
import pathlib
import re
import sys

import controls
import questions
import summaries
from releases import artifacts, fuzzing, night
from summaries import table
from timings import RESULTS, chains, describing, machine, matching, rows, same_points, speed_claim, step_by_step

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
PAPER = summaries.read(HERE / 'paper.csv')  # the paper's figures, by the questions of its tables and our names
LOCALIZATION = summaries.read(HERE / 'paper_localization.csv')


def precision_recall(row):
    return '%.3f / %.3f' % (float(row['precision']), float(row['recall'])) if row else '–'


def detected_points():
    """Points detected in both images: all photographs under changed light, those that nothing was trained on, and rendered scenes."""
    found, lines = summaries.by(rows('detected_points.csv'), 'place', 'detector', 'descriptor'), []
    for detector, own in (('ORB', 'ORB'), ('AKAZE', 'AKAZE'), ('SIFT', 'SIFT'), ('BRISK', 'BRISK'), ('KAZE', 'KAZE'), ('SURF', 'SURF'),
                          ('FAST', 'ORB'), ('AGAST', 'ORB')):
        cells = []
        for place, (descriptor, form) in itertools.product(('natural', 'light', 'rendered'), ((own, '%s'), ('IIB', '**%s**'))):
            row = found[place, detector, descriptor]
            cells.append(form % ('%.0f, %.0f %%' % (float(row['correct']), 100 * float(row['precision']))))
        lines.append([detector, own, *cells])
    pairs = [found[place, 'ORB', 'IIB']['pairs'] for place in ('natural', 'light', 'rendered')]
    return table(['points of', 'descriptor', 'photographs, %s pairs' % pairs[0], 'IIB', 'of other sets, %s pairs' % pairs[1], 'IIB', 'rendered, %s pairs' % pairs[2], 'IIB'],
                 lines)


def learned_points():
    """What the networks' own descriptors and IIB's default match at the networks' points."""
    return table(['points of', 'pairs', 'own descriptor, bytes', 'correct a pair', 'IIB: correct'],
                 [[row[c] for c in ('detector', 'pairs', 'bytes', 'correct', 'iib')] for row in rows('learned.csv')])


@functools.lru_cache(None)
def poses_by_time():
    """Of each detector, number of points and way of matching: of its matches as they are, by the better of PoseLib's thresholds, and refined
    here, milliseconds a pair and the areas up to 5 and 10 degrees."""
    found = {}
    for row in rows('poses_by_time.csv'):
        ways, way = found.setdefault((row['detector'], int(row['points']), row['matches']), {}), 'plain' if 'PoseLib' in row['estimator'] else 'refined'
        if way not in ways or float(row['at_5']) > float(ways[way]['at_5']):
            ways[way] = row
    return dict(sorted(found.items(), key=lambda item: float(item[1]['refined']['at_5'])))


def poses_and_time():
    """Poses by each detector over processor time, on the same pairs."""
    lines = []
    for (detector, points, matches), ways in reversed(poses_by_time().items()):
        lines.append([detector, str(points), matches])
        for row in (ways['plain'], ways['refined']):
            lines[-1] += ['%.2f (%.2f to %.2f)' % tuple(float(row[name]) for name in ('at_5', 'low', 'high')), '%.2f' % float(row['at_10']),
                          '%.0f' % float(row['milliseconds'])]
    return table(['points of', 'points', 'matches', 'as they are, PoseLib', 'up to 10°', 'ms a pair', 'refined here', 'up to 10°', 'ms a pair'], lines)


def learned_and_chain():
    """Of 1000 of ALIKED's points, as many of the chain's and four times as many, all refined here: scores, and times by the chain's, as they are
    shown; scores of 2048 of ALIKED's; the pairs."""
    found = poses_by_time()
    learned, *chain = (found[key]['refined'] for key in (('ALIKED-n16', 1000, 'LightGlue'), *(('recommended chain', points, 'mutual, a ratio') for points in (1000, 4000))))
    best = found['ALIKED-n16', 2048, 'LightGlue']
    return {'learned': '%.2f' % float(learned['at_5']), 'few': '%.2f' % float(chain[0]['at_5']), 'many': '%.2f' % float(chain[1]['at_5']),
            'most': '%.2f' % float(best['refined']['at_5']), 'most_plain': '%.2f' % float(best['plain']['at_5']),
            'times': '%.0f' % (float(learned['milliseconds']) / float(chain[1]['milliseconds'])), 'pairs': learned['pairs'],
            'runs': other_run(learned, chain[1])}


def other_run(*rows):
    """What is to be said of times that are compared, where they are of different runs."""
    return ', timed in different runs' if len({row['commit'] for row in rows}) > 1 else ''


def learned_limit():
    """README's sentence on learned features."""
    return ('- [Learned features](doc/guide.md#learned-features), of which ALIKED with LightGlue was tried, find better poses of as many points: of 1000 a score of {learned}, refined here, where the\n'
            '  chain has {few} ({pairs} pairs). On one thread of a busy CPU, 4000 points of the chain have {many} and took [1/{times} of the time](doc/results/README.md#learned-features-and-time)\n'
            "  of ALIKED's 1000 in PyTorch{runs}; no GPU was timed.").format(**learned_and_chain())


def learned_guide():
    """The guide's sentence on the same."""
    return ('With as many points ALIKED with LightGlue, the one learned matcher that was tried, finds better poses than the chain: 1000, refined, have a score of {learned}, of the chain {few};\n'
            '2048 have {most_plain} as they are and {most} refined. 4000 of the chain have {many}, in 1/{times} of the processor time that 1000 of ALIKED take in PyTorch on one thread{runs}\n'
            '([figures](results/README.md#learned-features-and-time), with OpenCV 4.11). No GPU was timed.').format(**learned_and_chain())


def classic_detectors():
    """How OpenCV's detectors are used where time is measured."""
    return ('ORB, AKAZE and SIFT are upright, as in the table of poses, and without the copies that SIFT makes of points. ORB and SIFT take two calls for that,\n'
            'and so more time than where they are oriented.')


def learned_claim():
    """What may be said of learned features and the chain."""
    found = poses_by_time()
    chain = {points: found['recommended chain', points, 'mutual, a ratio']['refined'] for points in (1000, 2000, 4000)}
    few, many = (found['ALIKED-n16', points, 'LightGlue'] for points in (1000, 2048))
    return ('*By number of points* ALIKED with LightGlue finds better poses than the chain: of 1000 points %s as they are and %s refined, of 2048 %s and %s,\n'
            'the chain, refined, of 1000, 2000 and 4000 points %s, %s and %s. *By time* 1000 points of ALIKED take %.0f times as long to their pose\n'
            'as 4000 of the chain, in PyTorch and on a machine that was busy with other work%s.' % (
                *('%.2f' % float(ways[way]['at_5']) for ways in (few, many) for way in ('plain', 'refined')), *('%.2f' % float(row['at_5']) for row in chain.values()),
                float(few['refined']['milliseconds']) / float(chain[4000]['milliseconds']),
                other_run(few['refined'], chain[4000])))


def paper(question):
    """One of the paper's tables: our figures beside its own. Where bits were learned, on scenes that they were not learned on."""
    natural, light, rendered = (summaries.by(rows('fixed_points.csv'), 'configuration', place=place) for place in ('natural', 'light', 'rendered'))
    photographs, lines = light if 'learning' in question else {**light, **natural}, []
    for row in (row for row in PAPER if row['question'] == question):
        name = row['configuration']
        line = [row['plain'] or name, '`%s`' % name, {**rendered, **photographs}.get(name, {}).get('bytes', '–')]
        for ours, theirs in ((photographs, 'natural'), (rendered, 'synthetic')):
            line += [precision_recall(ours.get(name)), row[theirs + '_map'] and '%s / %s' % (row[theirs + '_map'], row[theirs + '_mar']) or '–']
        lines.append(line)
    return table([question.lower(), 'row', 'bytes', 'photographs', 'paper, natural', 'rendered', 'paper, synthetic'], lines)


def matching_modes():
    """Hierarchical matching by the paper's thresholds, beside brute force."""
    found, lines = summaries.by(rows('matching.csv'), 'place', 'matcher'), []
    for matcher in sorted({key[1] for key in found}):
        line = [matcher]
        for place in ('natural', 'rendered'):
            row, brute = found[place, matcher], found[place, 'BFMatcher']
            line += [precision_recall(row), '%.3f' % float(row['cost']), '%.3f' % (float(row['milliseconds']) / float(brute['milliseconds']))]
        lines.append(line)
    return table(['matcher', 'photographs', 'cost', 'time', 'rendered', 'cost', 'time'], lines)


def localization_systems():
    """The paper's table of localization systems, as it quotes them."""
    head, *lines = quoted_systems()
    return table(head, lines)


def quoted_systems():
    """The head and the lines of that table."""
    return [['system', 'inputs', 'lateral', 'longitudinal', 'altitude'], *([value or '–' for value in row.values()] for row in LOCALIZATION)]


SETUPS = {'': 'recommended chain', '--lines': 'recommended chain, lines', '--orb-and-akaze': 'ORB and AKAZE',
          '--orb-and-akaze --lines': 'ORB and AKAZE, lines', '--orb-and-akaze --lines --imu': "the paper's: ORB and AKAZE, lines, IMU"}


def setups(key, file=ROOT / 'doc/localization/localization_setups.csv'):
    """Rows of setups.py's file by `key`: images, those found and those within 5 cm and 0.5 degrees, and means of the errors of those found."""
    for names, found in summaries.group(summaries.read(file), *key).items():
        images, located, near = (sum(int(row[column]) for row in found) for column in ('images', 'found', 'within_5'))
        means = (sum(float(row[column]) * int(row['found']) for row in found) / located if located else None
                 for column in ('lateral', 'longitudinal', 'altitude', 'orientation'))
        yield [SETUPS.get(name, name) for name in names] + [
            str(images), str(located), '%.0f %%' % (100 * near / images),
            *('–' if mean is None else form % mean for form, mean in zip(('%.1f cm', '%.1f cm', '%.1f cm', '%.2f°'), means))]


SETUP_HEAD = ['images', 'with a pose', 'within 5 cm, 0.5°', 'lateral', 'longitudinal', 'altitude', 'orientation']


def localization_setups():
    """Mean errors of the paper's set-up and of ours, with and without lines."""
    return table(['map', 'set-up'] + SETUP_HEAD, setups(('map', 'setup')))


SEEN = 'Herz-Jesus-P8', 'entry-P10', 'castle-P30'  # with which rules of matching were settled


def located_photographs():
    """How many images of Strecha's scenes are near their places, by method: those as they are and those relit, within 5 cm and within 25; then the
    same within 5 cm of each scene that nothing was chosen on."""
    found = [row for row in json.loads((ROOT / 'doc/localization/results.json').read_text())['rows'] if row['light'] in ('as they are', 'relit')]
    unseen = [place for place in dict.fromkeys(row['place'] for row in found) if place not in SEEN]

    def near(method, limit, places):
        for light in ('as they are', 'relit'):
            of = [row for row in found if (row['method'], row['light']) == (method, light) and (not places or row['place'] in places)]
            yield '%d of %d' % tuple(sum(row[column] for row in of) for column in (limit, 'images'))
    lines = [[method, *near(method, 'within_5', ()), *near(method, 'within_25', ()), *itertools.chain(*(near(method, 'within_5', [place]) for place in unseen))]
             for method in dict.fromkeys(row['method'] for row in found)]
    return unseen, lines


def localization_photographs():
    """The same as a table."""
    unseen, lines = located_photographs()
    heads = ['within 5 cm and 0.5°', 'within 25 cm', *('%s, 5 cm' % place for place in unseen)]
    return table(['', *(head + light for head in heads for light in ('', ', relit'))], lines)


def localization_lights(file):
    """The same by light, for the page of localization, in fewer columns: the head and the lines."""
    return [['map', 'set-up', 'light', 'poses', '5 cm, 0.5°', *SETUP_HEAD[3:]], *(
        [*line[:3], '%s of %s' % (line[4], line[3]), *line[5:]] for line in setups(('map', 'setup', 'light'), file))]


ONE, TWO, THREE = ('IIB x', 'IIB y', 'IIB i', 'IIB o'), ('IIB x+y', 'IIB o+i'), ('IIB x+y+i', 'IIB x+y+o')
# The best of each group finds more than the best of the next one.
ORDERS = {'x+y above every single channel': (('IIB x+y',), ONE), '4 channels above 3 above 2 above 1': (('IIB',), THREE, TWO, ONE),
          'QUARTILE above MEAN': (('IIB quartile',), ('IIB',)), 'overlap above none': (('IIB overlap',), ('IIB',)),
          'SORT below MEAN': (('IIB',), ('IIB sort',)),
          'MAX below MEAN': (('IIB',), ('IIB max',)), 'MIN below MEAN': (('IIB',), ('IIB min',)),
          'g5 above g4 above g3 above g2': (('IIB g5',), ('IIB',), ('IIB g3',), ('IIB g2',))}


GROUPS = {'natural': '%s pairs of photographs', 'light': '%s of them, of other sets', 'rendered': '%s rendered pairs'}


def paper_orders():
    """Whether the orders that the paper's tables show hold for our figures, in each group of pairs: all steps, or which ones; by less than a
    hundredth nothing is in order."""
    found = {place: summaries.by(rows('fixed_points.csv'), 'configuration', place=place) for place in GROUPS}

    def line(statement, column, groups, margin=0):
        cells = []
        for scores in found.values():
            values = {name: float(row[column]) for name, row in scores.items()}
            chosen = [max((name for name in members if name in values), key=values.get) for members in groups]
            steps = [values[a] - values[b] for a, b in zip(chosen, chosen[1:])]
            higher = [step >= max(margin, .01) for step in steps]
            holds = 'yes' if all(higher) else '**no**' if margin or min(steps) <= -.01 else 'in part' if any(higher) else 'level'
            signs = ['', *((', ' if each or holds != 'in part' else ' level with ') for each in higher)]
            cells.append('%s: %s' % (holds, ''.join('%s%s %.3f' % (sign, name.replace('IIB ', ''), values[name]) for sign, name in zip(signs, chosen))))
        return [statement, *cells]
    others = [row['configuration'] for row in PAPER if not row['configuration'].startswith('IIB')]
    heads = [text % found[place]['IIB']['pairs'] for place, text in GROUPS.items()]
    return table(['holds', *heads], [*(line(statement, 'recall', groups) for statement, groups in ORDERS.items()),
                                               line('0.1 precision above every other descriptor', 'precision', [['IIB'], others], .1)])


def estimates():
    """Of each method, place, kind of points and estimator, the areas under the curve of the pose's error; each estimator with that of its
    thresholds which is best up to 5 degrees."""
    found = {}
    for row in rows('estimators.csv'):
        key = (row['detector'], row['descriptor']), row['place'], row['points'], row['estimator'].split()[0]
        if key not in found or float(row['at_5']) > float(found[key]['at_5']):
            found[key] = row
    return found


CHAIN = 'Hessian', 'IIB UNIVERSAL'
WAYS = ('plain', 'MAGSAC'), ('plain', 'PoseLib'), ('propagated', 'findRelativePose')  # OpenCV's, the best of others, and this project's


def score(row):
    """The area up to 5 degrees with its interval."""
    return '%.2f (%.2f to %.2f)' % tuple(float(row[name]) for name in ('at_5', 'low', 'high'))


def pose_methods():
    """All methods that were measured, by what this project does and by what others do."""
    found, lines = estimates(), []
    methods = sorted({key[0] for key in found}, key=lambda method: -float(found[(method, 'other light') + WAYS[-1]]['at_5']))
    ways = list(itertools.product(('propagated', 'refined', 'plain'), ('findRelativePose', 'PoseLib', 'MAGSAC')))
    for place, method in itertools.product(('other light', 'same light'), methods):
        rows_of = [found[(method, place, *way)] for way in ways]
        lines.append(['%s, %s pairs' % (place, rows_of[0]['pairs']), *method, score(rows_of[0]) if place == 'other light' else '%.2f' % float(rows_of[0]['at_5']), *('%.2f' % float(row['at_5']) for row in rows_of[1:])])
    return table(['', 'points of', 'descriptor', *('%s, %s' % (points, estimator) for points, estimator in ways)], lines)


def drop_in():
    """Right matches at the points of a detector by its own descriptor, the best of two others and the default, and how many times as many, also
    on pairs of sets that nothing was trained on."""
    found, lines = summaries.by(rows('detected_points.csv'), 'place', 'detector', 'descriptor'), []

    def correct(detector, descriptor):
        return '%.0f' % float(found['natural', detector, descriptor]['correct'])
    gains = {(row['place'], row['detector']): '%.2f (%.2f to %.2f)' % tuple(float(row[column]) for column in ('gain', 'low', 'high')) for row in rows('gains.csv')}
    for name in ('ORB', 'BRISK', 'AKAZE', 'KAZE', 'SIFT'):
        rivals = max(((float(row['correct']), descriptor) for (place, detector, descriptor), row in found.items()
                      if (place, detector) == ('natural', name) and re.match('[BT]EBLID', descriptor)), default=None)
        lines.append([name, correct(name, name), '%s: %.0f' % rivals[::-1] if rivals else '–', correct(name, 'IIB'), gains['natural', name], gains['light', name]])
    scenes = {row['place']: row['scenes'] for row in rows('gains.csv')}
    return table(['points of (%s pairs of %s scenes)' % (found['natural', 'ORB', 'IIB']['pairs'], scenes['natural']), 'its own descriptor', 'best of BEBLID and TEBLID', '**IIB**', 'times its own (95 % interval)',
                  'times its own, on the %s pairs of %s scenes that are of no webcam' % (found['light', 'ORB', 'IIB']['pairs'], scenes['light'])], lines)


SIZES = {32: ('IIB SMALL', 'IIB TINY', 'ORB', 'BEBLID-256', 'TEBLID-256', 'BRIEF-256', 'LATCH-256'),
         64: ('IIB COMPACT', 'IIB BALANCED', 'BEBLID-512', 'TEBLID-512', 'LATCH-512', 'BRIEF-512')}


def equal_sizes():
    """Descriptors of equal size: at ORB's points, as detected in both images, and at the same points in both; pairs of sets that nothing was trained on."""
    detected, fixed = (summaries.by(rows(name), key, place='light', **more) for name, key, more in (
        ('detected_points.csv', 'descriptor', {'detector': 'ORB'}), ('fixed_points.csv', 'configuration', {})))
    lines = []
    for size, names in SIZES.items():
        for name in sorted(names, key=lambda name: -float(fixed[name]['recall'])):
            at_orb = detected.get(name)
            lines.append([str(size), name, '%.0f' % float(at_orb['correct']) if at_orb else '–', precision_recall(fixed[name])])
    return table(['bytes', 'descriptor', "right matches of ORB's points, %s pairs" % detected['ORB']['pairs'], 'precision / recall at fixed points, %s pairs' % fixed['ORB']['pairs']], lines)


def rotation_caveat():
    """What rotation does to upright codes."""
    turned = summaries.by(rows('robustness.csv'), 'configuration', 'target', kind='turn')
    recall = {(name, angle): '%.2f' % float(turned[name, angle]['recall']) for name in ('IIB', 'IIB oriented', 'ORB oriented') for angle in ('5', '15', '30')}
    return ("All other calls stay. **One thing differs**: ORB's descriptor follows the keypoint's angle, and this one is upright. An image rotated by 5, 15 and 30\n"
            'degrees leaves a recall of %s, %s and %s, ORB %s. Where images rotate, call `setOrientation(ORIENTATION_KEYPOINT)` (%s), or match by\n'
            '`matchViews`, which searches all rotations.' % (*(recall['IIB', angle] for angle in ('5', '15', '30')), recall['ORB oriented', '15'], recall['IIB oriented', '15']))


POSE_KEYS = 'place', 'detector', 'descriptor', 'points', 'estimator'


def compared(row, sign=1):
    """How much less than the chain's a way to a pose has, or with -1 how much more, on the same pairs; with its interval."""
    less = summaries.by(rows('differences.csv'), *POSE_KEYS)[tuple(row[key] for key in POSE_KEYS)]
    return '%.3f (%.3f to %.3f)' % tuple(round(sign * float(less[key]), 3) + 0. for key in ('less', *('low', 'high')[::sign]))


def same_light():
    """In the same light the score of SIFT's matches as they are, by PoseLib, and the best of all."""
    every = estimates()
    return {'sift': '%.2f' % float(every[('SIFT', 'SIFT'), 'same light', *WAYS[1]]['at_5']),
            'best': '%.2f' % max(float(row['at_5']) for key, row in every.items() if key[1] == 'same light')}


def estimator_limit():
    """README's sentence on other estimators of poses from the same matches."""
    theirs = estimates()[CHAIN, 'other light', 'propagated', 'PoseLib']
    return ("- PoseLib finds poses of the same refined matches as well as `findRelativePose`, which refuses some: in other light a difference of\n"
            '  %s on the same pairs, which is not significant.' % compared(theirs, -1))


def pose_claim():
    """README's sentences on poses in other light, and in one."""
    return controls.claim() + ("\nIn the same light the chain gains nothing: SIFT's matches as they are have %s by PoseLib, the chain's refined ones %.2f\n"
                               '(42 pairs of photographs of two buildings, [all](doc/results/README.md#other-estimators)).' % (
                                   same_light()['sift'], float(estimates()[CHAIN, 'same light', *WAYS[-1]]['at_5'])))


def photograph_claim():
    """The README's sentences on photographs: a statue by many cameras, and places found in maps."""
    statue = {row['method']: row for row in rows('photographs.csv') if row['scene'] == 'liberty' and row['registered']}
    run, = (row for row in rows('runs.csv') if row['file'] == 'photographs.csv, liberty')

    def told(method):
        largest, others = int(statue[method]['registered'].split()[0]), [int(n) for n in statue[method]['others'].split()]
        return '%d in %d parts, %d in the largest' % (largest + sum(others), 1 + len(others), largest) if others else '%d in one' % largest
    near = {line[0]: line[1:] for line in located_photographs()[1]}
    chain, sift = near['recommended chain'], near['SIFT, normalized image']
    pair = next(row for row in rows('photographs.csv') if row['method'] == 'chain and SIFT')
    close, shared = (int(n) for n in pair['close'].split(' of '))
    return ('Of photographs:\n'
            '- *One statue*, %s photographs from noon to sunset; true poses are unknown, so this counts images: COLMAP joins %s reconstruction with the chain\'s points,\n'
            "  with SIFT's %s, with SIFT's on normalized images %s. The chain's points are less exact: reprojection errors of %s pixels, SIFT's %s and %s.\n"
            '  %d of the %d cameras that the chain\'s and SIFT\'s reconstructions share disagree. By the code of %s ([how](doc/colmap.md#a-comparison)).\n'
            '- *Maps of five scenes* in one light: [`Localizer`](doc/maps.md#what-was-measured) places %s photographs within 5 cm and 0.5°, a program with SIFT on\n'
            '  normalized images, without our refinement, %s. Of photographs that a program has darkened and shaded it is %s and %s; within 25 cm %s and %s.\n'
            '  Rules of matching were settled with three of the five scenes.' % (
                statue['chain']['registered'].split()[-1], told('chain'), told('SIFT'), told('normalized'), *(statue[method]['reprojection'] for method in ('chain', 'SIFT', 'normalized')),
                shared - close, shared, run['date'], chain[0], sift[0], chain[1], sift[1], chain[3], sift[3]))


def view_rows(place):
    """Means over photographs seen from elsewhere, by kind of change, amount and method."""
    return summaries.by(rows('views.csv'), 'kind', 'amount', 'method', place=place)


def by_change(place, methods):
    """Right matches of all, and processor time, of methods by change."""
    found, lines = view_rows(place), []
    order = ('zoom', 'rotation', 'tilt', 'zoom and rotation', 'tilt and rotation')
    for kind, amount in sorted({key[:2] for key in found if key[2] == methods[-1]}, key=lambda key: (order.index(key[0]), float(key[1].split()[0]))):
        of = [found[kind, amount, method] for method in methods]
        lines.append(['%s %s' % (kind, amount), *itertools.chain(*(('%.0f of %.0f' % (float(row['right']), float(row['matches'])), '%.0f' % float(row['milliseconds'])) for row in of))])
    return table(['', *itertools.chain(*((method, 'ms') for method in methods))], lines)


def views():
    return by_change('photographs', ('matchViews', 'upright chain', 'ORB', 'SIFT'))


def views_chosen_on():
    return by_change('chosen on', ('matchViews', 'upright chain', 'ORB', 'SIFT'))


def views_affine():
    return by_change('some photographs', ('matchViews', 'AffineFeature'))


def views_run():
    """What was matched, where, and what was made of unrelated images."""
    found, apart = view_rows('photographs'), view_rows('unrelated')
    one, sift = apart['unrelated', '', 'matchViews'], apart['unrelated', '', 'SIFT']
    run, = (row for row in rows('runs.csv') if row['file'] == 'views.csv')
    changed = [row for place in ('photographs', 'chosen on') for key, row in view_rows(place).items() if key[2] == 'matchViews']
    return ('%s photographs of scenes that nothing was chosen on, at %s on %s (%s).\nOf %s pairs of images of different sets `matchViews` calls %.0f significant, '
            'in %.0f ms on average. Detection, description and matching by SIFT\ntake %.0f ms of the same pairs.\nOf the %d pairs of the first two tables it calls %.0f significant; in %.0f of these most matches are wrong.' % (
                found['zoom', '1', 'SIFT']['pairs'], run['commit'].replace(';', ' and '), run['date'], run['machine'], one['pairs'], float(one['found']) * int(one['pairs']),
                float(one['milliseconds']), float(sift['milliseconds']), sum(int(row['pairs']) for row in changed),
                *(sum(float(row[name]) * int(row['pairs']) for row in changed) for name in ('found', 'misled'))))


def views_guide():
    """The guide's sentences on matchViews: what it does, what it costs, its limits."""
    found, few, apart = view_rows('photographs'), view_rows('some photographs'), view_rows('unrelated')

    def right(kind, amount, method='matchViews'):
        return '%.0f' % float(found[kind, amount, method]['right'])

    def times(rows, method):
        every = [float(row['milliseconds']) for key, row in rows.items() if key[2] == method and key[:2] != ('zoom', '1')]
        return '%.0f to %.0f' % (min(every), max(every))
    return ('`matchViews` matches two images as they are and, if these matches are not decisive, in reduced, rotated and tilted views of both.\n'
            'Of %s photographs, the second image made by a program (warped, and darkened), it finds %s right matches on average at a quarter of the size\n'
            '(the upright chain %s, SIFT %s), and %s at a tilt of 4 (%s and %s). It takes %.0f ms of one thread for an ordinary pair, images to matches, where the\n'
            'chain takes %.0f; a search takes %s ms (SIFT %s; `cv::AffineFeature` with SIFT, which finds more matches of many more points,\n'
            '%s), and %.0f ms where the images have nothing in common (SIFT %.0f). All rotations are searched, relative sizes from a quarter to four\n'
            'times, and tilts up to 4 (`maxTilt`); the second image at twice the size leaves %s matches. Mirrored images are not searched for, and of a scene with strong\n'
            'perspective perhaps one part alone\n'
            '([all figures and conditions](results/README.md#other-zoom-rotation-and-tilt)).' % (
                found['zoom', '1', 'SIFT']['pairs'], *(right('zoom', '0.25', method) for method in ('matchViews', 'upright chain', 'SIFT')),
                *(right('tilt', '4', method) for method in ('matchViews', 'upright chain', 'SIFT')),
                *(float(found['zoom', '1', method]['milliseconds']) for method in ('matchViews', 'upright chain')), times(found, 'matchViews'), times(found, 'SIFT'),
                times(few, 'AffineFeature'), *(float(apart['unrelated', '', method]['milliseconds']) for method in ('matchViews', 'SIFT')), right('zoom', '2')))


def propagation():
    """The guide's sentence on what propagated matches bring the recommended chain."""
    found = estimates()
    before, after = (found[CHAIN, 'other light', points, 'findRelativePose'] for points in ('refined', 'propagated'))
    return ('In other light the score of poses by 1000 points goes from %.2f with refined matches to %.2f with propagated ones\n'
            '([means of %s pairs](results/README.md#poses)).' % (float(before['at_5']), float(after['at_5']), after['pairs']))


def presets():
    """Fixed points: light that no preset was trained on, rendered light, moved cameras, turned images."""
    use = (('IIB', 'default', 'a still camera, the paper as it is'),
           ('IIB ACCURATE', '`PRESET_ACCURATE`', 'a still camera, points of another detector'),
           ('IIB COMPACT', '`PRESET_COMPACT`', 'a still camera, many images to keep'),
           ('IIB TINY', '`PRESET_TINY`', 'a still camera, and memory is scarce'),
           ('IIB BALANCED', '`PRESET_BALANCED`', 'the camera moves between the images'),
           ('IIB VIEWPOINT', '`PRESET_VIEWPOINT`', 'the camera moves far'),
           ('IIB UNIVERSAL', '`PRESET_UNIVERSAL`', 'you do not know yet; light and camera both change'),
           ('IIB SMALL', '`PRESET_SMALL`', 'the same in 32 bytes'),
           ('IIB S512', '`PRESET_S512`', 'the default, shortened'),
           ('IIB S256', '`PRESET_S256`', 'the default, shortened'),
           ('IIB S128', '`PRESET_S128`', 'the default, shortened'))
    found = summaries.by(rows('fixed_points.csv'), 'configuration', 'place')
    turns = summaries.by(rows('robustness.csv'), 'configuration', 'target', kind='turn')
    lines = [[label, when, found[name, 'light']['bytes'], *(precision_recall(found.get((name, place))) for place in ('light', 'rendered', 'wall', 'graf')),
              precision_recall(turns[name, '10'])] for name, label, when in use if (name, 'light') in found]
    pairs = ['%s, %s pairs' % (place, found['IIB', place]['pairs']) for place in ('light', 'rendered', 'wall', 'graf')]
    return table(['preset', 'when', 'bytes', *pairs, 'turned, %s images' % turns['IIB', '10']['pairs']], lines)


def inside(level, quantity):
    """Of quantities whose names have a part, the least and the most of a hundred errors that are inside what is told for a level, by kind of data."""
    shares = [100 * float(row[level]) for row in rows('uncertainty.csv') if quantity in row['quantity'] and row[level]]
    return '%.0f to %.0f' % (min(shares), max(shares))


def sure_claim():
    """The README's sentence on uncertainties."""
    return ('- Uncertainties are no guarantee. Told 95 %% bounds held for %s of 100 relative poses, by kind of data, and for %s of 100 single points,\n'
            '  wrong matches among them, and %s of 100 corners of `alignImages` ([how sure](doc/uncertainty.md)).' % tuple(
                inside('0.95', what) for what in ('findRelativePose', 'refineMatches', 'alignImages')))


def how_sure():
    """What the table of uncertainties comes to."""
    return ('In short, of 100 errors, by kind of data: of relative poses %s are inside what is told for 50 %%, %s inside what is told for 95 %% and\n'
            '%s inside what is told for 99 %%; of `Localizer` %s, %s and %s. So what is told for 50 %% is rather too much, and what is told for 99 %%\n'
            'too little: a few poses are wrong by more than they say.' % tuple(
                inside(level, what) for what in ('findRelativePose', 'Localizer') for level in ('0.5', '0.95', '0.99')))


def uncertainty():
    """In how many pairs something was found, and how many errors are inside what was told."""
    return table(['', 'data', 'pairs', 'found', 'errors', 'inside 50 %', '95 %', '99 %'],
                 [[row['quantity'], row['data'], row['pairs'], row['found'], row['errors'],
                   *('%.0f' % (100 * float(row[level])) if row[level] else '–' for level in ('0.5', '0.95', '0.99'))] for row in rows('uncertainty.csv')])


def scale():
    """What scripts/helpers/scale.sh wrote."""
    return json.loads((RESULTS / 'scale.json').read_text())


def by_two(one, two):
    """How many times as fast two threads are; more than twice is noise, but for what a median is unsure of."""
    if one > 2.1 * two:
        sys.exit('scale.json: two threads are %.2f times as fast as one: measure again' % (one / two))
    return '%.1f' % (one / two)


def scale_run():
    """When and where that was, and at which sizes of codes a second thread brought IIB little."""
    data = scale()
    found = {(r['bytes'], r['k'], r['threads']): r for r in data['flat']['rows']}
    slow = sorted({key[0] for key, row in found.items() if key[2] == 1 and row['iib_ns'] < 1.5 * found[key[0], key[1], 2]['iib_ns']})
    run = summaries.by(rows('runs.csv'), 'file')['scale.json']
    text = 'Of %s, commit %s: %s. Searches take turns, and their medians of %d calls count.' % (data['date'], run['commit'], data['machine'], data['rounds'])
    return text + ' At %s bytes the second thread\nbrought little in that run: those rows are to be measured again.' % ' and '.join(map(str, slow)) if slow else text


def flat_search():
    """Exact search beside faiss's flat index on one thread, and what a second thread brings."""
    data, lines = scale(), []
    found = {(r['bytes'], r['k'], r['threads']): r for r in data['flat']['rows']}
    for width, k in sorted({key[:2] for key in found}):
        one, two = found[width, k, 1], found[width, k, 2]
        lines.append([str(width), str(k), '%.1f' % (one['faiss_ns'] / one['iib_ns']), by_two(one['iib_ns'], two['iib_ns'])])
    return table(['bytes', 'k', 'times as fast as faiss ' + data['faiss'], 'times as fast by two threads'], lines)


def mapped_index():
    """A MappedIndex opened in a fresh process, and searched by a worker of Dask."""
    data = scale()
    index, workers = data['mapped'], data['workers']
    return table(['%s codes of %d bytes' % (format(index['codes'], ','), index['bytes']), ''], [
        ['written and on the disk, s', '%.0f' % index['write_seconds']],
        ['opened, ms', '%.1f' % index['open_ms']],
        ['resident after that, MB', '%.1f' % index['open_resident_mb']],
        ['first query, which maps and checks all, ms', '%.0f' % index['first_search_ms']],
        ['the next, ms', '%.0f' % index['second_search_ms']],
        ['%d queries, k = 5, one worker of one thread, s' % workers['queries'], '%.1f' % workers['one_worker_seconds']]])


def photographs(known=True):
    """Reconstructions of scenes with known poses, and what they keep in other light; or of one without."""
    found = [row for row in rows('photographs.csv') if (row['scene'] != 'liberty') == known]
    columns = [name for name in found[0] if name != 'others' or not known]
    heads = {'others': 'images of other components', 'centres': 'centres, %', 'close': 'within 5 % and 5 degrees'}
    lines = table([heads.get(name, name) for name in columns], [[row[name] for name in columns] for row in found])
    if not known:
        return lines
    kept, errors = {}, {}
    points = {(row['scene'], row['method']): int(row['points']) for row in found}
    for row in found:
        errors.setdefault(row['method'], []).append(row['reprojection'])
        if row['scene'].endswith(' relit'):
            kept.setdefault(row['method'], []).append(round(100 * points[row['scene'], row['method']] /
                                                            points[row['scene'][:-len(' relit')], row['method']]))
    return '%s\n\nRelit, the chain keeps %d to %d of 100 of its points, SIFT %d to %d, normalized SIFT %d to %d. ' \
        'SIFT\'s points lie more exactly: reprojection errors\nof %s to %s pixels, the chain\'s %s to %s.' % (
            lines, *(end(kept[method]) for method in ('chain', 'SIFT', 'normalized') for end in (min, max)),
            *(end(errors[method]) for method in ('SIFT', 'chain') for end in (min, max)))


def photographs_of_many():
    return photographs(False)


QUESTIONS = dict.fromkeys(row['question'] for row in PAPER)
ALL = {function.__name__: function for function in (
    drop_in, rotation_caveat, equal_sizes, pose_claim, photograph_claim, speed_claim, sure_claim, presets, propagation, views, views_chosen_on, views_affine, views_run, views_guide, how_sure, photographs, photographs_of_many, machine, describing, chains, same_points, matching,
    step_by_step, fuzzing, mapped_index, scale_run, flat_search, matching_modes, learned_points, paper_orders, localization_systems, localization_setups, localization_photographs, pose_methods, poses_and_time, classic_detectors, learned_claim, learned_limit, estimator_limit, learned_guide,
    detected_points, uncertainty, night, artifacts)}
ALL.update({'paper_' + name: functools.partial(paper, question) for name, question in zip(
    ('channels', 'mappings', 'extras', 'overlap', 'granularity', 'sampling', 'others'), QUESTIONS)})
ALL.update({'poses': controls.table_of_best, 'pose_all': controls.table, 'pose_kinds': controls.kinds, 'pose_ratios': controls.by_ratio, 'pose_noise': controls.noise, 'pose_neighbours': controls.neighbours,
            'pose_pairs': controls.pairs, 'pose_cause': controls.cause, 'pose_limit': controls.limit, 'wrong_poses': controls.wrong})
ALL.update({name + '_run': functools.partial(controls.run, file + '.csv') for name, file in (('pose', 'controls'), ('estimator', 'estimators'), ('uncertainty', 'uncertainty'))})
ALL.update(questions.ALL)
