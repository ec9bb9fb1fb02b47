# SPDX-License-Identifier: Apache-2.0

"""Summaries, tables and figures of tools/evaluation's `controls`: poses by this library's points and descriptor, and by others with the same
refinement and estimator."""
import collections
import functools
import math
import pathlib

import summaries
from summaries import pair_of

RESULTS = pathlib.Path(__file__).resolve().parents[2] / 'doc/results'
CHAIN, OTHER, ROOT = ('Hessian', 'IIB UNIVERSAL'), ('SIFT normalized', 'SIFT'), ('SIFT normalized', 'RootSIFT')
# Kinds of places, grouped by renderer and by whether a preset was trained on walks through other places of the kind.
GROUPS = {'trained on the kind': ('room', 'terrain'), 'same renderer': ('street', 'facade'), 'new kinds': ('yard', 'hall'), 'other renderer': ('court', 'store')}
SAME = CHAIN[0], 'RootSIFT'  # the descriptor alone is another
COUNTED = CHAIN, ('Hessian', 'SIFT'), ('SIFT normalized', 'IIB UNIVERSAL'), OTHER, ('SIFT', 'SIFT')  # methods of the table of neighbours
WRONG = 10  # degrees
POINTS = {'Hessian': 'HessianDetector', 'SIFT normalized': 'SIFT normalized', 'SIFT CLAHE': 'SIFT on CLAHE'}


def kind(row):
    return row['set'].rsplit('_', 1)[0]


def area(error, limit=5):
    return max(0, 1 - float(error) / limit)


def groups_of(place):
    """The kind of a place, the group of its kind, and all that POV-Ray renders."""
    of = kind({'set': place})
    group = next((name for name, kinds in GROUPS.items() if of in kinds), None)
    return [of] + [group] * bool(group) + ['other light'] * (group not in (None, 'other renderer'))


def at_best(rows):
    """Rows of one method with the ratio that is best on the other places."""
    sums = collections.defaultdict(lambda: collections.defaultdict(float))
    for row in rows:
        sums[row['ratio']][row['set']] += area(row['error'])
    totals = {ratio: sum(places.values()) for ratio, places in sums.items()}
    best = {place: max(totals, key=lambda ratio: totals[ratio] - sums[ratio][place]) for place in {row['set'] for row in rows}}
    return [row for row in rows if row['ratio'] == best[row['set']]]


def upper_bound(wrong, count):
    """The upper 95 % bound of a rate (Clopper and Pearson)."""
    low, high = wrong / count, 1.
    for _ in range(60):
        rate = (low + high) / 2
        chance = sum(math.comb(count, k) * rate ** k * (1 - rate) ** (count - k) for k in range(wrong + 1))
        low, high = (rate, high) if chance > .05 else (low, rate)
    return high


def summarize(source, target):
    """For each method, with the ratio that is best on other places and with each ratio: areas under the curve, the lead of the chain on the same
    pairs, and the number of wrong poses."""
    methods = summaries.group(summaries.read(source), 'detector', 'descriptor', 'noise')
    chain = {pair_of(row): area(row['error']) for row in at_best(methods.get((*CHAIN, '0'), []))}
    lines = []
    for key, rows in sorted(methods.items()):
        for ratio in ('best', *sorted({row['ratio'] for row in rows})):
            chosen = at_best(rows) if ratio == 'best' else [row for row in rows if row['ratio'] == ratio]
            places = summaries.group(chosen, 'set')
            for name in dict.fromkeys(name for (place,) in places for name in groups_of(place) if (ratio == 'best' or name == 'other light')):
                of = [members for (place,), members in places.items() if name in groups_of(place)]
                every = [row for members in of for row in members]
                less = [[chain[pair_of(row)] - area(row['error']) for row in members] for members in of]
                poses = [float(row['error']) for row in every if float(row['error']) < math.inf]
                used = collections.Counter(row['ratio'] for row in every).most_common(1)[0][0]
                lines.append([name, *key, ratio, used, len(every), len(of), *('%.4g' % summaries.mean([area(row['error'], limit) for row in every]) for limit in (10, 5, 2)),
                              *('%.4g' % v for v in summaries.interval([[area(row['error']) for row in members] for members in of])),
                              '%.4g' % summaries.mean(sum(less, [])), *('%.4g' % v for v in summaries.interval(less)), len(poses), sum(error > WRONG for error in poses)])
    summaries.write(target, ['place', 'detector', 'descriptor', 'noise', 'ratio', 'used', 'pairs', 'places', 'at_10', 'at_5', 'at_2', 'low', 'high', 'less', 'less_low', 'less_high',
                             'poses', 'wrong'], sorted(lines))


