"""Which pairs of images are matched."""
from unittest import mock

from collection import Collection
from opencv_iib.colmap import pairs as pair_lists
from opencv_iib.colmap import hloc, pipeline
from support import optional

h5py = optional('h5py')


class Pairs(Collection):

    def setUp(self):
        super().setUp()
        self.listing = self.folder / 'pairs.txt'

    def build_listed(self, text, encoding='utf-8', **options):
        self.listing.write_text(text, encoding)
        return self.build(pairs=str(self.listing), force=True, **options)

    def test_orders(self):
        self.assertEqual(sorted(pair_lists.exhaustive(7, 2)), [(a, b) for a in range(7) for b in range(a + 1, 7)])
        pairs = list(pair_lists.exhaustive(60))
        tiles = list(pair_lists.tiles(pairs, 8))
        self.assertEqual(sorted(pair for tile in tiles for pair in tile), sorted(pairs))
        self.assertLessEqual(max(len({image for pair in tile for image in pair}) for tile in tiles), 16)
        self.assertLess(len(tiles), 1.5 * len(pairs) / 64)
        self.assertEqual(list(pair_lists.tiles(pairs, 1)), [[pair] for pair in pairs])
        self.assertEqual(list(pair_lists.sequential(4, 2)), [(0, 1), (0, 2), (1, 2), (1, 3), (2, 3)])
        self.assertEqual(list(pair_lists.distinct([(1, 2), (2, 1), (0, 1), (1, 2)])), [(1, 2), (0, 1)])

    def test_lists(self):
        self.assertEqual(self.build_listed('# pairs\na.png more/c.png\n')['pairs'], 1)
        with mock.patch.object(pipeline, 'describe_images', side_effect=AssertionError), \
                self.assertRaisesRegex(ValueError, 'pairs.txt:1: not the names of two images'):
            self.build_listed('a.png nothing.png\n')
        (self.images / 'broken.png').write_bytes(b'no image')
        self.assertEqual(self.build_listed('a.png broken.png\nb.png a.png\n')['pairs'], 1)

    def test_retrieval(self):
        self.assertEqual(self.build(pairs='retrieval', neighbours=1)['images'], 3)
        self.assertIn(self.query('SELECT COUNT(*) FROM matches')[0][0], (2, 3))

    def test_each_pair_is_one_step(self):
        steps = []
        with mock.patch.object(pipeline.Progress, 'close', lambda progress: steps.append((progress.title, progress.done))):
            counts = self.build(pairs='retrieval', neighbours=2), self.build_listed('a.png b.png\nb.png a.png\n')
        self.assertEqual([each['pairs'] for each in counts], [3, 1])
        self.assertEqual(steps[1::2], [('matching', 3), ('matching', 1)])

    def test_names_that_lists_cannot_hold(self):
        for old, new in (('a.png', '#a.png'), ('b.png', 'b 1.png')):
            (self.images / old).rename(self.images / new)
        self.assertEqual(self.build(verify='auto')['verified pairs'], 3)
        with mock.patch.object(pipeline, 'colmap_binary', return_value='colmap'), \
                self.assertRaisesRegex(ValueError, '#a.png: .*blanks'):
            self.build(verify='colmap', force=True)
        self.assertEqual(self.build_listed('# a comment\nb 1.png  more/c.png\n\n#a.png\tb 1.png\n', 'utf-8-sig')['pairs'], 2)
        if h5py is not None:
            with self.assertRaisesRegex(ValueError, 'hloc.*rename'):
                hloc.export(str(self.database), *(str(self.folder / name) for name in ('f.h5', 'm.h5', 'list.txt')))
