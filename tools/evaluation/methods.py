# SPDX-License-Identifier: Apache-2.0

"""Points and descriptors, matches, and poses from them with their errors."""
import functools
import math

import cv2
import numpy as np
import opencv_iib
from datasets import noise, read_image

try:
    import poselib
except ImportError:
    poselib = None

CHAIN, UNIVERSAL = ('Hessian', 'IIB UNIVERSAL'), 'IIB UNIVERSAL'
MAGSAC, POSELIB = (.75, 1), (.5, 1)  # thresholds in pixels
SIFT_SIGMA, SIFT_LAYERS = 1.6, 3  # of SIFT's first level, pixels
CLIP = 2  # of CLAHE, the choice of OpenCV's tutorials
# Gamma, brightness at the left, right, top and bottom, noise: deep shadows to the right; bright; dark from above.
LIGHTS = (2.2, 1, .25, 1, 1, 2), (.45, 1, 1, 1, 1, 3), (1.5, .3, .3, .4, 1.2, 4)


DETECTORS = {'Hessian': opencv_iib.HessianDetector, 'SIFT': lambda count: cv2.SIFT_create(), 'ORB': cv2.ORB_create,
             'AKAZE': lambda count: cv2.AKAZE_create(cv2.AKAZE_DESCRIPTOR_MLDB_UPRIGHT)}


def detector_of(name, count):
    """A detector, which also describes, perhaps on the locally normalized image."""
    made = DETECTORS[name.split()[0]](count)
    return opencv_iib.NormalizedDetector(made) if name.endswith('normalized') else made


def strongest(keypoints, count):
    """The strongest points without the copies that several orientations make, upright."""
    upright = {}
    for point in keypoints:
        point.angle = 0
        upright[(*point.pt, point.size)] = point
    return sorted(upright.values(), key=lambda point: (-point.response, point.pt[1], point.pt[0], point.size))[:count]


def leveled(keypoints):
    """Keypoints of another detector with the level of SIFT's pyramid that their sizes fit; SIFT reads it from a keypoint."""
    for k in keypoints:
        above = math.log2(k.size / 2 / SIFT_SIGMA)
        octave = max(-1, math.floor(above - 1 / SIFT_LAYERS + 1e-6))
        k.octave = (octave & 255) | (max(0, min(SIFT_LAYERS, round(SIFT_LAYERS * (above - octave)))) << 8)
    return keypoints


def relit(image, light):
    """Changes the light of a grey image, and adds a sensor's noise."""
    gamma, left, right, top, bottom, sigma = LIGHTS[light]
    out = cv2.pow(image.astype(np.float32) * np.float32(1 / 255), gamma) * np.float32(255)
    y, x = (np.arange(n) / n for n in image.shape)
    return cv2.add(np.float32(out * (left + (right - left) * x) * (top + (bottom - top) * y)[:, None] + noise(image.shape, sigma, light + 1)), 0, dtype=cv2.CV_8U)


@functools.lru_cache(16)
def picture(file, sigma=0, light=None):
    """An image as it is, with noise, or in another light."""
    image = read_image(file)
    if light is not None:
        return relit(image, light)
    return cv2.add(image, noise(image.shape, sigma, 1), dtype=cv2.CV_8U) if sigma else image


@functools.lru_cache(400)
def described(detector, descriptor, count, *change):
    """The strongest points of an image, changed as by `picture`: rows of x, y and size, and descriptors."""
    image = picture(*change)
    if detector == 'SIFT CLAHE':
        image = cv2.createCLAHE(CLIP).apply(image)
    points = detector_of(detector, count).detect(image)
    points = list(points) if detector == 'Hessian' else strongest(points, count)
    if descriptor.startswith('IIB '):
        feature = opencv_iib.IIBDescriptorExtractor.createPreset(descriptor[4:], opencv_iib.IIBDescriptorExtractor.scaleFactorFor(detector.split()[0]))
    else:
        feature = detector_of(descriptor.replace('Root', ''), count)
        points = leveled(points) if detector == 'Hessian' else points
    points, codes = feature.compute(image, points)
    if descriptor == 'RootSIFT':  # Arandjelovic and Zisserman, CVPR 2012
        codes = np.sqrt(codes / np.maximum(1e-9, np.abs(codes).sum(axis=1, keepdims=True)))
    return np.array([(*k.pt, k.size) for k in points], np.float32).reshape(-1, 3), codes


