"""Tables of what a release goes by, of the results in doc/results: the steps of the night, what was fuzzed, the files that were built."""
from summaries import table
from timings import rows


def night():
    return table(('step', 'what ran', 'minutes', 'commit', 'started (UTC)', 'result'), [
        ('`%s`' % row['step'], *(row[key] for key in ('counts', 'minutes', 'commit', 'started', 'result'))) for row in rows('night.csv')])


def artifacts():
    return table(('file', 'MB', 'SHA-256'), [('`%s`' % row['file'], '%.2f' % (int(row['bytes']) / 1e6), '`%s`' % row['sha256']) for row in rows('artifacts.csv')])


def fuzzing():
    return table(('target', 'executions with sanitizers', 'without', 'inputs kept', 'since'), [
        ('`%s`' % row['target'], *(format(int(row[key]), ',') for key in ('sanitized', 'plain')), row['kept'], row['since']) for row in rows('fuzz.csv')])
