"""Makes functions of Python of the documented methods of the extension.

Methods of nanobind have no inspect.signature, and their errors name types of C++. Methods without a docstring are internal.
"""
from __future__ import annotations

import ast
import typing
from typing import Any

import numpy.typing

import opencv_iib.enums
from opencv_iib import _core
from opencv_iib._arguments import integer, integers, number, numbers

# How arguments are checked, by their annotations; others are passed on as they are. Returned numbers become enums where annotated so.
CHECKS = {'int': 'integer({0}, {0!r})', 'float': 'number({0}, {0!r})', 'bool': 'bool({0})', 'typing.SupportsIndex': 'integer({0}, {0!r}, 64)',
          'typing.Sequence[float]': 'numbers({0}, {0!r})', 'typing.Sequence[typing.SupportsIndex]': 'integers({0}, {0!r}, 64)'}
NAMES = {'integer': integer, 'integers': integers, 'number': number, 'numbers': numbers, 'typing': typing, 'numpy': numpy, 'opencv_iib': opencv_iib}


def function_of(method: Any, signature: str, doc: str) -> Any:
    """A function with a signature such as ``def setSigma(self, sigma: float) -> None``, which calls the method."""
    function: Any = ast.parse(signature + ': ...').body[0]
    passed = [CHECKS.get(ast.unparse(each.annotation) if each.annotation else '', '{0}').format(each.arg) for each in function.args.args]
    call = f'method({", ".join(passed)})'
    if ast.unparse(function.returns).startswith('opencv_iib.enums.'):
        call = f'{ast.unparse(function.returns)}({call})'
    source = f'from __future__ import annotations\n{signature}:\n    return {call}'
    names: dict[str, Any] = {**NAMES, 'method': method}
    exec(compile(source, method.__module__, 'exec'), names)
    made = names[function.name]
    made.__doc__, made.__module__, made.__qualname__ = doc, method.__module__, method.__qualname__
    return made


for _owner in [value for value in vars(_core).values() if isinstance(value, type)]:
    for _name, _method in list(vars(_owner).items()):
        for _signature, _doc, _ in _method.__nb_signature__ if type(_method).__name__ == 'nb_method' else ():
            if _doc:
                setattr(_owner, _name, function_of(_method, _signature, _doc))
