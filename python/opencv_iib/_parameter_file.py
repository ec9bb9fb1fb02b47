"""Files of parameters in YAML, XML or JSON, as text: OpenCV opens no name beyond Windows' code page or with a '?', and follows any
depth until the stack ends."""
from __future__ import annotations

import gzip
import io
import os
import re
import zlib

import numpy as np

from opencv_iib import _core
from opencv_iib._arguments import Path

MAX_BYTES, MAX_DEPTH = 1 << 24, 100
_GZIP = b'\x1f\x8b'
_OPEN, _CLOSE = (np.array([chr(byte) in letters for byte in range(256)], np.int8) for letters in ('[{<', ']}'))


def text_of(file: Path) -> str:
    """What is in a file, which may be packed by gzip.

    :raises opencv_iib.error: for one that cannot be read, is larger than any of parameters or nests more deeply.
    """
    name = os.fsdecode(file)
    try:
        with open(name, 'rb') as opened:
            text = opened.read(MAX_BYTES + 1)
        if text.startswith(_GZIP):
            text = gzip.GzipFile(fileobj=io.BytesIO(text)).read(MAX_BYTES + 1)
    except (OSError, EOFError, zlib.error) as e:
        raise _core.error(f'{name} cannot be read: {getattr(e, "strerror", None) or e}') from None
    if len(text) > MAX_BYTES:
        raise _core.error(f'{name} is larger than a file of parameters: at most {MAX_BYTES >> 20} MB are read')
    letters = np.frombuffer(re.sub(rb'</|/>', b']', re.sub(rb'<[?!]', b'', text)), np.uint8)
    depth = np.cumsum(_OPEN[letters] - _CLOSE[letters], dtype=np.int32)
    if (depth - np.minimum.accumulate(depth)).max(initial=0) > MAX_DEPTH or b'- ' * MAX_DEPTH in text:  # YAML's, within a line
        raise _core.error(f'{name} nests {MAX_DEPTH} levels deep: it is no file of parameters')
    return text.decode('utf-8-sig', 'replace')
