"""Tables and figures of times by scripts/bench.sh: timings.py FOLDER prints those of the folder's speed.csv.
"""
import functools
import itertools
import pathlib
import sys

import pandas as pd

from summaries import by, read, table

RESULTS = pathlib.Path(__file__).resolve().parents[2] / 'doc/results'


def rows(name):
    return read(RESULTS / name)


@functools.lru_cache(None)
def speed():
    """Points and milliseconds by test and parameters, one column per instruction set, the widest first."""
    found = pd.read_csv(RESULTS / 'speed.csv', comment='#', dtype={'parameters': str, 'points': str})
    return found.fillna({'parameters': '', 'points': ''}).set_index(['test', 'parameters'])


def sets():
    return list(speed().columns[1:])


def ms(test, *parameters):
    """By instruction set; NaN where it was not measured."""
    key = test, '/'.join(map(str, parameters))
    return speed().loc[key][1:].astype(float) if key in speed().index else pd.Series(float('nan'), sets())


def methods(test, position=0):
    """The values of a parameter of a test; none if it was skipped."""
    return dict.fromkeys(parameters.split('/')[position] for name, parameters in speed().index if name == test)


def shown(form, row):
    return ['–' if pd.isna(value) else form % value for value in row]


def machine():
    """Machine, date, OpenCV, and the commit if it is known."""
    run = by(read(RESULTS / 'runs.csv'), 'file').get('speed.csv')
    return (RESULTS / 'speed.csv').read_text().partition('\n')[0][2:] + (', commit %s.' % run['commit'] if run else '.')


DESCRIBED = 'IIB_Describe_hd', 'IIB_Describe_contrib'


def describing():
    """Describing beside ORB."""
    orb, widest = [ms('IIB_Describe_hd', 'ORB', points) for points in (1000, 5000)], sets()[0]
    tests = [(test, name, '') for test in DESCRIBED for name in methods(test)] + [('IIB_Describe_hd_on_two_threads', 'default', ', 2 threads')]
    lines = []
    for test, name, threads in tests:
        few, many = (ms(test, name, points) for points in (1000, 5000))
        more = (many - few) / 4, (many - few) / (orb[1] - orb[0])
        lines.append([name + threads, *shown('%.2f', [few[widest], *few / orb[0], more[0][widest], more[1][widest]])])
    return table(['', 'ms, ' + widest, *('over ORB, ' + name for name in sets()), 'us a point more, ' + widest, 'over ORB'], lines)


def beside(peer, tests, form):
    """Rows of labelled tests, relative to the test that is called `peer`."""
    first = ms(*dict(tests).get(peer, tests[0][1])) if tests else None
    lines = [[label, speed().loc[test[0], '/'.join(test[1:])]['points'], *shown(form, ms(*test)), *shown('%.2f', ms(*test) / first)]
             for label, test in tests if (test[0], '/'.join(test[1:])) in speed().index]
    return table(['', 'points', *('ms, ' + name for name in sets()), *('over %s, %s' % (peer, name) for name in sets())], lines)


def chains():
    """Finding and describing, each method on its own points of a rendered picture."""
    return beside('ORB', [(name, (test, 'street_noon', name, '1000')) for test in ('IIB_Detect_vga', 'IIB_Chain_vga', 'IIB_Chain_others')
                          for name in methods(test, 1)],
                  '%.1f')


def same_points():
    """Describing the same points of AKAZE."""
    return beside('IIB', [(name, ('IIB_DescribeAkaze_street', name)) for name in methods('IIB_DescribeAkaze_street')], '%.2f')


def faster(name, check, codes):
    """How many times as fast as BFMatcher."""
    return ms('IIB_Match_match', 'BRUTE_FORCE', check, codes) / ms('IIB_Match_match', name, check, codes)


def matching():
    """Every way of matching beside BFMatcher."""
    widest, lines = sets()[0], []
    for name, check, codes in (parameters.split('/') for test, parameters in speed().index if test == 'IIB_Match_match'):
        times = faster(name, check, codes)
        if (name == 'EXACT' or codes == '10000') and name != 'BRUTE_FORCE' and codes != '1' and not times.isna().all():
            time = ms('IIB_Match_match', name, check, codes)[widest]
            lines.append([name.replace('THRESHOLD', 'THRESHOLD, .35'), codes, 'yes' if check == 'true' else '', *shown('%.2f', [time, 1e6 * time / int(codes) ** 2]), *shown('%.1f', times)])
    return table(['', 'codes', 'cross-check', 'ms, ' + widest, 'ns a pair', *('times as fast as BFMatcher, ' + name for name in sets())], lines)


