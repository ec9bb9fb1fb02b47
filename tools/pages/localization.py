# SPDX-License-Identifier: Apache-2.0

"""The page of localization across lights, from the results of tools/localization/measure.py."""
import math

import tables


def share(count, of):
    """Per cent with its 95 % confidence interval (Wilson)."""
    p, z = count / of, 1.96
    middle, half = (p + z * z / (2 * of)) / (1 + z * z / of), z * math.sqrt(p * (1 - p) / of + z * z / (4 * of * of)) / (1 + z * z / of)
    return '%.0f %% (%.0f to %.0f)' % (100 * p, 100 * max(0, middle - half), 100 * min(1, middle + half))


def worst(results):
    """Shares of images near their places in the worst light."""
    def within(place, limit):
        rows = [row for row in results['rows'] if (row['place'], row['method']) == (place, 'recommended chain')]
        return min(100 * row['within_%d' % limit] / row['images'] for row in rows)

    found = [('%s, within %s' % (what, near), '%.0f %%' % within(place, limit))
             for what, place, limit, near in (('keyframes 1.4 m apart', 'street', 5, '5 cm and 0.5°'),
                                              ('keyframes 1.4 m apart', 'street', 25, '25 cm and 2°'),
                                              ('keyframes 2.8 m apart', 'every 2', 5, '5 cm and 0.5°'),
                                              ('keyframes 5.6 m apart', 'every 4', 5, '5 cm and 0.5°'))]
    if results['unknown']:
        found.append(('photographs of other places that get a pose', share(*results['unknown'])))
    return found


def unseen():
    """Rows of doc/uncertainty.md's rendered places."""
    return [row for row in tables.rows('uncertainty.csv') if row['quantity'] == 'centre of Localizer' and row['data'].startswith('rendered places')]


def context(results, setups):
    """The template's variables; `setups` is the file of tools/localization/setups.py."""
    rows = sorted((row for row in results['rows'] if row['place'] == 'street'), key=lambda row: row['method'].startswith('SIFT'))
    return {**results, 'by_light': [[row for row in rows if row['light'] == light] for light in results['lights']], 'worst': worst(results),
            'setups': [tables.localization_lights(setups), tables.quoted_systems()],
            'photographs': sorted({row['place'] for row in results['rows']} - {'street', 'every 2', 'every 4'})}
