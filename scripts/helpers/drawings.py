#!/usr/bin/env python3
"""The drawings of doc/paper.md, in doc/paper: drawings.py [FOLDER]

Their values are computed from one small scene that is made here: two walls, a window and a lamp, by day and by night.
"""
import math
import pathlib
import sys

WIDTH, HEIGHT = 24, 16


def scene(x, y):
    """Grey value by day, depth in metres, label."""
    if 15 <= x < 20 and 4 <= y < 10:
        return 60 + 6 * (x - 15), 9, 3  # a window
    if y >= 13:
        return 110 - 4 * (y - 13), 3 + (16 - y), 1  # the ground
    if x >= 10:
        return 200 - 3 * (x - 10) + 2 * (y % 3), 8, 2  # a wall in the sun
    return 120 + 5 * (x % 4) + 3 * y, 12, 0  # a wall farther away


DAY = [[scene(x, y)[0] for x in range(WIDTH)] for y in range(HEIGHT)]
NIGHT = [[round(.22 * value + 14 + .3 * x) for x, value in enumerate(row)] for row in DAY]  # darker, light from the right


def gradients(image):
    """|gx|, |gy| and orientation by Sobel's operator, borders repeated."""
    def at(x, y):
        return image[min(max(y, 0), HEIGHT - 1)][min(max(x, 0), WIDTH - 1)]
    found = [[], [], []]
    for y in range(HEIGHT):
        gx = [sum(w * (at(x + 1, y + d) - at(x - 1, y + d)) for d, w in ((-1, 1), (0, 2), (1, 1))) for x in range(WIDTH)]
        gy = [sum(w * (at(x + d, y + 1) - at(x + d, y - 1)) for d, w in ((-1, 1), (0, 2), (1, 1))) for x in range(WIDTH)]
        for rows, row in zip(found, ([abs(v) for v in gx], [abs(v) for v in gy],
                                     [math.degrees(math.atan2(-b, a)) % 360 for a, b in zip(gx, gy)])):
            rows.append(row)
    return found


def quad(image, left, top, side):
    """Means of the four patches of a square, row by row, and the bits of equation (1)."""
    half = side // 2
    means = [sum(image[y][x] for y in range(top + j, top + j + half) for x in range(left + i, left + i + half)) / half ** 2
             for j in (0, half) for i in (0, half)]
    return means, ''.join('1' if value > sum(means) / 4 else '0' for value in means)


class Drawing:
    def __init__(self, width, height):
        self.size, self.parts = (width, height), []

    def add(self, text, *values):
        self.parts.append(text % values)

    def text(self, x, y, words, size=13, anchor='start'):
        self.add('<text x="%g" y="%g" font-size="%d" text-anchor="%s">%s</text>', x, y, size, anchor, words)

    def square(self, x, y, side, fill='none', width=1.5):
        self.add('<rect x="%g" y="%g" width="%g" height="%g" fill="%s" stroke="#b91c1c" stroke-width="%g"/>', x, y, side, side, fill, width)

    def picture(self, left, top, step, image, title):
        """One square a pixel, black to white between its least and largest value, or absolute for grey values."""
        values = [v for row in image for v in row]
        low, high = (0, 255) if title.startswith(('day', 'night')) else (min(values), max(values))
        greys = {}
        for y, row in enumerate(image):
            for x, value in enumerate(row):
                grey = 8 * round(31 * (value - low) / max(1, high - low))
                greys.setdefault(grey, []).append('M%d %dh1' % (x, y))
        for grey, squares in greys.items():  # a line of one pixel's width and length is a square
            self.add('<path transform="translate(%g %g) scale(%g)" stroke="#%02x%02x%02x" stroke-width="1.04" d="%s"/>', left,
                     top + step / 2, step, grey, grey, grey, ''.join(squares))
        self.text(left, top - 6, title)

    def write(self, file):
        file.write_text('<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 %d %d" width="%d" font-family="sans-serif">\n'
                        '<rect width="100%%" height="100%%" fill="#fff"/>\n%s\n</svg>\n' %
                        (*self.size, self.size[0], '\n'.join(self.parts)))


