# SPDX-License-Identifier: Apache-2.0

"""Summary, table and figures of tools/evaluation/poses_by_time.py: poses of each way, over the processor time that they cost."""
import functools

import summaries
import timings

CHAIN, LEARNED = 'recommended chain', 'ALIKED-n16'


def summarize(source, target):
    """Means of each way in other light. On the same pairs and by the same estimator, what it gains over the chain of about as many points, and over
    that of most."""
    rows, score = [row for row in summaries.read(source) if summaries.light_place(row) == ['other light']], summaries.pose_area(5)
    ways, lines = summaries.group(rows, 'detector', 'points', 'matches', 'estimator'), []
    chain = {(key[3], int(key[1])): {summaries.pair_of(row): score(row) for row in of} for key, of in ways.items() if key[0] == CHAIN}
    for key, of in sorted(ways.items()):
        places = summaries.group(of, 'set').values()
        means = (summaries.shown([value(row) for row in of]) for value in (summaries.column('milliseconds'), *map(summaries.pose_area, (10, 2, 5))))
        lines.append([*key, len(of), *means, *('%.4g' % end for end in summaries.interval([[score(row) for row in members] for members in places]))])
        counts = [points for estimator, points in chain if estimator == key[3]]
        for points in (min(counts, key=lambda count: abs(count - int(key[1]))), max(counts)):
            gains = [[score(row) - chain[key[3], points][summaries.pair_of(row)] for row in members] for members in places]
            lines[-1] += ['%.4g' % number for number in (summaries.mean(sum(gains, [])), *summaries.interval(gains))]
    gained = [name + end for name in ('gain', 'over_most') for end in ('', '_low', '_high')]
    summaries.write(target, ['detector', 'points', 'matches', 'estimator', 'pairs', 'milliseconds', 'at_10', 'at_2', 'at_5', 'low', 'high', *gained], lines)


@functools.lru_cache(None)
def found():
    """Rows by detector, number of points and kind of matches: `plain` by the better of PoseLib's thresholds, and `refined` here."""
    every = {}
    for row in timings.rows('poses_by_time.csv'):
        ways, way = every.setdefault((row['detector'], int(row['points']), row['matches']), {}), 'plain' if 'PoseLib' in row['estimator'] else 'refined'
        if way not in ways or float(row['at_5']) > float(ways[way]['at_5']):
            ways[way] = row
    return dict(sorted(every.items(), key=lambda item: float(item[1]['refined']['at_5'])))


def gain(row, name):
    return '%+.2f (%.2f to %.2f)' % tuple(float(row[name + end]) + 0. for end in ('', '_low', '_high'))


def poses_and_time():
    """Poses by each detector over processor time, on the same pairs."""
    lines = []
    for (detector, points, matches), ways in reversed(found().items()):
        lines.append([detector, str(points), matches])
        for row in (ways['plain'], ways['refined']):
            lines[-1] += [summaries.score(row), '%.2f' % float(row['at_10']), '%.0f' % float(row['milliseconds'])]
        lines[-1] += ['–' if detector == CHAIN and (name == 'gain' or points == 4000) else gain(ways['refined'], name) for name in ('gain', 'over_most')]
    return summaries.table(['points of', 'points', 'matches', 'as they are, PoseLib', 'up to 10°', 'ms a pair', 'refined here', 'up to 10°', 'ms a pair',
                            'refined, against the chain of as many points', 'against the chain of 4000'], lines)


def figures():
    """Scores of ALIKED with LightGlue and of the chain by number of points, what ALIKED gains, and the ratio of the times of ALIKED's 1000 and the
    chain's 4000."""
    rows = {'%s_%d' % (name, key[1]): ways for name, detector in (('aliked', LEARNED), ('chain', CHAIN)) for key, ways in found().items() if key[0] == detector}
    values = {name + '_' + way: '%.2f' % float(row['at_5']) for name, ways in rows.items() for way, row in ways.items()}
    gains = {name + '_' + column + end: gain(ways[way], column) for name, ways in rows.items() for column in ('gain', 'over_most') for way, end in (('refined', ''), ('plain', '_plain'))}
    few, many = rows['aliked_1000']['refined'], rows['chain_4000']['refined']
    return {**values, **gains, 'times': '%.0f' % (float(few['milliseconds']) / float(many['milliseconds'])), 'pairs': few['pairs']}
