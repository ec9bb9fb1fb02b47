"""Aligns images of one place under changed illumination with a reference: pictures, a table and a page to compare them."""
from __future__ import annotations

import glob
import itertools
import json
import os
from typing import Any, Callable, Iterable, NamedTuple, Optional, Sequence

import numpy as np
from numpy.typing import NDArray

from opencv_iib import __version__
from opencv_iib._align_page import PREVIEWS, html_page
from opencv_iib._arguments import InvalidOption, MissingFile, Path, check_choice, sequence
from opencv_iib._files import Results, check_folder, check_images, csv_bytes, is_in, is_same, write_whole
from opencv_iib._image_file import ImageFile, Masks
from opencv_iib._image_names import find_images, in_order
from opencv_iib._images import FORMATS, can_be, holds, import_cv2, in_8_bits, reduced, write_picture
from opencv_iib._parallel import Threads, in_parallel, thread_count
from opencv_iib._progress import Progress
from opencv_iib._streams import note
from opencv_iib._tiff import geo_of_part
from opencv_iib._orientation import Turn, upright
from opencv_iib.enums import AlignmentModel
from opencv_iib.features import check_max_size
from opencv_iib.geometry import ImageAligner
from opencv_iib.views import rotation_and_scale

CORNERS = ('top_left', 'top_right', 'bottom_right', 'bottom_left')
HEADER = ['image', 'verdict', 'matches', *(f'error_{corner}' for corner in CORNERS),
          *(f't{row}{column}' for row in '123' for column in '123'), 'file', 'model']
INTERPOLATIONS = ('NEAREST', 'LINEAR', 'CUBIC', 'LANCZOS4')  #: of cv2, by their names there
STATE = 'align.json'  #: results and settings, which a later call reuses
WARPED = tuple(map(np.dtype, ('u1', 'u2', 'i2', 'f4', 'f8')))  #: types that cv2.warpPerspective takes
LARGEST_SIDE = 32766  #: pixels that cv2.warpPerspective takes
LONGEST_STEM = 200  #: bytes of a file's name, with room for a number and the suffix


class Aligned(NamedTuple):
    """The result for an image."""

    name: str  #: path, as it was given
    verdict: str  #: 'aligned', 'aligned through NAME', or why it cannot be read or aligned
    matches: int = 0  #: number that agree with the transform
    errors: Sequence[float] = ()  #: standard deviations of its corners in the reference, pixels, in the order of CORNERS
    transform: Sequence[float] = ()  #: 3 x 3, row by row: from its pixels to pixels of the reference
    file: str = ''  #: name of the aligned picture
    size: Sequence[int] = ()  #: its width and height; empty if it cannot be read
    rotation: float = 0  #: degrees clockwise against the reference, without EXIF's orientation; 0: less than 8
    scale: float = 1  #: of its pixels by the reference's; 1: less than a fifth more or less
    model: str = ''  #: name of the AlignmentModel of the transform
    note: str = ''  #: advice about the transform, mostly ''

    def __str__(self) -> str:
        if not self.file:
            return self.verdict
        seen = f', scale {self.scale:.2f}, rotated by {round(self.rotation) % 360} degrees' if (self.rotation, self.scale) != (0, 1) else ''
        through = self.verdict[len('aligned'):]
        return (f'{self.matches} matches agree{through}, its corners are known to {max(self.errors):.2f} pixels ({self.model.lower()}){seen}'
                + (f'; {self.note}' if self.note else ''))


class _Options(NamedTuple):
    """Arguments of align."""

    model: int
    exif: bool
    mask: Optional[str]
    max_size: int
    format: Optional[str]
    crop: bool
    interpolation: str
    chain: bool

    def check(self) -> None:
        """:raises InvalidOption: for a value that is not known."""
        check_max_size(self.max_size)
        check_choice(self.format or 'PNG', 'format', FORMATS)
        check_choice(self.interpolation, 'interpolation', INTERPOLATIONS)


