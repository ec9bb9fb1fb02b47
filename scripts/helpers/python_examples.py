#!/usr/bin/env python3
"""Prints the examples of the Python package as a page of Markdown, a paragraph and a piece of code a cell: python_examples.py"""
import ast
import pathlib

EXAMPLES = pathlib.Path(__file__).resolve().parents[2] / 'python/examples'
NAMES = ('day_night', 'align', 'poses', 'reconstruction', 'million_codes')


def main():
    print('# The Python package: examples {#opencv_iib_python_examples}\n\nThey lie in `python/examples` of a clone and need no data; '
          '`python day_night.py` runs one from a shell; VS Code, '
          'Spyder and PyCharm run its cells (`# %%`), and `jupytext --to notebook day_night.py` makes a notebook of it.\n')
    for name in NAMES:
        text = (EXAMPLES / (name + '.py')).read_text(encoding='utf-8')
        head, *cells = text.split('\n# %% ')
        print('## %s.py\n\n%s\n\n```python\n%s\n```\n' % (name, ast.get_docstring(ast.parse(text)), head.split('"""')[2].strip()))
        for cell in cells:
            told, _, code = cell.partition('\n')
            print('%s\n\n```python\n%s\n```\n' % (told, code.strip()))


if __name__ == '__main__':
    main()
