#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0

"""The experiments of README.md that measure poses, alignment and uncertainty, by the package opencv_iib; scripts/evaluate.sh calls it beside
iib_evaluation, which has the others, with the same options."""
import argparse
import pathlib
import sys

import opencv_iib
from alignment import alignment
from poses import controls, estimators
from uncertainty import uncertainty
from warped import views

EXPERIMENTS = {make.__name__: make for make in (estimators, controls, alignment, uncertainty, views)}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('data', nargs='+', metavar='DATA')
    parser.add_argument('--out', type=pathlib.Path, required=True)
    parser.add_argument('--only', action='append', default=[])
    parser.add_argument('--points', type=int, default=1000)
    parser.add_argument('--tolerance', type=float, default=3)
    parser.add_argument('--detectors', action='append', default=[], help='of estimators')
    for other in ('--compare', '--descriptor', '--keypoints'):  # of iib_evaluation
        parser.add_argument(other, action='append', help=argparse.SUPPRESS)
    options = parser.parse_intermixed_args()
    options.out.mkdir(parents=True, exist_ok=True)
    try:
        for name, measure in EXPERIMENTS.items():
            if name in options.only or not options.only:
                measure(options)
    except (RuntimeError, ValueError, OSError, opencv_iib.error) as error:
        sys.exit('evaluate.py: %s' % error)


if __name__ == '__main__':
    main()
