#!/usr/bin/env python3
"""Writes type stubs of the modules whose classes get methods when they are loaded (see _names.py): stubs.py PACKAGE OUT

CMake runs it, so that the wheel has the stubs beside the modules; a source tree has none.
"""
import ast
import copy
import pathlib
import sys

sys.path.insert(0, sys.argv[1])
from _names import accessors, snake_case


def stub(body, aliases):
    """Signatures and docstrings alone."""
    for node in list(body):
        if isinstance(node, ast.Assign) and ast.unparse(node.value).startswith('Parameter('):
            kind, meaning = node.value.args
            at = body.index(node)
            body[at:at + 1] = ast.parse(accessors(node.targets[0].id, kind.id, meaning.value)).body
    for node in list(body):
        if isinstance(node, ast.ClassDef):
            if 'self._core' in ast.unparse(node):  # what other modules of the package read
                node.body.append(ast.parse('_core: Any').body[0])
            stub(node.body, any(ast.unparse(base) in ('SnakeCase', 'Detector') for base in node.bases))
        elif isinstance(node, ast.FunctionDef):
            node.body = node.body[:1] if ast.get_docstring(node) else [ast.Expr(ast.Constant(...))]
            if aliases and not node.name.startswith('_') and snake_case(node.name) != node.name:
                twin = copy.deepcopy(node)
                twin.name = snake_case(node.name)
                body.append(twin)


for path in sorted(pathlib.Path(sys.argv[1]).glob('*.py')):
    text = path.read_text(encoding='utf-8')
    if 'SnakeCase):' in text or 'Detector):' in text:
        tree = ast.parse(text)
        stub(tree.body, False)
        pathlib.Path(sys.argv[2]).mkdir(parents=True, exist_ok=True)
        pathlib.Path(sys.argv[2], path.stem + '.pyi').write_text(ast.unparse(tree) + '\n', encoding='utf-8')
