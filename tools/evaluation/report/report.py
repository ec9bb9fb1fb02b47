#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0

"""One page, index.html, from the CSV files of iib_evaluation: report.py RESULTS. Needs python3-jinja2."""
import argparse
import os
import sys

import jinja2

import descriptors
from paper_orders import orders
from results import areas, column, describing_times, domain, file_name, group, interval, mean, mean_accuracy, read

HERE = os.path.dirname(os.path.abspath(__file__))
# The figures of Lin et al., "Illumination-insensitive Binary Descriptor for Visual Measurement Based on Local Inter-patch
# Invariance", by the questions that its tables answer and the names of our results; those that it lacks are empty.
PAPER = read(HERE, "paper")
CSV_FILES = ("fixed_points", "detected_points", "whole_tasks", "robustness", "learned", "comparison")


def score(rows):
    """Means over pairs with half of their confidence intervals, or None without rows."""
    if not rows:
        return None
    precision, recall = column(rows, "precision"), column(rows, "recall")
    return {"precision": mean(precision), "recall": mean(recall), "precision_interval": interval(precision),
            "recall_interval": interval(recall), "pairs": len(rows), "bytes": rows[0].get("bytes"),
            "correct": mean(column(rows, "correct")), "correct_interval": interval(column(rows, "correct"))}


def by_name(rows, name="configuration"):
    return {key: members for (key,), members in group(rows, name).items()}


def illumination(rows, where="natural", unseen=False):
    return [r for r in rows if r["kind"] == "illumination" and domain(r) == where and
            not (unseen and r["set"] in descriptors.TRAINED_ON)]


def overview(tables):
    """The rows of the main table: pairs that no preset of IIB was trained on."""
    fixed = by_name(illumination(tables["fixed_points"], unseen=True))
    detected = group(illumination(tables["detected_points"], unseen=True), "detector", "descriptor")
    times = describing_times()
    found = []
    for name, (points, learned, licence) in descriptors.SHOWN.items():
        if name in fixed:
            found.append({"name": name, "learned": learned, "licence": licence, "time": times.get(name),
                          "score": score(fixed[name]), "points": points and points[0],
                          "detected": score(detected.get(points, [])), "ours": name.startswith("IIB")})
    return found


def networks(tables):
    """Learned descriptors at their own points, for the end of the main table."""
    return [dict(row, licence=descriptors.NETWORKS[row["descriptor"]]) for row in tables["learned"]]


def detectors(tables):
    """For each detector: its own descriptor and IIB's on the same points."""
    rows = illumination(tables["detected_points"])
    found = []
    for (detector,), members in group(rows, "detector").items():
        lines = [{"name": name, "ours": name.startswith("IIB"), "score": score(mine)}
                 for name, mine in by_name(members, "descriptor").items()]
        found.append({"name": detector, "normalized": detector.endswith(" normalized"),
                      "lines": sorted(lines, key=lambda r: -r["score"]["correct"])})
    return found


def changes(tables):
    """Moved cameras, blur and compression: the scores of the compared descriptors by kind of change."""
    scores = group([r for r in tables["fixed_points"] if r["kind"] in descriptors.CHANGES], "configuration", "kind")
    kinds = [kind for kind in descriptors.CHANGES if ("IIB", kind) in scores]
    return {"kinds": [(descriptors.CHANGES[kind], sorted({r["sequence"] for r in scores["IIB", kind]}))
                      for kind in kinds],
            "lines": [(name, [score(scores.get((name, kind), [])) for kind in kinds])
                      for name in descriptors.COMPARED if any((name, kind) in scores for kind in kinds)]}


def warps(tables):
    """Recall over rotations and scales of the reference itself."""
    scores = group([r for r in tables["robustness"] if r["kind"] in ("rotation", "scale")], "configuration", "kind", "target")
    changes = sorted({key[1:] for key in scores}, key=lambda change: (change[0], float(change[1])))
    return {"changes": [amount + "\u00b0" if kind == "rotation" else "\u00d7 " + amount for kind, amount in changes],
            "lines": [(name, [mean(column(scores[(name, *change)], "recall")) for change in changes])
                      for name in descriptors.WARPED if changes and (name, *changes[0]) in scores]}


# Of the error of a pose, degrees, for the areas under its curve.
LIMITS = (5, 10, 20)


def task_line(key, rows):
    errors = column(rows, "error")
    parts = [areas(errors, limit) for limit in LIMITS]
    return {"detector": key[0], "descriptor": key[1], "matching": key[2], "pairs": len(errors),
            "areas": [(mean(p), interval(p)) for p in parts],
            "accuracy": mean_accuracy(errors, range(1, LIMITS[-1] + 1)), "inliers": mean(column(rows, "inliers"))}


def whole_tasks(tables):
    """Areas under the curve of the error of poses, by kind of images, then detector and descriptor, each with the best choice
    of matches and threshold; the table holds all."""
    rows = [dict(row, images=domain(row)) for row in tables["whole_tasks"]
            if row["task"] == "pose" and row["set"] not in descriptors.TRAINED_ON]
    found = []
    for (which,), members in sorted(group(rows, "images").items()):
        lines = [task_line(key, mine) for key, mine in group(members, "detector", "descriptor", "matching").items()]
        lines.sort(key=lambda line: -line["areas"][1][0])
        best = {}
        for line in lines:
            best.setdefault((line["detector"], line["descriptor"]), line)
        bars = [best[key] for key in descriptors.TASKS if key in best]
        found.append({"images": which, "limits": LIMITS, "lines": list(best.values()),
                      "sequences": sorted({r["sequence"] for r in members}),
                      "pairs": max(line["pairs"] for line in lines),
                      "bars": sorted(bars, key=lambda line: -line["areas"][1][0])})
    return found


