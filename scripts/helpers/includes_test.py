#!/usr/bin/env python3
"""The picture of includes of modules, which CONTRIBUTING.md has: includes_test.py [--draw] FOLDER...; with --draw it is written anew.

It reads the sources, since it is about them. Arrows between folders point downwards only, no file includes itself by way of
others, where a header and the source of the same name count as one, nothing leaves the module but for what tests share (what modules share is in opencv2/iib/detail), and raw
intrinsics stand in one file.
"""
import pathlib
import re
import sys

#: What tests of other modules may include of iib, and how many files each module has at least.
SHARED = ('iib/test/support/*.hpp', 'iib/perf/matcher.hpp')
FILES = {'iib': 80, 'iib_index': 10, 'iib_geometry': 50}
INTRINSICS = re.compile(r'(?:^|[^a-zA-Z_])(?:_mm[0-9]*_|__m(?:128|256|512)|v[a-z]+q_[a-z]*[0-9])', re.MULTILINE)


def folder(path):
    return re.sub('^src/?', '', path.parent.as_posix())


def resolved(module, file, path):
    """What a file includes by a path: from its own folder, or from src, as the compiler looks for it."""
    beside = (file.parent / path).resolve()
    return beside if beside.exists() else module / 'src' / path


def circle_of(included):
    """Units that include each other in a circle, or include some that do."""
    while free := {unit for unit, others in included.items() if not others & included.keys()}:
        included = {unit: others for unit, others in included.items() if unit not in free}
    return included.keys()


def mistakes(module):
    files = sorted(module.rglob('*.[ch]pp'))
    if len(files) < FILES[module.name]:
        yield 'only %d files below %s' % (len(files), module)
    units, layers = {}, {}  # files and folders of src, and which they include
    for file in files:
        text, name = file.read_text(), file.relative_to(module)
        included = []
        for path in re.findall(r'^#include "([^"]*)(?<!_declarations.hpp)"', text, re.MULTILINE):  # those CMake makes
            target = resolved(module, file, path)
            if module not in target.parents and not any(target.match(shared) for shared in SHARED):
                yield '%s includes %s, which is not of the module' % (name, path)
            elif module in target.parents and target.exists():
                included.append(target.relative_to(module))
        if name.parts[0] != 'src':
            continue
        layer = folder(name)
        layers.setdefault(layer, set()).update({folder(path) for path in included if path.name != 'precomp.hpp'} - {layer})
        unit = name.with_suffix('')
        units.setdefault(unit, set()).update({path.with_suffix('') for path in included} - {unit})
        if INTRINSICS.search(text) and name.name != 'vectors.simd.hpp':
            yield '%s has raw intrinsics; give them a name in a vectors.simd.hpp' % name
    for what, of in (('files', units), ('folders', layers)):
        circle = circle_of(of)
        if circle:
            yield 'these %s include each other in a circle, or include some that do: %s' % (what, ', '.join(map(str, sorted(circle))))


def picture(modules):
    """A line for each folder below src, with the folders that its files include."""
    for module in modules:
        included = {}
        for file in sorted((module / 'src').rglob('*.[ch]pp')):
            layer = folder(file.relative_to(module))
            for path in re.findall(r'^#include "([^"]*)"', file.read_text(), re.MULTILINE):
                target = resolved(module, file, path)
                inside = folder(target.relative_to(module)) if module in target.parents and target.exists() else ''
                detail = re.match('opencv2/iib/detail', path) and not (module / 'include' / path).exists() and 'iib/detail'
                included.setdefault(layer, set()).update({inside or detail or layer} - {layer})
        yield '%s/src' % module.name
        for layer in sorted(included, key=lambda layer: (-len(included[layer]), layer)):
            yield ('  %-24s%s' % (layer or '.', '  '.join(sorted(included[layer])))).rstrip()


def draw(modules, write):
    """Compares the picture in CONTRIBUTING.md with the sources, or writes it."""
    page = pathlib.Path(__file__).resolve().parents[2] / 'CONTRIBUTING.md'
    before = page.read_text()
    after = re.sub('(<!-- includes -->\n```\n)[^`]*', lambda head: head[1] + '\n'.join(picture(modules)) + '\n', before)
    if write:
        page.write_text(after)
    elif before != after:
        yield 'CONTRIBUTING.md shows other includes than these: scripts/helpers/includes_test.py --draw modules/*'


if __name__ == '__main__':
    given = [pathlib.Path(folder).resolve() for folder in sys.argv[1:] if folder != '--draw']
    sys.exit('\n'.join([*(mistake for module in given for mistake in mistakes(module)), *draw(given, '--draw' in sys.argv)]) or 0)
