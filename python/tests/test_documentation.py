"""The programs of the README and of doc/python.md run as they stand there, with this package."""
import os
import re
import subprocess
import sys
import tempfile
import unittest

from support import REPOSITORY, cv2

PAIR = [REPOSITORY / 'tools/synthetic' / name for name in ('day.png', 'night.png')]


def programs(page):
    return re.findall('^```python\n(.*?)^```', (REPOSITORY / page).read_text(), re.S | re.M)


@unittest.skipIf(cv2 is None, 'no cv2')
@unittest.skipUnless(PAIR[0].exists(), 'the documentation is not beside these tests')
class Documentation(unittest.TestCase):

    def test_the_program_of_the_readme(self):
        program, = programs('README.md')
        done = subprocess.run([sys.executable, '-c', program, *map(str, PAIR)], capture_output=True, text=True)
        self.assertRegex(done.stdout, r'^\d{3} matches\n$', done.stderr)

    def test_the_programs_of_the_package(self):
        first, second = programs('doc/python.md')
        with tempfile.TemporaryDirectory() as folder:
            images = [cv2.imread(str(path)) for path in PAIR]
            for name, image in zip(('day.jpg', 'night.jpg'), images):
                cv2.imwrite(os.path.join(folder, name), image)
            where, names = os.getcwd(), dict(zip(('image_a', 'image_b'), images))
            os.chdir(folder)
            try:
                exec(first, names)
                self.assertGreater(len(names['matches']), 100)
                exec(second, names)
            finally:
                os.chdir(where)
        self.assertGreater(len(names['pairs']), 100)
        self.assertEqual(names['matched_a'].shape, names['matched_b'].shape)
