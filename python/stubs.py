#!/usr/bin/env python3
"""Writes type stubs of the modules whose classes get methods when they are loaded (see _names.py): stubs.py OUT

CMake runs it, so that the wheel has the stubs beside the modules; a source tree has none.
"""
import ast
import copy
import pathlib
import sys

PACKAGE = pathlib.Path(__file__).resolve().parent / 'opencv_iib'
sys.path.insert(0, str(PACKAGE))
import enums
from _names import accessors, constants, method, snake_case

TEXTS = {'Method': method, 'Parameter': accessors}


def written(node, owner):
    """What stands in a class for a statement of its source: methods and constants."""
    call = getattr(getattr(node, 'value', None), 'func', None)
    if getattr(call, 'id', '') in TEXTS:
        arguments = [getattr(argument, 'id', None) or argument.value for argument in node.value.args]
        return ast.parse(TEXTS[call.id](node.targets[0].id, *arguments)).body
    if getattr(node, 'name', '') != '__init__' or any(getattr(other, 'name', '') == 'create' for other in owner.body):
        return [node]
    create = copy.deepcopy(node)
    create.name, create.args.args[0].arg, create.returns = 'create', 'cls', ast.Name(owner.name)
    create.decorator_list = [ast.Name('classmethod')]
    return [node, create]


def stub(tree, aliases=True):
    """Makes signatures and docstrings of a module's tree, with second names or without, and returns it."""
    for owner in ast.walk(tree):
        if isinstance(owner, ast.ClassDef) and {'SnakeCase', 'Detector'} & {ast.unparse(base) for base in owner.bases}:
            kinds = [kind.id for keyword in owner.keywords for kind in keyword.value.elts]
            owner.body = [made for node in owner.body for made in written(node, owner)] + ast.parse('_core: Any\n' + '\n'.join(
                f'{name} = {kind}.{member}' for kind in kinds for name, member, _ in constants(getattr(enums, kind)))).body
            owner.keywords = []
            for node in list(owner.body):
                if aliases and isinstance(node, ast.FunctionDef) and node.name[0] != '_' and snake_case(node.name) != node.name:
                    owner.body.append(copy.deepcopy(node))
                    owner.body[-1].name = snake_case(node.name)
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef):
            node.body = node.body[:1] if ast.get_docstring(node) else [ast.Expr(ast.Constant(...))]
    return tree


if __name__ == '__main__':
    out = pathlib.Path(sys.argv[1])
    out.mkdir(parents=True, exist_ok=True)
    for path in sorted(PACKAGE.glob('*.py')):
        source = path.read_text(encoding='utf-8')
        if 'import Method' in source:
            (out / (path.stem + '.pyi')).write_text(ast.unparse(stub(ast.parse(source))) + '\n', encoding='utf-8')
