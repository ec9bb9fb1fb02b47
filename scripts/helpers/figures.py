#!/usr/bin/env python3
"""Tables of README.md and of pages in doc, and the page doc/results/index.html, from the committed results in doc/results:
figures.py --check | --write | --print FOLDER

A table stands between the lines `<!-- figures NAME -->` and `<!-- end of figures -->`, NAME being a function below or one of
TABLES. --write puts each anew, --check ends with an error where one differs from the results, which ctest runs. --print prints
the tables of scripts/bench.sh from results in another FOLDER.
"""
import argparse
import functools
import importlib.util
import itertools
import json
import pathlib
import re
import subprocess
import sys

import summaries

ROOT = pathlib.Path(__file__).resolve().parents[2]
results = ROOT / 'doc/results'
PAPER = summaries.read(ROOT / 'tools/evaluation/report/paper.csv')  # the paper's figures, by the questions of its tables and our names
LOCALIZATION = summaries.read(ROOT / 'tools/evaluation/report/paper_localization.csv')


def rows(name):
    return summaries.read(results / name)


def table(head, lines):
    text = ['| ' + ' | '.join(head) + ' |', '|---' * len(head) + '|']
    return '\n'.join(text + ['| ' + ' | '.join(line) + ' |' for line in lines])


def precision_recall(row):
    return '%.3f / %.3f' % (float(row['precision']), float(row['recall'])) if row else '–'


def detected_points():
    """Points detected in both images: all photographs under changed light, and rendered scenes."""
    found, lines = summaries.by(rows('detected_points.csv'), 'place', 'detector', 'descriptor'), []
    for detector, own in (('ORB', 'ORB'), ('AKAZE', 'AKAZE'), ('SIFT', 'SIFT'), ('BRISK', 'BRISK'), ('KAZE', 'KAZE'), ('SURF', 'SURF'),
                          ('FAST', 'ORB'), ('AGAST', 'ORB')):
        cells = []
        for place in ('natural', 'rendered'):
            for descriptor in (own, 'IIB'):
                row = found[place, detector, descriptor]
                cells.append('%.0f, %.0f %%' % (float(row['correct']), 100 * float(row['precision'])))
        lines.append([detector, own, cells[0], '**%s**' % cells[1], cells[2], '**%s**' % cells[3]])
    return table(['points of', 'descriptor', 'photographs', 'IIB', 'rendered', 'IIB'], lines)


def learned_points():
    """What the networks' own descriptors and IIB's default match at the networks' points."""
    return table(['points of', 'pairs', 'own descriptor, bytes', 'correct a pair', 'IIB: correct'],
                 [[row[c] for c in ('detector', 'pairs', 'bytes', 'correct', 'iib')] for row in rows('learned.csv')])


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
    return table(['system', 'inputs', 'lateral', 'longitudinal', 'altitude'], [[value or '–' for value in row.values()] for row in LOCALIZATION])


SETUPS = {'': 'recommended chain', '--lines': 'recommended chain, lines', '--orb-and-akaze': 'ORB and AKAZE',
          '--orb-and-akaze --lines': 'ORB and AKAZE, lines', '--orb-and-akaze --lines --imu': "the paper's: ORB and AKAZE, lines, IMU"}


def setups(key, file=results / 'localization_setups.csv'):
    """Rows of setups.py's file by `key`: images within 5 cm and 0.5 degrees, and means of the errors of those found."""
    for names, found in summaries.group(summaries.read(file), *key).items():
        images, located, near = (sum(int(row[column]) for row in found) for column in ('images', 'found', 'within_5'))
        means = (sum(float(row[column]) * int(row['found']) for row in found if int(row['found'])) / max(located, 1)
                 for column in ('lateral', 'longitudinal', 'altitude', 'orientation'))
        yield [SETUPS.get(name, name) for name in names] + [str(images), '%.0f %%' % (100 * near / images),
               *(form % mean for form, mean in zip(('%.1f cm', '%.1f cm', '%.1f cm', '%.2f°'), means))]


