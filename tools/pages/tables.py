"""Tables and figures in README.md and in pages of doc, of the results in doc/results, as Markdown.

A table stands between the lines `<!-- figures NAME -->` and `<!-- end of figures -->`, NAME being a function below or one of the paper's
tables; ALL has them. A figure within a sentence stands between `<!-- GROUP.NAME -->` and `<!-- -->`; FIGURES has a function for each
group, which returns its figures by name.
"""
import functools
import itertools
import json
import pathlib
import re

import controls
import orders
import questions
import summaries
import ways
from summaries import score, table
from timings import RESULTS, chains, describing, matching, rows, same_points, speed_figures, step_by_step

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


def ratios():
    """Scores of poses, right matches and the share of wrong ones under several ratio tests."""
    still = {'tilde_webcam': 'webcams, seasons', 'amos_daynight': 'webcams, day and night', 'mefb_exposure': 'two exposures'}
    found, shown, lines = summaries.by(rows('ratios.csv'), 'place', 'points', 'ratio'), ('0.85', '0.9', '0.92', '0.95', '1.0'), []
    for place, count in [*(('other light, moved', count) for count in ('500', '1000', '2000', '4000')), *((place, '1000') for place in still)]:
        cells = [found[place, count, ratio] for ratio in shown]
        gain = '%+.2f (%.2f to %.2f)' % tuple(float(cells[2][name]) for name in ('gain', 'low', 'high')) if cells[2]['gain'] else '–'
        lines.append([still.get(place, place), count, cells[0]['pairs'], *(
            '%.2f' % float(cell['at_5']) if cell['at_5'] else '%.0f, %.0f %%' % (float(cell['right']), 100 - 100 * float(cell['right']) / float(cell['matches']))
            for cell in cells), gain])
    return table(['images', 'points', 'pairs', *('**%s**' % ratio if ratio == '0.92' else ratio for ratio in shown), '0.92 against 0.9'], lines)


def ratio_figures():
    """Per cent of matches that a ratio of .92 gives more than .9: least and most of all sets and numbers of points."""
    found = summaries.by(rows('ratios.csv'), 'place', 'points', 'ratio')
    more = [100 * float(row['matches']) / float(found[place, points, '0.9']['matches']) - 100 for (place, points, ratio), row in found.items() if ratio == '0.92']
    return {'more': '%.0f to %.0f' % (min(more), max(more))}


def paper(question):
    """One of the paper's tables: our figures beside its own. Learned bits are judged on scenes that they were not learned on."""
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


def quoted_systems():
    """The head and the lines of the paper's table of localization systems."""
    return [['system', 'inputs', 'lateral', 'longitudinal', 'altitude'], *([value or '–' for value in row.values()] for row in LOCALIZATION)]


def localization_systems():
    head, *lines = quoted_systems()
    return table(head, lines)


SETUPS = {'': 'recommended chain', '--lines': 'recommended chain, lines', '--orb-and-akaze': 'ORB and AKAZE',
          '--orb-and-akaze --lines': 'ORB and AKAZE, lines', '--orb-and-akaze --lines --imu': "the paper's: ORB and AKAZE, lines, IMU"}


def setups(key, file=ROOT / 'doc/localization/localization_setups.csv'):
    """Rows of setups.py's file by `key`: number of images, of poses, share within 5 cm and 0.5 degrees, and mean errors of the poses."""
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


SEEN = 'Herz-Jesus-P8', 'entry-P10', 'castle-P30'  # scenes that rules of matching were chosen on


def located_photographs():
    """Images of Strecha's scenes near their places, by method, as they are and relit: within 5 cm, within 25 cm, and within 5 cm in the scenes
    that nothing was chosen on, which come first."""
    found = [row for row in json.loads((ROOT / 'doc/localization/results.json').read_text())['rows'] if row['light'] in ('as they are', 'relit')]
    unseen = [place for place in dict.fromkeys(row['place'] for row in found) if place not in SEEN]

    def near(method, limit, places):
        for light in ('as they are', 'relit'):
            of = [row for row in found if (row['method'], row['light']) == (method, light) and row['place'] in places]
            yield '%d of %d' % tuple(sum(row[column] for row in of) for column in (limit, 'images'))
    every = [('within_5', (*SEEN, *unseen)), ('within_25', (*SEEN, *unseen)), ('within_5', unseen)]
    return unseen, {method: [cell for what in every for cell in near(method, *what)] for method in dict.fromkeys(row['method'] for row in found)}


