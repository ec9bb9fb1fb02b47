"""Copies and pickles of objects of the extension."""
from __future__ import annotations

import copy
from typing import Any, TypeVar

T = TypeVar('T')


def around(cls: type[T], core: Any) -> T:
    """A new object of a class of this package, of what an object of the extension holds."""
    made = cls.__new__(cls)
    type(core).__setstate__(made, core)
    return made


def state_of(self: Any) -> dict[str, Any]:
    """What a pickle holds of an object: its attributes, and its parameters by the name of old, which pickles keep."""
    return {**vars(self), '_core': self._parameters()}


def copied(cls: type[T]) -> type[T]:
    """Copies and pickles of a class have the parameters of the object inside, and the attributes that a subclass has added.

    Of `_parameters()`, `_restored()` makes an equal object of the extension.
    """

    def __setstate__(self: Any, state: dict[str, Any]) -> None:
        vars(self).update({name: value for name, value in state.items() if name != '_core'})
        core = self._restored(state['_core'])
        type(core).__setstate__(self, core)

    def twin(self: Any, attributes: dict[str, Any]) -> Any:
        kind: Any = type(self)
        made = kind.__new__(kind)
        made.__setstate__({**attributes, '_core': self._parameters()})
        return made

    def __copy__(self: Any) -> Any:
        return twin(self, vars(self))

    def __deepcopy__(self: Any, memo: Any) -> Any:
        return twin(self, {name: _deep_copy(value, memo) for name, value in vars(self).items()})

    for name, method in (('__getstate__', state_of), *((method.__name__, method) for method in (__setstate__, __copy__, __deepcopy__))):
        if name not in vars(cls):
            setattr(cls, name, method)
    return cls


def _deep_copy(value: Any, memo: Any) -> Any:
    try:
        return copy.deepcopy(value, memo)
    except TypeError:  # such as a detector of cv2
        return value
