"""Images of one place in other light, laid onto a reference: pictures, a table and a page to compare them."""
from __future__ import annotations

import csv
import html
import itertools
import os
import re
from typing import NamedTuple, Optional, Sequence, TextIO
from urllib.parse import quote

import numpy as np
from numpy.typing import NDArray

from opencv_iib._files import is_same, new_results, rows_of
from opencv_iib._arguments import Path
from opencv_iib._turns import Turn, upright
from opencv_iib.colmap.images import import_cv2, read_with_orientation, write_picture
from opencv_iib.colmap.progress import Progress
from opencv_iib.enums import AlignmentModel
from opencv_iib.geometry import alignImages

CORNERS = ('top_left', 'top_right', 'bottom_right', 'bottom_left')
HEADER = ['image', 'verdict', 'matches', *(f'error_{corner}' for corner in CORNERS),
          *(f't{row}{column}' for row in '123' for column in '123'), 'file']
PAGE = '''<!DOCTYPE html>
<html lang="en"><meta charset="utf-8"><meta name="viewport" content="width=device-width"><title>Aligned with {reference}</title>
<style>body {{ font: 16px sans-serif; margin: 2em auto; max-width: {width}px; padding: 0 1em; background: #1c1a20; color: #ebebeb }}
h1, p, figcaption {{ overflow-wrap: anywhere }} figure {{ position: relative; margin: 0 0 2em }} img {{ display: block; width: 100%; height: auto }}
div {{ position: relative }} div img + img {{ position: absolute; top: 0; clip-path: inset(0 0 0 50%) }}
input {{ width: 100%; margin: .5em 0 }}</style>
<h1>Aligned with {reference}</h1>
{figures}
<script>for (const slider of document.querySelectorAll('input')) slider.oninput = () => slider.parentNode.querySelector(
'img + img').style.clipPath = `inset(0 0 0 ${{slider.value}}%)`</script></html>
'''
FIGURE = '''<figure><div><img src="reference.png" alt="the reference" loading="lazy" width="{width}" height="{height}"><img src="{file}"
alt="{name}, aligned" loading="lazy" width="{width}" height="{height}"></div>
<input type="range" value="50" aria-label="border between the reference, left, and {name}">
<figcaption>{name}: {verdict}</figcaption></figure>'''
LARGEST_SIDE = 32766  #: pixels that cv2.warpPerspective takes
LONGEST_STEM = 200  #: bytes of a file's name, with room for a number and the suffix


class Aligned(NamedTuple):
    """What became of an image."""

    name: str  #: path, as it was given
    verdict: str  #: 'aligned', or why it cannot be read or laid onto the reference
    matches: int = 0  #: that agree with the transform
    errors: Sequence[float] = ()  #: standard deviations of the places of its corners in pixels, in the order of CORNERS
    transform: Sequence[float] = ()  #: 3 x 3, row by row: from its pixels to those of the reference
    file: str = ''  #: as the reference's camera would see it

    def __str__(self) -> str:
        if not self.file:
            return self.verdict
        return f'{self.matches} matches agree, its corners are known to {max(self.errors):.2f} pixels'


def align(reference: Path, images: Sequence[Path], out: Path, model: int = AlignmentModel.HOMOGRAPHY, exif: bool = True) -> list[Aligned]:
    """Aligns images with a reference, and writes them as its camera would see them: NAME.png, ``transforms.csv`` and
    ``index.html``, in which a slider moves the border between the reference and each.

    An interruption keeps what is done until then.

    :param images: of a plane, or of anything by a camera that stays where it is. The reference among them is left out.
    :param out: folder to write; results of an earlier call are replaced.
    :param exif: images are compared as upright as their EXIF data say; pixels, transforms and what is written are those of the files.
    :return: of each image but the reference.
    :raises ValueError: for a reference that is no image or too large, or no image beside it.
    :raises FileExistsError: for a folder with other files, or with an image to be aligned.
    """
    reference, out = os.fspath(reference), os.fspath(out)
    first, done = _read(reference, exif), []
    paths = [os.fspath(path) for path in images if not is_same(path, reference)]
    if not paths:
        raise ValueError(f'no image to align but the reference, {reference}')
    for path in (reference, *paths):
        if os.path.realpath(path).startswith(os.path.join(os.path.realpath(out), '')):
            raise FileExistsError(f'{path} is in {out}, whose files would be replaced: choose another folder')
    stopped: Optional[BaseException] = None
    with new_results(out, 'transforms.csv', _earlier) as folder:
        write_picture(os.path.join(folder, 'reference.png'), first[0])
        progress = Progress('aligning', len(paths))
        taken = {'reference.png'}
        try:
            for path in paths:
                done.append(_aligned(first, path, folder, taken, model, exif))
                progress.step()
        except (Exception, KeyboardInterrupt) as e:
            if not done:
                raise
            stopped = e
        progress.close()
        with _file(os.path.join(folder, 'transforms.csv')) as table:
            csv.writer(table).writerows([HEADER, *map(_row, done)])
        with _file(os.path.join(folder, 'index.html')) as page:
            page.write(_page(os.path.basename(reference), done, *first[0].shape[1::-1]))
    if stopped is not None:
        raise stopped
    return done


