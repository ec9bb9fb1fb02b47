"""The names of Python's style beside those of OpenCV."""
from __future__ import annotations

import re
from typing import Any


def snake_case(name: str) -> str:
    """``detectAndCompute`` is ``detect_and_compute``."""
    return re.sub('(?<=[a-z0-9])(?=[A-Z])', '_', name).lower()


class SnakeCase:
    """Gives every method of the classes below it a second name in snake_case; python/stubs.py tells type checkers."""

    def __init_subclass__(cls, **keywords: Any) -> None:
        super().__init_subclass__(**keywords)
        for name, member in list(vars(cls).items()):
            if not name.startswith('_') and not name.isupper():
                setattr(cls, snake_case(name), member)
