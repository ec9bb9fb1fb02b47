"""Methods that are told in one line, and second names of Python's style."""
from __future__ import annotations

import enum
import functools
import inspect
import os
import re
import sys
from typing import Any, Iterator, Union

Path = Union[str, os.PathLike[str]]


def snake_case(name: str) -> str:
    """``detectAndCompute`` is ``detect_and_compute``."""
    return re.sub('(?<=[a-z0-9])(?=[A-Z])', '_', name).lower()


def method(name: str, signature: str, meaning: str) -> str:
    """The text of a method that calls the extension's object: ``imageOf``, ``(row: int) -> int``, what it tells."""
    arguments = [f'os.fspath({argument})' if kind == 'Path' else argument
                 for argument, kind in re.findall(r'(\w+): (\w+)', signature)]
    call = f'self._core.{name}({", ".join(arguments)})'
    return f'''
def {name}(self, {signature[1:]}:
    """{meaning}"""
    return {f'tuple({call})' if '-> tuple' in signature else call}
'''


def accessors(name: str, kind: str, meaning: str, argument: str = '') -> str:
    """The text of the two methods of a parameter, such as setSigma(sigma) and getSigma().

    :param kind: the type of the value; for an enum, integers are taken as well.
    :param argument: of the first method, if it is not the parameter's name.
    """
    upper, taken = name[0].upper() + name[1:], kind if kind in ('bool', 'float') else 'int'
    return f'''
def set{upper}(self, {argument or name}: {taken}) -> None:
    """{meaning}"""
    self._core.{name} = {argument or name}

def get{upper}(self) -> {kind}:
    """{meaning}"""
    return {kind}(self._core.{name})
'''


class Method:
    """Stands in a class for a method of the extension's object, which checks what it is given."""

    def __init__(self, signature: str, meaning: str) -> None:
        self._text = functools.partial(method, signature=signature, meaning=meaning)

    def __set_name__(self, owner: type, name: str) -> None:
        methods: dict[str, Any] = {}
        delattr(owner, name)
        exec(self._text(name), {'os': os, **vars(sys.modules[owner.__module__])}, methods)
        for each in methods.values():
            each.__qualname__ = f'{owner.__qualname__}.{each.__name__}'
            setattr(owner, each.__name__, each)


class Parameter(Method):
    """Stands in a class for the two methods that set and get a value of the extension's object, which checks it."""

    def __init__(self, kind: type, meaning: str, argument: str = '') -> None:
        self._text = functools.partial(accessors, kind=kind.__name__, meaning=meaning, argument=argument)


def constants(kind: type[enum.IntEnum]) -> Iterator[tuple[str, str, Any]]:
    """Names of C++, such as BORDER_DROP, with names and values of the members of an enum."""
    for name, value in kind.__members__.items():
        yield f'{kind.__name__.upper()}{"S" * (name == "DEFAULT")}_{name}', name, value


class SnakeCase:
    """Every method of the classes below has a second name in snake_case, ``create`` does what the class does, and the members
    of ``enums`` are constants. python/stubs.py tells type checkers of this and of Method and Parameter."""

    @classmethod
    def _of(cls, core: Any) -> Any:
        """Around an object of the extension."""
        made: Any = cls.__new__(cls)
        made._core = core
        return made

    def __init_subclass__(cls, enums: tuple[Any, ...] = (), **keywords: Any) -> None:
        super().__init_subclass__(**keywords)
        for kind in enums:
            for name, _, value in constants(kind):
                setattr(cls, name, value)
        if 'create' not in vars(cls) and '__init__' in vars(cls):
            def create(owner: Any, *arguments: Any, **keywords: Any) -> Any:
                return owner(*arguments, **keywords)
            create.__doc__, create.__signature__ = cls.__init__.__doc__, inspect.signature(cls.__init__)  # type: ignore
            cls.create = classmethod(create)  # type: ignore
        for name, member in list(vars(cls).items()):
            if not name.startswith('_') and not name.isupper():
                setattr(cls, snake_case(name), member)
