#!/usr/bin/env python3
"""Tells in doc/results/runs.csv of which run a file of results is: remember.py FILE COMMIT MACHINE"""
import os
import sys

from summaries import remember, today
from timings import RESULTS


def main():
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    file, commit, machine = sys.argv[1:]
    remember(RESULTS / 'runs.csv', {os.path.relpath(file, RESULTS): [commit, today(), machine]})


if __name__ == '__main__':
    main()
