# SPDX-License-Identifier: Apache-2.0

"""Tables and figures of doc/questions.md."""
import json

import controls
import summaries
from timings import RESULTS, ms


def figures():
    """Scores of poses by night, milliseconds of large images, and the run that measured maps."""
    found = summaries.read(RESULTS / 'neighbours.csv')
    night = {(row['detector'], row['descriptor']): row for row in found if (row['place'], row['points']) == ('light: night', '1000')}
    ours, theirs = night[controls.CHAIN], night[controls.OTHER]
    data = json.loads((RESULTS / 'map.json').read_text())
    large, = (row for row in data['rows'] if row['images'] == 10000)
    of_map = {name: '%.2g' % (large[column] / unit) for name, column, unit in (
        ('map_minutes', 'build_seconds', 60), ('map_peak', 'build_peak_mb', 1024), ('map_disk', 'file_mb', 1024), ('map_resident', 'resident_mb', 1024),
        ('map_open', 'open_seconds', 60))}
    return {**of_map, 'night_pairs': ours['pairs'], 'night_chain': '%.2f' % float(ours['at_5']), 'night_sift': '%.2f' % float(theirs['at_5']),
            'large_ms': '%.0f' % ms('IIB_Describe_large', 'default', 8)['AVX2'], 'large_orb_ms': '%.0f' % ms('IIB_Describe_large', 'ORB', 8)['AVX2'],
            'align_ms': '%.0f' % ms('IIB_Align_noon_and_winter', 50)['AVX2'], 'map_run': '%s (%s)' % (data['date'], data['machine'])}


def limits():
    """The zoom, rotation and tilt at which half of the right matches are left."""
    found = summaries.by(summaries.read(RESULTS / 'views.csv'), 'kind', 'amount', 'method', place='photographs')
    same = {method: float(found['zoom', '1', method]['right']) for method in ('upright chain', 'matchViews', 'SIFT', 'ORB')}

    def last(method, kind, step):
        amounts = {float(key[1]): float(row['right']) >= same[method] / 2 for key, row in found.items() if key[::2] == (kind, method)}
        kept = [amount for amount, half in amounts.items() if half]
        return 'none' if not kept else 'any (%g)' % max(kept) if kind == 'rotation' and all(amounts.values()) else '%g' % step(kept)
    lines = [[method, last(method, 'zoom', min), last(method, 'zoom', max), last(method, 'rotation', max), last(method, 'tilt', max)] for method in same]
    return summaries.table(['half of the right matches are left at', 'reduced to', 'enlarged by', 'rotation, degrees', 'tilt'], lines)


def map_size():
    """Memory and time of a large map."""
    def took(row, name):
        return '%.0f' % row[name] if row.get(name) else '–'
    lines = [[format(row['images'], ','), format(row['points'], ','), '%.0f' % row['build_seconds'], took(row, 'build_peak_mb'), '%.0f' % row['file_mb'], '%.0f' % row['resident_mb'],
              '%d of %d' % (row['found'], row['queries']), took(row, 'found_ms'), took(row, 'refused_ms')] for row in json.loads((RESULTS / 'map.json').read_text())['rows']]
    return summaries.table(['images in the map', 'points', 'built in, s', 'memory to build, MB', 'on the disk, MB', 'resident, MB', 'images found', 'ms each', 'ms each not found'], lines)


ALL = {'question_' + make.__name__: make for make in (limits, map_size)}
