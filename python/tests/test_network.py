"""Workers of Dask on machines of their own, network namespaces, whose cable is cut: scripts/helpers/servers_test.sh."""
import os
import shutil
import signal
import subprocess
import sys
import threading
import time
import unittest
from unittest import mock

import numpy as np

from collection import Collection
from opencv_iib import _parallel, shards
from opencv_iib.colmap import pipeline
from support import brute_force

NAMESPACE = os.environ.get('IIB_NETWORK')  # set inside the tests' network namespace

if NAMESPACE:
    import dask
    import distributed


def ip(*arguments):
    subprocess.run(['ip', *arguments], check=True)


@unittest.skipUnless(NAMESPACE, 'no network namespace: scripts/helpers/servers_test.sh makes one')
class NetworkTest(Collection):
    """A scheduler here and three workers, each with a cable to one switch."""

    WORKERS = ('one', 'two', 'three')

    @classmethod
    def setUpClass(cls):
        ip('link', 'add', 'switch', 'type', 'bridge')
        ip('address', 'add', '10.231.0.1/24', 'dev', 'switch')
        ip('link', 'set', 'switch', 'up')
        for number, name in enumerate(cls.WORKERS):
            ip('netns', 'add', name)
            ip('link', 'add', name, 'type', 'veth', 'peer', 'name', 'cable', 'netns', name)
            ip('link', 'set', name, 'master', 'switch')
            ip('-n', name, 'address', 'add', f'10.231.0.{number + 2}/24', 'dev', 'cable')
            for cable in ('lo', 'cable'):
                ip('-n', name, 'link', 'set', cable, 'up')

    def setUp(self):
        super().setUp()
        for name in self.WORKERS:
            ip('link', 'set', name, 'up')
        # By default a connection without answers counts as lost after half a minute, a silent worker after five.
        settings = {'distributed.comm.timeouts.tcp': '11s', 'distributed.comm.timeouts.connect': '4s',
                    'distributed.scheduler.worker-ttl': '5s'}
        configuration = dask.config.set(settings)
        self.addCleanup(configuration.__exit__, None, None, None)
        environment = {**os.environ, **{'DASK_' + name.upper().replace('.', '__').replace('-', '_'): value
                                        for name, value in settings.items()}}
        cluster = distributed.LocalCluster(n_workers=0, host='10.231.0.1', dashboard_address=None, silence_logs=50)
        self.addCleanup(cluster.close)
        self.client = distributed.Client(cluster)
        self.addCleanup(self.client.close)
        self.processes = {}
        for name in self.WORKERS:
            self.processes[name] = subprocess.Popen(
                ['ip', 'netns', 'exec', name, sys.executable, '-m', 'distributed.cli.dask_worker',
                 cluster.scheduler_address, '--no-nanny', '--nthreads', '1', '--no-dashboard', '--name', name],
                env=environment, cwd=self.folder, stderr=subprocess.DEVNULL)
            self.addCleanup(self.processes[name].wait)
            self.addCleanup(self.processes[name].kill)
        self.client.wait_for_workers(len(self.WORKERS), timeout=120)

    def names(self):
        return {worker['name'] for worker in self.client.scheduler_info(n_workers=-1)['workers'].values()}

    def expect_left(self, *names):
        """Checks that the scheduler knows only these workers, while the others still run."""
        for _ in range(100):
            if self.names() == set(names):
                break
            time.sleep(.1)
        self.assertEqual(self.names(), set(names))

    def test_search(self):
        rng = np.random.default_rng(8)
        codes, queries = rng.integers(0, 256, (400, 8), np.uint8), rng.integers(0, 256, (30, 8), np.uint8)
        folder = os.path.join(self.folder, 'codes')
        shards.write(folder, codes, 40)
        expected = [array.tobytes() for array in shards.search(folder, queries)]
        np.testing.assert_array_equal(shards.search(folder, queries)[0], brute_force(queries, codes, 5)[0])
        found = []
        self.processes['one'].send_signal(signal.SIGSTOP)  # it must have its shards when the cable is cut
        thread = threading.Thread(target=lambda: found.append(shards.search(folder, queries, 5, self.client)))
        thread.start()
        thread.join(1)
        self.assertTrue(thread.is_alive())
        ip('link', 'set', 'one', 'down')
        self.processes['one'].send_signal(signal.SIGCONT)
        thread.join(60)
        self.assertFalse(thread.is_alive())
        self.assertEqual([array.tobytes() for array in found[0]], expected)
        self.expect_left('two', 'three')
        ip('link', 'set', 'two', 'down')  # idle
        self.assertEqual([array.tobytes() for array in shards.search(folder, queries, 5, self.client)], expected)
        self.expect_left('three')

    def test_colmap(self):
        for n in range(9):
            shutil.copy(self.images / 'a.png', self.images / f'{n}.png')

        def cutting(method, name, count):
            """Wraps a method: its call with this number cuts a cable."""
            original, calls = getattr(pipeline.Database, method), []

            def call(*arguments):
                calls.append(arguments)
                if len(calls) == count:
                    ip('link', 'set', name, 'down')
                return original(*arguments)
            return mock.patch.object(pipeline.Database, method, call)

        self.build()
        expected = self.dump()
        with mock.patch.object(_parallel.Cluster, 'tile_side', 2), cutting('add_image', 'one', 3), cutting('add_pair', 'two', 10):
            self.build(client=self.client)
        self.assertEqual(self.dump(), expected)
        self.expect_left('three')
