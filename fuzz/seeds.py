#!/usr/bin/env python3
"""Writes the random part of the seed corpus: seeds.py corpus. Files of other names there were added by hand."""
import pathlib
import random
import sys

corpus = pathlib.Path(sys.argv[1])
for target, count, length in (("descriptor", 12, 160), ("matcher", 12, 120), ("parameters", 12, 160), ("states", 12, 300),
                              ("detector", 12, 100), ("mapped", 12, 400)):
    (corpus / target).mkdir(parents=True, exist_ok=True)
    for number in range(count):
        source = random.Random(f"{target} {number}")
        seed = bytes(source.randrange(256) for _ in range(length))
        (corpus / target / f"random-{number:02}").write_bytes(seed)
