"""Copies and pickles of objects of the extension."""
from __future__ import annotations

import copy
from contextlib import suppress
from typing import Any, TypeVar

from opencv_iib import _core

T = TypeVar('T')


def around(cls: type[T], core: Any) -> T:
    """A new object of a class of this package, of what an object of the extension holds."""
    made = cls.__new__(cls)
    type(core).__setstate__(made, core)
    return made


class MissingDetector:
    """Stands for a detector that could not be pickled with the object that used it."""

    def __init__(self, name: str) -> None:
        self.name = name

    def getDefaultName(self) -> str:
        """The name of the one that is missing."""
        return self.name

    def detect(self, image: Any, mask: Any = None) -> Any:
        """Raises: there is none."""
        raise RuntimeError(f'the detector {self.name} was not pickled with the object that used it: set it again')


class _Kept:
    """A detector in the state of an object: one of cv2 cannot be copied, nor pickled, and describing needs none."""

    def __init__(self, detector: Any) -> None:
        self.detector = detector

    def __deepcopy__(self, memo: Any) -> _Kept:
        with suppress(TypeError):
            return _Kept(copy.deepcopy(self.detector, memo))
        return self

    def __reduce__(self) -> Any:
        known = self.detector is None or isinstance(self.detector, _core.Detector)
        return _Kept, (self.detector if known else MissingDetector(detector_name(self.detector)),)


def detector_name(detector: Any) -> str:
    """Its getDefaultName(), or its class's name."""
    name = getattr(detector, 'getDefaultName', None)
    return str(name()) if callable(name) else type(detector).__name__


def copied(cls: type[T]) -> type[T]:
    """Copies and pickles of a class have the parameters of the object inside, and the attributes that a subclass has added.

    Of `_parameters()`, `_restored()` makes an equal object of the extension.
    """
    def __getstate__(self: Any) -> dict[str, Any]:
        attributes = {name: _Kept(value) if name == '_detector' else value for name, value in vars(self).items()}
        return {**attributes, '_core': self._parameters()}

    def __setstate__(self: Any, state: dict[str, Any]) -> None:
        vars(self).update({name: value.detector if isinstance(value, _Kept) else value for name, value in state.items() if name != '_core'})
        core = self._restored(state['_core'])
        type(core).__setstate__(self, core)

    setattr(cls, '__getstate__', __getstate__)
    setattr(cls, '__setstate__', __setstate__)
    return cls
