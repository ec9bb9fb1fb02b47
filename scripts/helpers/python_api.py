#!/usr/bin/env python3
"""Prints the Python package's reference as a page of Markdown, from its sources: python_api.py

Members that classes inherit from the extension are listed if the package is installed, since its build makes the stub.
"""
import ast
import importlib.util
import pathlib

PACKAGE = pathlib.Path(__file__).resolve().parents[2] / 'python/opencv_iib'
INSTALLED = importlib.util.find_spec('opencv_iib')
STUB = {node.name: node for node in ast.parse(pathlib.Path(INSTALLED.origin).with_name('_core.pyi').read_text(encoding='utf-8')).body
        if isinstance(node, ast.ClassDef)} if INSTALLED else {}


def signature(node, owner):
    if isinstance(node, ast.ClassDef):
        return 'class %s%s' % (node.name, '(%s)' % ', '.join(map(ast.unparse, node.bases)) if node.bases else '')
    return '%s%s(%s)%s' % (owner, node.name, ast.unparse(node.args), ' -> ' + ast.unparse(node.returns) if node.returns else '')


def methods(node):
    """Of a class: its own, and the documented ones of the extension's class that it extends."""
    found = [member for member in node.body if isinstance(member, ast.FunctionDef)]
    for base in map(ast.unparse, node.bases):
        if base.removeprefix('_core.') in STUB:
            known = {member.name for member in found}
            found += [member for member in methods(STUB[base.removeprefix('_core.')]) if member.name not in known and ast.get_docstring(member)]
    return found


def entries(nodes, owner=''):
    """Signatures, a line for each overload, and docstrings as text, since Doxygen would read more into them."""
    heads = []
    for node in nodes:
        if isinstance(node, (ast.ClassDef, ast.FunctionDef)) and not node.name.startswith('_'):
            if 'overload' in map(ast.unparse, node.decorator_list):
                heads.append(signature(node, owner))
                continue
            print('```text\n%s\n\n%s\n```\n' % ('\n'.join(heads or [signature(node, owner)]), ast.get_docstring(node) or ''))
            heads = []
            if isinstance(node, ast.ClassDef):
                entries(methods(node), node.name + '.')


def main():
    print('# The Python package: reference {#opencv_iib_python_api}\n')
    for path in sorted(PACKAGE.rglob('*.py')):
        if path.name.startswith('_') and path.name != '__init__.py':
            continue
        tree = ast.parse(path.read_text(encoding='utf-8'))
        name = '.'.join(path.relative_to(PACKAGE.parent).with_suffix('').parts).replace('.__init__', '')
        print('## %s\n\n```text\n%s\n```\n' % (name, ast.get_docstring(tree) or ''))
        entries(tree.body)


if __name__ == '__main__':
    main()