def localization_photographs():
    unseen, lines = located_photographs()
    heads = ['within 5 cm and 0.5°', 'within 25 cm', '%s: 5 cm' % ', '.join(unseen)]
    return table(['', *(head + light for head in heads for light in ('', ', relit'))], [[method, *cells] for method, cells in lines.items()])


def localization_lights(file):
    """Head and lines of set-ups by light, in fewer columns, for the page of localization."""
    return [['map', 'set-up', 'light', 'poses', '5 cm, 0.5°', *SETUP_HEAD[3:]], *(
        [*line[:3], '%s of %s' % (line[4], line[3]), *line[5:]] for line in setups(('map', 'setup', 'light'), file))]


def paper_orders():
    """Whether the orders of the paper's tables hold for our figures."""
    return orders.table([row['configuration'] for row in PAPER if not row['configuration'].startswith('IIB')])


def estimates():
    """Rows by method, place, kind of points and estimator, each estimator with its best threshold up to 5 degrees."""
    found = {}
    for row in rows('estimators.csv'):
        key = (row['detector'], row['descriptor']), row['place'], row['points'], row['estimator'].split()[0]
        if key not in found or float(row['at_5']) > float(found[key]['at_5']):
            found[key] = row
    return found


CHAIN = 'Hessian', 'IIB UNIVERSAL'


def pose_methods():
    """All methods with plain, refined and propagated matches, by three estimators."""
    found, lines = estimates(), []
    methods = sorted({key[0] for key in found}, key=lambda method: -float(found[method, 'other light', 'propagated', 'findRelativePose']['at_5']))
    ways = list(itertools.product(('propagated', 'refined', 'plain'), ('findRelativePose', 'PoseLib', 'MAGSAC')))
    for place, method in itertools.product(('other light', 'same light'), methods):
        rows_of = [found[(method, place, *way)] for way in ways]
        lines.append(['%s, %s pairs' % (place, rows_of[0]['pairs']), *method, score(rows_of[0]) if place == 'other light' else '%.2f' % float(rows_of[0]['at_5']), *('%.2f' % float(row['at_5']) for row in rows_of[1:])])
    return table(['', 'points of', 'descriptor', *('%s, %s' % (points, estimator) for points, estimator in ways)], lines)


def pose_answers():
    """The pairs that findRelativePose answers: its scores and PoseLib's."""
    found, lines = estimates(), []
    for (method, place, points, estimator), row in found.items():
        if (place, points, estimator) == ('other light, answered', 'propagated', 'findRelativePose'):
            whole = found[method, 'other light', points, estimator]
            lines.append([*method, '%s of %s' % (row['pairs'], whole['pairs']), score(row), '%.2f' % float(found[method, place, points, 'PoseLib']['at_5'])])
    return table(['points of', 'descriptor', 'answered', 'findRelativePose', 'PoseLib'], sorted(lines, key=lambda line: line[3], reverse=True))


def not_included():
    """Poses under mistakes that all matches share."""
    return table(['mistake', 'rotations inside 95 %', 'directions', 'median error of the rotation', 'of the direction'],
                 [[row['mistake'], *('%.0f %%' % (100 * float(row[name])) for name in ('rotation_inside', 'direction_inside')),
                   *('%.2f°' % float(row[name]) for name in ('rotation', 'direction'))] for row in rows('not_included.csv')])


def own_descriptors():
    """Right matches at a detector's points by its own descriptor, the best of two others, and the default; and the ratio, also for sets that
    nothing was trained on."""
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


