# This file is part of OpenCV project.
# It is subject to the license terms in the LICENSE file found in the top-level directory
# of this distribution and at http://opencv.org/license.html.
"""The short names of C++ in Python: cv2.iib.IIB is cv2.iib.IIBDescriptorExtractor, cv2.iib.IIB_create its create, and
so on. OpenCV's generator of bindings does not see the typedef. cv2's loader adds everything else of the module."""

import cv2


def _short_names(native):
    long_name = 'IIBDescriptorExtractor'
    return {name.replace(long_name, 'IIB', 1): value
            for name, value in vars(native).items() if name == long_name or name.startswith(long_name + '_')}


globals().update(_short_names(cv2.iib))
