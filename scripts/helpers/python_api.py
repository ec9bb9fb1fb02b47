#!/usr/bin/env python3
"""Prints the Python package's reference as a page of Markdown, from its sources: python_api.py"""
import ast
import pathlib

PACKAGE = pathlib.Path(__file__).resolve().parents[2] / 'python/opencv_iib'


def entry(node, owner=''):
    """Signature and docstring as text, since Doxygen would read more into them."""
    doc = ast.get_docstring(node) or ''
    if isinstance(node, ast.ClassDef):
        head = 'class %s%s' % (node.name, '(%s)' % ', '.join(map(ast.unparse, node.bases)) if node.bases else '')
    else:
        head = '%s%s(%s)%s' % (owner, node.name, ast.unparse(node.args), ' -> ' + ast.unparse(node.returns) if node.returns else '')
    print('```text\n%s\n\n%s\n```\n' % (head, doc))


def main():
    print('# The Python package: reference {#opencv_iib_python_api}\n')
    for path in sorted(PACKAGE.rglob('*.py')):
        if path.name.startswith('_') and path.name != '__init__.py':
            continue
        tree = ast.parse(path.read_text(encoding='utf-8'))
        name = '.'.join(path.relative_to(PACKAGE.parent).with_suffix('').parts).replace('.__init__', '')
        print('## %s\n\n```text\n%s\n```\n' % (name, ast.get_docstring(tree) or ''))
        for node in tree.body:
            if isinstance(node, (ast.ClassDef, ast.FunctionDef)) and not node.name.startswith('_'):
                entry(node)
                for member in node.body if isinstance(node, ast.ClassDef) else ():
                    if isinstance(member, ast.FunctionDef) and not member.name.startswith('_'):
                        entry(member, node.name + '.')


if __name__ == '__main__':
    main()