def drop_in():
    """Right matches by a detector's own descriptor and by the default, for all photographs; and by two descriptors of one size, for photographs
    that nothing was trained on."""
    found = summaries.by(rows('detected_points.csv'), 'place', 'detector', 'descriptor')
    lines = []
    for place, detector, ours in (*(('natural', name, 'IIB') for name in ('ORB', 'AKAZE', 'SIFT')), ('light', 'ORB', 'IIB SMALL')):
        before, now = (float(found[place, detector, name]['correct']) for name in (detector, ours))
        lines.append([detector if ours == 'IIB' else 'ORB, 32 bytes each', '%.0f' % before, '%.0f' % now, '%.1f' % (now / before)])
    return table(['points of', 'its own descriptor', '**IIB**', 'times'], lines)


SIZES = {32: ('IIB SMALL', 'IIB TINY', 'ORB', 'BEBLID-256', 'TEBLID-256', 'BRIEF-256', 'LATCH-256'),
         64: ('IIB COMPACT', 'IIB BALANCED', 'BEBLID-512', 'TEBLID-512', 'LATCH-512', 'BRIEF-512')}


def byte_figures():
    """Bytes of descriptors."""
    return {row['descriptor'].lower(): row['bytes'] for row in rows('detected_points.csv') if row['descriptor'].isalpha()}


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


def rotation_figures():
    """Recall of upright and oriented codes of rotated images."""
    turned = summaries.by(rows('robustness.csv'), 'configuration', 'target', kind='turn')
    return {'%s_%s' % (name, angle): '%.2f' % float(turned[configuration, angle]['recall']) for name, configuration, angle in (
        ('upright', 'IIB', '15'), ('universal', 'IIB UNIVERSAL', '15'), ('orb', 'ORB oriented', '15'))}


def pose_figures():
    """Scores of the chain in other light, and of SIFT and the best method in the same light; number of pairs in other light."""
    every = estimates()
    ours = every[CHAIN, 'other light', 'propagated', 'findRelativePose']
    scores = {'chain': ours, 'refined': every[CHAIN, 'other light', 'refined', 'findRelativePose'], 'sift_same': every[('SIFT', 'SIFT'), 'same light', 'plain', 'PoseLib'],
              'best_same': max((row for key, row in every.items() if key[1] == 'same light'), key=lambda row: float(row['at_5']))}
    return {**{name: '%.2f' % float(row['at_5']) for name, row in scores.items()}, 'pairs': ours['pairs']}


def photograph_figures():
    """Reconstruction of a statue by many cameras, places found in maps, and points kept in other light."""
    found = rows('photographs.csv')
    statue = {row['method']: row for row in found if row['scene'] == 'liberty' and row['registered']}

    def joined(row):
        largest, *others = (int(n) for n in (row['registered'].split()[0] + ' ' + row['others']).split())
        return '%d in the largest of %d' % (largest, 1 + len(others)) if others else '%d in the only one' % largest
    near = located_photographs()[1]
    close, shared = next(row['close'] for row in found if row['method'] == 'chain and SIFT').split(' of ')
    figures = {'images': statue['chain']['registered'].split()[-1], 'disagree': '%d of %s' % (int(shared) - int(close), shared)}
    for name, method in (('chain', 'recommended chain'), ('sift', 'SIFT, normalized image, refined')):
        figures.update(zip((name + end for end in ('_located', '_relit', '_near', '_near_relit', '_unseen', '_unseen_relit')), near[method]))
    points = {(row['scene'], row['method']): int(row['points']) for row in found if row['points']}
    for method in ('chain', 'SIFT', 'normalized'):
        kept = [round(100 * count / points[scene[:-len(' relit')], name]) for (scene, name), count in points.items() if name == method and scene.endswith(' relit')]
        errors = [row['reprojection'] for row in found if row['method'] == method and row['scene'] != 'liberty']
        name = method.lower()
        figures.update({name: joined(statue[method]), name + '_error': statue[method]['reprojection'], name + '_kept': '%d to %d' % (min(kept), max(kept)),
                        name + '_errors': '%s to %s' % (min(errors), max(errors))})
    return figures


def view_rows(place):
    """Means over warped photographs, by kind of change, amount and method."""
    return summaries.by(rows('views.csv'), 'kind', 'amount', 'method', place=place)


