"""Ctrl-C ends a command without a traceback while its modules are being imported, too: all but what Python and pip's script import
themselves, ``site`` and ``re``, before any module of a package."""
from __future__ import annotations

import os
import signal
import sys


def _is_command() -> bool:
    words = getattr(sys, 'orig_argv', [])  # from Python 3.10 on
    return (os.path.splitext(os.path.basename(getattr(sys, 'argv', None) and sys.argv[0] or ''))[0] == 'opencv-iib'
            or ('-m', 'opencv_iib') in zip(words, words[1:]))


_ends_at_once = _is_command() and signal.getsignal(signal.SIGINT) is signal.default_int_handler
if _ends_at_once:
    try:
        signal.signal(signal.SIGINT, signal.SIG_DFL)
    except ValueError:  # in another thread than the main one
        _ends_at_once = False


def end_of_start() -> None:
    """From here on, Ctrl-C raises KeyboardInterrupt."""
    global _ends_at_once
    if _ends_at_once:
        signal.signal(signal.SIGINT, signal.default_int_handler)
        _ends_at_once = False
