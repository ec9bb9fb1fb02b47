# SPDX-License-Identifier: Apache-2.0

"""The page of an evaluation's results, of summaries.py's files and descriptors.py."""
import descriptors
from summaries import by, group, read
from tables import HERE
from timings import DESCRIBED, methods, ms

FILES = ("fixed_points", "detected_points", "curves", "estimators", "alignment", "robustness", "learned", "comparison")


def number(row, column):
    return float(row[column])


def describing_times():
    """Milliseconds for 1000 points, measured by scripts/bench.sh, by the evaluation's names of configurations."""
    return {name.replace("default", "IIB").replace("PRESET_", "IIB "): ms(test, name, 1000).iloc[0] for test in DESCRIBED for name in methods(test)}


def overview(tables):
    """The rows of the main table: pairs that no preset of IIB was trained on."""
    fixed = by(tables["fixed_points"], "configuration", place="light")
    detected = by(tables["detected_points"], "detector", "descriptor", place="light")
    times = describing_times()
    found = []
    for licence, names in descriptors.SHOWN.items():
        for name, points in names.items():
            if name in fixed:
                own = name.partition("-")[0]  # AKAZE-486 is AKAZE's own
                key = (points or own, own if points == descriptors.OWN else name)
                found.append({"name": name, "learned": name not in descriptors.NOT_LEARNED, "licence": licence, "time": times.get(name),
                              "score": fixed[name], "points": key[0], "detected": points is not None and detected.get(key),
                              "ours": name.startswith("IIB")})
    return found


def detected_lines(tables):
    """Descriptors at the points of each detector, in photographs and in rendered scenes."""
    rendered = by(tables["detected_points"], "detector", "descriptor", place="rendered")
    lines = [(row, rendered.get((row["detector"], row["descriptor"]))) for row in tables["detected_points"] if row["place"] == "light"]
    return sorted(lines, key=lambda line: (line[0]["detector"], -number(line[0], "correct")))


def changes(tables):
    """Moved cameras, blur and compression: the scores of the compared descriptors by kind of change."""
    scores = by(tables["fixed_points"], "configuration", "place")
    kinds = [kind for kind in descriptors.CHANGES if ("IIB", kind) in scores]
    return {"kinds": [descriptors.CHANGES[kind] for kind in kinds],
            "lines": [(name, [scores.get((name, kind)) for kind in kinds])
                      for name in descriptors.COMPARED if any((name, kind) in scores for kind in kinds)]}


def warps(tables):
    """Recall over rotations and scales of the reference itself."""
    scores = by(tables["robustness"], "configuration", "kind", "target")
    shown = sorted({key[1:] for key in scores}, key=lambda change: (change[0] == "scale", float(change[1])))
    return {"changes": [amount + "\u00b0" if kind == "turn" else "\u00d7 " + amount for kind, amount in shown],
            "lines": [(name, [scores[(name, *change)]["recall"] for change in shown])
                      for name in descriptors.WARPED if shown and (name, *shown[0]) in scores]}


def estimates(tables):
    """Areas under the curve of the error of poses up to 5 degrees by place: a line for plain, refined and propagated matches of
    each method, with a column for each estimator."""
    names = sorted({row["estimator"] for row in tables["estimators"]}, key=lambda name: (name != "findRelativePose", name))  # ours first
    found = {place: [] for place in ("other light", "same light")}
    for (place, detector, descriptor, points), rows in group(tables["estimators"], "place", "detector", "descriptor", "points").items():
        method = descriptors.POSES.get((detector, descriptor), "%s, %s" % (detector, descriptor))
        found.setdefault(place, []).append((method, points, by(rows, "estimator")))
    for lines in found.values():
        lines.sort(key=lambda line: line[0] != "recommended chain")
    bars = [(method, line["findRelativePose"]) for method, points, line in found["other light"] if points == "propagated"]
    return {"names": names, "places": {place: lines for place, lines in found.items() if lines}, "bars": sorted(bars, key=lambda bar: -number(bar[1], "at_5"))}


def slider(tables):
    """The pairs of images of the slider with the matches of all methods, in the form of the page's script."""
    scenes, known, methods_known = [], list(descriptors.SCENES), list(descriptors.METHODS)
    pairs = group(tables["comparison"], "reference", "target").items()
    for (reference, target), members in sorted(pairs, key=lambda pair: known.index(pair[0][1]) if pair[0][1] in known else 0):
        title, about = descriptors.SCENES.get(target, ("%s, %s" % (reference, target), ""))
        methods = []
        for row in sorted(members, key=lambda row: methods_known.index((row["detector"], row["descriptor"]))):
            values = [float(v) for v in row["matches"].split()]
            methods.append({"name": descriptors.METHODS[row["detector"], row["descriptor"]], "right": int(row["right"]),
                            "wrong": int(row["wrong"]), "matches": [values[i:i + 5] for i in range(0, len(values), 5)]})
        scenes.append({"title": title, "about": about, "methods": methods, "pictures": ["pictures/%s.jpg" % name for name in (reference, target)]})
    return scenes


def curves(tables):
    """For each place and each of the paper's detectors, the three measures of each descriptor, threshold by threshold."""
    found = {}
    for (place, detector, descriptor), rows in group(tables["curves"], "place", "detector", "descriptor").items():
        if detector in descriptors.SUITS:
            chart = found.setdefault(place, {}).setdefault(detector, {"pairs": rows[0]["pairs"], "lines": {}})
            chart["lines"][descriptor] = [[number(row, c) for row in rows] for c in ("right", "recall", "one_minus_precision")]
    return found


def context(folder):
    """The template's variables, from a folder of summaries; empty without fixed_points.csv."""
    tables = {name: read(folder / (name + ".csv")) for name in FILES}
    settings = folder / "settings.txt"
    return tables["fixed_points"] and {
        "overview": overview(tables), "networks": tables["learned"], "licences": descriptors.NETWORKS, "detected": detected_lines(tables),
        "changes": changes(tables), "warps": warps(tables), "estimates": estimates(tables), "anchors": read(HERE / "anchors.csv"),
        "alignment": tables["alignment"], "slider": slider(tables), "methods": list(descriptors.METHODS.values()), "curves": curves(tables),
        "settings": settings.read_text().splitlines() if settings.is_file() else [], "runs": read(folder / "runs.csv"),
        "files": [name + ".csv" for name in FILES if tables[name]]}