def align(reference: Path, images: Sequence[Path], out: Path, model: int = AlignmentModel.AUTO, exif: bool = True,
          mask: Optional[Path] = None, max_size: int = 0, format: Optional[str] = None, crop: bool = False, interpolation: str = 'LINEAR',
          workers: Optional[int] = None, chain: bool = False, log: Callable[[str], None] = note) -> list[Aligned]:
    """Aligns images with a reference. Writes each as the reference's camera would see it, with its own depth, channels and pages (NAME.png, .jpg
    or .tif); ``transforms.csv``; ``align.json``; and ``index.html``, where a slider moves the border between the reference and the image.

    Pixels and transforms are those of the files, not turned by EXIF. An interrupted call keeps its results. A later call with the same reference
    and options reuses results of files that have not changed.

    :param images: files, folders, and patterns such as ``*.jpg``, of a plane, or of any scene by a camera that does not move. The reference
        among them is skipped.
    :param out: folder to write; results of an earlier call are replaced.
    :param exif: compare the images as upright as their EXIF data say.
    :param mask: a picture, or a folder with a.jpg.png for an image a.jpg; pixels where it is 0 are not compared.
    :param max_size: images are reduced to this longer side, in pixels, before they are compared; 0: they are not.
    :param format: one of FORMATS; None: the format of each image's file, or PNG, or TIFF where only that holds all of it.
    :param crop: write the part that all aligned images show, instead of the part that the reference shows.
    :param interpolation: one of INTERPOLATIONS.
    :param workers: threads; None for one per core.
    :param chain: the images are a series, such as exposures or years. An image without a transform to the reference is aligned through the image
        before or after it, and the errors of both steps add up.
    :param log: gets a line for each file that cv2 does not read, and for pages that are left out since they differ from the first one.
    :return: results in the order of `images`; the table and the page sort 2 before 10 and b before C.
    :raises ValueError: for a reference that is no image or too large, for no other image, or with `crop` if no part is common to all.
    :raises FileExistsError: for a folder with other files, or with an image to be aligned.
    """
    reference, out = os.fspath(reference), os.fspath(out)
    options = _Options(model, exif, None if mask is None else os.path.abspath(mask), max_size, format, crop, interpolation, chain)
    options.check()
    threads, masks = Threads(thread_count(workers)), Masks(options.mask)
    check_images(reference)
    check_folder(out, (reference,))
    series = _expanded(images, out, log)
    paths = [path for path in series if not is_same(path, reference)]
    if len(paths) == len(series):
        series = [reference, *series]
    if not paths:
        raise InvalidOption(f'no image to align but the reference, {reference}')
    check_folder(out, (*paths, *masks.check([os.path.basename(path) for path in (reference, *paths)])))
    work = _Work(reference, options, masks, log)
    with Results(out, 'align') as results:
        work.place = results.place
        done, stopped = _align_into(results, work, series, paths, threads)
    if stopped is not None:
        raise stopped
    return done


def _align_into(results: Results, work: _Work, series: Sequence[str], paths: Sequence[str], threads: Threads
                ) -> tuple[list[Aligned], Optional[BaseException]]:
    """Aligns and writes images, and those before an error if their pictures can be written.
    :param series: as in _chain; `paths` are those without the reference."""
    settings, stamps = work.settings(), {path: work.stamp(path) for path in paths}
    done, old_part = _known(results.folder, settings, stamps)
    known, names = list(done), _file_names(paths, done)
    part, progress = None if work.options.crop else work.whole, Progress('aligning', len(paths), len(done))
    stopped: Optional[BaseException] = None

    def drop_old_state() -> None:  # so that a killed call leaves no state that lists pictures of another part
        if part not in (None, old_part):
            results.remove([STATE])

    def do(job: Callable[[str], Aligned], paths: list[str]) -> None:
        done.update(in_parallel(job, paths, threads))

    def align_one(path: str) -> Aligned:
        found = work.align(path, names[path], part)
        progress.step()
        return found
    drop_old_state()
    try:
        do(align_one, [path for path in paths if path not in done])
        if work.options.chain:
            _chain(work, series, done, do)
        part = part or _common(work.whole, done.values())
    except (Exception, KeyboardInterrupt) as e:
        if not done or part is None:
            raise
        stopped = e
    progress.close()
    drop_old_state()
    for name in [done[path].file for path in known if part == old_part]:
        for file in (name, f'{PREVIEWS}/{name}.jpg'):
            if name and os.path.exists(os.path.join(results.folder, file)):
                results.place(file)
    do(lambda path: work.write(done[path], names[path], part),
       [path for path, each in done.items() if each.transform and each.file not in results.written])
    ordered = [done[path] for path in paths if path in done]
    _write_tables(results, work.write_reference(part), os.path.basename(work.path), ordered, part)
    state = {'settings': settings, 'part': part, 'images': [[stamps[each.name], each] for each in ordered if each.size]}
    write_whole(results.place(STATE), json.dumps(state).encode())
    return ordered, stopped


