#!/usr/bin/env python3
"""Checks the includes of modules and their diagram in CONTRIBUTING.md: includes_test.py [--draw] FOLDER...; --draw writes the diagram.

- Arrows between folders point downwards only.
- No file includes itself through others; a header and the source of the same name count as one file.
- Modules include each other's public headers and opencv2/iib/detail only; tests may share more.
- Raw intrinsics stand in one file.
"""
import pathlib
import re
import sys

# Folders below src: what each may include, besides precomp.hpp. The rest of a module is free.
ALLOWED = {'': {''}, 'common': {'common'}, 'rotation': {'rotation', 'common'}}
ALLOWED['verdict'] = {'verdict', 'common'}  # of iib_geometry
ALLOWED['pose'] = {'pose', *ALLOWED['verdict']}
ALLOWED['views'] = {'views', *ALLOWED['pose']}
ALLOWED['alignment'] = {'alignment', *ALLOWED['views']}
ALLOWED['map'] = {'map', *ALLOWED['pose']}
ALLOWED['locate'] = {'locate', *ALLOWED['map'], *ALLOWED['views']}
for wing in ('descriptor', 'matcher', 'detector', 'normalization', 'refinement'):
    ALLOWED[wing + '/kernels'] = {wing + '/kernels', 'common'}
    ALLOWED[wing] = {wing, wing + '/kernels', 'common'}
for wing in ('detector', 'refinement'):
    ALLOWED[wing].add('normalization')
ALLOWED['detector'].add('normalization/kernels')  # halves the normalized image, too
ALLOWED['descriptor'].add('detector')  # an extractor writes and reads the file of its detector
#: Files of iib that tests of other modules may include; least number of files of each module.
SHARED = ('iib/test/support/*.hpp', 'iib/perf/matcher.hpp')
FILES = {'iib': 80, 'iib_index': 10, 'iib_geometry': 50}
INTRINSICS = re.compile(r'(?:^|[^a-zA-Z_])(?:_mm[0-9]*_|__m(?:128|256|512)|v[a-z]+q_[a-z]*[0-9])', re.MULTILINE)


def folder(path):
    return re.sub('^src/?', '', path.parent.as_posix())


def resolved(module, file, path):
    """What a file includes by a path: from its own folder, or from src, as the compiler looks for it."""
    beside = (file.parent / path).resolve()
    return beside if beside.exists() else module / 'src' / path


def mistakes(module):
    files = sorted(module.rglob('*.[ch]pp'))
    if len(files) < FILES[module.name]:
        yield 'only %d files below %s' % (len(files), module)
    units = {}  # of src, and which they include
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
        allowed = ALLOWED.get(layer, set())
        for path in included:
            if folder(path) not in allowed and path.name != 'precomp.hpp':
                yield '%s includes %s: %s may include only %s' % (name, path, layer, ', '.join(sorted(allowed)))
        unit = name.with_suffix('')
        units.setdefault(unit, set()).update({path.with_suffix('') for path in included} - {unit})
        if INTRINSICS.search(text) and name.name != 'vectors.simd.hpp':
            yield '%s has raw intrinsics; give them a name in a vectors.simd.hpp' % name
    # Units that include no other one still there are taken away, until none is left: what remains are circles.
    while True:
        free = {unit for unit, included in units.items() if not included & units.keys()}
        if not free:
            break
        units = {unit: included for unit, included in units.items() if unit not in free}
    if units:
        yield 'these files include each other in a circle, or include some that do: ' + ', '.join(map(str, sorted(units)))


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
