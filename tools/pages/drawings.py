"""The drawings of doc/paper.md: their values are computed from one small scene, two walls, a window and a lamp, by day and by night."""
import numpy as np
from matplotlib.patches import Rectangle

from charts import GREY, RED, plt, svg

HEIGHT, WIDTH = 16, 24
SIDE, LEFT, TOP = 8, 8, 2  # of the magnified quad


def scene():
    """Grey values by day, depth in metres, labels."""
    y, x = np.mgrid[:HEIGHT, :WIDTH]
    where = [(15 <= x) & (x < 20) & (4 <= y) & (y < 10), y >= 13, x >= 10]  # a window, the ground, a wall in the sun; else one farther away
    return (np.select(where, values, default) for values, default in (
        ((60 + 6 * (x - 15), 110 - 4 * (y - 13), 200 - 3 * (x - 10) + 2 * (y % 3)), 120 + 5 * (x % 4) + 3 * y),
        ((9, 19 - y, 8), 12), ((3, 1, 2), 0)))


DAY, DEPTH, LABELS = scene()
NIGHT = np.round(.22 * DAY + 14 + .3 * np.arange(WIDTH))  # darker, light from the right


def gradients(image):
    """|gx|, |gy| and orientation by Sobel's operator, borders repeated."""
    padded = np.pad(image, 1, mode='edge')
    across, along = padded[:, 2:] - padded[:, :-2], padded[2:] - padded[:-2]
    gx, gy = across[:-2] + 2 * across[1:-1] + across[2:], along[:, :-2] + 2 * along[:, 1:-1] + along[:, 2:]
    return abs(gx), abs(gy), np.degrees(np.arctan2(-gy, gx)) % 360


def quad(image):
    """Means of the four patches of the square, row by row, and the bits of equation (1)."""
    means = image[TOP:TOP + SIDE, LEFT:LEFT + SIDE].reshape(2, SIDE // 2, 2, SIDE // 2).mean(axis=(1, 3)).ravel()
    return means, ''.join('1' if value > means.mean() else '0' for value in means)


def axes(columns, rows=1, size=2.4):
    figure, all_axes = plt.subplots(rows, columns, figsize=(size * columns, .8 * size * rows), layout='constrained', squeeze=False)
    for axis in all_axes.flat:
        axis.axis('off')
        axis.set_aspect('equal')
    return figure, all_axes.ravel()


def picture(axis, image, title, grey=None):
    """One square a pixel, black to white from the least to the largest value, or in the range of grey values."""
    axis.imshow(image, 'gray', vmin=grey and 0, vmax=grey, interpolation='none')
    axis.set_title(title, fontsize=10)


def squares(axis, left, top, side, count, **style):
    """The grid of a square's cells."""
    for y, x in np.ndindex(count, count):
        axis.add_patch(Rectangle((left + x * side / count, top + y * side / count), side / count, side / count, **{'fill': False, 'edgecolor': RED, **style}))


def observation():
    """The same quad by day and by night: values differ, the bits of intensity and of the gradient do not."""
    figure, both = axes(2, size=4)
    for axis, name, image in zip(both, ('day', 'night'), (DAY, NIGHT)):
        lines = [name]
        for channel, values in (('intensity', image), ('|gx|', gradients(image)[0])):
            means, bits = quad(values)
            lines.append('%s: %s, mean %.0f: %s' % (channel, ' '.join('%.0f' % mean for mean in means), means.mean(), bits))
        picture(axis, image, '\n'.join(lines), 255)
        squares(axis, LEFT - .5, TOP - .5, SIDE, 2)
    return svg(figure)


def formation():
    """Region, channels, levels of the quadtree, bits."""
    figure, all_axes = axes(8, size=1.7)
    picture(all_axes[0], DAY, 'day: a region', 255)
    squares(all_axes[0], LEFT - .5, TOP - .5, SIDE, 1)
    for axis, name, image in zip(all_axes[1:], ('|gx|', '|gy|', 'orientation'), gradients(DAY)):
        picture(axis, image, name)
    for level, axis in enumerate(all_axes[4:], 1):
        axis.set(xlim=(-.05, 1.05), ylim=(1.05, -.05))
        squares(axis, 0, 0, 1, 2 ** level if level < 4 else 2)
        axis.set_title('level %d: %d' % (level, 4 ** level) if level < 4 else 'x > mean(x)', fontsize=10)
    for (y, x), mean, bit in zip(np.ndindex(2, 2), *quad(DAY)):
        squares(all_axes[7], x / 2, y / 2, .5, 1, fill=bit == '1', facecolor='#fee2e2')
        all_axes[7].text(x / 2 + .25, y / 2 + .25, '%.0f\n%s' % (mean, bit), ha='center', va='center')
    return svg(figure)


def bit_rules():
    """What a bit compares: points, patches, four patches."""
    figure, (points, patches, quads) = axes(3)
    for axis, name in ((points, 'BRIEF: two points'), (patches, 'BEBLID: two patches'), (quads, 'IIB: each of four with their mean')):
        axis.set(xlim=(-1, 129), ylim=(129, -1))
        axis.set_title(name, fontsize=10)
        squares(axis, 0, 0, 128, 1, edgecolor=GREY)
    for ends in (((30, 30), (86, 92)), ((100, 24), (52, 70))):
        points.plot(*zip(*ends), color=RED, marker='o')
    for x, y, u, v, side in ((18, 20, 80, 84, 22), (90, 14, 26, 76, 30)):
        squares(patches, x, y, side, 1)
        squares(patches, u, v, side, 1)
        patches.plot((x + side / 2, u + side / 2), (y + side / 2, v + side / 2), color=RED)
    squares(quads, 0, 0, 128, 4, linewidth=.7)
    squares(quads, 0, 0, 128, 2, linewidth=2)
    return svg(figure)


def channels():
    """The four channels of the default descriptor, and three possible extra channels."""
    figure, all_axes = axes(4, 2, 2.2)
    padded = np.pad(DAY, 1, mode='edge')
    texture = sum((padded[1 + j:1 + j + HEIGHT, 1 + i:1 + i + WIDTH] >= DAY).astype(int) for i in (-1, 0, 1) for j in (-1, 0, 1)) - 1
    for axis, name, image in zip(all_axes, ('intensity', 'horizontal gradient', 'vertical gradient', 'orientation', 'depth, if there is any',
                                            'labels, if there are any', 'texture (local binary patterns)'), (DAY, *gradients(DAY), DEPTH, LABELS, texture)):
        picture(axis, image, name)
    return svg(figure)


ALL = observation, formation, bit_rules, channels
