"""Finds image files, and says which programs can hold their names."""
from __future__ import annotations

import collections
import contextlib
import os
import re
from typing import Callable, NoReturn

from opencv_iib._arguments import Path
from opencv_iib._images import import_cv2
from opencv_iib._streams import note

SUFFIXES = ('.jpg', '.jpeg', '.jpe', '.jfif', '.png', '.tif', '.tiff', '.bmp', '.webp', '.ppm', '.pgm', '.pbm', '.pnm')
SOMETIMES = ('.avif', '.gif', '.heic', '.heif', '.jp2')  #: suffixes that some builds of cv2 read


def find_images(folder: Path, log: Callable[[str], None] = note) -> list[str]:
    """Paths of images below `folder`, relative to it, with '/', in_order: COLMAP's names.
    :param log: gets a line about images that the installed cv2 does not read.
    :raises OSError: for a folder that cannot be read."""
    def fail(why: OSError) -> NoReturn:
        raise type(why)(f'{why.filename} cannot be read: {why.strerror}')

    names, skipped = [], collections.Counter[str]()
    for root, _, files in os.walk(folder, onerror=fail):
        for file in files:
            path, suffix = os.path.join(root, file), os.path.splitext(file)[1].lower()
            if suffix in SUFFIXES or (suffix in SOMETIMES and _is_read(path)):
                names.append(os.path.relpath(path, folder).replace(os.sep, '/'))
            elif suffix in SOMETIMES:
                skipped[suffix] += 1
    if skipped:
        kinds = ', '.join(f'{count} {suffix}' for suffix, count in sorted(skipped.items()))
        log(f'{os.fspath(folder)}: {sum(skipped.values())} files are skipped, which the installed cv2 does not read ({kinds}): convert them')
    return sorted(names, key=in_order)


def _is_read(path: str) -> bool:
    """Whether cv2 knows the format of a file by how it begins."""
    with contextlib.suppress(UnicodeError):  # of a name that is not UTF-8
        return os.path.isfile(path) and bool(import_cv2().haveImageReader(path))
    return False


def in_order(name: str) -> tuple[list[tuple[int, str]], str]:
    """A key that sorts names as people do: 2 before 10, and b before C."""
    return [(int(part), '') if n % 2 else (-1, part) for n, part in enumerate(re.split('([0-9]+)', name.lower()))], name


def is_utf8(name: str) -> bool:
    """Whether Python could decode a file's name."""
    return not any('\ud800' <= letter <= '\udfff' for letter in name)


def is_listable(name: str) -> bool:
    """Whether COLMAP's and hloc's lists can hold a name: two a line, with a blank between them."""
    return not name.startswith('#') and not any(letter.isspace() for letter in name)
