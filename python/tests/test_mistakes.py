"""Messages for mistakes name the argument in words of Python, and say what to do."""
import inspect
from pathlib import Path
from unittest import mock

import numpy as np

import opencv_iib
from opencv_iib import HessianDetector, HierarchicalMatcher, IIB, MappedIndex, NormalizedDetector
from opencv_iib import shards
from opencv_iib.align import align
from opencv_iib.colmap import FeatureOptions, Options, build_database
from opencv_iib.localization import Camera, Localizer, Location, build, localize_images, smooth_poses, update
from opencv_iib.measure import match_images
from support import InFolder, cv2, grid, texture


class Texts(InFolder):

    def expect(self, kind, text, call):
        with self.subTest(text), self.assertRaisesRegex(kind, text):
            call()

    def test_images(self):
        planes = np.zeros((3, 40, 60), np.uint8)
        for use in (lambda image: IIB().compute(image, grid()), opencv_iib.detect_and_describe, HessianDetector().detect,
                    IIB().detectAndCompute, lambda image: opencv_iib.matchRotated(image, image, IIB(), HierarchicalMatcher())):
            self.expect(TypeError, 'did cv2.imread find the file', lambda: use(None))
            for path in ('a.png', Path('a.png')):
                self.expect(TypeError, 'pass the image', lambda: use(path))
            self.expect(opencv_iib.error, 'channels come last', lambda: use(planes))

    def test_detectors_and_codes(self):
        for make in (IIB.createFor, IIB().setDetector, NormalizedDetector):
            self.expect(TypeError, r'cv2.ORB_create\(\)', lambda: make('ORB'))
        if cv2 is not None:
            self.expect(TypeError, r'cv2.SIFT_create\(\)', lambda: IIB.createFor(cv2.SIFT))
        floats, codes = np.zeros((5, 128), np.float32), np.zeros((5, 128), np.uint8)
        for use in (lambda a: opencv_iib.match(a, codes), lambda a: opencv_iib.match(codes, a), HierarchicalMatcher().add):
            self.expect(opencv_iib.error, 'uint8, not float32', lambda: use(floats))
        self.expect(TypeError, 'HierarchicalMatcher is needed, not IIB',
                    lambda: opencv_iib.matchRotated(texture(40, 40), texture(40, 40), IIB(), IIB()))

    @mock.patch('warnings.warn')
    def test_no_call_shows_the_types_of_cpp_or_ends_in_a_bare_error(self, _):
        index = MappedIndex.create(self.folder, [8])
        index.add(np.zeros((3, 8), np.uint8))
        owners = (IIB(), HessianDetector(), NormalizedDetector(HessianDetector()), HierarchicalMatcher(), index, Camera.parse('PINHOLE,9,9,9,9,4,4'))
        calls = [getattr(opencv_iib, name) for name in opencv_iib.__all__ if inspect.isfunction(getattr(opencv_iib, name))]
        calls += [method for owner in owners for name, method in inspect.getmembers(owner, inspect.isroutine) if name[0] != '_']
        shapes = [[[]], ((),), *(np.zeros(shape, kind) for shape in ((5, 0), (0, 5), (5,), (0,), (1, 1), (2, 2, 2, 2), (3, 0, 3), (0, 0, 3))
                                 for kind in (np.uint8, np.float32))]
        count = 0
        for call in calls + [type(owner) for owner in owners]:
            parameters = inspect.signature(call).parameters.values()
            needed = [parameter.name for parameter in parameters if parameter.default is inspect.Parameter.empty]
            given = [dict.fromkeys(needed, array) for array in shapes]
            for parameter in parameters:
                is_file = parameter.name.lower() == 'filename'
                given += [{**dict.fromkeys(needed, np.zeros((3, 8), np.uint8)), parameter.name: object() if is_file and isinstance(wrong, str) else wrong}
                          for wrong in (object(), 'x', 1 << 70, -1.5, None, [object()], float('nan'))]
            for arguments in given:
                count += 1
                with self.subTest(call=call, arguments=arguments):
                    try:
                        call(**arguments)
                    except (TypeError, ValueError, AttributeError, opencv_iib.error) as e:
                        self.assertNotRegex(str(e), 'incompatible function arguments|std::')
        self.assertGreater(count, 500)

    def test_arrays_without_numbers(self):
        image, points = texture(60, 60), grid()
        for matches in ([[]], ((),), ((), ()), np.zeros((5, 0), np.int32), np.zeros((0, 2), np.int32), np.zeros(0), []):
            for found in (opencv_iib.refineMatches(image, points, image, points, matches), opencv_iib.propagateMatches(image, points, image, points, matches)[1:]):
                self.assertEqual([(a.shape, a.dtype) for a in found], [(shape, np.float32) for shape in ((0, 2), (0, 2), (0, 3), (0,))])
            self.expect(opencv_iib.error, '0 matches', lambda: opencv_iib.estimateRotation(points, points, matches))
        self.assertFalse(opencv_iib.findRelativePose(np.zeros((9, 0)), np.zeros((9, 0)), np.eye(3), np.eye(3)).found)
        for flat in (np.zeros(5, np.uint8), np.zeros(0, np.uint8), np.zeros((5, 0), np.uint8)):
            for orientation in (1, 6):
                for given in ((flat, 9, None), (image, 9, flat)):
                    if flat.ndim == 1 and flat.size:
                        self.expect(opencv_iib.error, '2 or 3 dimensions', lambda: opencv_iib.detect_and_describe(*given, orientation))
                    else:  # None for an image and a mask, like OpenCV's classes
                        opencv_iib.detect_and_describe(*given, orientation)

    def test_numbers(self):
        self.expect(ValueError, 'maxFeatures is 3000000000', lambda: HessianDetector(3000000000))
        self.expect(TypeError, 'granularity: an integer is needed, not 2.5', lambda: IIB(granularity=2.5))
        self.expect(TypeError, "sigma: a number is needed, not '3'", lambda: HessianDetector().setSigma('3'))
        image = np.zeros((40, 40), np.longdouble)
        self.expect(opencv_iib.error, 'CV_64F', lambda: IIB().compute(image, grid()))
        np.testing.assert_array_equal(IIB().compute(texture(40, 40), grid().astype(np.longdouble))[1],
                                      IIB().compute(texture(40, 40), grid())[1])
        points = grid()
        for index in (1 << 32, -(1 << 32)):
            self.expect(opencv_iib.error, 'match', lambda: opencv_iib.estimateRotation(points, points, np.array([[0, 0], [1, 1], [index, 2]])))

    def test_keypoints_in_lists(self):
        image, rows = texture(60, 60), [[20, 20, 5], (30, 30, 6)]
        np.testing.assert_array_equal(opencv_iib.refineMatches(image, rows, image, rows, np.array([[0, 0], [1, 1]])).points1,
                                      [[20, 20], [30, 30]])
        self.expect(opencv_iib.error, 'keypoints are objects', lambda: opencv_iib.refineMatches(image, [[20, 20]], image, rows, []))
        self.expect(TypeError, 'keypoints: an array of numbers', lambda: opencv_iib.refineMatches(image, [[1, 2, 'x']], image, rows, []))

    def test_cameras_and_places(self):
        camera = Camera.parse('PINHOLE,640,480,500,500,320,240')
        for wrong in (3, None, b'PINHOLE'):
            self.expect(TypeError, "'MODEL,WIDTH,HEIGHT,PARAMS' is needed", lambda: Camera.parse(wrong))
        self.expect(ValueError, 'points: an array of N x 3 is needed, not of 1 x 2', lambda: camera.project([[0, 0]]))
        self.expect(TypeError, 'pixels: an array of numbers', lambda: camera.undistorted('x'))
        np.testing.assert_array_equal(camera.project([[0, 0, 1]]), [[319.5, 239.5]])
        self.expect(TypeError, 'PathLike', lambda: Localizer(None))
        self.expect(TypeError, 'points: an integer', lambda: Localizer(self.folder, 'x'))
        self.expect(ValueError, 'points is 3000000000', lambda: Localizer(self.folder, 3000000000))
        self.expect(TypeError, "locations: what Localizer.localize finds is needed, not 'x'", lambda: smooth_poses([1], ['x'], np.zeros((1, 7))))
        self.expect(TypeError, 'readings', lambda: smooth_poses([], [], 'x'))
        self.expect(ValueError, 'come together', lambda: Location(np.eye(4)))

    def test_plain_values(self):
        codes, readings = np.zeros((5, 8), np.uint8), np.zeros((1, 7))
        for text, *arguments in (('rows_per_shard: an integer', codes, (3, 5)), ('rows_per_shard: an integer', codes, 1.5), ('codes: an array, or', None),
                                 ('codes: an array of numbers', 'x'), ('levelSizes: a sequence', codes, 5, 'x')):
            self.expect(TypeError, text, lambda: shards.write(self.folder / 'sh', *arguments))
        self.expect(ValueError, 'at least 1 is needed', lambda: shards.write(self.folder / 'sh', codes, 0))
        for flat in (codes[0], [codes[0]]):
            self.expect(ValueError, 'codes: rows x bytes are needed', lambda: shards.write(self.folder / 'sh', flat))
        self.assertEqual(shards.write(self.folder / 'sh', codes).rows(), 5)
        for workers in ('x', 2.5):
            for call in (lambda: build(self.folder, self.folder, self.folder / 'map', workers=workers),
                         lambda: update(self.folder, self.folder, workers=workers),
                         lambda: localize_images(self.folder, self.folder, self.folder / 'out', workers=workers),
                         lambda: align(self.folder, [], self.folder / 'out', workers=workers),
                         lambda: build_database(self.folder, self.folder / 'x.db', workers=workers)) if cv2 is not None else ():
                self.expect(TypeError, f'workers: an integer is needed, not {workers!r}', call)
        self.expect(TypeError, 'keypoints: an array of numbers', lambda: opencv_iib.array_to_keypoints('x'))
        self.expect(ValueError, 'N x 7 is needed, .* not of 3 x 2', lambda: opencv_iib.array_to_keypoints(np.zeros((3, 2))))
        for wrong in ([1], 'x', None, 3, [None]):
            self.expect((TypeError, AttributeError), 'keypoints: a sequence of objects like cv2.KeyPoint is needed', lambda: opencv_iib.keypoints_to_array(wrong))
        self.expect(TypeError, 'locations: a sequence', lambda: smooth_poses([1], None, readings))
        self.expect(TypeError, 'a pose: an array of numbers', lambda: smooth_poses([1], [Location()], readings, 'x'))
        for wrong in (3, None):
            self.expect(TypeError, 'expected str, bytes or os.PathLike', lambda: update(wrong, self.folder))
            self.expect(TypeError, 'expected str, bytes or os.PathLike', lambda: update(self.folder, wrong))
        for distance in (float('nan'), -1):
            self.expect(opencv_iib.error, 'maxDistance is .*: it must be more than 0', lambda: HierarchicalMatcher().radiusMatch(codes, codes, distance))
        for field, wrong in (('points', 2.5), ('max_size', 'x')):
            self.expect(TypeError, field + ': an integer', FeatureOptions(**{field: wrong}).check)
        for field, wrong in (('focal', 'x'), ('neighbours', 1.5), ('ratio', None), ('camera_of', 'x=y')):
            self.expect(TypeError, f'{field}: .* is needed, not {wrong!r}', Options(**{field: wrong}).check)
        for wrong in ({'verify': 3}, {'camera_model': None}, {'camera_of': [3]}):
            self.expect(ValueError, 'must be|there are', Options(**wrong).check)
        (self.folder / 'a.png').touch()
        self.expect(TypeError, 'images: a sequence of paths', lambda: align(self.folder / 'a.png', 'x', self.folder / 'out'))
        self.expect(TypeError, 'cameras: a sequence of cameras', lambda: match_images('a', 'b', cameras='PINHOLE,9,9,9,9,4,4'))

    def test_presets_by_name(self):
        for name in ('COMPACT', 'compact', 'PRESET_Compact'):
            self.assertEqual(IIB.createFor(HessianDetector(), name).descriptorSize(), 64)
            self.assertEqual(IIB.createPreset(name, 3).descriptorSize(), 64)
        self.expect(ValueError, "no preset 'LARGE', but S128, .*SMALL", lambda: IIB.createFor(HessianDetector(), 'LARGE'))

    def test_a_preset_takes_the_scale_factor_of_orb_with_a_word(self):
        with self.assertWarnsRegex(UserWarning, 'scaleFactorFor'):
            self.assertEqual(IIB.createPreset(IIB.PRESET_BALANCED).getScaleFactor(), 2.25)

    def test_paths(self):
        matcher = HierarchicalMatcher([8])
        matcher.add(np.zeros((3, 8), np.uint8))
        for name in (b'\xe9', 'caf\xe9'.encode()):
            path = self.folder / name.decode('utf-8', 'surrogateescape')
            MappedIndex.create(path, [8]).add(np.zeros((3, 8), np.uint8))
            self.assertEqual(MappedIndex(path).rows(), 3)
            matcher.saveIndex(path.with_suffix('.iib'))
            self.assertEqual(HierarchicalMatcher.loadIndex(path.with_suffix('.iib')).levelSizes(), (8,))
            self.expect(opencv_iib.error, str(path), lambda: MappedIndex(path / 'none'))
        kept = sorted(self.folder.iterdir())
        for use in (IIB().save, IIB().write, IIB().read, matcher.saveIndex, HierarchicalMatcher.loadIndex, MappedIndex,
                    lambda path: MappedIndex.create(path, [8])):
            self.expect(ValueError, 'null', lambda: use(f'{self.folder}/a\0b.yml'))
            self.expect(TypeError, 'str, bytes or os.PathLike', lambda: use(7.5))
        self.assertEqual(sorted(self.folder.iterdir()), kept)

    def test_match_rotated_checks_arguments_before_it_detects(self):
        class Never:
            def detect(self, image, mask):
                raise AssertionError('it detects')
        iib = IIB()
        iib.setDetector(Never())
        for rotation, orientation in ((400, IIB.ORIENTATION_KEYPOINT), (-1, IIB.ORIENTATION_NONE)):
            iib.setOrientation(orientation)
            with self.assertRaisesRegex(opencv_iib.error, 'rotation|orientation'):
                opencv_iib.matchRotated(texture(40, 40), texture(40, 40), iib, HierarchicalMatcher(), rotation)
