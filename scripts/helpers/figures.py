#!/usr/bin/env python3
"""Tables of README.md and of pages in doc from the committed results in doc/results: figures.py --check | --write | --print FOLDER

A table stands between the lines `<!-- figures NAME -->` and `<!-- end of figures -->`, NAME being a function below.
--write puts each anew, --check ends with an error where one differs from the results, which ctest runs. --print prints the
tables of scripts/bench.sh from results in another FOLDER.
"""
import argparse
import collections
import csv
import json
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
TRAINED_ON_RENDERED = {'IIB UNIVERSAL', 'IIB SMALL'}  # walks through two of the rendered scenes
results = ROOT / 'doc/results'
LIGHT = {'light', 'trained'}  # places of summaries.py: real images under changed light


def rows(name):
    with open(results / name, newline='') as file:
        return list(csv.DictReader(file))


def unseen(chosen):
    """These rows; no preset is judged by scenes that it was trained on."""
    for row in chosen:
        name = row.get('configuration') or row['descriptor']
        if (row.get('place') == 'trained' and re.match('IIB [A-Z]+[0-9]*$', name) or
                row.get('place') == 'rendered' and name in TRAINED_ON_RENDERED):
            sys.exit(name + ' was trained on scenes of this figure')
    return chosen


def mean(chosen, column):
    """Of all pairs of images that these rows sum up."""
    unseen(chosen)
    return sum(int(r['pairs']) * float(r[column]) for r in chosen) / sum(int(r['pairs']) for r in chosen)


def table(head, lines):
    text = ['| ' + ' | '.join(head) + ' |', '|---' * len(head) + '|']
    return '\n'.join(text + ['| ' + ' | '.join(line) + ' |' for line in lines])


def precision_recall(chosen):
    return '%.3f / %.3f' % (mean(chosen, 'precision'), mean(chosen, 'recall')) if chosen else '–'


def grouped(name, key, chosen=lambda row: True):
    """Rows of a file by the columns of `key`."""
    found = collections.defaultdict(list)
    for row in rows(name):
        if chosen(row):
            found[tuple(row[column] for column in key) if len(key) > 1 else row[key[0]]].append(row)
    return found


def detected_points():
    """Points detected in both images, all pairs of real images under changed light."""
    found = grouped('detected_points.csv', ('detector', 'descriptor'), lambda row: row['place'] in LIGHT)

    def cells(detector, descriptor):
        chosen = found[detector, descriptor]
        return ['%.0f' % mean(chosen, 'correct'), '%.0f %%' % (100 * mean(chosen, 'precision'))]

    lines = []
    for detector, own in (('ORB', 'ORB'), ('AKAZE', 'AKAZE'), ('SIFT', 'SIFT'), ('BRISK', 'BRISK'), ('KAZE', 'KAZE'),
                          ('FAST', 'ORB'), ('AGAST', 'ORB')):
        lines.append([detector, own] + cells(detector, own) + ['**%s**' % c for c in cells(detector, 'IIB')])
    return table(['points of', 'descriptor', 'correct a pair', 'precision', 'IIB: correct', 'IIB: precision'], lines)


def fixed_points():
    """The same 1000 points in both images: light, and the two sequences of Oxford's set whose camera moves."""
    found = grouped('fixed_points.csv', ('configuration', 'place'))
    lines = []
    for label, name in (('IIB', 'IIB'), ('IIB, `PRESET_BALANCED`', 'IIB BALANCED'), ('SIFT', 'SIFT'),
                        ('KAZE', 'KAZE'), ('AKAZE', 'AKAZE-486'), ('BEBLID', 'BEBLID-512'),
                        ('BEBLID, 35 px', 'BEBLID-512 5x'), ('TEBLID', 'TEBLID-512'),
                        ('TEBLID, 35 px', 'TEBLID-512 5x'), ('LATCH', 'LATCH-512'), ('ORB', 'ORB'),
                        ('BRIEF', 'BRIEF-512'), ('FREAK', 'FREAK'), ('BRISK', 'BRISK')):
        light = found[name, 'light']
        lines.append([label, light[0]['bytes']] +
                     [precision_recall(chosen) for chosen in (light, found[name, 'wall'], found[name, 'graf'])])
    return table(['', 'bytes', 'changed light', '`wall`', '`graf`'], lines)