SETUP_HEAD = ['images', 'within 5 cm, 0.5°', 'lateral', 'longitudinal', 'altitude', 'orientation']


def localization_setups():
    """Mean errors of the paper's set-up and of ours, with and without lines."""
    return table(['map', 'set-up'] + SETUP_HEAD, setups(('map', 'setup')))


def localization_lights(*file):
    """The same by light, for the page of localization, above the paper's table."""
    lines = [['map', 'set-up', 'light'] + SETUP_HEAD, *setups(('map', 'setup', 'light'), *file)]
    lines += [["as the paper quotes it", row['system'], row['inputs'], '', '', row['lateral'], row['longitudinal'], row['altitude'], ''] for row in LOCALIZATION]
    cells = [''.join('<%s>%s</%s>' % (tag, cell, tag) for cell in line) for tag, line in zip(['th'] + ['td'] * len(lines), lines)]
    return '\n'.join(['<div class="scroll"><table>', *('<tr>%s</tr>' % line for line in cells), '</table></div>'])


ONE, TWO, THREE = ('IIB x', 'IIB y', 'IIB i', 'IIB o'), ('IIB x+y', 'IIB o+i'), ('IIB x+y+i', 'IIB x+y+o')
# The best of each group finds more than the best of the next one.
ORDERS = {'x+y above every single channel': (('IIB x+y',), ONE), '4 channels above 3 above 2 above 1': (('IIB',), THREE, TWO, ONE),
          'QUARTILE above MEAN': (('IIB quartile',), ('IIB',)), 'overlap above none': (('IIB overlap',), ('IIB',)),
          'SORT below MEAN': (('IIB',), ('IIB sort',)),
          'MAX below MEAN': (('IIB',), ('IIB max',)), 'MIN below MEAN': (('IIB',), ('IIB min',)),
          'g5 above g4 above g3 above g2': (('IIB g5',), ('IIB',), ('IIB g3',), ('IIB g2',))}


def paper_orders():
    """Whether the orders that the paper's tables show hold for our figures."""
    natural = summaries.by(rows('fixed_points.csv'), 'configuration', place='natural')
    recall, precision = ({name: float(row[column]) for name, row in natural.items()} for column in ('recall', 'precision'))

    def line(statement, values, chosen, margin=0):
        holds = all(values[a] - values[b] > margin for a, b in zip(chosen, chosen[1:]))
        return [statement, 'yes' if holds else 'no', ', '.join('%s %.3f' % (name, values[name]) for name in chosen)]
    others = [row['configuration'] for row in PAPER if row['configuration'] in natural and not row['configuration'].startswith('IIB')]
    return table(['statement', 'holds', 'figures'], [
        *(line(statement, recall, [max(members, key=recall.get) for members in groups]) for statement, groups in ORDERS.items()),
        line('0.1 precision above every other descriptor', precision, ['IIB', max(others, key=precision.get)], .1)])


def estimates():
    """Of each method, place, kind of points and estimator, the area under the curve of the pose's error up to 10 degrees."""
    return {((row['detector'], row['descriptor']), row['place'], row['points'], row['estimator']): row for row in rows('estimators.csv')}


CHAIN = 'Hessian', 'IIB UNIVERSAL'
METHODS = {('ORB', 'ORB'): 'ORB', ('AKAZE', 'AKAZE'): 'AKAZE', ('SIFT', 'SIFT'): 'SIFT', ('SIFT normalized', 'SIFT'): 'SIFT, normalized',
           CHAIN: 'recommended chain'}
WAYS = ('plain', 'MAGSAC 0.75 px'), ('propagated', 'findRelativePose')  # of others, and of this project


def poses():
    """What others do beside what this project does for poses, for the methods on the first page."""
    found, places = estimates(), ('same light', 'other light')
    lines = [['**%s**' % label if method == CHAIN else label] +
             ['%.2f' % float(found[(method, place) + way]['at_10']) for place in places for way in WAYS]
             for method, label in METHODS.items()]
    head = ['%s, %s pairs: %s' % (place, found[(CHAIN, place) + WAYS[0]]['pairs'], how) for place in places for how in ('MAGSAC', 'ours')]
    return table(['points and descriptor', *head], lines)


