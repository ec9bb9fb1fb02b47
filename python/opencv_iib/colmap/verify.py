"""Two-view geometry of matches by COLMAP's own program."""
from __future__ import annotations

import os
import shutil
import subprocess
import tempfile
from typing import Iterable, Optional


def colmap_binary() -> Optional[str]:
    """The path of COLMAP's program; None without it."""
    return shutil.which('colmap')


def matches_importer(binary: str, database: str, pairs: Iterable[tuple[str, str]]) -> None:
    """Has COLMAP verify matches that are in the database; it takes those instead of matching anew.

    :raises RuntimeError: with the program's last lines, if it fails.
    """
    with tempfile.NamedTemporaryFile('w', suffix='.txt', encoding='utf-8', delete=False) as file:
        for a, b in pairs:
            file.write(f'{a} {b}\n')
    try:
        usage = subprocess.run([binary, 'matches_importer', '--help'], capture_output=True, text=True,
                               env={**os.environ, 'QT_QPA_PLATFORM': 'offscreen'}).stdout
        gpu = 'FeatureMatching' if '--FeatureMatching.use_gpu' in usage else 'SiftMatching'
        done = subprocess.run([binary, 'matches_importer', '--database_path', database, '--match_list_path', file.name,
                               '--match_type', 'pairs', f'--{gpu}.use_gpu', '0'],
                              capture_output=True, text=True, env={**os.environ, 'QT_QPA_PLATFORM': 'offscreen'})
        if done.returncode:
            tail = '\n'.join((done.stdout + done.stderr).splitlines()[-5:])
            raise RuntimeError(f'colmap matches_importer failed:\n{tail}')
    finally:
        os.unlink(file.name)
