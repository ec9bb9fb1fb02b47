#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0

"""Writes everything that shows figures from the results in doc: the tables of README.md and of pages in doc and upstream, doc/results/index.html,
doc/localization/index.html, charts and the paper's drawings. With arguments, the page of other results alone.

Needs python3-pandas, python3-jinja2 and python3-matplotlib.
"""
import argparse
import json
import pathlib
import re
import sys

import jinja2

import charts
import drawings
import localization
import results
import tables
import ways

ROOT = tables.ROOT


def rendered(template, context):
    environment = jinja2.Environment(loader=jinja2.FileSystemLoader(tables.HERE), autoescape=True, trim_blocks=True, lstrip_blocks=True,
                                     undefined=jinja2.StrictUndefined)
    return environment.get_template(template).render(context)


def results_page(folder):
    """The files that show the summaries of an evaluation."""
    context = results.context(folder)
    if not context:
        sys.exit('%s: no results of iib_evaluation' % folder)
    ours = folder == tables.RESULTS
    cost = ours and {**ways.figures(), **tables.pose_figures()}
    page = {folder / 'index.html': rendered('results.html.j2', {**context, 'cost': cost})}
    if ours:
        page[folder / 'cost.svg'] = charts.cost()
    return {**page, folder / 'scores.svg': charts.scores(context['estimates']['bars'])} if context['estimates']['bars'] else page


def localization_page(folder):
    """The files that show measured localization."""
    found = json.loads((folder / 'results.json').read_text())
    unseen = localization.unseen() if folder == ROOT / 'doc/localization' else []
    return {folder / 'index.html': rendered('localization.html.j2', {**localization.context(found, folder / 'localization_setups.csv'), 'unseen': unseen}),
            folder / 'errors.svg': charts.localization(found)}


def markdown():
    """Pages with tables, filled with current figures."""
    pages, used = {}, set()
    figures = {'%s.%s' % (group, name): value for group, make in tables.FIGURES.items() for name, value in make().items()}
    for page in [ROOT / 'README.md', *sorted((ROOT / 'doc').rglob('*.md')), *sorted((ROOT / 'upstream').glob('*.md'))]:
        def fill(match):
            used.add(match[2])
            return match[1] + tables.ALL[match[2]]() + '\n'
        if re.search(r'^ *<!-- \w+\.\w+ -->', page.read_text(), re.M):
            sys.exit('%s: a line that begins with a figure is taken as HTML: begin it with a word' % page)
        text = re.sub(r'(<!-- figures (\w+) -->\n).*?(?=<!-- end of figures -->)', fill, page.read_text(), flags=re.DOTALL)
        pages[page] = re.sub(r'(<!-- (\w+\.\w+) -->)[^<]*(?=<!-- -->)', lambda match: match[1] + figures[match[2]], text)
    if used != set(tables.ALL):
        sys.exit('no page shows the tables %s' % ', '.join(set(tables.ALL) - used))
    return pages


def everything():
    """All files made from results, and their text."""
    doc = ROOT / 'doc'
    made = {**markdown(), **results_page(tables.RESULTS), **localization_page(doc / 'localization')}
    made.update({doc / (chart.__name__ + '.svg'): chart() for chart in (charts.speed, charts.poses, charts.uncertainty, charts.views)})
    return {**made, **{doc / 'paper' / (draw.__name__ + '.svg'): draw() for draw in drawings.ALL}}


def differs(file, text):
    """Whether the text differs; a chart by another version of matplotlib is not compared."""
    before = file.read_text() if file.exists() else ''
    return before != text and not (file.suffix == '.svg' and before and charts.MAKER not in before)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    mode = parser.add_mutually_exclusive_group()
    mode.add_argument('--check', action='store_true', help='write nothing; an error where something would change')
    mode.add_argument('--results', type=pathlib.Path, metavar='FOLDER', help='the page of the summaries in a folder')
    mode.add_argument('--localization', type=pathlib.Path, metavar='FOLDER', help='the page of what tools/localization/measure.py wrote')
    arguments = parser.parse_args()
    made = results_page(arguments.results) if arguments.results else localization_page(arguments.localization) if arguments.localization else everything()
    if arguments.check:
        sys.exit('\n'.join('%s differs from its results: run tools/pages/pages.py' % file for file, text in made.items() if differs(file, text)) or 0)
    for file, text in made.items():
        file.write_text(text, encoding='utf-8')


if __name__ == '__main__':
    main()