def observation():
    """The same quad by day and by night: values differ, the bits of intensity and of the gradient do not."""
    drawing, step, (left, top, side) = Drawing(620, 250), 11, (8, 2, 8)
    for i, (name, image) in enumerate((('day', DAY), ('night', NIGHT))):
        x = 10 + 310 * i
        drawing.picture(x, 24, step, image, name)
        for j in (0, side // 2):
            for k in (0, side // 2):
                drawing.square(x + step * (left + k), 24 + step * (top + j), step * side / 2)
        for line, (channel, values) in enumerate((('intensity', image), ('|gx|', gradients(image)[0]))):
            means, bits = quad(values, left, top, side)
            drawing.text(x, 220 + 18 * line, '%s: %s, mean %.0f: <tspan font-weight="bold">%s</tspan>' % (
                channel, ' '.join('%.0f' % value for value in means), sum(means) / 4, bits))
    return drawing


def formation():
    """Region, channels, levels of the quadtree, bits."""
    drawing = Drawing(760, 190)
    drawing.picture(10, 40, 6, DAY, 'day: a region')
    drawing.square(10 + 6 * 8, 40, 96, width=2)
    for i, (name, values) in enumerate(zip(('|gx|', '|gy|', 'orientation'), gradients(DAY))):
        drawing.picture(180, 22 + 60 * i, 2.4, values, name)
    for level in range(1, 4):
        x, side = 270 + 120 * (level - 1), 96 / 2 ** level
        for i in range(4 ** level):
            drawing.square(x + side * (i % 2 ** level), 40 + side * (i // 2 ** level), side, width=1)
        drawing.text(x, 156, 'level %d: %d' % (level, 4 ** level))
    means, bits = quad(DAY, 8, 2, 8)
    for i, (value, bit) in enumerate(zip(means, bits)):
        x, y = 640 + 48 * (i % 2), 40 + 48 * (i // 2)
        drawing.square(x, y, 48, '#fee2e2' if bit == '1' else 'none')
        drawing.text(x + 24, y + 22, '%.0f' % value, anchor='middle')
        drawing.text(x + 24, y + 40, bit, 15, 'middle')
    drawing.text(640, 156, 'x > mean(x)')
    return drawing


def bit_rules():
    """What a bit compares: points, patches, four patches."""
    drawing = Drawing(640, 190)
    for i, name in enumerate(('BRIEF: two points', 'BEBLID: two patches', 'IIB: each of four with their mean')):
        drawing.add('<rect x="%d" y="20" width="128" height="128" fill="#f5f5f4" stroke="#78716c"/>', 10 + 200 * i)
        drawing.text(10 + 200 * i, 170, name, 12)
    for (x, y), (u, v) in (((40, 50), (96, 112)), ((110, 44), (62, 90))):
        drawing.add('<path d="M%d %dL%d %d" stroke="#b91c1c"/>', x, y, u, v)
        for a, b in ((x, y), (u, v)):
            drawing.add('<circle cx="%d" cy="%d" r="3" fill="#b91c1c"/>', a, b)
    for x, y, u, v, side in ((228, 40, 290, 104, 22), (300, 34, 236, 96, 30)):
        drawing.square(x, y, side)
        drawing.square(u, v, side)
        drawing.add('<path d="M%d %dL%d %d" stroke="#b91c1c"/>', x + side / 2, y + side / 2, u + side / 2, v + side / 2)
    for i in range(16):
        drawing.square(410 + 32 * (i % 4), 20 + 32 * (i // 4), 32, width=.7)
    for i in range(4):
        drawing.square(410 + 64 * (i % 2), 20 + 64 * (i // 2), 64, width=2)
    return drawing


def channels():
    """The four channels of the default descriptor, and three that may come to them."""
    drawing = Drawing(760, 285)
    maps = [[[scene(x, y)[i] for x in range(WIDTH)] for y in range(HEIGHT)] for i in (1, 2)]
    texture = [[sum(DAY[min(max(y + j, 0), HEIGHT - 1)][min(max(x + i, 0), WIDTH - 1)] >= DAY[y][x] for i in (-1, 0, 1) for j in (-1, 0, 1)) - 1
                for x in range(WIDTH)] for y in range(HEIGHT)]
    named = zip(('intensity', 'horizontal gradient', 'vertical gradient', 'orientation', 'depth, if there is any', 'labels, if there are any',
                 'texture (local binary patterns)'), [DAY, *gradients(DAY), *maps, texture])
    for i, (name, image) in enumerate(named):
        drawing.picture(10 + 190 * (i % 4), 24 + 140 * (i // 4), 7, image, name)
    return drawing


def main():
    out = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else pathlib.Path(__file__).resolve().parents[2] / 'doc/paper'
    out.mkdir(exist_ok=True)
    for make in (observation, formation, bit_rules, channels):
        make().write(out / (make.__name__ + '.svg'))


if __name__ == '__main__':
    main()
