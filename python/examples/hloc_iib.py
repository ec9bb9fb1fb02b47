"""An extractor for hloc (Hierarchical-Localization): copy this file to hloc/extractors/iib.py.

    from hloc import extract_features, match_features
    features = {'output': 'feats-iib', 'model': {'name': 'iib', 'max_keypoints': 2000},
                'preprocessing': {'grayscale': True, 'resize_max': 1600}}
    matches = {'output': 'matches-iib',  # square root, since hloc squares it: .92 of the bits
               'model': {'name': 'nearest_neighbor', 'do_mutual_check': True, 'ratio_threshold': .92 ** .5}}
    extract_features.main(features, images, outputs)
    match_features.main(matches, pairs, features['output'], outputs)

Each bit becomes 1/32 or -1/32. Then descriptors have length 1, and their squared distance is four times the share of different bits. So
hloc's own matcher finds the matches that opencv_iib.HierarchicalMatcher.createRecommended() finds in both directions.
"""
import numpy as np
import torch
from hloc.utils.base_model import BaseModel

import opencv_iib


class IIB(BaseModel):
    """The recommended chain, with 128 bytes a point."""

    default_conf = {'max_keypoints': 2000}
    required_inputs = ['image']

    def _init(self, conf):
        pass

    def _forward(self, data):
        grey = np.rint(data['image'][0].cpu().numpy().mean(axis=0) * 255).astype(np.uint8)
        points, _, codes = opencv_iib.detect_and_describe(grey, self.conf['max_keypoints'])
        bits = np.unpackbits(codes, axis=1).astype(np.float32)
        return {
            'keypoints': torch.from_numpy(points.astype(np.float64))[None],  # hloc writes float32 as halves of pixels
            'scores': torch.from_numpy(np.linspace(1, 0, len(points), dtype=np.float32))[None],  # the strongest first
            'descriptors': torch.from_numpy((2 * bits.T - 1) / np.float32(bits.shape[1] ** .5))[None],
        }
