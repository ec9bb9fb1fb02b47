"""Names of classes, functions and constants."""
import importlib.metadata
import inspect
import operator
import pathlib
import pkgutil
import pydoc
import re
import subprocess
import sys
import traceback
import typing
import unittest

import opencv_iib

CLASSES = ('IIBDescriptorExtractor', 'HierarchicalMatcher', 'HessianDetector', 'NormalizedDetector', 'MappedIndex')


class Names(unittest.TestCase):

    def test_all_that_cv2_has_is_here(self):
        for line in pathlib.Path(__file__).with_name('cv2_names.txt').read_text().splitlines():
            name, *rest = line.split(' ')
            with self.subTest(name):
                here = operator.attrgetter(name)(opencv_iib)
                if isinstance(here, int):
                    self.assertEqual([str(int(here))], rest)
                else:
                    self.assertLessEqual(set(rest), set(inspect.signature(here).parameters))

    def test_constants(self):
        iib = opencv_iib.IIB
        for owner, enum, prefix in ((iib, opencv_iib.Mapping, 'MAPPING_'), (iib, opencv_iib.Border, 'BORDER_'), (iib, opencv_iib.Preset, 'PRESET_'),
                                    (iib, opencv_iib.Orientation, 'ORIENTATION_'), (opencv_iib.HierarchicalMatcher, opencv_iib.Mode, '')):
            for name, member in enum.__members__.items():
                self.assertIs(getattr(owner, prefix + name), member)
        for name, member in opencv_iib.Channel.__members__.items():
            self.assertIs(getattr(iib, 'CHANNELS_DEFAULT' if name == 'DEFAULT' else 'CHANNEL_' + name), member)

    def test_getters_return_them_and_there_are_no_others(self):
        iib, matcher = opencv_iib.IIB(channels=59, granularity=5), opencv_iib.HierarchicalMatcher([8, 8])  # every value is valid
        for enum, use, get in ((opencv_iib.Mapping, iib.setMapping, iib.getMapping), (opencv_iib.Border, iib.setBorder, iib.getBorder),
                               (opencv_iib.Mode, matcher.setMode, matcher.getMode), (opencv_iib.Orientation, iib.setOrientation, iib.getOrientation),
                               (opencv_iib.Preset, lambda preset: iib.createPreset(preset, 2), None)):
            for member in enum:
                use(int(member))
                self.assertTrue(get is None or get() is member)
            with self.assertRaises(opencv_iib.error, msg=enum):
                use(len(enum))

    def test_one_version(self):
        self.assertEqual(opencv_iib.__version__, importlib.metadata.version('opencv-iib'))
        self.assertRegex(opencv_iib.OPENCV_VERSION, r'^[45]\.\d')

    def test_the_program(self):
        program, = [e for e in importlib.metadata.distribution('opencv-iib').entry_points if e.group == 'console_scripts']
        self.assertEqual((program.name, program.load().__name__), ('opencv-iib', 'main'))

    def test_every_public_name_is_documented(self):
        modules = [importlib.import_module(m.name) for m in pkgutil.walk_packages(opencv_iib.__path__, 'opencv_iib.')
                   if '._' not in m.name]
        self.assertGreater(len(modules), 20)
        public = {f'{module.__name__}.{name}': value for module in [opencv_iib, *modules]
                  for name, value in vars(module).items()
                  if not name.startswith('_') and getattr(value, '__module__', '') == module.__name__}
        for name, value in list(public.items()):
            if inspect.isclass(value):
                public.update({f'{name}.{member}': getattr(value, member) for member in vars(value)
                               if not member.startswith('_')})
        self.assertEqual([name for name, value in public.items()
                          if callable(value) and not (value.__doc__ or '').strip()], [])

    def test_methods_have_signatures_and_docstrings_wherever_they_are_written(self):
        for name in CLASSES:
            owner = getattr(opencv_iib, name)
            for member, method in inspect.getmembers(owner, inspect.isroutine):
                if not member.startswith('_'):
                    with self.subTest(owner=name, member=member):
                        self.assertTrue(method.__doc__)
                        self.assertTrue(inspect.signature(method))
                        self.assertIn('return', typing.get_type_hints(method))
        shown = pydoc.plain(pydoc.render_doc(opencv_iib.HessianDetector))
        shown = re.sub(r'[\s|]+', ' ', shown).replace('( ', '(')  # Python 3.13 breaks long lines
        self.assertRegex(shown, r"HessianDetector\(maxFeatures: '?int'? = 1000, threshold: '?float'? = 0.0, scales: '?int'? = 5, sigma: '?float'? = 2.2, ")
        self.assertRegex(shown, r"setSigma\(self, sigma: '?float'?\) -> '?None'? Sigma of the smallest scale in pixels, 1.5 to 8\. ")

    def test_help_and_star_import_see_the_classes(self):
        names = {}
        exec('from opencv_iib import *', names)
        self.assertEqual(set(opencv_iib.__all__) - set(names), set())
        for name in (*CLASSES, 'IIB', 'DMatch', 'KeyPoint', 'error', 'estimateRotation'):
            self.assertIn(name, names)
            self.assertIn(name, pydoc.plain(pydoc.render_doc(opencv_iib)))

    def test_nothing_is_printed_of_what_another_thread_holds_at_the_end(self):
        program = ('import threading, time, opencv_iib\nmatcher = opencv_iib.HierarchicalMatcher()\n'
                   'threading.Thread(target=lambda: (time.sleep(60), matcher), daemon=True).start()')
        done = subprocess.run([sys.executable, '-c', program], capture_output=True, text=True, check=True)
        self.assertEqual(done.stdout + done.stderr, '')

    def test_an_error_is_what_went_wrong_without_paths(self):
        with self.assertRaises(opencv_iib.error) as caught:
            opencv_iib.IIB.create(-1)
        self.assertRegex(traceback.format_exception_only(opencv_iib.error, caught.exception)[0], '^opencv_iib.error: scaleFactor')
        self.assertNotIn('/', str(caught.exception))
