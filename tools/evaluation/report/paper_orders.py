# SPDX-License-Identifier: Apache-2.0

"""The orders that the paper's tables show, and whether the results have them."""


def orders(mar, map_, others):
    """[(statement, holds, figures)] from mAR and mAP by configuration."""
    found = []

    def check(statement, values):
        names = [n for n, _ in values]
        if all(v is not None for _, v in values):
            numbers = [v for _, v in values]
            found.append((statement, all(a > b for a, b in zip(numbers, numbers[1:])),
                          ", ".join("%s %.3f" % pair for pair in zip(names, numbers))))

    def of(*names):
        return [(n, mar.get(n)) for n in names]

    singles = [n for n in ("IIB x", "IIB y", "IIB i", "IIB o") if n in mar]
    if singles:
        best = max(singles, key=mar.get)
        check("x+y above every single channel (the best of them shown)", of("IIB x+y", best))
    three = max((n for n in ("IIB x+y+i", "IIB x+y+o") if n in mar), key=mar.get, default="IIB x+y+i")
    two = max((n for n in ("IIB x+y", "IIB o+i") if n in mar), key=mar.get, default="IIB x+y")
    one = max(singles, key=mar.get, default="IIB x")
    check("4 channels above 3 above 2 above 1 (the best of each number)", of("IIB", three, two, one))
    check("QUARTILE above MEAN", of("IIB quartile", "IIB"))
    check("overlap above none", of("IIB overlap", "IIB"))
    check("MAX below MEAN", of("IIB", "IIB max"))
    check("MIN below MEAN", of("IIB", "IIB min"))
    check("g5 above g4 above g3 above g2", of("IIB g5", "IIB", "IIB g3", "IIB g2"))
    rivals = [n for n in others if n in map_ and not n.startswith("IIB")]
    if rivals and "IIB" in map_:
        best = max(rivals, key=map_.get)
        found.append(("IIB at least 0.1 precision above every other descriptor (the best of them shown)",
                      map_["IIB"] - map_[best] >= 0.1, "IIB %.3f, %s %.3f" % (map_["IIB"], best, map_[best])))
    return found
