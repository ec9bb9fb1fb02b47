"""Checks arguments, so that errors name them and not types of C++, and imports optional modules."""
from __future__ import annotations

import importlib
import operator
import os
from typing import Any, Iterable, Union

#: A file or folder.
Path = Union[str, os.PathLike[str]]


class InvalidOption(ValueError):
    """An invalid value of an option: commands end with status 2."""


class MissingFile(InvalidOption, FileNotFoundError):
    """An option names a missing file or folder."""


class TakenFile(InvalidOption, FileExistsError):
    """An output is an input too, or another output."""


class UnusableName(InvalidOption, OSError):
    """An option names something that can never be read or written, such as a folder instead of a file."""


def integer(value: Any, name: str, bits: int = 32) -> int:
    """:raises TypeError: if it is no integer. :raises ValueError: if it needs more bits."""
    try:
        whole = operator.index(value)
    except TypeError:
        raise TypeError(f'{name}: an integer is needed, not {value!r}') from None
    if not -1 << (bits - 1) <= whole < 1 << (bits - 1):
        raise ValueError(f'{name} is {whole}: at most {(1 << (bits - 1)) - 1} can be had')
    return whole


def sequence(values: Iterable[Any], name: str, what: str) -> list[Any]:
    """:raises TypeError: for a non-sequence or a text."""
    if isinstance(values, (str, bytes, os.PathLike)) or not hasattr(values, '__iter__'):
        raise TypeError(f'{name}: a sequence of {what} is needed, not {values!r}')
    return list(values)


def integers(values: Iterable[Any], name: str, bits: int = 32) -> list[int]:
    return [integer(value, name, bits) for value in sequence(values, name, 'integers')]


def number(value: Any, name: str) -> float:
    """:raises TypeError: if it is no number."""
    if isinstance(value, (str, bytes)) or not hasattr(value, '__float__'):
        raise TypeError(f'{name}: a number is needed, not {value!r}')
    return float(value)


def numbers(values: Iterable[Any], name: str) -> list[float]:
    return [number(value, name) for value in sequence(values, name, 'numbers')]


MAX_COUNT = 1 << 30  # fits in the int of a detector


def check_choice(value: Any, name: str, known: Iterable[str]) -> None:
    if value not in known:
        raise InvalidOption(f'no {name} {value}: there are {", ".join(known)}')


def check_count(value: Any, name: str, most: int = MAX_COUNT) -> None:
    """:raises InvalidOption: for less than 1, or more than `most`."""
    if not 1 <= integer(value, name, 64) <= most:
        raise InvalidOption(f'{name} is {value}: it must be 1 to {most}')


def import_module(name: str, what: str) -> Any:
    """:param what: what the module is needed for, and what to install, for the ImportError."""
    try:
        return importlib.import_module(name)
    except ImportError as e:
        raise ImportError(f'{e}: {what}') from None