def pose_methods():
    """All methods that were measured, by what others do, by what this project does, and by PoseLib."""
    found, lines = estimates(), []
    methods = sorted({key[0] for key in found}, key=lambda method: -float(found[(method, 'other light') + WAYS[1]]['at_5']))
    for place in ('same light', 'other light'):
        for method in methods:
            ways = [found.get((method, place, *way)) for way in (
                WAYS[0], *itertools.product(('refined', 'propagated'), ('findRelativePose', 'PoseLib 0.5 px')))]
            lines.append([place, *method] + ['/'.join('%.2f' % float(row[area]) for area in ('at_10', 'at_5', 'at_2')) if row else '–' for row in ways])
    return table(['', 'points of', 'descriptor', 'plain, MAGSAC .75 px', 'refined, `findRelativePose`', 'refined, PoseLib .5 px',
                  'propagated, `findRelativePose`', 'propagated, PoseLib .5 px'], lines)


def pose_bars():
    """The same in other light as bars of SVG."""
    found, lines = estimates(), []
    for n, (method, label) in enumerate(METHODS.items()):
        lines.append('<text x="180" y="%d" text-anchor="end"%s>%s</text>' % (66 + 46 * n, ' font-weight="bold"' * (method == CHAIN), label))
        for k, (way, colour) in enumerate(zip(WAYS, ('#9aa5b1', '#1f6fb2'))):
            score, y = float(found[(method, 'other light') + way]['at_10']), 42 + 46 * n + 19 * k
            lines.append('<rect x="190" y="%d" width="%.0f" height="17" fill="%s"/><text x="%.0f" y="%d">%.2f</text>' % (
                y, 540 * score, colour, 196 + 540 * score, y + 13, score))
    return '\n'.join(lines)


def match_claim():
    """The README's sentence on right matches."""
    found = {row['detector']: row for row in rows('gains.csv')}
    return ("- **More right matches**: %.1f times ORB's, %.1f times AKAZE's, %.1f times SIFT's, at the points of each\n"
            '  ([%s pairs under changed light, camera still](doc/results/README.md#points-detected-in-both-images)).' %
            (*(float(found[name]['gain']) for name in ('ORB', 'AKAZE', 'SIFT')), found['ORB']['pairs']))


def pose_claim():
    """The README's sentence on poses: of others the best of all their ways."""
    found = estimates()
    ours = float(found[CHAIN, 'other light', *WAYS[1]]['at_10'])
    best = {name: max(float(row['at_10']) for key, row in found.items() if key[:2] == ((name, name), 'other light')) for name in ('SIFT', 'ORB')}
    return ('- **Better poses where the camera moves too**: a score of %.2f in other light; the best that SIFT reaches with any estimator is '
            '%.2f,\n  ORB %.2f (table below).' % (ours, best['SIFT'], best['ORB']))


def propagation():
    """The guide's sentence on what propagated matches bring the recommended chain."""
    found = estimates()
    before, after = (found[CHAIN, 'other light', points, 'findRelativePose'] for points in ('refined', 'propagated'))
    return ('In other light %.0f instead of %.0f matches of 1000 points agree with the pose that `findRelativePose` finds, whose score up to 5\n'
            'degrees goes from %.2f to %.2f ([means of %s pairs](results/README.md#poses)).' %
            (float(after['inliers']), float(before['inliers']), float(before['at_5']), float(after['at_5']), after['pairs']))


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
    lines = [[label, found[name, 'light']['bytes']] +
             [precision_recall(found.get((name, place))) for place in ('light', 'rendered', 'wall', 'graf')] +
             [precision_recall(turns[name, '10']), when] for name, label, when in use if (name, 'light') in found]
    return table(['preset', 'bytes', 'light', 'rendered', 'wall', 'graf', 'turned', 'when'], lines)


