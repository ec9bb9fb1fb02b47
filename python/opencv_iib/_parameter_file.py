"""Files of parameters in YAML, XML or JSON, before OpenCV reads them: it follows any depth until the stack ends."""
from __future__ import annotations

import gzip
import re

import numpy as np

from opencv_iib import _core
from opencv_iib._arguments import Path

MAX_BYTES, MAX_DEPTH = 1 << 24, 100
_GZIP = b'\x1f\x8b'
_OPEN, _CLOSE = (np.array([chr(byte) in letters for byte in range(256)], np.int8) for letters in ('[{<', ']}'))


def check_nesting(file: Path) -> None:
    """:raises opencv_iib.error: for a file that nests more deeply than any of parameters, or is larger. :raises OSError: for one that
    cannot be read."""
    with open(file, 'rb') as opened:
        packed = opened.read(2) == _GZIP
    with gzip.open(file) if packed else open(file, 'rb') as opened:
        text = opened.read(MAX_BYTES + 1)
    if len(text) > MAX_BYTES:
        raise _core.error(f'{file!s} is larger than a file of parameters: at most {MAX_BYTES >> 20} MB are read')
    letters = np.frombuffer(re.sub(rb'</|/>', b']', re.sub(rb'<[?!]', b'', text)), np.uint8)
    depth = np.cumsum(_OPEN[letters] - _CLOSE[letters], dtype=np.int32)
    if (depth - np.minimum.accumulate(depth)).max(initial=0) > MAX_DEPTH or b'- ' * MAX_DEPTH in text:  # YAML's, within a line
        raise _core.error(f'{file!s} nests {MAX_DEPTH} levels deep: it is no file of parameters')