def extra_channels():
    """Fixed points of rendered scenes: depth and labels of what is seen as further channels."""
    found = grouped('fixed_points.csv', ('configuration',), lambda row: row['place'] == 'rendered')
    return table(['', 'rendered scenes'],
                 [[name, precision_recall(found[name])] for name in ('IIB', 'IIB +depth', 'IIB +labels', 'IIB +depth+labels')])


def turned():
    """Fixed points: the reference turned about its centre, in the same light, of scenes that no preset was trained on."""
    found = grouped('robustness.csv', ('configuration', 'target'))
    lines = [[name] + [precision_recall(found[name, degrees]) for degrees in ('5', '10', '15', '30')]
             for name in ('IIB', 'IIB BALANCED', 'IIB oriented', 'ORB', 'ORB oriented', 'SIFT', 'SIFT oriented')]
    return table(['', '5 degrees', '10', '15', '30'], lines)


# Points and descriptor of a row of poses, as the results name them, and as people do.
POSES = (('ORB', 'ORB'), ('ORB', 'BEBLID-512'), ('ORB', 'IIB'), ('AKAZE', 'AKAZE'), ('SIFT', 'SIFT'),
         ('AKAZE normalized', 'AKAZE'), ('SIFT normalized', 'SIFT'), ('SIFT normalized', 'IIB UNIVERSAL'),
         ('AKAZE normalized', 'IIB UNIVERSAL'), ('Hessian', 'IIB'), ('Hessian', 'IIB SMALL'), ('Hessian', 'IIB UNIVERSAL'),
         ('Hessian x2', 'IIB UNIVERSAL'))


def best_poses(places=('buildings', 'street', 'facade')):
    """For each row of poses and each place, the results under the rule that scores best there."""
    found = grouped('whole_tasks.csv', ('detector', 'descriptor', 'place'))
    return [(row, [max(unseen(found[row + (place,)]), key=lambda rule: float(rule['score'])) for place in places])
            for row in POSES]


def score(row):
    """With its 95 % confidence interval."""
    return '%.2f (%.2f to %.2f)' % tuple(float(row[column]) for column in ('score', 'low', 'high'))


def pose_table(cell):
    chosen = best_poses()
    pairs = [best['pairs'] for best in chosen[0][1]]
    lines = [[detector.replace('Hessian', 'HessianDetector'), descriptor] + [cell(best) for best in row]
             for (detector, descriptor), row in chosen]
    return table(['points of', 'descriptor', 'buildings by day, %s pairs' % pairs[0],
                  'street, other light, %s pairs' % pairs[1], 'facade, other light, %s pairs' % pairs[2]], lines)


def poses():
    """Area under the curve of the error of the relative pose up to 10 degrees."""
    return pose_table(score)


def match_claim():
    """The README's sentence on right matches."""
    found = {row['detector']: row for row in rows('gains.csv')}
    texts = ['%.2f (%.2f to %.2f) of %s' % (*(float(found[name][column]) for column in ('gain', 'low', 'high')), name + "'s")
             for name in ('BRISK', 'ORB', 'AKAZE', 'KAZE', 'SIFT')]
    return ('- **More right matches where light changes.** In %s pairs of photographs by a camera that stood still, or nearly so,\n'
            "  points found in both by a detector, the default descriptor gives more right matches than the detector's own:\n  times %s,"
            ' %s, %s,\n  %s and %s ([how](doc/results/README.md#points-detected-in-both-images)).' % (found['ORB']['pairs'], *texts))


def pose_claim():
    """The README's sentence on poses."""
    found = {row: score(best[1]) for row, best in best_poses()}
    return ("- **Better poses.** Where light and camera both change (a rendered street), the score of relative poses (table below)\n"
            "  is %s with the recommended chain; with ORB %s, with SIFT %s." %
            (found['Hessian', 'IIB UNIVERSAL'], found['ORB', 'ORB'], found['SIFT', 'SIFT']))


