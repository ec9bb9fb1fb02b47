#!/usr/bin/python3
"""Writes the networks beside it, for test_deep_keypoints.cpp, which says what they compute. Needs Debian's python3-onnx;
the files are committed, so that the tests do not."""
import pathlib

import numpy as np
import onnx
from onnx import TensorProto, helper, numpy_helper

HERE = pathlib.Path(__file__).resolve().parent


def write(name, nodes, weights, channels, outputs):
    """weights: {name: array}; outputs: {name: shape}; the input is `image`, channels x 64 x 64."""
    graph = helper.make_graph(
        nodes, 'test',
        [helper.make_tensor_value_info('image', TensorProto.FLOAT, [1, channels, 64, 64])],
        [helper.make_tensor_value_info(output, TensorProto.FLOAT, shape) for output, shape in outputs.items()],
        [numpy_helper.from_array(value, weight) for weight, value in weights.items()])
    model = helper.make_model(graph, opset_imports=[helper.make_opsetid('', 11)], producer_name='')
    model.ir_version = 7
    onnx.checker.check_model(model)
    onnx.save(model, HERE / (name + '.onnx'))


def convolution(output, weights, kernel, bias=()):
    """Of the image, in blocks of kernel x kernel."""
    return helper.make_node('Conv', ['image', weights, *bias], [output], kernel_shape=[kernel] * 2,
                            strides=[kernel] * 2)


def floats(*shape):
    return np.ones(shape, np.float32)


# Scores: the image itself. Descriptors: the sum over cells of 8 x 8, and twice that.
write('heatmap', [convolution('scores', 'one', 1), convolution('map', 'sums', 8)],
      {'one': floats(1, 1, 1, 1), 'sums': floats(2, 1, 8, 8) * np.float32([1, 2])[:, None, None, None]}, 1,
      {'scores': [1, 1, 64, 64], 'map': [1, 2, 8, 8]})

# Logit c is 20 times pixel c of the cell, the last is 0.
write('superpoint', [convolution('semi', 'pick', 8)],
      {'pick': 20 * np.eye(65, 64, dtype=np.float32).reshape(65, 1, 8, 8)}, 1, {'semi': [1, 65, 8, 8]})

# Three points and their scores, whatever the image: weights are zero, so that the biases are left.
nodes, weights = [], {}
for name, values, columns in (('keypoints', [-1, -1, 0, 0, .5, -.5], 2), ('confidence', [.1, .9, .5], 1)):
    weights[name + '_weights'] = 0 * floats(len(values), 3, 1, 1)
    weights[name + '_values'] = np.float32(values)
    weights[name + '_shape'] = np.int64([3, columns])
    nodes += [convolution(name + '_conv', name + '_weights', 1, [name + '_values']),
              helper.make_node('GlobalAveragePool', [name + '_conv'], [name + '_mean']),
              helper.make_node('Reshape', [name + '_mean', name + '_shape'], [name])]
write('list', nodes, weights, 3, {'keypoints': [3, 2], 'confidence': [3, 1]})

# No keypoint networks: an image of five channels, and a map of descriptors without scores.
write('five_channels', [convolution('features', 'weights', 1)], {'weights': floats(1, 5, 1, 1)}, 5,
      {'features': [1, 1, 64, 64]})
write('map', [convolution('map', 'weights', 8)], {'weights': floats(2, 1, 8, 8)}, 1, {'map': [1, 2, 8, 8]})
