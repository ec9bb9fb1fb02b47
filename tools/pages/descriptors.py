# SPDX-License-Identifier: Apache-2.0

"""What the page shows of a descriptor besides its results."""

# Descriptors of the main table, in its order, by licence of the code: name in the results of fixed points, and detector of the points
# that they are shown with. Unmeasured ones are left out.
ORB, HESSIAN, OWN = "ORB", "Hessian", ""
SHOWN = {
    "Apache-2.0": {"IIB": ORB, "IIB ACCURATE": ORB, "IIB COMPACT": ORB, "IIB BALANCED": ORB, "IIB VIEWPOINT": ORB,
                   "IIB UNIVERSAL": HESSIAN, "IIB SMALL": HESSIAN},
    "Apache-2.0 (OpenCV)": {"ORB": ORB, "BRISK": OWN, "AKAZE-486": OWN, "KAZE": OWN, "SIFT": OWN},
    "Apache-2.0 (opencv_contrib)": {"BEBLID-256": None, "BEBLID-256 5x": None, "BEBLID-512": ORB, "BEBLID-512 5x": None, "TEBLID-256": None,
                                    "TEBLID-256 5x": None, "TEBLID-512": ORB, "TEBLID-512 5x": None, "LATCH-512": ORB,
                                    "BRIEF-512": ORB, "FREAK": ORB, "DAISY": None},
    "not free": {"SURF": OWN}}
NOT_LEARNED = {"IIB", "BRISK", "AKAZE-486", "KAZE", "SIFT", "BRIEF-512", "DAISY", "SURF"}

# Changes other than light, kinds of change first, and their names on the page.
CHANGES = {"viewpoint": "other viewpoint", "zoom": "zoom and rotation", "blur": "blur", "jpeg": "compression"}

# Descriptors in the table of moved cameras and blur.
COMPARED = ("IIB", "IIB COMPACT", "IIB BALANCED", "IIB VIEWPOINT", "IIB UNIVERSAL", "ORB", "BRISK", "SIFT", "AKAZE-486",
            "BEBLID-512", "TEBLID-512", "LATCH-512")

# Learned descriptors that come with their own points and are entered in learned.csv: licence of the weights.
NETWORKS = {"XFeat": "Apache-2.0", "SuperPoint": "noncommercial research only", "ALIKE-n": "BSD-3-Clause", "ALIKED-n16": "BSD-3-Clause"}

# Lines of the table of turned and scaled images.
WARPED = ("IIB", "IIB oriented", "IIB VIEWPOINT", "IIB UNIVERSAL", "ORB oriented", "SIFT", "SIFT oriented", "BEBLID-512", "TEBLID-512", "LATCH-512")

# Rows of poses: points of a detector and what describes them, as people call them.
POSES = {("Hessian", "IIB UNIVERSAL"): "recommended chain", ("SIFT normalized", "SIFT"): "SIFT normalized",
         ("SIFT normalized", "IIB UNIVERSAL"): "SIFT normalized, IIB UNIVERSAL",
         ("SIFT", "SIFT"): "SIFT", ("AKAZE", "AKAZE"): "AKAZE", ("ORB", "ORB"): "ORB"}

# Whose matches the slider draws.
METHODS = {("Hessian", "IIB UNIVERSAL"): "recommended chain", ("AKAZE", "IIB"): "IIB at AKAZE's points", ("AKAZE", "AKAZE"): "AKAZE",
           ("ORB", "ORB"): "ORB", ("BRISK", "BRISK"): "BRISK", ("ORB", "BEBLID-512"): "BEBLID at ORB's points",
           ("SIFT", "SIFT"): "SIFT"}

# The paper's nine detectors, or the most similar ones that are available.
SUITS = ("AKAZE", "ORB", "BRISK", "SIFT", "SURF", "KAZE", "superpoint", "alike-n", "aliked-n16", "xfeat")

# Pairs of the slider by their second image: title and comment.
SCENES = {
    "view_overcast": ("street, sun and clouds", "The light is much the same, and soft: what the paper's first picture shows beside the next scene."),
    "night": ("street, noon and night", "The light comes from lamps and windows in place of the sun."),
    "street_winter": ("street, noon and winter", "A low sun: what lay in the shade is lit, and the other way round."),
    "facade_night": ("block of flats, noon and night", "One bay over and over: most of what looks alike is wrong."),
    "view_panned": ("street, noon and dusk, camera turned", "The camera turned by ten degrees to the left and three upwards."),
    "facade_turned": ("a failure: turned by 40 degrees",
                      "The camera is turned between noon and dusk. All are described upright here, and hardly anything is left. "
                      "matchRotated() is for such images: it finds the turn and describes the second image anew.")}
