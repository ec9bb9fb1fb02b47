# SPDX-License-Identifier: Apache-2.0

"""Whether the orders of the paper's tables hold: differences of recall between variants of the descriptor, on the same pairs."""
import collections
import itertools

import summaries
import timings

ONE, TWO, THREE = ('IIB x', 'IIB y', 'IIB i', 'IIB o'), ('IIB x+y', 'IIB o+i'), ('IIB x+y+i', 'IIB x+y+o')
# The best of each group finds more than the best of the next one.
ORDERS = {'x+y above every single channel': (('IIB x+y',), ONE), '4 channels above 3 above 2 above 1': (('IIB',), THREE, TWO, ONE),
          'QUARTILE above MEAN': (('IIB quartile',), ('IIB',)), 'overlap above none': (('IIB overlap',), ('IIB',)),
          'SORT below MEAN': (('IIB',), ('IIB sort',)),
          'MAX below MEAN': (('IIB',), ('IIB max',)), 'MIN below MEAN': (('IIB',), ('IIB min',)),
          'g5 above g4 above g3 above g2': (('IIB g5',), ('IIB',), ('IIB g3',), ('IIB g2',))}
GROUPS = {'natural': '%s pairs of photographs', 'light': '%s of them, of other sets', 'rendered': '%s rendered pairs'}
MARGIN = .1  # of precision, above every other descriptor


def summarize(source, target):
    """For each step of ORDERS and each choice in it: the mean difference of recall on the same pairs, and its 95 % interval over scenes."""
    recalls = collections.defaultdict(dict)
    for row in summaries.read(source):
        for place in summaries.places(row):
            if place in GROUPS:
                recalls[place, row['configuration']][summaries.scene(row), row['target']] = float(row['recall'])
    steps = dict.fromkeys(pair for groups in ORDERS.values() for step in zip(groups, groups[1:]) for pair in itertools.product(*step))
    lines = []
    for place, (more, less) in itertools.product(GROUPS, steps):
        scenes = collections.defaultdict(list)
        for pair in recalls[place, more].keys() & recalls[place, less]:
            scenes[pair[0]].append(recalls[place, more][pair] - recalls[place, less][pair])
        if scenes:
            every = sum(scenes.values(), [])
            lines.append([place, more, less, len(every), len(scenes), *('%.4g' % v for v in (summaries.mean(every), *summaries.interval(of for _, of in sorted(scenes.items()))))])
    summaries.write(target, ['place', 'more', 'less', 'pairs', 'scenes', 'difference', 'low', 'high'], lines)


def table(others):
    """Whether the orders hold, in each group of pairs; an order is level where the interval of its difference has a 0. `others`: descriptors that
    IIB's precision is compared with."""
    found = {place: summaries.by(timings.rows('fixed_points.csv'), 'configuration', place=place) for place in GROUPS}
    differences = summaries.by(timings.rows('orders.csv'), 'place', 'more', 'less')

    def best(place, column, names):
        return max((name for name in names if name in found[place]), key=lambda name: float(found[place][name][column]))

    def cell(place, groups):
        chosen = [best(place, 'recall', names) for names in groups]
        steps = [differences[(place, *pair)] for pair in zip(chosen, chosen[1:])]
        higher = [float(step['low']) > 0 for step in steps]
        holds = 'yes' if all(higher) else '**no**' if any(float(step['high']) < 0 for step in steps) else 'in part' if any(higher) else 'level'
        by = ('%s above %s by %.3f (%.3f to %.3f)' % (*(step[name].replace('IIB ', '') for name in ('more', 'less')), *(float(step[name]) for name in ('difference', 'low', 'high')))
              for step in steps)
        return '%s: %s' % (holds, ', '.join(by))

    def margin(place):
        other = best(place, 'precision', others)
        ours, theirs = (float(found[place][name]['precision']) for name in ('IIB', other))
        return '%s: IIB %.3f, %s %.3f' % ('yes' if ours - theirs >= MARGIN else '**no**', ours, other, theirs)
    lines = [[statement, *(cell(place, groups) for place in GROUPS)] for statement, groups in ORDERS.items()]
    return summaries.table(['holds', *(text % found[place]['IIB']['pairs'] for place, text in GROUPS.items())],
                           [*lines, ['%g precision above every other descriptor' % MARGIN, *map(margin, GROUPS)]])