def _expanded(images: Sequence[Path], out: str, log: Callable[[str], None]) -> list[str]:
    """The files of names, folders and patterns, each once; folders and patterns in_order, without files in `out`, which earlier calls have
    written.

    :raises MissingFile: for a name or a pattern without a file.
    :raises TakenFile: if all files are in `out`.
    """
    paths: dict[str, bool] = {}  # whether each is left out
    for image in sequence(images, 'images', 'paths'):
        given = os.fspath(image)
        if os.path.isdir(given):
            found = [os.path.join(given, name) for name in find_images(given, log)]
        elif not os.path.lexists(given) and glob.escape(given) != given:
            found = [path for path in glob.glob(given, recursive=True) if not os.path.isdir(path)]
            if not found:
                raise MissingFile(f'no image is called {given}')
        else:
            check_images(given)
            paths[given] = False
            continue
        for path in sorted(found, key=in_order):
            paths.setdefault(path, is_in(path, out))
    if all(paths.values()):
        check_folder(out, paths)
    return [path for path, left_out in paths.items() if not left_out]


def _chain(work: _Work, series: Sequence[str], done: dict[str, Aligned], do: Callable[[Callable[[str], Aligned], list[str]], None]) -> None:
    """Aligns images without a transform through their neighbours in the series, starting beside images that have one."""
    tried: set[tuple[str, str]] = set()
    while True:
        through = {path: other for first, second in zip(series, series[1:]) for path, other in ((first, second), (second, first))
                   if path in done and done[path].size and not done[path].transform and other in done and done[other].transform
                   and (path, other) not in tried}
        if not through:
            return
        tried.update(through.items())
        do(lambda path: work.align_through(done[path], done[through[path]]), list(through))


def _known(out: str, settings: list[Any], stamps: dict[str, str]) -> tuple[dict[str, Aligned], Optional[list[int]]]:
    """Results of an earlier call for the same files, by path, and the part of the reference that it wrote."""
    try:
        with open(os.path.join(out, STATE), encoding='utf-8') as file:
            state = json.load(file)
        if state['settings'] != json.loads(json.dumps(settings)):
            return {}, None
        found = [Aligned(*each) for was, each in state['images'] if stamps.get(each[0]) == was]
        return {each.name: each for each in found}, state['part']
    except (OSError, ValueError, KeyError, TypeError):
        return {}, None


