#!/usr/bin/python3
"""Writes doc/uncertainty.md and doc/uncertainty.svg: how many errors are inside what was told.

    build/tools/evaluation/iib_evaluation --only uncertainty --only localization_uncertainty --points 2000 --out FOLDER DATA...
    python3 tools/pages/uncertainty.py FOLDER

The tables are of uncertainty.csv and localization_uncertainty.csv in FOLDER. Needs pandas, SciPy and matplotlib.
"""
import argparse
import pathlib

import matplotlib
import pandas as pd
from scipy.stats import chi2

matplotlib.use('svg')
import matplotlib.pyplot as plt  # noqa: E402

DOC = pathlib.Path(__file__).resolve().parents[2] / 'doc'
LEVELS = ['0.1', '0.25', '0.5', '0.75', '0.9', '0.95', '0.99']
DATA = {'amos_daynight': 'webcams over a day', 'tilde_webcam': 'webcams over a year', 'mefb_exposure': 'other exposures',
        'photometric_stereo': 'other lamps', 'middlebury2014': 'other lamps and exposures (rooms)', 'iib_demo': "the authors' scene",
        'oxford_affine': 'other exposures (leuven)', 'strecha': "photographs with a laser's poses, one light"}
INTRODUCTION = '''# How sure

An uncertainty holds if errors are as large as it says: half of them inside what is told for 50 %, 95 of 100 inside what is told for
95 %. This page counts them on data with known truth. It is written by `tools/pages/uncertainty.py` from what `iib_evaluation --only
uncertainty --only localization_uncertainty` measures.

    python3 tools/synthetic/views.py views --seed 31 --scenes street facade room
    build/tools/evaluation/iib_evaluation --only uncertainty --only localization_uncertainty --points 2000 --out FOLDER views DATA...
    python3 tools/pages/uncertainty.py FOLDER

*Rendered places* are those of seed 31, three of its four scenes, at which nobody looked while rules and constants were chosen; each pair is
an image at noon and one by night, at dusk or in winter from another place. On *all other data* constants were chosen: they show
that one rule serves them all, not how it does on yours.

'''
REMARKS = '''
![Calibration curves](uncertainty.svg)

## What is not in it
- What all matches of a pair have in common: a wrong camera matrix, rolling shutter, a lens that is not as it says.
- For refined points, whether a match is right: counted are those within three pixels of the truth.
- For aligned webcams, that the truth itself is known to one or two pixels only, since the cameras move in the wind.
- For `Localizer`, errors of the map's poses that the map's own images do not show.
'''


def told(folder):
    """A row a quantity and data set: number of errors, and shares inside the levels."""
    table = pd.read_csv(folder / 'uncertainty.csv')
    table['data'] = [DATA.get(name, 'rendered places, other light') for name in table['set']]
    sums = table.groupby(['quantity', 'data'])[['count', *LEVELS]].sum()
    rows = [sums[LEVELS].div(sums['count'], axis=0).assign(count=sums['count'])]
    places = folder / 'localization_uncertainty.csv'
    if places.exists():
        table = pd.read_csv(places)
        found = table[table['squared_centre'].notna()]
        data = [DATA.get(name, 'rendered places, other light') for name in found['set']]
        for what in ('centre', 'rotation'):
            inside = pd.DataFrame({level: found[f'squared_{what}'] < chi2.ppf(float(level), 3) for level in LEVELS})
            grouped = inside.groupby([pd.Series(f'{what} of Localizer', inside.index, name='quantity'),
                                      pd.Series(data, inside.index, name='data')])
            rows.append(grouped.mean().assign(count=grouped.size()))
    return pd.concat(rows)


def markdown(rows):
    lines = ['| | data | errors | inside 50 % | 95 % | 99 % |', '|---|---|---|---|---|---|']
    for (quantity, data), row in rows.iterrows():
        cells = [f'{100 * row[level]:.0f}' for level in ('0.5', '0.95', '0.99')]
        lines.append(f'| {quantity} | {data} | {row["count"]:.0f} | ' + ' | '.join(cells) + ' |')
    return '\n'.join(lines) + '\n'


def draw(rows, file):
    """A curve a quantity over all its data."""
    plt.rcParams.update({'svg.hashsalt': 'iib', 'svg.fonttype': 'path'})
    figure, axes = plt.subplots(figsize=(7, 5), layout='constrained')
    levels = [float(level) for level in LEVELS]
    for quantity, each in rows.groupby(level='quantity'):
        shares = each[LEVELS].mul(each['count'], axis=0).sum() / each['count'].sum()
        axes.plot(levels, shares, marker='o', label=quantity)
    axes.plot([0, 1], [0, 1], color='grey', linestyle='--', label='as told')
    axes.set(xlabel='told chance', ylabel='share of errors inside', xlim=(0, 1), ylim=(0, 1))
    axes.legend(frameon=False)
    figure.savefig(file, metadata={'Date': None})


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('folder', type=pathlib.Path)
    rows = told(parser.parse_args().folder)
    draw(rows, DOC / 'uncertainty.svg')
    (DOC / 'uncertainty.md').write_text(INTRODUCTION + markdown(rows) + REMARKS, encoding='utf-8')


if __name__ == '__main__':
    main()
