import contextlib
import os
import re
import signal
import threading
import unittest
from pathlib import Path
from unittest import mock

import numpy as np

import opencv_iib
from opencv_iib import MappedIndex, shards
from support import InFolder, brute_force, optional

distributed = optional('distributed')


class Interrupted(Exception):
    pass


def until(arrays, count):
    """Yields the first `count` values, then raises an error."""
    yield from arrays[:count]
    raise Interrupted


@contextlib.contextmanager
def workers(count):
    with distributed.LocalCluster(n_workers=count, threads_per_worker=1, dashboard_address=None, silence_logs=50) as cluster, \
            distributed.Client(cluster) as client:
        yield client


class ShardsTest(InFolder):

    def setUp(self):
        super().setUp()
        self.folder = str(self.folder / 'codes')
        rng = np.random.default_rng(8)
        self.codes = rng.integers(0, 256, (400, 8), np.uint8)  # of 8 bytes, so that many distances tie
        self.queries = rng.integers(0, 256, (30, 8), np.uint8)

    def expect_found(self, found, k, codes=None):
        expected = brute_force(self.queries, self.codes if codes is None else codes, k)
        self.assertEqual([found[0].tobytes(), found[1].tobytes()],
                         [expected[0].astype(np.int64).tobytes(), expected[1].astype(np.int32).tobytes()])
        self.assertEqual((found[0].dtype, found[1].dtype), (np.int64, np.int32))

    def test_any_number_of_shards(self):
        for rows_per_shard in (1 << 20, 400, 399, 57, 1):
            with self.subTest(rows_per_shard):
                folder = f'{self.folder}-{rows_per_shard}'
                index = shards.write(folder, self.codes, rows_per_shard)
                self.assertEqual(index.segments(), -(-400 // min(rows_per_shard, 400)))
                for k in (1, 5, 100):  # more than a shard holds
                    self.expect_found(shards.search(folder, self.queries, k), k)

    def test_arrays_stay_whole(self):
        index = shards.write(Path(self.folder), (self.codes[i:i + 30] for i in range(0, 400, 30)), 100, (2, 6))
        self.assertEqual((index.images(), index.segments(), index.levelSizes()), (14, 4, (2, 6)))
        self.expect_found(shards.search(Path(self.folder), self.queries), 5)

    def test_no_codes(self):
        shards.write(self.folder, self.codes[:0])
        for array in shards.search(self.folder, self.queries, 3):
            np.testing.assert_array_equal(array, np.full((30, 3), -1))
        shards.write(self.folder + '2', [], level_sizes=[8])
        self.assertEqual(MappedIndex(self.folder + '2').segments(), 0)
        with self.assertRaisesRegex(ValueError, 'no codes'):
            shards.write(self.folder + '3', [])

    def test_an_interrupted_call_goes_on(self):
        images = [self.codes[i:i + 30] for i in range(0, 400, 30)]
        for count in (1, 5, 9):
            with self.assertRaises(Interrupted):
                shards.write(self.folder, until(images, count), 60)
            self.assertFalse(os.path.exists(self.folder))
        first = os.path.join(self.folder + '.partial', 'segment-000001.iib')
        inode = os.stat(first).st_ino
        with self.assertRaisesRegex(ValueError, 'level sizes'):
            shards.write(self.folder, images, 60, (4, 4))
        for others in (images[:7], images[1:], [images[0] ^ 1, *images[1:]], [self.codes[::-1][i:i + 30] for i in range(0, 400, 30)]):
            with self.assertRaisesRegex(ValueError, 'other codes'):
                shards.write(self.folder, others, 60)
        index = shards.write(self.folder, images, 60)
        self.assertEqual((index.images(), index.segments()), (14, 7))
        self.assertEqual(os.stat(os.path.join(self.folder, 'segment-000001.iib')).st_ino, inode)
        self.assertFalse(os.path.exists(self.folder + '.partial'))
        self.expect_found(shards.search(self.folder, self.queries), 5)

    def test_one_writer(self):
        def images():
            yield self.codes
            with self.assertRaisesRegex(BlockingIOError, 'another process'):
                shards.write(self.folder, self.codes)
        shards.write(self.folder, images(), 10)
        file = self.folder + '-file'
        Path(file).write_bytes(b'precious')
        for name in (self.folder, file):
            with self.assertRaises(FileExistsError):
                shards.write(name, self.codes)
            self.assertFalse(os.path.exists(name + '.partial'))
        self.expect_found(shards.search(self.folder, self.queries), 5)

    def test_a_call_with_wrong_sizes_is_not_in_the_way_of_a_right_one(self):
        for wrong in ((6,), (2, 7)):
            with self.assertRaises(opencv_iib.error):
                shards.write(self.folder, self.codes, level_sizes=wrong)
        with self.assertRaises(opencv_iib.error):
            shards.write(self.folder, [self.codes[:5, :3], self.codes])
        self.assertEqual(shards.write(self.folder, self.codes, level_sizes=(2, 6)).levelSizes(), (2, 6))
        self.expect_found(shards.search(self.folder, self.queries), 5)

    def test_a_slash_at_the_end(self):
        self.assertEqual(shards.write(self.folder + os.sep, self.codes).rows(), 400)
        self.assertEqual(os.listdir(os.path.dirname(self.folder)), [os.path.basename(self.folder)])
        self.assertNotIn('.partial', os.listdir(self.folder))

    def test_a_new_commit_is_seen(self):
        index = shards.write(self.folder, self.codes[:300], 100)
        self.expect_found(shards.search(self.folder, self.queries), 5, self.codes[:300])
        index.add(self.codes[300:])
        self.expect_found(shards.search(self.folder, self.queries), 5)

    def altered(self):
        """Alters a shard. :return: its name."""
        name = os.path.join(self.folder, 'segment-000003.iib')
        content = bytearray(Path(name).read_bytes())
        content[-9] ^= 1
        Path(name).write_bytes(content)
        return name

    def test_an_altered_shard_is_named(self):
        shards.write(self.folder, self.codes, 100)
        with self.assertRaisesRegex(opencv_iib.error, re.escape(self.altered())):
            shards.search(self.folder, self.queries)

    @unittest.skipIf(distributed is None, 'no dask.distributed')
    def test_workers_of_dask(self):
        shards.write(self.folder, self.codes, 57)
        shards.write(self.folder + '0', [], level_sizes=[8])
        with workers(2) as client:
            for k in (1, 100):
                self.expect_found(shards.search(self.folder, self.queries, k, client), k)
            self.assertEqual(shards.search(self.folder + '0', self.queries, 2, client)[0].tolist(), [[-1, -1]] * 30)
            for array, same in zip(shards.search(self.folder, self.queries, 500, client), shards.search(self.folder, self.queries, 500)):
                np.testing.assert_array_equal(array, same)
            for k in (10 ** 9, 0):
                with self.assertRaises(opencv_iib.error):
                    shards.search(self.folder, self.queries, k, client)
            with self.assertRaises(opencv_iib.error):
                shards.search(self.folder, self.queries[:, 1:], 5, client)
            self.expect_found(self.while_workers_die(client, 1), 5)
            index = MappedIndex(self.folder)
            index.add(self.codes[:50])
            self.expect_found(shards.search(self.folder, self.queries, 5, client), 5,
                              np.concatenate([self.codes, self.codes[:50]]))
            name = self.altered()
            index.remove([index.images() - 1])  # all workers must map it again
            with self.assertRaisesRegex(opencv_iib.error, re.escape(name)):
                shards.search(self.folder, self.queries, 5, client)

    @unittest.skipIf(distributed is None, 'no dask.distributed')
    def test_all_workers_die_together(self):
        shards.write(self.folder, self.codes, 57)
        with workers(2) as client:
            self.expect_found(self.while_workers_die(client, 2), 5)  # nannies start new workers
        with workers(0) as client, mock.patch.object(shards, '_WITHOUT_WORKERS', 1), self.assertRaisesRegex(RuntimeError, 'no worker'):
            shards.search(self.folder, self.queries, 5, client)

    @unittest.skipIf(distributed is None, 'no dask.distributed')
    def test_all_workers_die_before_a_result_is_fetched(self):
        shards.write(self.folder, self.codes, 57)
        wait = distributed.wait
        with workers(2) as client:
            processes = list(client.run(os.getpid).values())

            def wait_and_kill(*arguments):
                finished = wait(*arguments)
                while processes:
                    os.kill(processes.pop(), signal.SIGKILL)
                return finished
            found = []
            with mock.patch('distributed.wait', wait_and_kill):
                thread = threading.Thread(target=lambda: found.append(shards.search(self.folder, self.queries, 5, client)), daemon=True)
                thread.start()
                thread.join(60)
            self.assertFalse(thread.is_alive())
            self.expect_found(found[0], 5)

    def while_workers_die(self, client, count):
        """A search whose workers are stopped before it, and killed once they have their shards."""
        found = []
        processes = list(client.run(os.getpid).values())[:count]
        for process in processes:
            os.kill(process, signal.SIGSTOP)
        thread = threading.Thread(target=lambda: found.append(shards.search(self.folder, self.queries, 5, client)))
        thread.start()
        thread.join(.5)
        self.assertTrue(thread.is_alive())  # the search waits for workers
        for process in processes:
            os.kill(process, signal.SIGKILL)
        thread.join(60)
        self.assertFalse(thread.is_alive())
        return found[0]
