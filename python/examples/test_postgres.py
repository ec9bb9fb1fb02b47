import os
import threading
import unittest

import numpy as np

from opencv_iib import HierarchicalMatcher

SERVER = os.environ.get('IIB_POSTGRES')

if SERVER:
    import psycopg
    from postgres import Places


def plain_votes(places, codes, count=10):
    """The result that Places.vote should return, computed by HierarchicalMatcher."""
    matcher = HierarchicalMatcher()
    matcher.add(list(places.values()))
    images = matcher.knnMatchArrays(codes)[2].ravel()
    votes = np.bincount(images[images >= 0], minlength=len(places))
    order = np.argsort(-votes, kind='stable')[:count]
    return [(list(places)[i], int(votes[i])) for i in order if votes[i]]


@unittest.skipUnless(SERVER, 'no server: scripts/helpers/servers_test.sh starts one')
class PlacesTest(unittest.TestCase):

    def setUp(self):
        self.connection = psycopg.connect(SERVER)
        self.addCleanup(self.connection.close)  # rolls everything back
        rng = np.random.default_rng(9)
        self.walk = {f'noon/{i}': rng.integers(0, 256, (15 + i % 3, 20), np.uint8) for i in range(12)}
        self.night = {}
        for name, codes in self.walk.items():
            noise = np.packbits(rng.random((len(codes), 160)) < .12, axis=1)
            self.night[name] = np.concatenate([codes ^ noise, rng.integers(0, 256, (10, 20), np.uint8)])

    def places(self, walk):
        places = Places(self.connection, 'walk', next(iter(walk.values())).shape[1])
        for place, codes in walk.items():
            places.insert(place, codes)
        return places

    def test_votes_are_those_of_a_plain_scan(self):
        self.connection.row_factory = psycopg.rows.dict_row
        places = self.places(self.walk)
        for name, codes in self.night.items():
            votes = places.vote(codes)
            self.assertEqual(votes, plain_votes(self.walk, codes))
            self.assertEqual(votes[0][0], name)
        self.assertEqual(places.vote(self.night['noon/3'], 2), plain_votes(self.walk, self.night['noon/3'], 2))

    def test_ties_go_to_the_first_place(self):
        code = np.arange(20, dtype=np.uint8)[None]
        places = self.places({'b': code ^ 1, 'a': code ^ 2, 'c': code ^ 255})
        self.assertEqual(places.vote(np.repeat(code, 3, 0)), [('b', 3)])
        self.assertEqual(places.vote(np.concatenate([code ^ 254, code ^ 1])), [('b', 1), ('c', 1)])

    def test_tables_are_found_again(self):
        self.places(self.walk)
        again = Places(self.connection, 'walk', 20)
        again.delete('noon/0')
        again.delete('noon/0')
        left = {name: codes for name, codes in self.walk.items() if name != 'noon/0'}
        self.assertEqual(again.vote(self.night['noon/0']), plain_votes(left, self.night['noon/0']))

    def test_nothing_to_find(self):
        places = Places(self.connection, 'walk', 20)
        self.assertEqual(places.vote(self.night['noon/0']), [])
        places.insert('no codes', np.empty((0, 20), np.uint8))
        self.assertEqual(places.vote(self.night['noon/0']), [])
        self.assertEqual(places.vote(np.empty((0, 20), np.uint8)), [])

    def test_nothing_is_committed(self):
        self.places(self.walk)
        with psycopg.connect(SERVER) as other:
            self.assertEqual(other.execute("SELECT to_regclass('walk')").fetchone(), (None,))

    def test_half_an_insert(self):
        with psycopg.connect(SERVER, autocommit=True) as connection:
            places = Places(connection, 'halves', 20)
            places._bits = lambda codes: ['0' * 160, 'no bits']
            with self.assertRaises(psycopg.Error):
                places.insert('noon/0', self.walk['noon/0'])
            del places._bits
            places.insert('noon/0', self.walk['noon/0'])
            self.assertEqual(places.vote(self.walk['noon/0']), [('noon/0', len(self.walk['noon/0']))])
            connection.execute('DROP TABLE halves_codes, halves')

    def test_writers_at_once(self):
        errors, barrier = [], threading.Barrier(8)

        def write(name):
            try:
                with psycopg.connect(SERVER) as connection:
                    barrier.wait()
                    Places(connection, 'written', 20).insert(name, self.walk[name])
            except Exception as e:
                errors.append(e)
        threads = [threading.Thread(target=write, args=[name]) for name in list(self.walk)[:8]]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(errors, [])
        self.assertEqual(Places(self.connection, 'written', 20).vote(self.walk['noon/5'])[0][0], 'noon/5')
        self.connection.execute('DROP TABLE written_codes, written')
        self.connection.commit()

    def test_mistakes(self):
        places = self.places(self.walk)
        for call in (lambda: Places(self.connection, 'a "walk"', 20), lambda: Places(self.connection, 'w' * 41, 20),
                     lambda: places.vote(self.night['noon/0'][:, 1:]), lambda: places.insert('new', np.zeros(20, np.uint8)),
                     lambda: places.insert('new', np.zeros((1, 20)))):
            with self.assertRaises(ValueError):
                call()
        with self.assertRaises(psycopg.errors.UniqueViolation):
            places.insert('noon/0', self.walk['noon/0'])
        self.assertEqual(places.vote(self.night['noon/3']), plain_votes(self.walk, self.night['noon/3']))

    def test_the_index_finds_what_a_scan_finds(self):
        if not self.connection.execute("SELECT 1 FROM pg_available_extensions WHERE name = 'vector'").fetchone():
            self.skipTest('pgvector is not installed on this server')
        self.connection.execute('CREATE EXTENSION IF NOT EXISTS vector')
        self.connection.execute('SET enable_seqscan = off')  # scanning a small table would be faster
        self.connection.execute('SET jit = off')  # disabled plans have a cost beyond its threshold
        places = self.places(self.walk)
        places.create_index()
        places.create_index()
        for codes in self.night.values():
            self.assertEqual(places.vote(codes, candidates=1000), plain_votes(self.walk, codes))
