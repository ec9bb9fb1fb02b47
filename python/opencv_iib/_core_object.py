"""What the classes of this package have in common: an object of the extension inside."""
from __future__ import annotations

import copy
from typing import Any, TypeVar

T = TypeVar('T', bound='CoreObject')


class CoreObject:
    """Copies and pickles have the parameters of the object inside, and the attributes that a subclass has added."""

    _core: Any

    @classmethod
    def _of(cls: type[T], core: Any) -> T:
        """Around an object of the extension."""
        made = cls.__new__(cls)
        made._core = core
        return made

    def _parameters(self) -> Any:
        """What `_restored` makes an equal object of the extension of."""
        raise NotImplementedError

    def _restored(self, parameters: Any) -> Any:
        raise NotImplementedError

    def __getstate__(self) -> dict[str, Any]:
        return {**vars(self), '_core': self._parameters()}

    def __setstate__(self, state: dict[str, Any]) -> None:
        vars(self).update(state)
        self._core = self._restored(state['_core'])

    def __copy__(self: T) -> T:
        return self._twin(vars(self))

    def __deepcopy__(self: T, memo: Any) -> T:
        return self._twin({name: _deep_copy(value, memo) for name, value in vars(self).items() if name != '_core'})

    def _twin(self: T, attributes: dict[str, Any]) -> T:
        twin = type(self).__new__(type(self))
        twin.__setstate__({**attributes, '_core': self._parameters()})
        return twin


def _deep_copy(value: Any, memo: Any) -> Any:
    try:
        return copy.deepcopy(value, memo)
    except TypeError:  # such as a detector of cv2
        return value
