"""Prints what OpenCV's generator makes of the C++ headers for cv2.iib: constants, methods and functions with their arguments.

scripts/intree.sh compares it with cv2_names.txt, and test_names.py that with the package.
"""
import inspect
import re

import cv2


def inputs(doc):
    """Required arguments of a call, and optional ones that are no results, from the first line of its docstring."""
    given, results = re.match(r'\w+\((.*)\) -> (.*)', doc).groups()
    must, *may = given.split('[', 1)
    names = re.findall(r'\w+', must) + [name for name in re.findall(r'\w+', ''.join(may)) if name not in results.split(', ')]
    return ' '.join(names)


found = []
for name, value in vars(cv2.iib).items():
    if inspect.isclass(value):
        found += [f'{name}.{method} {inputs(call.__doc__)}' for method, call in vars(value).items()
                  if inspect.ismethoddescriptor(call) and not isinstance(call, staticmethod) and not method.startswith('_')]
    elif isinstance(value, int) and not re.match('[A-Z]+_', name):  # others are the same in OpenCV's older spelling
        found.append(f'{name.replace("_", ".", 1)} {value}')
    elif inspect.isbuiltin(value):  # functions, and those of classes
        found.append(f'{name.replace("_", ".", 1)} {inputs(value.__doc__)}')
print('\n'.join(line.rstrip() for line in sorted(found) if not line.startswith('IIB.')))  # which is IIBDescriptorExtractor
