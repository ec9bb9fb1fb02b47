"""Methods with names of OpenCV's style and of Python's."""
from __future__ import annotations

import re
import sys
from typing import Any


def snake_case(name: str) -> str:
    """``detectAndCompute`` is ``detect_and_compute``."""
    return re.sub('(?<=[a-z0-9])(?=[A-Z])', '_', name).lower()


def accessors(name: str, kind: str, meaning: str) -> str:
    """The text of the two methods of a parameter, such as setSigma(sigma) and getSigma().

    :param kind: the type of the value; for an enum, integers are taken as well.
    """
    upper, taken = name[0].upper() + name[1:], kind if kind in ('bool', 'float') else 'int'
    return f'''
def set{upper}(self, {name}: {taken}) -> None:
    """{meaning}"""
    self._core.{name} = {name}

def get{upper}(self) -> {kind}:
    """{meaning}"""
    return {kind}(self._core.{name})
'''


class Parameter:
    """Stands in a class for the two methods that set and get a value of the extension's object, which checks it."""

    def __init__(self, kind: type, meaning: str) -> None:
        self._kind, self._meaning = kind, meaning

    def __set_name__(self, owner: type, name: str) -> None:
        methods: dict[str, Any] = {}
        exec(accessors(name, self._kind.__name__, self._meaning), vars(sys.modules[owner.__module__]), methods)
        for method in methods.values():
            method.__qualname__ = f'{owner.__qualname__}.{method.__name__}'
            setattr(owner, method.__name__, method)
        delattr(owner, name)


class SnakeCase:
    """Gives every method of the classes below it a second name in snake_case.

    python/stubs.py tells type checkers of these and of a Parameter's methods.
    """

    def __init_subclass__(cls, **keywords: Any) -> None:
        super().__init_subclass__(**keywords)
        for name, member in list(vars(cls).items()):
            if not name.startswith('_') and not name.isupper():
                setattr(cls, snake_case(name), member)
