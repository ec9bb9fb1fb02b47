"""Charts of the results as SVG, by matplotlib."""
import io
import re

import matplotlib
import numpy as np
import pandas as pd

import controls
import summaries
import tables
import timings
import ways

matplotlib.use('svg')
matplotlib.rcParams.update({'svg.hashsalt': 'iib', 'axes.grid': True, 'grid.linewidth': .4, 'figure.constrained_layout.h_pad': .1})
import matplotlib.pyplot as plt  # noqa: E402
from matplotlib import ft2font, ticker  # noqa: E402

GREY, RED, BLUE = '#64748b', '#b91c1c', '#1d4ed8'
# For each detector that `cost` draws: its colour, and the place of its name in points from the line's end, clear of other lines.
BESIDE = (8, 0), 'left'
DRAWN = {'recommended chain': (RED, (-20, -76), 'center'), 'ALIKED-n16': (BLUE, *BESIDE), 'ORB': (GREY, (-8, 10), 'right'),
         'AKAZE': ('#a16207', (8, -14), 'left'), 'SIFT': ('#047857', (14, -20), 'left'), 'SIFT normalized': ('#7e22ce', (-8, 6), 'right')}
FAR = 1000  # centimetres
WIDTH = 9  # inches, of every chart
ENDS = {'elinewidth': .8}  # of confidence intervals
MAKER = 'Matplotlib %s, FreeType %s' % (matplotlib.__version__, ft2font.__freetype_version__)  # text positions depend on them


def svg(figure):
    """The text of a figure, the same whenever it is drawn by the same MAKER."""
    text = io.StringIO()
    figure.savefig(text, format='svg', metadata={'Date': None, 'Creator': MAKER})
    plt.close(figure)
    return re.sub(r'(?<!>)\s+', ' ', re.sub(r'>\s+<(?!g id=|/svg)', '><', text.getvalue()))  # a named group a line


def speed():
    """Time over keypoints, pixels and codes."""
    figure, axes = plt.subplots(2, 2, figsize=(WIDTH, 6), layout='constrained')
    axes = axes.ravel()

    def draw(axis, test, form, sizes, labels):
        for name, label in labels.items():
            values = [timings.ms(test, *form(name, size))['AVX2'] for size in sizes]
            axis.plot(list(sizes.values()), values, marker='o', label=label)

    draw(axes[0], 'IIB_Chain_vga', lambda name, size: ('street_noon', name, size), {size: size for size in (1000, 2000)}, {'recommended chain': 'IIB', 'ORB': 'ORB'})
    draw(axes[1], 'IIB_Describe_large', lambda name, size: (name, size), {k: 24 * (k / 8) ** 2 for k in (1, 2, 3, 4, 6, 8)}, {'default': 'IIB', 'ORB': 'ORB'})
    for test, labels in zip(timings.DESCRIBED, ({'default': 'IIB', 'PRESET_UNIVERSAL': 'IIB UNIVERSAL', 'ORB': 'ORB'}, {'BEBLID-512': 'BEBLID-512'})):
        draw(axes[2], test, lambda name, size: (name, size), {size: size for size in (1000, 5000)}, labels)
    draw(axes[3], 'IIB_Match_match', lambda name, size: (name, 'true', size), {size: size for size in (100, 500, 1000, 10000)},
         {'EXACT': "IIB's matcher", 'BRUTE_FORCE': 'BFMatcher'})
    axes[3].set(xscale='log', yscale='log')  # parallel lines have a constant ratio
    for axis, title, label in zip(axes, ('Detect and describe', 'Description alone: larger images', 'Description alone: more points', 'Match'), (
            'keypoints (640 x 480)', 'megapixels (1000 keypoints)', 'keypoints (1280 x 720)', 'codes on either side, cross-check')):
        axis.set(title=title, xlabel=label, ylabel='ms, AVX2')
        axis.legend()
        if axis is not axes[3]:
            axis.set(xlim=(0, None), ylim=(0, None))
    return svg(figure)


