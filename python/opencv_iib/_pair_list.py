"""Lists of pairs of images, as COLMAP and hloc write them, and the order in which their pairs are matched."""
from __future__ import annotations

import itertools
import os
import posixpath
import re
from typing import Callable, Container, Iterable, Iterator, Mapping, Optional

from opencv_iib._arguments import InvalidOption, MissingFile, Path
from opencv_iib._image_names import is_utf8

Pair = tuple[int, int]
BLOCK = 50  # images a block: the codes of two blocks are in memory while their pairs are matched


def pair_name(a: str, b: str) -> str:
    return '/'.join(name.replace('/', '-') for name in (a, b))


def tiles(pairs: Iterable[Pair], side: int) -> Iterator[list[Pair]]:
    """The pairs in lists, each of `side` images with as many others; a side of 1 keeps their order."""
    def tile(pair: Pair) -> Pair:
        return pair[0] // side, pair[1] // side

    pairs = iter(pairs)
    while block := list(itertools.islice(pairs, BLOCK * BLOCK if side > 1 else 1)):
        for _, found in itertools.groupby(sorted(block, key=tile), tile):
            yield list(found)


def read_list(path: Path, numbers: Mapping[str, Optional[int]]) -> tuple[list[Pair], list[str]]:
    """Pairs of a text file with two names a line, as COLMAP and hloc write them, and messages about invalid lines; '#' begins a comment.

    Names may be quoted, begin with ./ and have \\ for /. A comma may separate them, and a score follow.
    :param numbers: of the images by name; None for those that could not be described, whose pairs are left out.
    :raises ValueError: for a file that is not UTF-8.
    :raises MissingFile: for a missing file."""
    if not os.path.exists(path):
        raise MissingFile(f'there is no list of pairs {os.fspath(path)}')
    pairs, wrong = [], []
    with open(path, encoding='utf-8-sig', errors='surrogateescape') as file:
        for number, line in enumerate(map(str.strip, file), 1):
            place = f'{os.fspath(path)}:{number}'
            if not is_utf8(line):
                raise ValueError(f'{place}: not UTF-8')
            names = _names(line, numbers)
            unknown = [name for name in names if name not in numbers]
            if names and not unknown and names[0] != names[1]:
                a, b = (numbers[name] for name in names)
                if a is not None and b is not None:
                    pairs.append((a, b))
            elif line and not line.startswith('#'):
                wrong.append(f'{place}: ' + ('not the names of two images' if not names else f'{names[0]} is paired with itself' if not unknown
                                             else f'no image is called {" or ".join(unknown)}'))
    return pairs, wrong


def check_list(path: Path, numbers: Mapping[str, Optional[int]], log: Callable[[str], None]) -> tuple[list[Pair], int]:
    """As read_list, with the number of invalid lines, which are logged. :raises InvalidOption: for a list without pairs."""
    pairs, wrong = read_list(path, numbers)
    if not pairs:
        raise InvalidOption(wrong[0] if wrong else f'{os.fspath(path)} has no pair of images')
    for text in wrong:
        log(text)
    return pairs, len(wrong)


SEPARATOR = r'\s*[,;]\s*|\s+'


def _names(line: str, known: Container[str]) -> list[str]:
    """The two names of a line, known ones if possible; an empty list if it has not two words."""
    def name(text: str) -> str:
        return text if text in known else posixpath.normpath(text.strip('"\'').replace('\\', '/'))

    alone = re.sub(r'([\s,;]+[-+]?[\d.]+(e[-+]?\d+)?)+$', '', line)  # without a score
    for text in (line, alone):
        for cut in re.finditer(SEPARATOR, text):  # names may have blanks
            found = [name(text[:cut.start()]), name(text[cut.end():])]
            if found[0] in known and found[1] in known:
                return found
    words = re.split(SEPARATOR, alone)
    return [name(word) for word in words] if len(words) == 2 else []
