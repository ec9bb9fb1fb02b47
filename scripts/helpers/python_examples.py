#!/usr/bin/env python3
"""Prints the examples of the Python package as a page of Markdown, cell by cell: python_examples.py [PICTURES]

With PICTURES, each cell is run as in a notebook, by a Python that has the package. Its output and pictures follow it; the pictures
go to that folder.
"""
import ast
import contextlib
import io
import os
import pathlib
import shutil
import sys
import tempfile

EXAMPLES = pathlib.Path(__file__).resolve().parents[2] / 'python/examples'
NAMES = ('day_night', 'align', 'webcam_year', 'poses', 'reconstruction', 'two_flights', 'robot_at_night', 'million_codes')


def run(code, variables, pictures):
    """The output and the pictures of a cell, as Markdown."""
    before, printed = set(os.listdir()), io.StringIO()
    with contextlib.redirect_stdout(printed):
        exec(code, variables)
    text = printed.getvalue().rstrip()
    print('```text\n%s\n```\n' % text if text else '')
    for name in sorted(name for name in set(os.listdir()) - before if os.path.isfile(name)):
        shutil.copy(name, pictures / ('output_' + name))  # Doxygen puts all pictures of a site into one folder
        print('![What it draws](output_%s)\n' % name)


def show(name, pictures):
    """An example; the text above its first cell counts as a cell."""
    text = (EXAMPLES / (name + '.py')).read_text(encoding='utf-8')
    head, *cells = text.split('\n# %% ')
    print('## %s.py\n' % name)
    variables = {}
    for about, code in [(ast.get_docstring(ast.parse(text)), head.split('"""')[2]), *(cell.split('\n', 1) for cell in cells)]:
        print('%s\n\n```python\n%s\n```\n' % (about, code.strip()))
        if pictures:
            run(code, variables, pictures)


def main():
    pictures = pathlib.Path(sys.argv[1]).resolve() if len(sys.argv) > 1 else None
    print('# The Python package: examples {#opencv_iib_python_examples}\n\nThey lie in `python/examples` of a clone and need no data; '
          '`python day_night.py` runs one from a shell; VS Code, '
          'Spyder and PyCharm run its cells (`# %%`), and `jupytext --to notebook day_night.py` makes a notebook of it.\n')
    if pictures:
        print('What stands below a cell is what it printed and drew when this site was made. The two images of `align.py`, laid '
              'onto each other, [with a slider](align/index.html).\n')
    sys.path.insert(0, str(EXAMPLES))
    sys.argv = sys.argv[:1]
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        for name in NAMES:
            show(name, pictures)
        os.chdir('/')


if __name__ == '__main__':
    main()