def nearest(codes1, codes2):
    """Pairs of mutual nearest neighbours, and each distance over that of the second neighbour."""
    if codes1 is None or codes2 is None or len(codes1) == 0 or len(codes2) < 2:
        return np.empty((0, 2), np.int32), np.empty(0)
    matcher = cv2.BFMatcher(cv2.NORM_HAMMING if codes1.dtype == np.uint8 else cv2.NORM_L2)
    back = matcher.match(codes2, codes1)
    kept = [two for two in matcher.knnMatch(codes1, codes2, 2) if back[two[0].trainIdx].trainIdx == two[0].queryIdx]
    return (np.array([(m.queryIdx, m.trainIdx) for m, _ in kept], np.int32).reshape(-1, 2),
            np.array([m.distance / second.distance if second.distance > 0 else 1 for m, second in kept], np.float32))


def matched(descriptor, codes1, codes2):
    """Mutual nearest neighbours under a ratio: .92 of IIB, .9 of other bits, .8 of numbers."""
    pairs, ratios = nearest(codes1, codes2)
    return pairs[ratios < np.float32(.8 if 'SIFT' in descriptor else .92 if descriptor.startswith('IIB') else .9)]


def moved(images, rows, pairs, call=opencv_iib.propagateMatches):
    """Points of refined matches in both images, also of propagated ones."""
    if not len(pairs):
        return np.empty((2, 0, 2))
    found = call(images[0], rows[0], images[1], rows[1], pairs)
    return np.array([found.points1, found.points2], float)


def error_of(R, t, pair):
    """The larger angle in degrees of rotation and direction."""
    t = np.ravel(t)
    cosines = (np.trace(R.T @ pair.R) - 1) / 2, t @ pair.t / np.linalg.norm(t) / np.linalg.norm(pair.t)
    return max(math.degrees(math.acos(max(-1, min(1, cosine)))) for cosine in cosines)


def by_find_relative_pose(points, pair):
    """The error of the pose, infinite without one, and the number of inliers; so are the others."""
    pose = opencv_iib.findRelativePose(*points, *pair.cameras)
    return (error_of(pose.R, pose.t, pair), int(pose.inliers.sum())) if pose.found else (math.inf, 0)


def by_magsac(points, pair, threshold):
    if len(points[0]) < 6:
        return math.inf, 0
    rays = [(each - K[:2, 2]) / K[[0, 1], [0, 1]] for each, K in zip(points, pair.cameras)]
    E, mask = cv2.findEssentialMat(*rays, np.eye(3), cv2.USAC_MAGSAC, .9999, threshold / pair.cameras[1][0, 0])
    if E is None or len(E) != 3:
        return math.inf, 0
    inliers = cv2.countNonZero(mask)
    _, R, t, _ = cv2.recoverPose(E, *rays, np.eye(3), mask=mask)
    return error_of(R, t, pair), inliers


def by_poselib(points, pair, threshold):
    if len(points[0]) < 5:
        return math.inf, 0
    cameras = ({'model': 'PINHOLE', 'width': 1, 'height': 1, 'params': K[[0, 1, 0, 1], [0, 1, 2, 2]]} for K in pair.cameras)
    pose, info = poselib.estimate_relative_pose(*(each.copy() for each in points), *cameras, {'max_epipolar_error': threshold}, {})
    return error_of(pose.R, pose.t, pair), info['num_inliers']


def estimators():
    """Estimators by name; PoseLib's where pip has installed it."""
    found = {'findRelativePose': by_find_relative_pose}
    for name, estimate, thresholds in (('MAGSAC', by_magsac, MAGSAC), ('PoseLib', by_poselib, POSELIB if poselib else ())):
        found.update({'%s %g px' % (name, threshold): functools.partial(estimate, threshold=threshold) for threshold in thresholds})
    return found


def by_views(images, count):
    """Whether the matches are significant, and the points of matches in both images; so are the other ways to match images."""
    found = opencv_iib.matchViews(*images, count)
    return found.found, np.array([found.points1, found.points2], float)


def by_chain(images, count):
    features = [opencv_iib.detect_and_describe(image, count) for image in images]
    pairs = opencv_iib.match(features[0].codes, features[1].codes).pairs
    return True, moved(images, [np.column_stack(each[:2]) for each in features], pairs)


def by_feature(create, ratio):
    """Mutual nearest neighbours under a ratio, by a method of OpenCV's."""
    def match(images, count):
        (points1, codes1), (points2, codes2) = (create(count).detectAndCompute(image, None) for image in images)
        pairs, ratios = nearest(codes1, codes2)
        pairs = pairs[ratios < np.float32(ratio)]
        return True, np.array([[points[k].pt for k in chosen] for points, chosen in ((points1, pairs[:, 0]), (points2, pairs[:, 1]))]).reshape(2, -1, 2)
    return match


WAYS = {'matchViews': by_views, 'upright chain': by_chain, 'SIFT': by_feature(cv2.SIFT_create, .8), 'ORB': by_feature(cv2.ORB_create, .9),
        'AffineFeature': by_feature(lambda count: cv2.AffineFeature_create(cv2.SIFT_create(count)), .8)}
