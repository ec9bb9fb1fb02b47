"""Images of one place in other light, laid onto a reference: pictures, a table and a page to compare them."""
from __future__ import annotations

import csv
import html
import os
from typing import NamedTuple, Sequence, TextIO
from urllib.parse import quote

import numpy as np
from numpy.typing import NDArray

from opencv_iib.colmap.images import import_cv2, read_colour, write_picture
from opencv_iib.colmap.progress import Progress
from opencv_iib.enums import AlignmentModel
from opencv_iib.geometry import alignImages

CORNERS = ('top_left', 'top_right', 'bottom_right', 'bottom_left')
HEADER = ['image', 'verdict', 'matches', *(f'error_{corner}' for corner in CORNERS),
          *(f't{row}{column}' for row in '123' for column in '123'), 'file']
PAGE = '''<!DOCTYPE html>
<html lang="en"><meta charset="utf-8"><title>Aligned with {reference}</title>
<style>body {{ font: 16px sans-serif; margin: 2em auto; max-width: {width}px; background: #1c1a20; color: #ebebeb }}
figure {{ position: relative; margin: 0 0 2em }} img {{ display: block; width: 100% }}
div {{ position: relative }} div img + img {{ position: absolute; top: 0; clip-path: inset(0 0 0 50%) }}
input {{ width: 100% }}</style>
<h1>Aligned with {reference}</h1>
{figures}
<script>for (const slider of document.querySelectorAll('input')) slider.oninput = () => slider.parentNode.querySelector(
'img + img').style.clipPath = `inset(0 0 0 ${{slider.value}}%)`</script></html>
'''
FIGURE = '''<figure><div><img src="reference.png" alt="the reference"><img src="{file}" alt="{name}, aligned"></div>
<input type="range" value="50" aria-label="border between the reference, left, and {name}">
<figcaption>{name}: {verdict}</figcaption></figure>'''


class Aligned(NamedTuple):
    """What became of an image."""

    name: str
    verdict: str  #: 'aligned', 'nothing in common', or why it cannot be read
    matches: int = 0  #: that agree with the transform
    errors: Sequence[float] = ()  #: standard deviations of the places of its corners in pixels, in the order of CORNERS
    transform: Sequence[float] = ()  #: 3 x 3, row by row: from its pixels to those of the reference
    file: str = ''  #: as the reference's camera would see it

    def __str__(self) -> str:
        if not self.file:
            return self.verdict
        return f'{self.matches} matches agree, its corners are known to {max(self.errors):.2f} pixels'


def align(reference: str, images: Sequence[str], out: str, model: int = AlignmentModel.HOMOGRAPHY) -> list[Aligned]:
    """Aligns images with a reference, and writes them as its camera would see them: NAME.png, ``transforms.csv`` and
    ``index.html``, in which a slider moves the border between the reference and each.

    :param images: of a plane, or of anything by a camera that stays where it is.
    :param out: folder to write; results of an earlier call are replaced.
    :raises ValueError: for a reference that is no image.
    :raises FileExistsError: for a folder with other files.
    """
    from opencv_iib.localization.folders import new_folder
    first, done = read_colour(reference), []
    with new_folder(out, ['transforms.csv', 'index.html', '*.png']) as folder:
        write_picture(os.path.join(folder, 'reference.png'), first)
        progress = Progress('aligning', len(images))
        taken = {'reference.png'}
        for path in images:
            done.append(_aligned(first, path, folder, taken, model))
            progress.step()
        progress.close()
        with _file(os.path.join(folder, 'transforms.csv')) as table:
            csv.writer(table).writerows([HEADER, *map(_row, done)])
        figures = '\n'.join(FIGURE.format(file=quote(os.fsencode(each.file)), name=html.escape(each.name), verdict=each)
                            if each.file else f'<p>{html.escape(each.name)}: {html.escape(each.verdict)}</p>' for each in done)
        with _file(os.path.join(folder, 'index.html')) as page:
            page.write(PAGE.format(reference=html.escape(os.path.basename(reference)), width=first.shape[1], figures=figures))
    return done


def _file(path: str) -> TextIO:
    return open(path, 'w', encoding='utf-8', errors='backslashreplace', newline='')


def _aligned(reference: NDArray[np.uint8], path: str, folder: str, taken: set[str], model: int) -> Aligned:
    cv2, name = import_cv2(), os.path.basename(path)
    try:
        image = read_colour(path)
    except ValueError as e:
        return Aligned(name, str(e))
    found = alignImages(reference, image, model)
    if found.transform is None or found.error is None:
        return Aligned(name, 'nothing in common', len(found.matches))
    stem, count = os.path.splitext(name)[0], 1
    file = stem + '.png'
    while file in taken:
        count += 1
        file = f'{stem}_{count}.png'
    taken.add(file)
    write_picture(os.path.join(folder, file), cv2.warpPerspective(image, found.transform, reference.shape[1::-1]))
    return Aligned(name, 'aligned', len(found.matches), found.error.ravel().tolist(), found.transform.ravel().tolist(), file)


def _row(each: Aligned) -> list[str]:
    numbers = [f'{value:.3f}' for value in each.errors] + [f'{value:.9g}' for value in each.transform]
    return [each.name, each.verdict, str(each.matches), *(numbers or [''] * 13), each.file]