def _common(whole: list[int], images: Iterable[Aligned]) -> list[int]:
    """The largest part of the reference that all aligned images show: x, y, width, height.

    :raises ValueError: if there is none.
    """
    cv2, (_, _, width, height) = import_cv2(), whole
    shown = np.full((height, width), 1, np.uint8)
    for each in images:
        if each.transform:
            inside = np.ones(each.size[::-1], np.uint8)
            shown &= cv2.warpPerspective(inside, np.reshape(each.transform, (3, 3)), (width, height), flags=cv2.INTER_NEAREST)
    # The common part is convex, so a rectangle is inside if its left and right sides are.
    columns = np.flatnonzero(shown.any(axis=0))
    columns = columns[::1 + len(columns) // 2000]
    top = shown[:, columns].argmax(axis=0)
    bottom = height - shown[::-1, columns].argmax(axis=0)
    heights = np.minimum(bottom[:, None], bottom) - np.maximum(top[:, None], top)
    areas = np.maximum(heights, 0) * (columns - columns[:, None] + 1)
    if not areas.size or areas.max() <= 0:
        raise ValueError('the aligned images have no part that all show: align fewer, or do without crop (--crop)')
    left, right = np.unravel_index(areas.argmax(), areas.shape)
    return [int(columns[left]), int(max(top[left], top[right])), int(columns[right] - columns[left] + 1), int(heights[left, right])]


def _write_tables(results: Results, reference: str, title: str, done: Sequence[Aligned], part: list[int]) -> None:
    """The table and the page."""
    ordered = sorted(done, key=lambda each: in_order(each.name))
    write_whole(results.place('transforms.csv'), csv_bytes([HEADER, *map(_row, ordered)]))
    text = html_page(title, reference, [(each.name, str(each), each.file) for each in ordered], part[2], part[3], results.written)
    write_whole(results.place('index.html'), text.encode(errors='backslashreplace'))


def _file_names(paths: Sequence[str], known: dict[str, Aligned]) -> dict[str, str]:
    """Names of the aligned pictures, without suffixes, that all systems and pages allow; known images keep theirs."""
    names = {path: os.path.splitext(each.file)[0] for path, each in known.items() if each.file}
    taken = {'reference', *(name.lower() for name in names.values())}  # some file systems ignore case
    for path in paths:
        if path not in names:
            stem = ''.join('_' if '\ud800' <= letter <= '\udfff' else letter for letter in os.path.splitext(os.path.basename(path))[0])
            stem = stem.encode()[:LONGEST_STEM].decode(errors='ignore')
            names[path] = next(name for name in (f'{stem}_{count}' if count > 1 else stem for count in itertools.count(1))
                               if name.lower() not in taken)
            taken.add(names[path].lower())
    return names


class _Compared:
    """An image, and its upright, perhaps reduced copy that is compared, with a mask of pixels that hold data."""

    def __init__(self, path: str, options: _Options, masks: Masks, factor: int = 0) -> None:
        """:param factor: to reduce by; 0: the smallest whole factor for max_size.
        :raises ValueError: also for an image that is too large for cv2.warpPerspective."""
        file = ImageFile(path, options.exif)
        self.pages, self.left_out, self.no_data, self.geo = file.pages
        if self.no_data and not all(can_be(self.no_data, page.dtype) for page in self.pages):
            self.no_data = ''
        first = self.pages[0]
        self.size = list(first.shape[1::-1])
        if max(self.size) > LARGEST_SIDE:
            raise ValueError(f'{self.size[0]} x {self.size[1]} pixels, and cv2 lays sides of up to {LARGEST_SIDE} onto others: reduce it')
        mask, holes = masks.of(os.path.basename(path), first), self.holes(first)
        if holes is not None:
            whole = np.asarray(~(holes if first.ndim == 2 else holes.any(axis=2)), np.uint8)
            mask = whole if mask is None else mask * whole
            first = np.where(holes, np.nan, first)
        self.suffix, orientation = file.suffix, file.orientation
        turn, turned = Turn(orientation, *self.size), upright(in_8_bits(first, False), orientation)
        self.turn, self.factor = turn, factor or -(-max(self.size) // (options.max_size or max(self.size)))
        self.grey = self._reduced(turned)
        self.mask = None if mask is None else self._reduced(upright(mask, orientation))
        #: from pixels of the compared copy to pixels of the file
        self.matrix = turn.matrix @ [[self.factor, 0, (self.factor - 1) / 2], [0, self.factor, (self.factor - 1) / 2], [0, 0, 1]]

    def _reduced(self, image: NDArray[np.uint8]) -> NDArray[np.uint8]:
        height, width = (side // self.factor for side in image.shape)
        return reduced(image[:height * self.factor, :width * self.factor], max(height, width)) if height * width else image

    def holes(self, page: NDArray[Any]) -> Optional[NDArray[np.bool_]]:
        """Where a page holds no data: H x W, or H x W x 1 or channels; None if it holds data everywhere."""
        value = float(self.no_data or 'nan')
        if not self.no_data and page.dtype.kind != 'f':
            return None
        none = np.isnan(page) if np.isnan(value) else page == value
        if page.ndim == 3 and value >= 0:  # a value that one channel of a colour may have, too
            none = none.all(axis=2, keepdims=True)
        return none if none.any() else None


class _Work:
    """Aligns and writes each image. Threads share it."""

    place: Callable[[str], str]  #: the path of a file to write, by its name

    def __init__(self, reference: str, options: _Options, masks: Masks, log: Callable[[str], None]) -> None:
        self.path, self.options, self._masks, self._log = reference, options, masks, log
        try:
            self._reference = self._view(reference)
        except (ValueError, OSError) as e:
            raise ValueError(f'{reference}: {e}') from None
        if options.format not in (None, 'TIFF') and not (len(self._reference.pages) == 1 and holds(FORMATS[options.format], self._reference.pages[0])):
            raise InvalidOption(f'{reference}: {options.format} cannot hold all of it: take TIFF')
        self._aligner = ImageAligner(self._reference.grey, options.model, self._reference.mask)
        self.whole = [0, 0, *self._reference.size]

    def stamp(self, path: str) -> str:
        """As Masks.stamp."""
        return self._masks.stamp(path, os.path.basename(path))

    def settings(self) -> list[Any]:
        """What results depend on besides their images."""
        return [*self.options, os.path.abspath(self.path), self.stamp(self.path), __version__]

    def _view(self, path: str, factor: int = 0) -> _Compared:
        view = _Compared(path, self.options, self._masks, factor)
        if view.left_out:
            self._log(f'{path}: {view.left_out} of its pages are left out, since they have another size or type than the first one')
        return view

    def align(self, path: str, name: str, part: Optional[list[int]]) -> Aligned:
        """:param name: of the picture, without suffix.
        :param part: rectangle of the reference to write: x, y, width, height; None: write nothing."""
        try:
            view = self._view(path, self._reference.factor if self.options.model == AlignmentModel.TRANSLATION else 0)
        except (ValueError, OSError) as e:
            return Aligned(path, getattr(e, 'strerror', None) or str(e))
        aligned = self._aligned(self._aligner, self._reference, view, path)
        return aligned if part is None or not aligned.transform else self._written(view, aligned, name, part)

    def _aligned(self, aligner: ImageAligner, onto: _Compared, view: _Compared, path: str) -> Aligned:
        found = aligner.align(view.grey, view.mask)
        if not found.found:
            return Aligned(path, found.reason, len(found.matches), size=view.size)
        transform = onto.matrix @ found.transform @ np.linalg.inv(view.matrix)
        transform /= transform[2, 2]
        errors = view.turn.corners(found.error.ravel()) * onto.factor
        model = found.simplest if self.options.model == AlignmentModel.AUTO else AlignmentModel(self.options.model)
        return Aligned(path, 'aligned', len(found.matches), errors.tolist(), transform.ravel().tolist(), '', view.size,
                       *rotation_and_scale(np.linalg.inv(_derivative(found.transform, *np.array(view.grey.shape[::-1]) / 2))), model.name, found.note)

    def align_through(self, image: Aligned, other: Aligned) -> Aligned:
        """Aligns an image by its transform to another image and that image's transform to the reference; unchanged if there is none."""
        onto = self._view(other.name)
        view = self._view(image.name, onto.factor if self.options.model == AlignmentModel.TRANSLATION else 0)
        found = self._aligned(ImageAligner(onto.grey, self.options.model, onto.mask), onto, view, image.name)
        if not found.transform:
            return image
        to_other, to_reference = (np.reshape(each.transform, (3, 3)) for each in (found, other))
        transform = to_reference @ to_other
        transform /= transform[2, 2]
        right, bottom = view.size[0] - 1, view.size[1] - 1
        corners = np.array([[0, 0, 1], [right, 0, 1], [right, bottom, 1], [0, bottom, 1]]) @ to_other.T
        errors = [float(np.hypot(error * np.linalg.norm(_derivative(to_reference, x / w, y / w), 2), max(other.errors)))
                  for error, (x, y, w) in zip(found.errors, corners)]
        return found._replace(verdict=f'aligned through {os.path.basename(other.name)}', errors=errors, transform=transform.ravel().tolist(),
                              scale=found.scale * other.scale, rotation=(found.rotation + other.rotation) % 360)

    def write(self, aligned: Aligned, name: str, part: list[int]) -> Aligned:
        """Writes an image whose transform is known."""
        return self._written(_Compared(aligned.name, self.options, Masks(None)), aligned, name, part)

    def write_reference(self, part: list[int]) -> str:
        """:return: the name of its file."""
        x, y, width, height = part
        return self._write(self._reference, [page[y:y + height, x:x + width] for page in self._reference.pages], 'reference', part)

    def _written(self, view: _Compared, aligned: Aligned, name: str, part: list[int]) -> Aligned:
        onto = np.array([[1, 0, -part[0]], [0, 1, -part[1]], [0, 0, 1]]) @ np.reshape(aligned.transform, (3, 3))
        try:
            file = self._write(view, [self._warped(view, page, onto, part[2:]) for page in view.pages], name, part)
        except ValueError as e:  # the format cannot hold it
            return aligned._replace(verdict=str(e), transform=())
        return aligned._replace(file=file)

    def _write(self, view: _Compared, pages: Sequence[NDArray[Any]], name: str, part: list[int]) -> str:
        whole = len(pages) == 1 and holds(view.suffix, pages[0])
        suffix = FORMATS[self.options.format] if self.options.format else view.suffix if whole else '.tif'
        file = name + suffix
        write_picture(self.place(file), *pages, no_data=view.no_data, geo=geo_of_part(self._reference.geo, part[0], part[1]))
        if suffix == '.tif' or pages[0].dtype != np.uint8:  # browsers do not show it, or too dark
            holes = None if pages[0].dtype == np.uint8 else view.holes(pages[0])
            shown = pages[0] if holes is None else np.where(holes, np.nan, pages[0])  # which the scale leaves out
            shown = shown if np.isfinite(shown).any() else np.zeros_like(shown, np.uint8)
            write_picture(self.place(f'{PREVIEWS}/{file}.jpg'), in_8_bits(shown, True))
        return file

    def _warped(self, view: _Compared, page: NDArray[Any], onto: NDArray[Any], size: Sequence[int]) -> NDArray[Any]:
        """A page in pixels of the part. Pixels beside the image, and those interpolated from pixels without data, get no_data, or 0."""
        cv2 = import_cv2()

        def warp(values: NDArray[Any]) -> NDArray[Any]:
            warped: NDArray[Any] = cv2.warpPerspective(values, onto, tuple(size), flags=getattr(cv2, 'INTER_' + self.options.interpolation))
            return warped if warped.ndim == values.ndim else warped[..., None]
        holes, values = view.holes(page), page
        if holes is not None:
            values = np.where(holes, page.dtype.type(0), page)
        if page.dtype not in WARPED:
            values = values.astype(float)
        warped = warp(values)
        if page.dtype not in WARPED:
            warped = np.rint(warped).clip(np.iinfo(page.dtype).min, np.iinfo(page.dtype).max).astype(page.dtype)
        if holes is not None or view.no_data:
            shown = warp(np.ones(page.shape[:2] + (1,) * (page.ndim - 2), np.float32) if holes is None else (~holes).astype(np.float32))
            np.copyto(warped, page.dtype.type(float(view.no_data or 'nan')), where=np.abs(shown - 1) > 1e-3)
        return warped


def _derivative(transform: NDArray[np.float64], x: float, y: float) -> NDArray[np.float64]:
    """Of a homography at a point, 2 x 2."""
    place = transform @ (x, y, 1)
    derivative: NDArray[np.float64] = (transform[:2, :2] - np.outer(place[:2], transform[2, :2]) / place[2]) / place[2]
    return derivative


def _row(each: Aligned) -> list[str]:
    numbers = [f'{value:.3f}' for value in each.errors] + [f'{value:.9g}' for value in each.transform]
    return [each.name, each.verdict, str(each.matches), *(numbers or [''] * 13), each.file, each.model]
