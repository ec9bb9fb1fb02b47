#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0

"""Writes doc/api_python.md, the public names of the installed Python package and its commands. What changed or went is told in
CHANGELOG.md, as cpp_api.py has it of C++. Not compared are types, which vary with the versions of Python and numpy.
"""
import enum
import importlib
import inspect

import cpp_api
import opencv_iib
from opencv_iib.__main__ import _parser

PAGE = cpp_api.ROOT / 'doc/api_python.md'
MAY_CHANGE = {  # beside opencv_iib itself, of which what C++ has in iib_geometry may change
    'opencv_iib.localization': None, 'opencv_iib.colmap': None,  # None: __all__
    'opencv_iib.shards': ('search', 'write'), 'opencv_iib.align': ('align',), 'opencv_iib.features': ('to_colmap',),
    'opencv_iib.measure': ('match_images',),
}


class Shown:
    """A default value as one would write it, in every version of Python."""

    def __init__(self, value):
        self.value = value

    def __repr__(self):
        value = self.value
        if isinstance(value, enum.Enum):
            return '%d' % value if isinstance(value, enum.Flag) else '%s.%s' % (type(value).__name__, value.name)
        if hasattr(value, 'tolist'):
            return repr(value.tolist())
        if callable(value):
            return value.__name__
        return type(value).__name__ + '()' if hasattr(value, '__dataclass_fields__') else repr(value)


def arguments(function):
    return str(inspect.Signature([
        each.replace(annotation=each.empty, default=each.empty if each.default is each.empty else Shown(each.default))
        for each in inspect.signature(function).parameters.values()]))


def declarations(name, value):
    """(depth, line) of a function, a class with its methods, or an enum, which may grow as those of C++."""
    if isinstance(value, enum.EnumMeta):
        yield 0, 'enum %s { %s };' % (name, ', '.join('%s = %d' % each for each in value.__members__.items()))
    elif not isinstance(value, type):
        yield 0, name + (arguments(value) if callable(value) else '')
    elif value.__name__ != name:
        yield 0, '%s = %s' % (name, value.__name__)
    else:
        known = [base for base in value.__mro__[1:] if base is not object and not base.__name__.startswith('_') and base.__name__ != name]
        yield 0, 'class %s%s' % (name, ' : ' + known[0].__name__ if known else '')
        if not issubclass(value, BaseException):
            yield 1, name + arguments(value)
        for member in dir(value):
            found = inspect.getattr_static(value, member)
            owner = next(base for base in value.__mro__ if member in vars(base))
            if member.startswith('_') or not owner.__module__.startswith('opencv_iib'):
                continue
            if isinstance(found, property) or not callable(getattr(value, member)):
                yield 1, member
            elif callable(getattr(value, member)) and type(found).__name__ not in ('nb_method', 'nb_func'):  # those are undocumented
                yield 1, member + arguments(getattr(value, member))


def option(action):
    """As in --points N = 4000."""
    name, default = ', '.join(action.option_strings) or action.dest, repr(Shown(action.default))
    if not action.option_strings or action.nargs == 0:
        return name
    told = ' (required)' if action.required else ' = ' + default if default not in ('None', '[]') else ''
    return '%s %s%s' % (name, action.metavar or action.dest.upper(), told)


def page():
    lines = ['# Public names of the Python package, and what is promised of them', '',
             'Made from the package by `scripts/helpers/python_names.py`; a test fails where they differ. Those of C++: [api](api.md).']

    def of(module, names):
        return [each for name in sorted(names) for each in declarations(name, getattr(module, name))]
    new = {name for name in opencv_iib.__all__ if getattr(getattr(opencv_iib, name), '__module__', '') == 'opencv_iib.geometry'}
    new.add('AlignmentModel')
    lines += cpp_api.section('opencv_iib', cpp_api.STABLE, 'python', of(opencv_iib, set(opencv_iib.__all__) - new))
    lines += cpp_api.section('opencv_iib: poses and alignment', cpp_api.MAY_CHANGE, 'python', of(opencv_iib, new))
    for name, names in MAY_CHANGE.items():
        module = importlib.import_module(name)
        lines += cpp_api.section(name, cpp_api.MAY_CHANGE, 'python', of(module, names or module.__all__))
    commands = [each for name, command in _parser().commands.items() for each in
                ((0, 'command %s : %s' % (name, ' '.join(option(action) for action in command._actions if not action.option_strings))),
                 *((1, option(action)) for action in command._actions if action.option_strings and action.dest != 'help'))]
    lines += cpp_api.section('opencv-iib', cpp_api.MAY_CHANGE, 'text', commands)
    return '\n'.join(line.rstrip() for line in lines) + '\n'


if __name__ == '__main__':
    cpp_api.main(__doc__, PAGE, page())
