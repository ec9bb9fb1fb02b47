# SPDX-License-Identifier: Apache-2.0

"""The figures of Lin et al., "Illumination-insensitive Binary Descriptor for Visual Measurement Based on Local
Inter-patch Invariance": natural mAP, natural mAR, synthetic mAP, synthetic mAR, by the names of our results."""

# Table "IIB_with_channels"
CHANNELS = {
    "IIB y": (0.8282, 0.6568, 0.8365, 0.6382),
    "IIB x": (0.8391, 0.6678, 0.8318, 0.6365),
    "IIB i": (0.8303, 0.6710, 0.7818, 0.5709),
    "IIB o": (0.7417, 0.5896, 0.7570, 0.5681),
    "IIB o+i": (0.8596, 0.7232, 0.8425, 0.6553),
    "IIB x+y": (0.9012, 0.7515, 0.9008, 0.7275),
    "IIB x+y+i": (0.9134, 0.7918, 0.9129, 0.7465),
    "IIB x+y+o": (0.9181, 0.7863, 0.9188, 0.7644),
    "IIB": (0.9187, 0.8041, 0.9210, 0.7655),
}

# Table "IIB_with_mapping_rules"; HAAR and PAIRWISE are not in the paper
MAPPINGS = {
    "IIB": (0.9187, 0.8041, 0.9210, 0.7655),
    "IIB max": (0.8639, 0.7270, 0.8568, 0.6771),
    "IIB min": (0.8629, 0.7238, 0.8584, 0.6787),
    "IIB quartile": (0.9270, 0.8139, 0.9314, 0.7796),
    "IIB sort": (0.9148, 0.7948, 0.9122, 0.7529),
    "IIB haar": None,
    "IIB pairwise": None,
}

# Table "IIB_with_overlaps"
OVERLAP = {
    "IIB": (0.9187, 0.8041, 0.9210, 0.7655),
    "IIB overlap": (0.9269, 0.8180, 0.9326, 0.7872),
}

# Table "IIB_with_granularities"
GRANULARITY = {
    "IIB g2": (0.5764, 0.3902, 0.5453, 0.3502),
    "IIB g3": (0.8368, 0.6808, 0.8163, 0.6129),
    "IIB": (0.9187, 0.8041, 0.9210, 0.7655),
    "IIB g5": (0.9414, 0.8368, 0.9473, 0.8251),
}

# Table "IIB_with_adaboost", whose last line differs from the other tables'
LEARNED = {
    "IIB S128": (0.7060, 0.5328, 0.6611, 0.4640),
    "IIB S256": (0.8221, 0.6590, 0.7837, 0.5816),
    "IIB S512": (0.8775, 0.7388, 0.8594, 0.6706),
    "IIB": (0.9157, 0.8005, 0.9173, 0.7556),
}

# Table "binary_comparsion" (as its label is spelled); float descriptors and TEBLID are not in it
BASELINES = {
    "IIB": (0.9187, 0.8041, 0.9210, 0.7655),
    "IIB x+y": (0.9012, 0.7515, 0.9008, 0.7275),
    "IIB g3": (0.8368, 0.6808, 0.8163, 0.6129),
    "ORB": (0.6096, 0.4193, 0.5737, 0.3622),
    "BRISK": (0.4138, 0.2537, 0.3708, 0.2178),
    "BEBLID-256": (0.7697, 0.5756, 0.7283, 0.4824),
    "BEBLID-512": (0.7914, 0.5951, 0.7514, 0.4990),
    "TEBLID-256": None,
    "TEBLID-512": None,
    "BRIEF-128": (0.5480, 0.3664, 0.5166, 0.3193),
    "BRIEF-256": (0.5968, 0.4068, 0.5634, 0.3505),
    "BRIEF-512": (0.6215, 0.4272, 0.5860, 0.3657),
    "LATCH-128": (0.5878, 0.4091, 0.5397, 0.3423),
    "LATCH-256": (0.6599, 0.4682, 0.6202, 0.3956),
    "LATCH-512": (0.7082, 0.5112, 0.6748, 0.4364),
    "FREAK": (0.6120, 0.4216, 0.4791, 0.2769),
    "SIFT": None,
    "IIB on AKAZE points": None,
    "AKAZE-128": (0.5698, 0.4109, 0.5251, 0.3599),
    "AKAZE-256": (0.6491, 0.4901, 0.6043, 0.4302),
    "AKAZE-486": (0.6922, 0.5342, 0.6545, 0.4706),
    "IIB on KAZE points": None,
    "KAZE": None,
}

# The tables under the questions that they answer, with plain names of those rows that are called by the paper's letters.
TABLES = (
    ("Which image channels", CHANNELS, {
        "IIB y": "vertical gradient", "IIB x": "horizontal gradient", "IIB i": "intensity",
        "IIB o": "direction of the gradient", "IIB o+i": "direction, intensity", "IIB x+y": "both gradients",
        "IIB x+y+i": "both gradients, intensity", "IIB x+y+o": "both gradients, direction",
        "IIB": "all four (default)"}),
    ("How four neighbours become bits", MAPPINGS, {
        "IIB": "above their mean (default)", "IIB max": "the largest", "IIB min": "the smallest",
        "IIB quartile": "quarter of their range", "IIB sort": "rank", "IIB haar": "halves and diagonals",
        "IIB pairwise": "above the next one"}),
    ("Overlapping quads", OVERLAP, {"IIB": "side by side (default)", "IIB overlap": "overlapping"}),
    ("How many levels", GRANULARITY, {
        "IIB g2": "2", "IIB g3": "3", "IIB": "4 (default)", "IIB g5": "5"}),
    ("Fewer bits, chosen by learning", LEARNED, {
        "IIB S128": "128 bits", "IIB S256": "256 bits", "IIB S512": "512 bits", "IIB": "all 1360 (default)"}),
    ("Other descriptors", BASELINES, {"IIB x+y": "IIB, both gradients alone", "IIB g3": "IIB, 3 levels"}))