def benchmark(name):
    """Milliseconds of iib_benchmark's rows by what, name, size and threads."""
    return {tuple(row[key] for key in ('what', 'name', 'size', 'threads')): row['milliseconds'] for row in json.loads((results / name).read_text())['rows']}


WIDE, AVX2, NARROW = 'benchmark.json', 'benchmark_without_avx512.json', 'benchmark_without_avx2.json'


def describing():
    """Describing beside ORB in one run, and in another one without AVX2 and AVX-512."""
    data, narrow, lines = benchmark(WIDE), benchmark(NARROW), []
    orb = [data['describe', 'cv::ORB', points, 1] for points in (1000, 5000)]
    for key in (key for key in data if key[0] == 'describe' and key[2] == 1000):
        few, many = data[key], data[(*key[:2], 5000, key[3])]
        lines.append([key[1] + ', 2 threads' * (key[3] == 2), '%.2f' % few, '%.2f' % (few / orb[0]), '%.2f' % ((many - few) / 4),
                      '%.2f' % ((many - few) / (orb[1] - orb[0])), '%.1f' % (narrow[key] / few)])
    return table(['', 'ms', 'ratio to ORB', 'us a point more', 'ratio', 'without AVX2, times'], lines)


def timed(what, other, form):
    """Rows of iib_benchmark beside the first of them."""
    found = [(key[1], key[2], time) for key, time in benchmark(AVX2).items() if key[0] == what]
    return table(['', 'points', 'ms', 'ratio to ' + other],
                 [[name, '%.0f' % points, form % time, '%.2f' % (time / found[0][2])] for name, points, time in found])


def chains():
    """Finding and describing, each method on its own points of a rendered picture."""
    return timed('chain', 'ORB', '%.1f')


def same_points():
    """Describing the same points of AKAZE."""
    return timed('same points', 'IIB', '%.2f')


def faster(data, what, name, codes):
    """How many times as fast as BFMatcher."""
    return data[what, 'BFMatcher', codes, 1] / data[what, name, codes, 1]


def matching():
    """Every way of matching beside BFMatcher in one run, and in another one without AVX2 and AVX-512."""
    wide, narrow, lines = benchmark(WIDE), benchmark(NARROW), []
    for what, name, codes, _ in wide:
        if (what, 'BFMatcher', codes, 1) in wide and name != 'BFMatcher':
            time = wide[what, name, codes, 1]
            lines.append([name, '%.0f' % codes, 'yes' if what == 'cross-check' else '', '%.2f' % time, '%.2f' % (1e6 * time / codes ** 2),
                          *('%.1f' % faster(data, what, name, codes) for data in (wide, narrow))])
    return table(['', 'codes', 'cross-check', 'ms', 'ns a pair', 'times as fast as BFMatcher', 'the same without AVX2'], lines)


def small_work():
    """What frames of a video ask for, in one run with all instruction sets and in others with fewer."""
    def column(name):
        data = benchmark(name)
        two = ('%.2f' % (data['frame', work, 5000, 1] / data['frame', work, 5000, 2]) for work in ('5000 points', '5000 codes'))
        return ['%.2f' % (data['describe', 'default', 1000, 1] / data['describe', 'cv::ORB', 1000, 1]),
                '%.1f' % faster(data, 'cross-check', 'EXACT', 1000),
                '%.2f' % (data['frame', 'default and EXACT', 1000, 2] / data['frame', 'ORB and BFMatcher', 1000, 2]),
                '%.0f' % (1000 * data['frame', 'one point', 1, 1]), '%.0f' % (1000 * data['frame', 'one code', 1, 1]), *two]
    labels = ('describe 1000 points, over ORB', 'match 1000 with 1000, cross-check: times as fast as BFMatcher',
              'a frame of 640 x 480: describe and match 1000 points on two threads, over ORB and BFMatcher',
              'one point of it described, us', 'one code matched with one, us',
              'describe 5000 points: times as fast on two threads', 'match 5000 with 5000, cross-check: the same')
    return table(['', 'AVX-512', 'AVX2', 'SSE4.2'], zip(labels, *(column(name) for name in (WIDE, AVX2, NARROW))))