BINS = 25, 50, 100  # right neighbours of normalized SIFT
STEPS = 'below 25', '25 to 49', '50 to 99', '100 and more'


def summarize_neighbours(source, target):
    """Means per pair, by the known depth: points that the other image shows, those also detected there, those whose nearest descriptor is there,
    and the score of poses. Grouped by kind of place, light, third of the baselines, and right neighbours of normalized SIFT."""
    rows, groups = summaries.read(source), collections.defaultdict(list)
    points = min((row['points'] for row in rows if (row['detector'], row['descriptor']) == ('SIFT', 'SIFT')), default='')
    methods = summaries.group(summaries.read(source.with_name('controls.csv')), 'detector', 'descriptor', 'noise')
    areas = {(*key[:2], points, *pair_of(row)): area(row['error']) for key, of in methods.items() if key[2] == '0' for row in at_best(of)}
    easy = {pair_of(row): int(row['nearest']) for row in rows if (row['detector'], row['descriptor'], row['points']) == (*OTHER, points)}
    baselines = sorted(float(row['baseline']) for row in rows)
    thirds = [baselines[len(baselines) * k // 3] for k in (1, 2)] if rows else []
    for row in rows:
        third, step = sum(float(row['baseline']) > limit for limit in thirds), sum(easy[pair_of(row)] >= limit for limit in BINS)
        names = groups_of(row['set'])[1:] + ['light: ' + row['sequence'], 'baseline: ' + ('up to %.2f m' % thirds[third] if third < 2 else 'above %.2f m' % thirds[1]),
                                         'neighbours: ' + STEPS[step]]
        for name in names if (row['detector'], row['descriptor']) in COUNTED else ():
            groups[name, row['detector'], row['descriptor'], row['points']].append(row)
    values = 'contrast', 'visible', 'repeated', 'nearest'
    lines = []
    for key, of in sorted(groups.items()):
        scores = [areas[where] for row in of if (where := (*key[1:], *pair_of(row))) in areas]
        lines.append([*key, len(of), *('%.4g' % summaries.mean([float(row[v]) for row in of]) for v in values), '%.4g' % summaries.mean(scores) if scores else ''])
    summaries.write(target, ['place', 'detector', 'descriptor', 'points', 'pairs', *values, 'at_5'], lines)


@functools.lru_cache(None)
def found(ratio='best', noise='0'):
    return summaries.by(summaries.read(RESULTS / 'controls.csv'), 'place', 'detector', 'descriptor', ratio=ratio, noise=noise)


def columns():
    """Groups of places that were measured."""
    return [name for name in ('other light', *GROUPS) if (name, *CHAIN) in found()]


def methods():
    return sorted({key[1:] for key in found() if key[0] == 'other light'}, key=lambda method: -float(found()['other light', *method]['at_5']))


def name(method):
    points, descriptor = POINTS.get(method[0], method[0]), method[1]
    return ('**%s, %s** (the chain)' if method == CHAIN else '%s, %s') % (points, descriptor)


def table(shown=None):
    """Methods at their best ratio, by group of places."""
    def cell(group, method):
        row = found().get((group, *method))
        return summaries.score(row) if row and group == 'other light' else '%.2f' % float(row['at_5']) if row else '–'

    def head(group):
        return '%s, places: %s' % (group if group == 'other light' else '%s (%s)' % (', '.join(of for of in GROUPS[group] if (of, *CHAIN) in found()), group), found()[group, *CHAIN]['places'])
    lines = [[name(method), found()['other light', *method]['used'], *(cell(group, method) for group in columns())] for method in shown or methods()]
    return summaries.table(['points, descriptor', 'ratio', *map(head, columns())], lines)


def kinds():
    """The chain, and RootSIFT at normalized SIFT's points, by kind of place. Of two places the difference of each is shown, of more an interval."""
    every = [of for of in (of for kinds in GROUPS.values() for of in kinds) if (of, *CHAIN) in found()]
    lines = []
    for of in every:
        ours, best = found()[of, *CHAIN], found()[of, *ROOT]
        lines.append([of, ours['places'], ours['pairs'], *('%.2f' % float(row['at_5']) for row in (ours, best)), less(best)])
    return summaries.table(['kind of place', 'places', 'pairs', 'chain', 'SIFT normalized, RootSIFT', 'difference'], lines)


def less(row):
    """How much less than the chain: with an interval over places, of two with both of them, of one alone."""
    shown = {1: '%.2f', 2: '%.2f (%.2f, %.2f)'}.get(int(row['places']), '%.2f (%.2f to %.2f)')
    return shown % tuple(float(row[column]) + 0. for column in ('less', 'less_low', 'less_high')[:shown.count('%')])


def figures():
    """Scores of the chain, also under its default ratio and of SMALL's bits, and of the better of SIFT and RootSIFT at the same points and at two
    kinds of SIFT's; pairs and places; and what the chain gains over RootSIFT at normalized
    SIFT's points, by its detector beside its descriptor, and by its descriptor beside its detector."""
    def best(points):
        return max((row for key, row in found().items() if key[:2] == ('other light', points) and key[2] in ('SIFT', 'RootSIFT')), key=lambda row: float(row['at_5']))
    ours = found()['other light', *CHAIN]
    scores = {'chain': ours, 'small': found()['other light', 'Hessian', 'IIB SMALL'], 'same_points': best('Hessian'), 'sift_points': best('SIFT normalized')}
    short = {**scores, 'default_ratio': found('0.92')['other light', *CHAIN], 'sift': best('SIFT')}
    gains = {'gain': ROOT, 'gain_by_points': (OTHER[0], CHAIN[1]), 'gain_by_descriptor': SAME}
    fixed = max((found(row['ratio'])['other light', *SAME] for row in summaries.read(RESULTS / 'controls.csv') if row['ratio'] != 'best'), key=lambda row: float(row['at_5']))
    return {**{name: summaries.score(row) for name, row in scores.items()}, **{name + '_mean': '%.2f' % float(row['at_5']) for name, row in short.items()},
            **{name: less(found()['other light', *method]) for name, method in gains.items()}, 'gain_at_fixed': less(fixed),
            'gain_new_kinds': less(found()['new kinds', *SAME]), 'gain_other_renderer': less(found()['other renderer', *SAME]),
            'best_sift': short['sift']['descriptor'],
            'pairs': ours['pairs'], 'places': ours['places']}


def by_ratio():
    """Every method with every ratio."""
    ratios = sorted({row['ratio'] for row in summaries.read(RESULTS / 'controls.csv')} - {'best'})
    return summaries.table(['other light', *ratios], [[name(method), *('%.2f' % float(found(ratio)['other light', *method]['at_5']) for ratio in ratios)] for method in methods()])


def noise():
    """How much sensor noise costs."""
    levels = sorted({row['noise'] for row in summaries.read(RESULTS / 'controls.csv')}, key=int)
    lines = [[name(method), *('%.2f' % float(found(noise=of)['other light', *method]['at_5']) for of in levels)]
             for method in methods() if ('other light', *method) in found(noise=levels[-1])]
    return summaries.table(['noise on the second image, grey levels', *('as rendered' if of == '0' else of for of in levels)], lines)


def wrong():
    """Significant poses with an error of more than WRONG degrees, and poses of images of different places."""
    lines = []
    for group in columns():
        row = found()[group, *CHAIN]
        lines.append(['two lights, ' + group, 'findRelativePose', row['pairs'], row['poses'], row['wrong'], int(row['wrong']), int(row['pairs'])])
    strangers = next(row for row in summaries.read(RESULTS / 'uncertainty.csv') if row['data'] == 'images of different places')
    views = next(row for row in summaries.read(RESULTS / 'views.csv') if (row['place'], row['method']) == ('unrelated', 'matchViews'))
    aligned = [row for row in summaries.read(RESULTS / 'alignment.csv') if row['place'] == 'other scenes']
    for what, data, count, yes in (('findRelativePose', 'images of different places', int(strangers['pairs']), int(strangers['found'])),
                                   ('matchViews', 'images of different sets', int(views['pairs']), round(float(views['found']) * int(views['pairs']))),
                                   *(('alignImages, ' + row['model'], 'images of different sets', int(row['pairs']), int(row['found'])) for row in aligned)):
        lines.append([data, what, str(count), str(yes), str(yes), yes, count])
    return summaries.table(['pairs of', 'by', 'pairs', 'significant', 'of them wrong', 'wrong of all pairs', '95 % bound'],
                           [[*line[:5], '%.1f %%' % (100 * line[5] / line[6]), 'below %.1f %%' % (100 * upper_bound(*line[5:]))] for line in lines])


@functools.lru_cache(None)
def counted():
    return summaries.by(summaries.read(RESULTS / 'neighbours.csv'), 'place', 'detector', 'descriptor', 'points')


def neighbours():
    """Points that both images show by the known depth: the share detected in both, and the share of these with the right nearest neighbour."""
    def cell(place, method, points='1000'):
        row = counted().get((place, *method, points))
        if not row:
            return '–'
        visible, repeated, nearest = (float(row[column]) for column in ('visible', 'repeated', 'nearest'))
        return '%.0f: %.0f %%, %.0f %%' % (nearest, 100 * repeated / visible, 100 * nearest / max(repeated, 1e-9))
    order = [of for of in columns() if (of, *CHAIN, '1000') in counted()] + sorted((of for of in {key[0] for key in counted()} if of.startswith(('baseline: ', 'light: '))), key=lambda of: (of[0], 'above' in of, of))
    lines = [[of, counted()[of, *CHAIN, '1000']['pairs'], *(cell(of, method) for method in COUNTED)] for of in order]
    lines += [['other light, %s points' % points, counted()['other light', *CHAIN, points]['pairs'], *(cell('other light', method, points) for method in COUNTED)] for points in ('500', '2000')]
    return summaries.table(['1000 points', 'pairs', *map(name, COUNTED)], lines)


def cause():
    """Poses by the number of right neighbours of normalized SIFT: with many, the chain has no lead."""
    names = ['neighbours: ' + step for step in STEPS]

    def cell(of, method):
        row = counted()[of, *method, '1000']
        return ['%.0f' % float(row['nearest']), '%.2f' % float(row['at_5'])]
    lines = [[of.split(': ')[1], counted()[of, *OTHER, '1000']['pairs'], '%.0f' % float(counted()[of, *OTHER, '1000']['contrast']), *cell(of, CHAIN), *cell(of, OTHER)]
             for of in names if (of, *OTHER, '1000') in counted()]
    return summaries.table(['right neighbours of SIFT normalized', 'pairs', 'contrast', 'chain: right neighbours', 'score', 'SIFT normalized: right neighbours', 'score'], lines)