def pose_rules():
    """The choice of matches and the threshold behind each figure of poses."""
    return pose_table(lambda best: best['matching'])


def pose_by_rule():
    """Poses of the recommended chain by the choice of matches and MAGSAC's threshold."""
    found = grouped('whole_tasks.csv', ('detector', 'descriptor', 'place', 'matching'))
    limits, lines = ('0.75', '1', '2'), []
    for place in ('buildings', 'street'):
        for label, rule in (('mutual', 'mutual'), ('a ratio of .9', 'ratio'), ('both', 'both')):
            chosen = [unseen(found['Hessian', 'IIB UNIVERSAL', place, '%s at %s px' % (rule, limit)])[0] for limit in limits]
            lines.append([place, label] + [score(row) for row in chosen])
    return table(['', ''] + [limit + ' px' for limit in limits], lines)


def elsewhere():
    """Poses with learned features, which were not measured here."""
    return table(['points', 'matches', 'at 2 px', 'at .75 px', 'ms an image', 'ms a pair'],
                 [[row[name] or '–' for name in ('points', 'matches', 'auc_at_2_px', 'auc_at_.75_px', 'ms_an_image', 'ms_a_pair')]
                  for row in rows('elsewhere.csv')])


def presets():
    """Fixed points: light that no preset was trained on, rendered light, moved cameras, turned images."""
    use = (('IIB', 'default', 'a still camera, the paper as it is'),
           ('IIB ACCURATE', '`PRESET_ACCURATE`', 'a still camera, and every match counts'),
           ('IIB COMPACT', '`PRESET_COMPACT`', 'a still camera, many images to keep'),
           ('IIB TINY', '`PRESET_TINY`', 'a still camera, and memory is scarce'),
           ('IIB BALANCED', '`PRESET_BALANCED`', 'the camera moves between the images'),
           ('IIB VIEWPOINT', '`PRESET_VIEWPOINT`', 'the camera moves far'),
           ('IIB UNIVERSAL', '`PRESET_UNIVERSAL`', 'you do not know yet; light and camera both change'),
           ('IIB SMALL', '`PRESET_SMALL`', 'the same in 32 bytes'),
           ('IIB S512', '`PRESET_S512`', 'the default, shortened'),
           ('IIB S256', '`PRESET_S256`', 'the default, shortened'),
           ('IIB S128', '`PRESET_S128`', 'the default, shortened'))
    found, turns = grouped('fixed_points.csv', ('configuration', 'place')), grouped('robustness.csv', ('configuration', 'target'))
    lines = []
    for name, label, when in use:
        if (name, 'light') not in found:
            continue
        places = [() if place == 'rendered' and name in TRAINED_ON_RENDERED else found[name, place]
                  for place in ('light', 'rendered', 'wall', 'graf')]
        lines.append([label, found[name, 'light'][0]['bytes']] + [precision_recall(chosen) for chosen in places] +
                     [precision_recall(turns[name, '10']), when])
    return table(['preset', 'bytes', 'light', 'rendered', 'wall', 'graf', 'turned', 'when'], lines)


def benchmark(name):
    """What iib_benchmark wrote."""
    return json.loads((results / name).read_text())


WIDE, AVX2, NARROW = 'benchmark.json', 'benchmark_without_avx512.json', 'benchmark_without_avx2.json'


def describing():
    """Describing beside ORB in one run, and in another one without AVX2 and AVX-512."""
    data, narrow = benchmark(WIDE), benchmark(NARROW)
    few, many = data['keypoints']
    orb, lines = data['rows'][0]['milliseconds'], []
    for row, slow in zip(data['rows'], narrow['rows']):
        first, second = row['milliseconds']
        lines.append([row['name'], '%.2f' % first, '%.2f' % (first / orb[0]),
                      '%.2f' % ((second - first) * 1000 / (many - few)), '%.2f' % ((second - first) / (orb[1] - orb[0])),
                      '%.1f' % (slow['milliseconds'][0] / first)])
    return table(['', 'ms', 'ratio to ORB', 'us a point more', 'ratio', 'without AVX2, times'], lines)


