"""pycolmap, or what says at its first use how to get it."""
from __future__ import annotations

import importlib
from typing import Any


class _Missing:
    def __getattr__(self, name: str) -> Any:
        raise ImportError('localization needs pycolmap: pip install opencv-iib[localization]')


try:
    pycolmap: Any = importlib.import_module('pycolmap')
except ImportError:
    pycolmap = _Missing()