def poses():
    """Every method at its best ratio, in other light; below them, of the run of `cost`, ALIKED with LightGlue."""
    bars = [('recommended chain' if method == controls.CHAIN else method[0] if len({*method}) == 1 else controls.name(method), controls.found()['other light', *method])
            for method in controls.methods()]
    learned, = (of['refined'] for key, of in ways.found().items() if key[:2] == (ways.LEARNED, 1000))
    return scores([*bars, ('ALIKED + LightGlue, another run', learned)], 'pose score (AUC to 5 degrees; 1 is perfect), rendered places in other light, 1000 points', 1)


def spread(rows, value='at_5'):
    """Values of rows, and the lengths of their confidence intervals on both sides."""
    values = np.array([[float(row[name]) for name in (value, 'low', 'high')] for row in rows]).T
    return values[0], [values[0] - values[1], values[2] - values[0]]


def scores(bars, label='score of poses in other light, up to 5 degrees', apart=0):
    """Scores from 0 to 1 of methods, with their confidence intervals; a gap before the last `apart` bars."""
    names, rows = zip(*bars)
    values, ends = spread(rows)
    figure, axis = plt.subplots(figsize=(WIDTH, .4 * len(names) + .6), layout='constrained')
    places = [n + .6 * (apart > 0 and n >= len(names) - apart) for n in range(len(names))]
    axis.barh(places, values, xerr=ends, error_kw=ENDS, color=[RED if name.startswith('recommended chain') else GREY for name in names])
    axis.set(xlim=(0, 1), xlabel=label, yticks=places, yticklabels=names)
    axis.grid(False)
    axis.invert_yaxis()
    return svg(figure)


def cost():
    """Scores of poses in other light over processor time, one line per detector from few points to many. A detector that is not in DRAWN gets
    a colour, and its name beside the line's end."""
    figure, axis = plt.subplots(figsize=(5.4, 4.2), layout='constrained')  # small, so that a phone shows all of it
    lines = {}
    for (detector, points, _), of in ways.found().items():
        lines.setdefault(detector, []).append((points, of))
    for n, (detector, each) in enumerate(lines.items()):
        colour, where, side = DRAWN.get(detector, ('C%d' % n, *BESIDE))
        each.sort(key=lambda one: one[0])
        for way, fill in (('plain', 'none'), ('refined', 'full')):
            rows = [of[way] for _, of in each]
            score, ends = spread(rows)
            axis.errorbar([float(row['milliseconds']) for row in rows], score, ends, marker='o', fillstyle=fill, color=colour,
                          linestyle='-' if way == 'refined' else ':', **ENDS)
        end = each[-1][1]['refined']
        axis.annotate('%s\n%s' % (detector.replace('-n16', ' +\nLightGlue'), ', '.join(str(points) for points, _ in each)),
                      (float(end['milliseconds']), float(end['at_5'])), where, textcoords='offset points', ha=side, va='center', color=colour)
    axis.set(xscale='log', ylim=(0, 1), xlim=(5, 20000), xlabel='ms of one core, from two images to the pose', ylabel='score of poses')
    axis.xaxis.set_major_formatter('{x:g}')
    axis.minorticks_off()
    axis.legend(handles=[plt.Line2D([], [], marker='o', fillstyle=fill, color=GREY, linestyle=style, label=label) for fill, style, label in (
        ('none', ':', 'matches as they are, PoseLib'), ('full', '-', 'propagateMatches, findRelativePose'))], loc='lower right', fontsize='small', frameon=False)
    return svg(figure)


def uncertainty():
    """Share of errors within the limit over the confidence level, one curve per quantity; rendered places apart from photographs."""
    rows = pd.read_csv(tables.RESULTS / 'uncertainty.csv').query('errors > 0')
    levels = list(summaries.LEVELS)
    rendered = rows['data'].str.startswith('rendered')
    figure, axes = plt.subplots(1, 2, figsize=(WIDTH, 5), layout='constrained', sharey=True)
    for axis, title, kind in zip(axes, ('rendered places, other light', 'photographs'), (rows[rendered], rows[~rendered])):
        for n, quantity in enumerate(sorted(set(rows['quantity']))):
            each = kind[kind['quantity'] == quantity]
            if len(each):
                shares = each[levels].mul(each['errors'], axis=0).sum() / each['errors'].sum()
                axis.plot([float(level) for level in levels], shares, marker='o', label=quantity, color='C%d' % n)
        axis.plot([0, 1], [0, 1], color='grey', linestyle='--', label='as reported')
        axis.set(title=title, xlabel='level of confidenceLimit', xlim=(0, 1), ylim=(0, 1))
        axis.legend(frameon=False, fontsize='small')
    axes[0].set(ylabel='share of errors inside')
    figure.suptitle('Below the dashed line: limits too narrow; above: too wide.', fontsize='medium')
    return svg(figure)


