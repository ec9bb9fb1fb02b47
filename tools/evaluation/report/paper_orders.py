# SPDX-License-Identifier: Apache-2.0

"""The orders that the paper's tables show, and whether the results have them."""

ONE, TWO, THREE = ("IIB x", "IIB y", "IIB i", "IIB o"), ("IIB x+y", "IIB o+i"), ("IIB x+y+i", "IIB x+y+o")
# The best of each group finds more than the best of the next one.
ORDERS = {"x+y above every single channel": (("IIB x+y",), ONE), "4 channels above 3 above 2 above 1": (("IIB",), THREE, TWO, ONE),
          "QUARTILE above MEAN": (("IIB quartile",), ("IIB",)), "overlap above none": (("IIB overlap",), ("IIB",)),
          "SORT below MEAN": (("IIB",), ("IIB sort",)),
          "MAX below MEAN": (("IIB",), ("IIB max",)), "MIN below MEAN": (("IIB",), ("IIB min",)),
          "g5 above g4 above g3 above g2": (("IIB g5",), ("IIB",), ("IIB g3",), ("IIB g2",))}


def orders(mar, map_, names):
    """[(statement, holds, figures)] from mAR and mAP by configuration."""
    def line(statement, values, chosen, margin=0):
        return (statement, all(values[a] - values[b] > margin for a, b in zip(chosen, chosen[1:])),
                ", ".join("%s %.3f" % (name, values[name]) for name in chosen))
    found = []
    for statement, groups in ORDERS.items():
        best = [max((name for name in members if name in mar), key=mar.get, default=None) for members in groups]
        if None not in best:
            found.append(line(statement, mar, best))
    others = [name for name in names if name in map_ and not name.startswith("IIB")]
    if others and "IIB" in map_:
        found.append(line("0.1 precision above every other descriptor", map_, ["IIB", max(others, key=map_.get)], 0.1))
    return found
