# SPDX-License-Identifier: Apache-2.0

"""Figures of doc/questions.md, of the same results as the other pages."""
import json

import controls
import summaries
from timings import RESULTS, ms


def near(place, method, points='1000'):
    return controls.counted()[place, *method, points]


def night():
    """A pair by night, from another place."""
    ours, theirs = (near('light: night', method) for method in (controls.CHAIN, controls.OTHER))
    return ('Of %s pairs of rendered places, noon against night, 1000 points have %.0f right nearest neighbours with the chain and %.0f with SIFT at normalized\n'
            'points. Their poses score %.2f and %.2f.' % (ours['pairs'], float(ours['nearest']), float(theirs['nearest']), float(ours['at_5']), float(theirs['at_5'])))


def limits():
    """How far the camera may zoom, rotate, tilt and move: half of the right matches without it are the limit."""
    found = summaries.by(summaries.read(RESULTS / 'views.csv'), 'kind', 'amount', 'method', place='photographs')
    same = {method: float(found['zoom', '1', method]['right']) for method in ('upright chain', 'matchViews', 'SIFT', 'ORB')}

    def last(method, kind, step):
        kept = [float(key[1]) for key, row in found.items() if key[::2] == (kind, method) and float(row['right']) >= same[method] / 2]
        return '%g' % step(kept) if kept else 'none'
    lines = [[method, last(method, 'zoom', min), last(method, 'zoom', max), last(method, 'rotation', lambda kept: max(k for k in kept if k <= 60)), last(method, 'tilt', max)] for method in same]
    moved = sorted((key[0] for key in controls.counted() if key[0].startswith('baseline: ')), key=lambda of: ('above' in of, of))
    of = ['%s %.0f (SIFT normalized %.0f)' % (name.split(': ')[1], float(near(name, controls.CHAIN)['nearest']), float(near(name, controls.OTHER)['nearest'])) for name in dict.fromkeys(moved)]
    return ('%s\n\nZooms from .25 to 2 and tilts up to 4 were measured; of rotations those up to 60 degrees are in the table. Of cameras that moved in other light, right neighbours of\n'
            '1000 points by baseline: %s.' % (summaries.table(['half of the right matches are left at', 'reduced to', 'enlarged by', 'rotation, degrees', 'tilt'], lines), ', '.join(of)))


def slam():
    """32 bytes a point, and a vocabulary of them."""
    small, chain = (controls.found()['other light', 'Hessian', name] for name in ('IIB SMALL', 'IIB UNIVERSAL'))
    nodes = sum(10 ** level for level in range(1, 7))
    return ("Poses score %s with `PRESET_SMALL` at `HessianDetector`'s points and %s with the chain's 128 bytes. A vocabulary of 10 branches and 6 levels has %s nodes:\n"
            '%.0f MB of codes of 32 bytes, %.0f MB of 128 bytes, as many as with ORB (32) and four times as many.' % (
                controls.score(small), controls.score(chain), format(nodes, ','), nodes * 32 / 2 ** 20, nodes * 128 / 2 ** 20))


def large():
    """Images of 2000 pixels and more."""
    return ('With AVX2 and one thread 1000 points of 3.4, 13.5 and 24 megapixels are described in %.1f, %.0f and %.0f ms (ORB %.1f, %.0f and %.0f); `alignImages` takes\n'
            '%.0f ms for two photographs of 12 megapixels and %.0f of 50.' % (
                *(ms('IIB_Describe_large', name, size)['AVX2'] for name in ('default', 'ORB') for size in (3, 6, 8)), *(ms('IIB_Align_noon_and_winter', size)['AVX2'] for size in (12, 50))))


def map_size():
    """Memory and time of a large map."""
    data = json.loads((RESULTS / 'map.json').read_text())
    def took(row, name):
        return '%.0f' % row[name] if row[name] else '–'
    lines = [[format(row['images'], ','), format(row['points'], ','), '%.0f' % row['build_seconds'], '%.0f' % row['file_mb'], '%.0f' % row['resident_mb'],
              '%d of %d' % (row['found'], row['queries']), took(row, 'found_ms'), took(row, 'refused_ms')] for row in data['rows']]
    return summaries.table(['images in the map', 'points', 'built in, s', 'on the disk, MB', 'resident, MB', 'images found', 'ms each', 'ms each not found'], lines) + (
        '\n\nOf %s: %s, processor time of one thread, busy with other work; %d points an image, %d x %d pixels; images by night, at dusk and in winter.' % (
            data['date'], data['machine'], data['keypoints'], *data['size']))


ALL = {'question_' + make.__name__: make for make in (night, limits, slam, large, map_size)}
