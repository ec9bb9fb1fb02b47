"""Three shifted images of one picture, and the database that opencv_iib.colmap makes."""
import io
import os
import sqlite3
import unittest
from contextlib import closing, contextmanager, redirect_stderr
from unittest import mock

from opencv_iib.colmap import FeatureOptions, Options, build_database, pipeline
from support import InFolder, cv2, texture


@unittest.skipIf(cv2 is None, 'no cv2')
class Collection(InFolder):

    def setUp(self):
        super().setUp()
        self.images, self.database = self.folder / 'images', self.folder / 'database.db'
        (self.images / 'more').mkdir(parents=True)
        world = cv2.resize(texture(160, 120, seed=3), (640, 480), interpolation=cv2.INTER_CUBIC)
        for i, name in enumerate(('a.png', 'b.png', 'more/c.png')):
            cv2.imwrite(str(self.images / name), world[20 * i:300 + 20 * i, 30 * i:400 + 30 * i])
        self.lines = []

    def build(self, force=False, client=None, detector='HESSIAN', workers=2, **options):
        features = FeatureOptions(detector, points=options.pop('points', 300), max_size=options.pop('max_size', 0))
        with redirect_stderr(io.StringIO()):
            return build_database(str(self.images), str(self.database), Options(features, **{'verify': 'magsac', **options}), force,
                                  workers=workers, log=self.lines.append, client=client)

    def query(self, sql):
        with closing(sqlite3.connect(self.database)) as connection:
            return connection.execute(sql).fetchall()

    def dump(self):
        """All rows of all tables; removes the database."""
        with closing(sqlite3.connect(self.database)) as connection:
            rows = list(connection.iterdump())
        self.database.unlink()
        return rows

    def files(self):
        return sorted(os.listdir(self.folder))

    @contextmanager
    def ended_in(self, owner, name, number=1):
        """Checks that the block ends with Ctrl-C in this call of a function."""
        real, calls = getattr(owner, name), []

        def call(*arguments):
            calls.append(arguments)
            if len(calls) == number:
                raise KeyboardInterrupt
            return real(*arguments)
        with mock.patch.object(owner, name, call), self.assertRaises(KeyboardInterrupt):
            yield

    def interrupt(self):
        with self.ended_in(pipeline, 'magsac', 3):
            self.build(workers=1)