def _page(reference: str, done: Sequence[Aligned], width: int, height: int) -> str:
    """In the order of people: 2 before 10."""
    ordered = sorted(done, key=lambda each: [(int(part), '') if n % 2 else (-1, part) for n, part in enumerate(re.split('([0-9]+)', each.name))])
    figures = (FIGURE.format(file=quote(each.file), name=html.escape(each.name), verdict=each, width=width, height=height)
               if each.file else f'<p>{html.escape(each.name)}: {html.escape(each.verdict)}</p>' for each in ordered)
    return PAGE.format(reference=html.escape(reference), width=width, figures='\n'.join(figures))


def _earlier(folder: str) -> Optional[list[str]]:
    """Files that an earlier call has written, by its table."""
    rows = rows_of(os.path.join(folder, 'transforms.csv'), HEADER)
    return None if rows is None else ['reference.png', 'index.html', *(row['file'] or '' for row in rows)]


def _file(path: str) -> TextIO:
    return open(path, 'w', encoding='utf-8', errors='backslashreplace', newline='')


def _read(path: str, exif: bool) -> tuple[NDArray[np.uint8], int]:
    """The image, and how its file stores it.

    :raises ValueError: also for an image that cv2 cannot lay onto another, or others onto it."""
    image, orientation = read_with_orientation(path, exif)
    if max(image.shape[:2]) > LARGEST_SIDE:
        raise ValueError(f'{path}: {image.shape[1]} x {image.shape[0]} pixels, and cv2 lays sides of up to {LARGEST_SIDE} onto others: reduce it')
    return image, orientation


def _file_name(path: str, taken: set[str]) -> str:
    """Of the aligned image, which all systems and pages can name."""
    stem = ''.join('_' if '\ud800' <= letter <= '\udfff' else letter for letter in os.path.splitext(os.path.basename(path))[0])
    stem = stem.encode()[:LONGEST_STEM].decode(errors='ignore')
    names = (f'{stem}_{count}.png' if count > 1 else f'{stem}.png' for count in itertools.count(1))
    return next(name for name in names if name.lower() not in taken)  # some systems know no difference


def _aligned(first: tuple[NDArray[np.uint8], int], path: str, folder: str, taken: set[str], model: int, exif: bool) -> Aligned:
    cv2, reference = import_cv2(), first[0]
    try:
        image, orientation = _read(path, exif)
    except (ValueError, OSError) as e:
        return Aligned(path, getattr(e, 'strerror', None) or str(e))
    found = alignImages(upright(*first), upright(image, orientation), model)
    if not found.found:
        return Aligned(path, found.reason, len(found.matches))
    file = _file_name(path, taken)
    taken.add(file.lower())
    onto, turn = Turn(first[1], *reference.shape[1::-1]), Turn(orientation, *image.shape[1::-1])
    transform = onto.matrix @ found.transform @ np.linalg.inv(turn.matrix)
    transform /= transform[2, 2]
    write_picture(os.path.join(folder, file), cv2.warpPerspective(image, transform, reference.shape[1::-1]))
    return Aligned(path, 'aligned', len(found.matches), turn.corners(found.error.ravel()).tolist(), transform.ravel().tolist(), file)


def _row(each: Aligned) -> list[str]:
    numbers = [f'{value:.3f}' for value in each.errors] + [f'{value:.9g}' for value in each.transform]
    return [each.name, each.verdict, str(each.matches), *(numbers or [''] * 13), each.file]
