"""Everything that the C++ headers offer to Python is there, by the same name and value."""
import importlib.metadata
import inspect
import pkgutil
import pydoc
import re
import subprocess
import sys
import traceback
import unittest

import opencv_iib
from support import REPOSITORY

HEADERS = {'IIBDescriptorExtractor': 'descriptor.hpp', 'HierarchicalMatcher': 'matcher.hpp',
           'HessianDetector': 'hessian_detector.hpp', 'NormalizedDetector': 'normalized_detector.hpp'}


def header(name):
    path = REPOSITORY / 'modules/iib/include/opencv2/iib' / name
    if not path.exists():
        raise unittest.SkipTest('the headers are not beside these tests')
    text = re.sub(r'/\*.*?\*/', '', path.read_text(), flags=re.S)
    return re.sub(r'//.*', '', text)


def enumerators(text):
    """Names of the enums, and names and values of their members."""
    for owner, body in re.findall(r'enum (\w+)\s*\{(.*?)\}', text, re.S):
        value = -1
        for member in filter(None, (m.strip() for m in body.split(','))):
            name, _, given = (part.strip() for part in member.partition('='))
            value = int(given, 0) if given else value + 1
            yield owner, name, value


class Names(unittest.TestCase):

    def test_constants(self):
        for owner, file in HEADERS.items():
            found = list(enumerators(header(file)))
            self.assertGreater(len(found), -1 if owner.endswith('Detector') else 2)
            for enum in {enum for enum, _, _ in found}:
                self.assertEqual(len(getattr(opencv_iib, enum).__members__), [e for e, _, _ in found].count(enum))
            for enum, name, value in found:
                with self.subTest(name):
                    short = re.sub(f'^{enum}S?_', '', name, flags=re.I)
                    self.assertIs(getattr(getattr(opencv_iib, owner), name), getattr(opencv_iib, enum)[short])
                    self.assertEqual(getattr(getattr(opencv_iib, owner), name), value)

    def test_methods_and_keywords(self):
        for owner, file in HEADERS.items():
            text = re.sub(r'\s+', ' ', header(file))
            calls = re.findall(r'CV_WRAP(?:_AS\((\w+)\))? (?:static |virtual )*[^;{(]*?(\w+)\(([^;{]*)\)(?: const)? ?(?:= 0)?[;{]',
                               text)
            self.assertGreater(len(calls), 3)
            for alias, name, arguments in calls:
                method = getattr(getattr(opencv_iib, owner), alias or name, None)
                with self.subTest(alias or name):
                    self.assertIsNotNone(method)
                    inputs = re.findall(r'(?:^|, )(?!OutputArray|CV_OUT (?!CV_IN_OUT))[^,]*?(\w+)(?: = [^,]*)?(?=,|$)',
                                        arguments)
                    self.assertLessEqual(set(inputs), set(inspect.signature(method).parameters))

    def test_every_method_has_one_name_and_a_place_in_a_file(self):
        for owner in (*HEADERS, 'MappedIndex'):
            methods = inspect.getmembers(getattr(opencv_iib, owner), inspect.isroutine)
            self.assertGreater(sum(not name.startswith('_') for name, _ in methods), 5)
            for name, method in methods:
                if not name.startswith('_'):
                    with self.subTest(f'{owner}.{name}'):
                        self.assertNotIn('_', name)
                        self.assertIn(f'def {name}(', inspect.getsource(method))

    def test_functions(self):
        calls = re.findall(r'CV_EXPORTS_W \w+ (\w+)\((.*?)\)', header('rotation.hpp') + header('refinement.hpp'), re.S)
        self.assertEqual([name for name, _ in calls], ['estimateRotation', 'matchRotated', 'matchRotated', 'refineMatches'])
        for name, arguments in calls:
            inputs = [re.search(r'(\w+)(?: = .*)?$', argument)[1] for argument in arguments.split(',')
                      if not re.search(r'CV_OUT (?!CV_IN_OUT)|OutputArray', argument)]
            self.assertLessEqual(set(inputs), set(inspect.signature(getattr(opencv_iib, name)).parameters))

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

    def test_help_and_star_import_see_the_classes(self):
        names = {}
        exec('from opencv_iib import *', names)
        self.assertEqual(set(opencv_iib.__all__) - set(names), set())
        for name in (*HEADERS, 'IIB', 'MappedIndex', 'DMatch', 'KeyPoint', 'error', 'estimateRotation'):
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