def by_change(place, methods):
    """Right and all matches and processor time of methods, by change."""
    found, lines = view_rows(place), []
    order = ('zoom', 'rotation', 'tilt', 'zoom and rotation', 'tilt and rotation')
    for kind, amount in sorted({key[:2] for key in found if key[2] == methods[-1]}, key=lambda key: (order.index(key[0]), float(key[1].split()[0]))):
        of = [found[kind, amount, method] for method in methods]
        lines.append(['%s %s' % (kind, amount), *itertools.chain(*(('%.0f of %.0f' % (float(row['right']), float(row['matches'])), '%.0f' % float(row['milliseconds'])) for row in of))])
    return table(['', *itertools.chain(*((method, 'ms') for method in methods))], lines)


def view_figures():
    """Right matches and milliseconds on warped photographs and on unrelated images, and the run."""
    found, some, apart = view_rows('photographs'), view_rows('some photographs'), view_rows('unrelated')
    run, = (row for row in rows('runs.csv') if row['file'] == 'views.csv')
    changed = [row for place in ('photographs', 'chosen on') for key, row in view_rows(place).items() if key[2] == 'matchViews']
    one = apart['unrelated', '', 'matchViews']
    figures = {**run, 'commit': run['commit'].replace(';', ' and '), 'pairs': found['zoom', '1', 'SIFT']['pairs'], 'unrelated': one['pairs'],
               'unrelated_found': '%.0f' % (float(one['found']) * int(one['pairs'])), 'changed': str(sum(int(row['pairs']) for row in changed)),
               **{'changed_' + name: '%.0f' % sum(float(row[name]) * int(row['pairs']) for row in changed) for name in ('found', 'misled')}}
    for name, method in (('ours', 'matchViews'), ('chain', 'upright chain'), ('sift', 'SIFT'), ('affine', 'AffineFeature')):
        of = some if name == 'affine' else found
        every = [float(row['milliseconds']) for key, row in of.items() if key[2] == method and key[:2] != ('zoom', '1')]
        figures[name + '_ms'] = '%.0f to %.0f' % (min(every), max(every))
        figures[name + '_plain_ms'] = '%.0f' % float(of['zoom', '1', method]['milliseconds'])
        figures.update({'%s_%s' % (name, label): '%.0f' % float(of[kind, amount, method]['right'])
                        for label, kind, amount in (('quarter', 'zoom', '0.25'), ('tilt', 'tilt', '4'), ('twice', 'zoom', '2'))})
        figures.update({name + '_apart_ms': '%.0f' % float(row['milliseconds']) for key, row in apart.items() if key[2] == method})
    return figures


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
    """Per cent of errors within the limit of a level: least and most of all kinds of data, for quantities with that name."""
    shares = [100 * float(row[level]) for row in rows('uncertainty.csv') if quantity in row['quantity'] and row[level]]
    return '%.0f to %.0f' % (min(shares), max(shares))


SURE = {'pose': ('relative poses', 'findRelativePose'), 'localizer': ('`Localizer`', 'Localizer'), 'align': ('corners by `alignImages`', 'alignImages'),
        'points': ('points by `refineMatches`', 'refineMatches'), 'propagated': ('points by `propagateMatches`', 'propagated')}


def sure_figures():
    """Per cent of errors within the limits of 95 %."""
    return {name + '_95': inside('0.95', quantity) for name, (_, quantity) in SURE.items()}


def sure():
    """Per cent of errors within the limits of three levels."""
    return table(['per cent of the errors of', *('inside %g %%' % (100 * float(level)) for level in ('0.5', '0.95', '0.99'))],
                 [[label, *(inside(level, quantity) for level in ('0.5', '0.95', '0.99'))] for label, quantity in SURE.values()])