def pose_headline(tasks):
    """Poses in other light at detected points: the bars at the head of the page."""
    for task in tasks:
        if task["images"] == "rendered":
            return dict(task, bars=[dict(bar, name=descriptors.POSES[bar["detector"], bar["descriptor"]]) for bar in task["bars"]
                                    if (bar["detector"], bar["descriptor"]) in descriptors.POSES])
    return None


DRAWN = 100  # matches of a method on the slider


def slider(tables):
    """The pairs of images that the slider shows, each with the matches of all methods, as the page's script takes them."""
    scenes = []
    for (reference, target), members in group(tables["comparison"], "reference", "target").items():
        methods = []
        for (detector, descriptor), rows in group(members, "detector", "descriptor").items():
            right = sum(row["correct"] == "1" for row in rows)
            step = len(rows) // DRAWN + 1
            methods.append({"name": descriptors.POSES[detector, descriptor], "right": right, "wrong": len(rows) - right, "step": step,
                            "matches": [[float(row[c]) for c in ("x", "y", "target_x", "target_y")] + [int(row["correct"])]
                                        for row in rows[::step]]})
        title, about = descriptors.SCENES.get(target, ("%s and %s" % (reference, target), ""))
        scenes.append({"title": title, "about": about, "pictures": ["pictures/%s.jpg" % reference, "pictures/%s.jpg" % target],
                       "methods": sorted(methods, key=lambda method: -method["right"])})
    known = [title for title, _ in descriptors.SCENES.values()]
    return sorted(scenes, key=lambda scene: known.index(scene["title"]) if scene["title"] in known else len(known))


def paper_tables(tables):
    """The tables of the paper: ours, by domain, beside the paper's figures."""
    rows = {where: by_name(illumination(tables["fixed_points"], where)) for where in ("natural", "rendered")}
    found = []
    for (title,), members in group(PAPER, "question").items():
        lines = []
        for row in members:
            ours = [score(rows[where].get(row["configuration"], [])) for where in ("natural", "rendered")]
            theirs = row["natural_map"] and [[float(row[which + "_" + metric]) for metric in ("map", "mar")]
                                             for which in ("natural", "synthetic")]
            if any(ours):
                lines.append((row["configuration"], row["plain"], ours, theirs))
        if lines:
            found.append((title, lines))
    return found


def paper_orders(tables):
    scores = {name: score(members) for name, members in by_name(illumination(tables["fixed_points"])).items()}
    return orders({n: s["recall"] for n, s in scores.items()}, {n: s["precision"] for n, s in scores.items()},
                  [row["configuration"] for row in PAPER])


def scenes(tables):
    """Recall by sequence, all descriptors."""
    names = list(by_name(tables["fixed_points"]))
    lines = []
    for (set_, sequence, kind), members in group(tables["fixed_points"], "set", "sequence", "kind").items():
        scores = by_name(members)
        lines.append(("%s/%s" % (set_, sequence), kind, len(scores["IIB"]),
                      [mean(column(scores[n], "recall")) if n in scores else None for n in names]))
    return {"names": names, "lines": lines}


def settings(folder):
    found = []
    for name in ("settings.txt", "run.txt"):
        path = os.path.join(folder, name)
        if os.path.exists(path):
            with open(path) as file:
                found += [line.strip() for line in file if line.strip()]
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("results", help="folder of iib_evaluation's CSV files")
    folder = parser.parse_args().results
    tables = {name: read(folder, name) for name in CSV_FILES}
    if not any(tables.values()):
        sys.exit("%s: no results of iib_evaluation" % folder)
    rows = overview(tables)
    headline = [max(same, key=lambda r: r["score"]["recall"]) for same in
                ([r for r in rows if r["name"] in (name, name + " 5x")] for name in descriptors.HEADLINE) if same]
    tasks = whole_tasks(tables)
    environment = jinja2.Environment(loader=jinja2.FileSystemLoader(HERE), autoescape=True, trim_blocks=True,
                                     lstrip_blocks=True, undefined=jinja2.StrictUndefined)
    page = environment.get_template("page.html.j2").render(
        overview=rows, networks=networks(tables), headline=sorted(headline, key=lambda r: -r["score"]["recall"]),
        detectors=detectors(tables), changes=changes(tables), warps=warps(tables),
        tasks=tasks, poses=pose_headline(tasks), slider=slider(tables), paper=paper_tables(tables), orders=paper_orders(tables),
        scenes=scenes(tables),
        all_pairs=score(by_name(illumination(tables["fixed_points"])).get("IIB", [])), settings=settings(folder),
        files=[file_name(name) for name in CSV_FILES if tables[name]])
    path = os.path.join(folder, "index.html")
    with open(path, "w", encoding="utf-8") as file:
        file.write(page)
    print(path)


if __name__ == "__main__":
    main()