def speeds(name):
    """How many times as fast as BFMatcher, by mode, codes and cross-check."""
    found = {(m['name'], m['codes'], m['cross_check']): m['milliseconds'] for m in benchmark(name)['matching']}
    return {key: found['BFMatcher', key[1], key[2]] / time for key, time in found.items()}


def matching():
    """Every way of matching beside BFMatcher in one run, and in another one without AVX2 and AVX-512."""
    wide, narrow, lines = speeds(WIDE), speeds(NARROW), []
    for m in [m for m in benchmark(WIDE)['matching'] if m['name'] != 'BFMatcher']:
        key = m['name'], m['codes'], m['cross_check']
        lines.append([m['name'], str(m['codes']), 'yes' if m['cross_check'] else '', '%.2f' % m['milliseconds'],
                      '%.2f' % (1e6 * m['milliseconds'] / m['codes'] ** 2), '%.1f' % wide[key], '%.1f' % narrow[key],
                      '%.3f' % m['right']])
    return table(['', 'codes', 'cross-check', 'ms', 'ns a pair', 'times as fast as BFMatcher', 'the same without AVX2',
                  'right'], lines)


def small_work():
    """What frames of a video ask for, in ratios of one run, with all instruction sets and with fewer."""
    def column(name):
        data = benchmark(name)
        frames, times = data['frames'], {row['name']: row['milliseconds'] for row in data['rows']}
        pairs = {(m['name'], m['codes'], m['cross_check']): m['milliseconds'] / m['codes'] ** 2 for m in data['matching']}
        faster = speeds(name)

        def slowest(*presets):
            return '%.2f' % (max(times['PRESET_' + preset][1] for preset in presets) / times['default'][1])

        def further(row):
            return times[row][1] - times[row][0]
        return ['%.2f' % (times['default'][0] / times['cv::ORB'][0]),
                '%.1f' % (further('useOrientation') / further('default')),
                slowest('COMPACT', 'BALANCED'), slowest('VIEWPOINT', 'UNIVERSAL'),
                '%.2f' % (pairs['EXACT', 500, 0] / pairs['EXACT', 10000, 0]),
                '%.2f' % (pairs['EXACT', 1000, 0] / pairs['EXACT', 10000, 0]),
                '%.1f' % faster['EXACT', 500, 1], '%.1f' % faster['EXACT', 1000, 1], '%.1f' % faster['EXACT', 10000, 1],
                '%.2f' % (pairs['EXACT', 10000, 0] / pairs['ADAPTIVE', 10000, 0]),
                '%.2f' % (frames['iib'] / frames['orb']),
                '%.0f' % (1000 * frames['one_keypoint']), '%.0f' % (1000 * frames['one_code']),
                '%.2f' % (frames['describe'][0] / frames['describe'][1]),
                '%.2f' % (frames['match'][0] / frames['match'][1])]
    labels = ('describe 1000 points, over ORB', 'a turned point more, over an upright one',
              'describe 5000 points: COMPACT or BALANCED, the slower one, over the default', 'VIEWPOINT or UNIVERSAL, by boxes',
              'match 500 with 500: time a pair, over that of 10,000', '1000 with 1000, the same',
              'match 500 with 500, cross-check: times as fast as BFMatcher', '1000 with 1000', '10,000 with 10,000',
              'ADAPTIVE: times as fast as EXACT, 10,000 codes',
              'a frame of 640 x 480: describe and match 1000 points on two threads, over ORB and BFMatcher',
              'one point of it described, us', 'one code matched with one, us',
              'describe 5000 points: times as fast on two threads', 'match 5000 with 5000, cross-check: the same')
    return table(['', 'AVX-512', 'AVX2', 'SSE4.2'], zip(labels, *(column(name) for name in (WIDE, AVX2, NARROW))))


