import os
import unittest
from pathlib import Path

import numpy as np

from opencv_iib import IIB, HierarchicalMatcher
from support import cv2

SERVER = os.environ.get('IIB_POSTGRES')
DATA = Path(os.environ.get('OPENCV_TEST_DATA_PATH', '')) / 'illumination'

if SERVER:
    import psycopg
    from opencv_iib.postgres import Places


def plain_votes(places, codes, count=10):
    """What Places.vote returns, by HierarchicalMatcher."""
    matcher = HierarchicalMatcher()
    matcher.add(list(places.values()))
    images = matcher.knnMatchArrays(codes)[2].ravel()
    votes = np.bincount(images[images >= 0], minlength=len(places))
    order = np.argsort(-votes, kind='stable')[:count]
    return [(list(places)[i], int(votes[i])) for i in order if votes[i]]


@unittest.skipUnless(SERVER, 'no server: scripts/postgres_test.sh starts one')
class PlacesTest(unittest.TestCase):

    def setUp(self):
        self.connection = psycopg.connect(SERVER)
        self.addCleanup(self.connection.close)  # which rolls everything back
        rng = np.random.default_rng(9)
        self.walk = {f'noon/{i}': rng.integers(0, 256, (15 + i % 3, 20), np.uint8) for i in range(12)}
        self.night = {}
        for name, codes in self.walk.items():
            noise = np.packbits(rng.random((len(codes), 160)) < .12, axis=1)
            self.night[name] = np.concatenate([codes ^ noise, rng.integers(0, 256, (10, 20), np.uint8)])

    def places(self, walk, name='a "walk"'):
        places = Places(self.connection, name, next(iter(walk.values())).shape[1])
        for place, codes in walk.items():
            places.insert(place, codes)
        return places

    def recall(self, places, walk, night):
        """At 1, 5 and 10; the votes are those of a plain scan."""
        ranks = []
        for name, codes in night.items():
            votes = places.vote(codes)
            self.assertEqual(votes, plain_votes(walk, codes))
            ranks.append([place for place, _ in votes].index(name) if name in dict(votes) else 10)
        return [float(np.mean([rank < at for rank in ranks])) for at in (1, 5, 10)]

    def test_votes_are_those_of_a_plain_scan(self):
        places = self.places(self.walk)
        self.assertEqual(self.recall(places, self.walk, self.night), [1, 1, 1])
        self.assertEqual(places.vote(self.night['noon/3'], 2), plain_votes(self.walk, self.night['noon/3'], 2))

    def test_ties_go_to_the_first_place(self):
        code = np.arange(20, dtype=np.uint8)[None]
        places = self.places({'b': code ^ 1, 'a': code ^ 2, 'c': code ^ 255})
        self.assertEqual(places.vote(np.repeat(code, 3, 0)), [('b', 3)])
        self.assertEqual(places.vote(np.concatenate([code ^ 254, code ^ 1])), [('b', 1), ('c', 1)])

    def test_tables_are_found_again(self):
        self.places(self.walk)
        again = Places(self.connection, 'a "walk"', 20)
        again.delete('noon/0')
        again.delete('noon/0')
        left = {name: codes for name, codes in self.walk.items() if name != 'noon/0'}
        self.assertEqual(again.vote(self.night['noon/0']), plain_votes(left, self.night['noon/0']))
        again.insert('noon/0', self.walk['noon/0'])
        self.assertEqual(again.vote(self.night['noon/0'])[0][0], 'noon/0')

    def test_nothing_to_find(self):
        places = Places(self.connection, 'empty', 20)
        self.assertEqual(places.vote(self.night['noon/0']), [])
        places.insert('no codes', np.empty((0, 20), np.uint8))
        self.assertEqual(places.vote(self.night['noon/0']), [])
        self.assertEqual(places.vote(np.empty((0, 20), np.uint8)), [])

    def test_mistakes(self):
        places = self.places(self.walk)
        for call in (lambda: Places(self.connection, 'a "walk"', 21), lambda: Places(self.connection, 'none', 0),
                     lambda: places.vote(self.night['noon/0'][:, 1:]), lambda: places.insert('new', np.zeros(20, np.uint8)),
                     lambda: places.insert('new', np.zeros((1, 20)))):
            with self.assertRaises(ValueError):
                call()
        with self.assertRaises(psycopg.errors.UniqueViolation):
            places.insert('noon/0', self.walk['noon/0'])

    @unittest.skipIf(cv2 is None, 'no cv2')
    @unittest.skipUnless(DATA.is_dir(), 'no images in $OPENCV_TEST_DATA_PATH/illumination')
    def test_cameras_by_night(self):
        iib = IIB.createPreset(IIB.PRESET_COMPACT)
        day, night = {}, {}
        for sequence in sorted(DATA.glob('tilde_webcam/*')) + sorted(DATA.glob('amos_daynight/*')):
            images = sorted(sequence.glob('*.png'), key=lambda path: int(path.stem))
            for walk, image in ((day, images[0]), (night, images[-1])):
                grey = cv2.imread(str(image), cv2.IMREAD_GRAYSCALE)
                points = cv2.goodFeaturesToTrack(grey, 100, .001, 8)[:, 0]
                rows = np.column_stack([points, np.full(len(points), 32)]).astype(np.float32)
                walk[sequence.name] = iib.compute(grey, rows)[1]
        recall = self.recall(self.places(day), day, night)
        print(f'\n{len(day)} cameras, 100 codes each: recall by night at 1, 5, 10: ' + ' '.join(f'{r:.2f}' for r in recall))
        self.assertGreater(recall[0], .5)


if __name__ == '__main__':
    unittest.main()