def steps():
    """Labels, formats and values of the steps from an image to a pose."""
    pictures = {'scene': "the authors' scene", 'street_noon': 'a rendered street'}
    for test, method, peer, what in (('IIB_Detect_vga', 'HessianDetector', 'ORB detects', 'find points, over ORB'),
                                     ('IIB_Chain_vga', 'recommended chain', 'ORB', 'find and describe, over ORB')):
        for points, (picture, shown) in itertools.product((1000, 2000), pictures.items()):
            yield '%s: %d points, %s' % (what, points, shown), '%.2f', ms(test, picture, method, points) / ms(test, picture, peer, points)
    for name in ('default', 'PRESET_UNIVERSAL'):
        yield 'describe 1000 points of 1280 x 720, %s, over ORB' % name, '%.2f', ms('IIB_Describe_hd', name, 1000) / ms('IIB_Describe_hd', 'ORB', 1000)
    yield 'match 1000 with 1000, cross-check: times as fast as BFMatcher', '%.1f', faster('EXACT', 'true', 1000)
    for points in (1000, 2000, 4000):
        ours, theirs = (ms('IIB_MatchPair_mutual_and_ratio', name, points) for name in ('EXACT', 'BRUTE_FORCE'))
        yield 'match %d with %d of 128 bytes, mutual, ratio, ms' % (points, points), '%.1f', ours
        yield 'the same: times as fast as BFMatcher', '%.1f', theirs / ours
    yield 'refine 300 matches, over `calcOpticalFlowPyrLK`', '%.2f', ms('IIB_Refine_vga_300_matches', 'REFINE') / ms('IIB_Refine_vga_300_matches', 'OPTICAL_FLOW')
    for points in (1000, 2000, 4000):
        yield '`propagateMatches`, %d points, ms' % points, '%.1f', ms('IIB_Propagate_moved_and_by_night', points)
    for points in (1000, 2000, 4000):
        yield '`findRelativePose` with covariance, %d points, ms' % points, '%.1f', ms('IIB_PairPose_findRelativePose', points)
    yield ('`findRelativePose`, 200 matches, a fifth of them wrong: over MAGSAC', '%.2f',
           ms('RelativePose_findRelativePose') / ms('RelativePose_findEssentialMat_MAGSAC'))
    for points in (1000, 2000, 4000):
        yield 'from two images to a pose, %d points, ms' % points, '%.1f', ms('IIB_Pair_pose', points, 1)
        yield "the same, over ORB's points and codes of the two", '%.2f', ms('IIB_Pair_pose', points, 1) / ms('IIB_Pair_orb', points, 1)
        yield 'the same: times as fast on two threads', '%.2f', ms('IIB_Pair_pose', points, 1) / ms('IIB_Pair_pose', points, 2)
    for size in (2, 12, 50):
        yield '`alignImages`, %d megapixels in colour, ms' % size, '%.0f', ms('IIB_Align_noon_and_winter', size)
    yield '`Localizer::localize`, 768 x 512, ten images in the map, 1000 points, ms', '%.0f', ms('IIB_Localize_relit_among_ten', 1000)
    yield ('a frame of 640 x 480: describe and match 1000 points on two threads, over ORB and BFMatcher', '%.2f',
           ms('IIB_Frame_vga', 'default') / ms('IIB_Frame_vga', 'ORB'))
    yield 'one point described, us', '%.0f', 1000 * ms('IIB_Describe_hd_on_two_threads', 'default', 1)
    yield 'one code matched with one, us', '%.0f', 1000 * ms('IIB_Match_match', 'EXACT', 'true', 1)
    yield ('describe 5000 points: times as fast on two threads', '%.2f',
           ms('IIB_Describe_hd', 'default', 5000) / ms('IIB_Describe_hd_on_two_threads', 'default', 5000))
    yield ('match 5000 with 5000, cross-check: the same', '%.2f',
           ms('IIB_Match_match', 'EXACT', 'true', 5000) / ms('IIB_Match_on_two_threads', 'EXACT', 'true', 5000))


def step_by_step():
    """Steps from an image to a pose, by instruction set, without those that were not measured."""
    return table(['', *sets()], [[label, *shown(form, row)] for label, form, row in steps() if not row.isna().all()])


def speed_figures():
    """With AVX2: milliseconds to find and describe, the time to describe over ORB's, the speed of mutual matching over BFMatcher's."""
    figures = {name: '%.1f' % ms(test, 'street_noon', method, 1000)['AVX2'] for name, test, method in (
        ('chain_ms', 'IIB_Chain_vga', 'recommended chain'), ('orb_ms', 'IIB_Chain_vga', 'ORB'))}
    return {**figures, 'machine': machine(), 'mutual': '%.1f' % faster('EXACT', 'true', 1000)['AVX2'],
            'described': '%.2f' % (ms('IIB_Describe_hd', 'default', 1000)['AVX2'] / ms('IIB_Describe_hd', 'ORB', 1000)['AVX2'])}


if __name__ == '__main__':
    RESULTS = pathlib.Path(sys.argv[1])
    print(*(make() for make in (machine, describing, chains, same_points, matching, step_by_step)), sep='\n\n')
