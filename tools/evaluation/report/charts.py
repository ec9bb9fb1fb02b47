# SPDX-License-Identifier: Apache-2.0

"""Places the points of line charts, which page.html.j2 draws as SVG. Axes begin at zero."""

WIDTH, HEIGHT = 360, 240           # of a chart, in its own units
LEFT, RIGHT, TOP, BOTTOM = 40, 10, 10, 36

# Colour and dashes of a series: no two alike, also without colour.
STYLES = (("#b91c1c", ""), ("#1d4ed8", "6 3"), ("#15803d", "2 3"), ("#7e22ce", "8 3 2 3"), ("#b45309", "1 2"),
          ("#0f766e", "10 4"), ("#334155", "4 2 1 2"), ("#be185d", "3 6"), ("#4d7c0f", "12 3 3 3"),
          ("#0369a1", "5 1"), ("#78350f", "9 2 2 2 2 2"))


def lines(series, x_label, y_label, x_ticks, y_top=1.0, x_range=None, place=lambda x: x):
    """A chart of {name: [(x, y)]}. `place` maps x to the axis, as for factors; x_ticks are [(x, text)]."""
    low, high = x_range or (0, max(x for points in series.values() for x, _ in points))
    low, high = place(low), place(high)

    def at(x, y):
        return (round(LEFT + (place(x) - low) / (high - low) * (WIDTH - LEFT - RIGHT), 1),
                round(HEIGHT - BOTTOM - y / y_top * (HEIGHT - TOP - BOTTOM), 1))

    if len(series) > len(STYLES):
        raise ValueError("%d series, and styles for %d" % (len(series), len(STYLES)))
    drawn = []
    for (name, points), (colour, dashes) in zip(series.items(), STYLES):
        placed = [at(x, y) for x, y in points]
        drawn.append({"name": name, "colour": colour, "dashes": dashes, "points": placed,
                      "path": " ".join("%g,%g" % p for p in placed)})
    y_ticks = [(at(x_ticks[0][0], y_top * i / 5)[1], "%.1f" % (y_top * i / 5)) for i in range(6)]
    return {"series": drawn, "x_label": x_label, "y_label": y_label, "width": WIDTH, "height": HEIGHT,
            "left": LEFT, "right": WIDTH - RIGHT, "top": TOP, "bottom": HEIGHT - BOTTOM,
            "x_ticks": [(at(x, 0)[0], text) for x, text in x_ticks], "y_ticks": y_ticks}
