"""Tables of what a release goes by, of the results in doc/results: the steps of the night, what was fuzzed, the files that were built; and
that of the first pull request to opencv_contrib."""
from summaries import by, read, table
from timings import RESULTS, rows


def night():
    return table(('step', 'what ran', 'minutes', 'commit', 'started (UTC)', 'result'), [
        ('`%s`' % row['step'], *(row[key] for key in ('counts', 'minutes', 'commit', 'started', 'result'))) for row in rows('night.csv')])


def artifacts():
    return table(('file', 'MB', 'SHA-256'), [('`%s`' % row['file'], '%.2f' % (int(row['bytes']) / 1e6), '`%s`' % row['sha256']) for row in rows('artifacts.csv')])


def fuzzing():
    return table(('target', 'executions with sanitizers', 'without', 'inputs kept', 'since'), [
        ('`%s`' % row['target'], *(format(int(row[key]), ',') for key in ('sanitized', 'plain')), row['kept'], row['since']) for row in rows('fuzz.csv')])


def first_patch():
    """The paper's descriptor beside those that OpenCV has, in changed light."""
    found, ms = by(rows('fixed_points.csv'), 'place', 'configuration'), by(read(RESULTS.parents[1] / 'upstream/speed.csv'), 'descriptor')
    lines = []
    for name in ('IIB', 'IIB overlap', 'IIB quartile', 'IIB g3', 'BEBLID-512', 'BRIEF-512', 'LATCH-512', 'ORB', 'SIFT'):
        row = found['light', name]
        lines.append((name.replace('g3', 'granularity 3'), row['bytes'], *('%.3f' % float(row[key]) for key in ('precision', 'recall')),
                      '%.2f to %.2f' % (float(row['low']), float(row['high'])), ms[name]['ms'] if name in ms else ''))
    return table(('descriptor', 'bytes', 'precision', 'recall', 'interval of recall', 'ms for 1000 points'), lines)
