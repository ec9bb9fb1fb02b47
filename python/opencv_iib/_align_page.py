"""The page of the command align, on which a slider moves the border between the reference and each image."""
from __future__ import annotations

import html
from typing import Container, Sequence
from urllib.parse import quote

PREVIEWS = 'views'  #: folder of JPEG copies of pictures that browsers do not show
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
FIGURE = '''<figure><div><img src="{reference}" alt="the reference" loading="lazy" width="{width}" height="{height}"><img src="{file}"
alt="{name}, aligned" loading="lazy" width="{width}" height="{height}"></div>
<input type="range" value="50" aria-label="border between the reference, left, and {name}">
<figcaption>{name}: {verdict}</figcaption></figure>'''


def html_page(title: str, reference: str, images: Sequence[tuple[str, str, str]], width: int, height: int, files: Container[str]) -> str:
    """:param reference: name of its picture.
    :param images: name, verdict, and name of the picture, which is '' for an image that is not aligned.
    :param width: of all pictures, pixels; so is `height`.
    :param files: names of all files of the folder."""
    def shown(file: str) -> str:
        preview = f'{PREVIEWS}/{file}.jpg'
        return quote(preview if preview in files else file)
    figures = (FIGURE.format(reference=shown(reference), file=shown(file), name=html.escape(name), verdict=html.escape(verdict), width=width, height=height)
               if file else f'<p>{html.escape(name)}: {html.escape(verdict)}</p>' for name, verdict, file in images)
    return PAGE.format(reference=html.escape(title), width=width, figures='\n'.join(figures))
