"""Copies and pickles of objects of the extension, and of the detectors in them."""
from __future__ import annotations

import copy
from contextlib import suppress
from typing import Any, TypeVar

from opencv_iib import _core

T = TypeVar('T')


def around(cls: type[T], core: Any) -> T:
    """An object of a class of this package that shares the content of an object of the extension."""
    made = cls.__new__(cls)
    type(core).__setstate__(made, core)
    return made


class MissingDetector:
    """Replaces a detector that could not be pickled with the object that used it."""

    def __init__(self, name: str) -> None:
        self.name = name

    def getDefaultName(self) -> str:
        return self.name

    def detect(self, image: Any, mask: Any = None) -> Any:
        raise RuntimeError(f'the detector {self.name} was not pickled with the object that used it: set it again')


class _Detector:
    """A detector in an object's state. Those of cv2 can neither be copied nor pickled: copies share them, pickles lose them."""

    def __init__(self, detector: Any) -> None:
        self.detector = detector

    def __deepcopy__(self, memo: Any) -> _Detector:
        with suppress(TypeError):
            return _Detector(copy.deepcopy(self.detector, memo))
        return self

    def __reduce__(self) -> Any:
        known = self.detector is None or isinstance(self.detector, _core.Detector)
        return _Detector, (self.detector if known else MissingDetector(detector_name(self.detector)),)


def detector_name(detector: Any) -> str:
    """A detector's getDefaultName(), or the name of its class."""
    name = getattr(detector, 'getDefaultName', None)
    return str(name()) if callable(name) else type(detector).__name__


def copied(cls: type[T]) -> type[T]:
    """Gives a class copies and pickles, which have its `_parameters()` and the attributes that a subclass has added.

    Its `_restored(parameters)` makes an equal object of the extension."""
    def __getstate__(self: Any) -> dict[str, Any]:
        attributes = {name: _Detector(value) if name == '_detector' else value for name, value in vars(self).items()}
        return {**attributes, '_core': self._parameters()}

    def __setstate__(self: Any, state: dict[str, Any]) -> None:
        vars(self).update({name: value.detector if isinstance(value, _Detector) else value for name, value in state.items() if name != '_core'})
        core = self._restored(state['_core'])
        type(core).__setstate__(self, core)

    setattr(cls, '__getstate__', __getstate__)
    setattr(cls, '__setstate__', __setstate__)
    return cls