def uncertainty():
    """Number of pairs with a result, share of errors within the limits, reported deviation and logarithmic score."""
    def cells(row):
        inside = ('%.0f' % (100 * float(row[level])) if row[level] else '–' for level in ('0.5', '0.95', '0.99'))
        return [*inside, *('%.2g' % float(row[name]) if row.get(name) else '–' for name in ('deviation', 'score'))]
    return table(['', 'data', 'pairs', 'found', 'errors', 'inside 50 %', '95 %', '99 %', 'deviation', 'log score'],
                 [[*(row[name] for name in ('quantity', 'data', 'pairs', 'found', 'errors')), *cells(row)] for row in rows('uncertainty.csv')])


def photographs(known=True):
    """Reconstructions of scenes with known poses and their points in other light; or of a scene without known poses."""
    found = [row for row in rows('photographs.csv') if (row['scene'] != 'liberty') == known]
    columns = [name for name in found[0] if name != 'others' or not known]
    heads = {'others': 'images of other components', 'centres': 'centres, %', 'close': 'within 5 % and 5 degrees'}
    return table([heads.get(name, name) for name in columns], [[row[name] for name in columns] for row in found])


def night():
    """The steps of the last night before a release."""
    return table(['step', 'counted', 'minutes', 'commit', 'started (UTC)', 'result'],
                 [['`%s`' % row['step'], *(row[key] for key in ('counted', 'minutes', 'commit', 'started', 'result'))] for row in rows('night.csv')])


def first_patch():
    """The paper's descriptor beside those that OpenCV has, under changed illumination."""
    found, ms = summaries.by(rows('fixed_points.csv'), 'place', 'configuration'), summaries.by(summaries.read(ROOT / 'upstream/speed.csv'), 'descriptor')
    lines = []
    for name in ('IIB', 'IIB overlap', 'IIB quartile', 'IIB g3', 'BEBLID-512', 'BRIEF-512', 'LATCH-512', 'ORB', 'SIFT'):
        row = found['light', name]
        lines.append((name.replace('g3', 'granularity 3'), row['bytes'], *('%.3f' % float(row[key]) for key in ('precision', 'recall')),
                      '%.2f to %.2f' % (float(row['low']), float(row['high'])), ms[name]['ms'] if name in ms else ''))
    return table(('descriptor', 'bytes', 'precision', 'recall', 'interval of recall', 'ms for 1000 points'), lines)


def run_figures():
    """Commit, date and machine of each file, by its name without folder and suffix."""
    return {re.sub(r'.*/|\.\w+', '', row['file']).replace(', ', '_'): '%s on %s (%s)' % (row['commit'].replace(';', ' and '), row['date'], row['machine'])
            for row in rows('runs.csv')}


QUESTIONS = dict.fromkeys(row['question'] for row in PAPER)
ALL = {function.__name__: function for function in (
    drop_in, own_descriptors, equal_sizes, presets, ratios, photographs, describing, chains, same_points, matching, step_by_step,
    matching_modes, learned_points, paper_orders, localization_systems, localization_setups, localization_photographs, pose_methods, pose_answers, ways.poses_and_time,
    detected_points, sure, uncertainty, not_included, night, first_patch)}
ALL.update({'paper_' + name: functools.partial(paper, question) for name, question in zip(
    ('channels', 'mappings', 'extras', 'overlap', 'granularity', 'sampling', 'others'), QUESTIONS)})
ALL.update({'photographs_of_many': functools.partial(photographs, False), 'views_affine': functools.partial(by_change, 'some photographs', ('matchViews', 'AffineFeature')),
            'views': functools.partial(by_change, 'photographs', ('matchViews', 'upright chain', 'ORB', 'SIFT')), 'pose_all': controls.table, 'pose_kinds': controls.kinds, 'pose_ratios': controls.by_ratio, 'pose_noise': controls.noise,
            'pose_neighbours': controls.neighbours, 'pose_cause': controls.cause, 'wrong_poses': controls.wrong, **questions.ALL})
FIGURES = {'learned': ways.figures, 'controls': controls.figures, 'ratios': ratio_figures, 'poses': pose_figures, 'photographs': photograph_figures, 'views': view_figures, 'sure': sure_figures,
           'speed': speed_figures, 'rotation': rotation_figures, 'bytes': byte_figures, 'questions': questions.figures, 'runs': run_figures}