def speed_claim():
    """The README's sentence on time, with each set of instructions: a shared machine, so that ratios alone say much."""
    names = (WIDE, AVX2, NARROW)
    times = [{row['name']: row['milliseconds'][0] for row in benchmark(name)['rows']} for name in names]
    return ('- **Fast.** Describing 1000 points takes %.2f of the time of `cv::ORB::compute` with AVX-512, %.2f with AVX2, %.2f with\n'
            '  SSE4.2; the exact matcher is %.0f, %.0f and %.0f times as fast as `cv::BFMatcher` (1,000 codes with 1,000, cross-check):\n'
            '  one thread, the default descriptor, a shared AMD EPYC ([conditions](doc/performance.md)).' %
            (*(row['default'] / row['cv::ORB'] for row in times), *(speeds(name)['EXACT', 1000, 1] for name in names)))


SCALE = 'scale.json'


def flat_search():
    """Exact search beside faiss's flat index, in ns a pair; by threads."""
    data = benchmark(SCALE)
    faiss = 'faiss ' + data['faiss']
    found = {(r['bytes'], r['k'], r['threads']): r for r in data['flat']['rows']}
    lines = []
    for width, k in sorted({key[:2] for key in found}):
        cells = []
        for threads in (1, 2):
            row = found[width, k, threads]
            cells += ['%.2f' % row['iib_ns'], '%.2f' % row['faiss_ns'], '%.1f' % (row['faiss_ns'] / row['iib_ns'])]
        lines.append([str(width), str(k)] + cells)
    return table(['bytes', 'k', 'ns a pair', faiss, 'times', '2 threads', faiss, 'times'], lines)


def mapped_index():
    """A MappedIndex opened in a fresh process, and the same search by one worker of Dask and by two."""
    data = benchmark(SCALE)
    index, workers = data['mapped'], data['workers']
    return table(['%s codes of %d bytes' % (format(index['codes'], ','), index['bytes']), ''], [
        ['written and on the disk, s', '%.0f' % index['write_seconds']],
        ['opened, ms', '%.1f' % index['open_ms']],
        ['resident after that, MB', '%.1f' % index['open_resident_mb']],
        ['first query, which maps and checks all, ms', '%.0f' % index['first_search_ms']],
        ['the next, ms', '%.0f' % index['second_search_ms']],
        ['%d queries, k = 5, one worker of one thread, s' % workers['queries'], '%.1f' % workers['one_worker_seconds']],
        ['two such workers, s', '%.1f' % workers['two_workers_seconds']],
        ['times as fast', '%.1f' % (workers['one_worker_seconds'] / workers['two_workers_seconds'])]])


PAGES = {'README.md': (match_claim, pose_claim, speed_claim, poses),
         'doc/guide.md': (pose_by_rule, presets),
         'doc/performance.md': (describing, matching, small_work),
         'doc/scale.md': (mapped_index, flat_search),
         'doc/results/README.md': (pose_rules, elsewhere, extra_channels, detected_points, fixed_points, turned)}


def filled(page, makers):
    """The page's text, before and with its tables made anew."""
    before = (ROOT / page).read_text()
    named = {function.__name__: function for function in makers}
    after, count = re.subn(r'(<!-- figures (\w+) -->\n).*?(?=<!-- end of figures -->)',
                           lambda match: match[1] + named[match[2]]() + '\n', before, flags=re.DOTALL)
    if count != len(makers):
        sys.exit('%s holds %d tables of figures, not %d' % (page, count, len(makers)))
    return before, after


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    mode = parser.add_mutually_exclusive_group(required=True)
    mode.add_argument('--check', action='store_true')
    mode.add_argument('--write', action='store_true')
    mode.add_argument('--print', type=pathlib.Path, metavar='FOLDER')
    arguments = parser.parse_args()
    if arguments.print:
        global results
        results = arguments.print
        print(*(make() for make in (describing, matching, small_work)), sep='\n\n')
        return
    for page, makers in PAGES.items():
        before, after = filled(page, makers)
        if arguments.write:
            (ROOT / page).write_text(after)
        elif after != before:
            sys.exit(page + ' differs from doc/results: run scripts/helpers/figures.py --write')


if __name__ == '__main__':
    main()