def views():
    """Right matches of each method by zoom, rotation and tilt."""
    found, methods = tables.view_rows('photographs'), {'matchViews': (RED, '-'), 'upright chain': ('#fca5a5', '-'), 'SIFT': ('#047857', '-'), 'ORB': (GREY, '-'),
                                                       'AffineFeature': ('#047857', ':')}
    figure, axes = plt.subplots(1, 3, figsize=(WIDTH, 3.4), layout='constrained', sharey=True)
    for axis, kind, label in zip(axes, ('zoom', 'rotation', 'tilt'), ('size of the second image', 'rotation, degrees', 'tilt: one axis shortened by')):
        unchanged = {'zoom': 1, 'rotation': 0, 'tilt': 1}[kind]
        for method, (colour, style) in methods.items():
            values = {unchanged: found['zoom', '1', method], **{float(key[1]): row for key, row in found.items() if key[::2] == (kind, method)}}
            axis.plot(sorted(values), [max(1, float(values[at]['right'])) for at in sorted(values)], style, color=colour, marker='o', markersize=3,
                      label=method if method != 'AffineFeature' else 'AffineFeature with SIFT, %s photographs' % found['zoom', '1', method]['pairs'])
        axis.set(xlabel=label, yscale='log', ylim=(.9, 12000))
        axis.yaxis.set_major_formatter('{x:g}')
    axes[0].set(xscale='log', xticks=(.25, .35, .5, .7, 1, 1.4, 2), ylabel='right matches (1: one or none)')
    axes[0].xaxis.set_major_formatter('{x:g}')
    axes[0].minorticks_off()
    axes[1].set(xticks=range(0, 181, 45))
    figure.legend(*axes[0].get_legend_handles_labels(), loc='upper center', ncols=5, frameon=False, fontsize='small')
    figure.get_layout_engine().set(rect=(0, 0, 1, .9))  # below the legend
    return svg(figure)


def localization(results):
    """Share of images over the error in centimetres, one chart per light, one line per method."""
    colours = {'recommended chain': RED, 'SIFT, normalized image': BLUE, 'SIFT, plain image': GREY}
    rows = [row for row in results['rows'] if row['place'] == 'street' and row['method'] in colours]
    lights = [light for light in results['lights'] if any(row['errors'] for row in rows if row['light'] == light)]
    figure, axes = plt.subplots(-(-len(lights) // 3) or 1, 3, figsize=(WIDTH, 2.2 * (-(-len(lights) // 3) or 1)), layout='constrained', sharex=True, sharey=True,
                                squeeze=False)
    for axis, light in zip(axes.flat, lights):
        for row in (row for row in rows if row['light'] == light and row['errors']):
            shares = [n / row['images'] for n in range(len(row['errors']) + 1)]
            axis.step([row['errors'][0], *row['errors'], FAR], [*shares, shares[-1]], where='post', color=colours[row['method']], label=row['method'])
        axis.set(xscale='log', title=light, xlabel='cm', xlim=(.1, FAR), ylim=(0, 1.02))
        axis.xaxis.set_major_formatter('{x:g}')
        axis.yaxis.set_major_formatter(ticker.PercentFormatter(1))
        axis.minorticks_off()
        axis.tick_params(labelbottom=True)
    for axis in axes.flat[len(lights):]:
        axis.axis('off')
    lines = dict(zip(*axes.flat[0].get_legend_handles_labels()[::-1]))
    figure.legend(lines.values(), lines.keys(), loc='lower right')
    return svg(figure)