def speed_claim():
    """The README's sentence on time: of a machine with AVX2, in ratios, since it is shared."""
    data = benchmark(AVX2)
    times = {key[1]: time for key, time in data.items() if key[0] == 'chain'}
    return ("- **Fast**: points and descriptors of an image in %.1f of ORB's time, 1/%.0f of SIFT's; an exact matcher %.0f times as fast\n"
            '  as `cv::BFMatcher` ([one thread, AVX2](doc/performance.md)).' %
            (times['recommended chain'] / times['ORB'], times['SIFT'] / times['recommended chain'], faster(data, 'cross-check', 'EXACT', 1000)))


def scale():
    """What scripts/helpers/scale.sh wrote."""
    return json.loads((results / 'scale.json').read_text())


def by_two(one, two):
    """How many times as fast two threads are; more than twice is noise, but for what a median is unsure of."""
    if one > 2.1 * two:
        sys.exit('scale.json: two threads are %.2f times as fast as one: measure again' % (one / two))
    return '%.1f' % (one / two)


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
    lines = table(['scene', 'method', 'registered', 'points', 'track', 'reprojection', 'centres, %', 'degrees', 'within 5 % and 5 degrees'],
                  [list(row.values()) for row in found])
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


# Tables of the paper by the questions of tools/evaluation/report/paper.csv.
QUESTIONS = dict.fromkeys(row['question'] for row in PAPER)
TABLES = {'paper_' + name: functools.partial(paper, question)
          for name, question in zip(('channels', 'mappings', 'extras', 'overlap', 'granularity', 'sampling', 'others'), QUESTIONS)}

PAGES = {'doc/poses.svg': (pose_bars,),
         'README.md': (match_claim, pose_claim, speed_claim, poses),
         'doc/guide.md': (presets, propagation),
         'doc/colmap.md': (photographs, photographs_of_many),
         'doc/performance.md': (describing, chains, same_points, matching, small_work),
         'doc/scale.md': (mapped_index, flat_search),
         'doc/paper.md': (matching_modes, learned_points, paper_orders, localization_systems, localization_setups),
         'doc/localization/index.html': (localization_lights,),
         'doc/results/README.md': (pose_methods, detected_points)}


def filled(page, makers):
    """The page's text, before and with its tables made anew."""
    before = (ROOT / page).read_text()
    named = {**{function.__name__: function for function in makers}, **TABLES}
    after, count = re.subn(r'(<!-- figures (\w+) -->\n).*?(?=<!-- end of figures -->)',
                           lambda match: match[1] + named[match[2]]() + '\n', before, flags=re.DOTALL)
    if count != len(makers) + sum('<!-- figures %s -->' % name in before for name in TABLES):
        sys.exit('%s holds %d tables of figures, not %d' % (page, count, len(makers)))
    return before, after


def write_page():
    """doc/results/index.html; whether it differs from what was there. Without jinja2 it stays."""
    page = results / 'index.html'
    before = page.read_text()
    if importlib.util.find_spec('jinja2'):
        subprocess.run([sys.executable, '-B', ROOT / 'tools/evaluation/report/report.py', results], check=True,
                       stdout=subprocess.DEVNULL)
    return page.read_text() != before


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
        print(*(make() for make in (describing, chains, same_points, matching, small_work)), sep='\n\n')
        return
    for page, makers in PAGES.items():
        before, after = filled(page, makers)
        if arguments.write:
            (ROOT / page).write_text(after)
        elif after != before:
            sys.exit(page + ' differs from doc/results: run scripts/helpers/figures.py --write')
    if write_page() and arguments.check:
        sys.exit('doc/results/index.html differed from its results, and was written anew')


if __name__ == '__main__':
    main()
