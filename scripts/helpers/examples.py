#!/usr/bin/env python3
"""Fails where an example for users is not the recommended chain: examples.py

A block of code of README.md, doc or the tutorials, or a sample, that makes an extractor or a matcher does so by
createRecommended. A block may make others beside it, or stand beside OpenCV's BFMatcher, whose place the matcher takes.
scripts/demo.sh, the Python package's commands and iib_localize have the same chain as their default.
"""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
EXTRACTOR = re.compile(r'\bIIB(?:DescriptorExtractor)?(?:::|\.)(?:create\w*)\(')
MATCHER = re.compile(r'\bHierarchicalMatcher(?:(?:::|\.)create\w*)?\(')
DEFAULTS = {
    'modules/iib/samples/iib_demo.cpp': ('IIBDescriptorExtractor::createRecommended(MAX_KEYPOINTS)',
                                         'HierarchicalMatcher::createRecommended()', 'MAX_KEYPOINTS = 1000,'),
    'python/opencv_iib/colmap/features.py': ("detector: str = 'HESSIAN'", "preset: str = 'UNIVERSAL'"),
    'python/opencv_iib/colmap/pipeline.py': ('ratio: float = .9', 'crossCheck=True'),
    'modules/iib_geometry/src/features.cpp': ('IIB::createRecommended(',),
    'modules/iib_geometry/src/localizer.cpp': ('HierarchicalMatcher::createRecommended()',),
    'python/opencv_iib/__main__.py': ('default=FeatureOptions.detector', 'default=FeatureOptions.preset'),
    'python/opencv_iib/demo.py': ('from opencv_iib.functions import match',),
    'python/opencv_iib/functions.py': ('matcher or HierarchicalMatcher.createRecommended())',),
}


def blocks():
    """Pairs of a place and a text: blocks of C++ and Python in pages, whole samples, the package's first lines."""
    pages = [ROOT / 'README.md', *sorted((ROOT / 'doc').glob('*.md')), *sorted((ROOT / 'modules/iib/tutorials').glob('*.markdown'))]
    for page in pages:
        text = page.read_text()
        for found in re.finditer(r'^```(?:cpp|python)\n(.*?)^```$', text, re.MULTILINE | re.DOTALL):
            yield '%s:%d' % (page.relative_to(ROOT), text.count('\n', 0, found.start()) + 1), found[1]
    for sample in sorted((ROOT / 'modules/iib/samples').glob('*.*')):
        if not sample.name.startswith('iib_demo'):  # which compares, see DEFAULTS
            yield str(sample.relative_to(ROOT)), sample.read_text()
    yield 'python/opencv_iib/__init__.py', (ROOT / 'python/opencv_iib/__init__.py').read_text().split('"""')[1]


def main():
    wrong, seen = [], 0
    for place, text in blocks():
        for pattern, name in ((EXTRACTOR, 'IIB'), (MATCHER, 'HierarchicalMatcher')):
            calls = pattern.findall(text)
            seen += len(calls)
            if name != 'IIB' and 'BFMatcher' in text:
                continue
            if calls and not any('createRecommended' in call for call in calls):
                wrong.append('%s makes %s other than by createRecommended' % (place, name))
    for place, texts in DEFAULTS.items():
        wrong += ['%s lacks %s' % (place, text) for text in texts if text not in (ROOT / place).read_text()]
    if seen < 10:
        wrong.append('only %d examples were found' % seen)
    sys.exit('\n'.join(wrong) or 0)


if __name__ == '__main__':
    main()
