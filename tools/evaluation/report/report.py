# This file is part of OpenCV project.
# It is subject to the license terms in the LICENSE file found in the top-level directory
# of this distribution and at http://opencv.org/license.html.

#!/usr/bin/env python3
"""One self-contained HTML page from the CSV files of iib_evaluation: report.py RESULTS [--no-pictures]."""
import argparse
import base64
import html
import os
import sys

import paper
import plots
from paper_orders import orders
from results import domain, group, mean, read, scores

STYLE = """
body{font:15px/1.5 system-ui,sans-serif;color:#1c1917;max-width:1100px;margin:2em auto;padding:0 1em}
h1{font-size:1.7em}h2{margin-top:2.2em;border-bottom:2px solid #e7e5e4;padding-bottom:.2em}h3{margin-top:1.6em}
table{border-collapse:collapse;margin:.8em 0;font-variant-numeric:tabular-nums;font-size:.92em}
th,td{padding:.22em .7em;text-align:right;border-bottom:1px solid #e7e5e4}th{background:#fafaf9;font-weight:600}
td:first-child,th:first-child{text-align:left}tr.default td{font-weight:600}.paper{color:#78716c}
.yes{color:#15803d}.no{color:#b91c1c}svg{max-width:100%;height:auto}.note{color:#57534e;max-width:52em}
figure{margin:.6em 0}figcaption{font-size:.85em;color:#57534e}img{max-width:100%}
.gallery{display:grid;grid-template-columns:repeat(auto-fill,minmax(480px,1fr));gap:.8em}
nav a{margin-right:1em}.big{font-size:1.25em}"""


def cell(value, digits=3):
    return "" if value is None else "%.*f" % (digits, value)


def table(head, rows, mark=None):
    """rows: lists of text, the first the name; the row named `mark` stands out."""
    lines = ["<table><tr>" + "".join("<th>%s</th>" % h for h in head) + "</tr>"]
    for row in rows:
        lines.append("<tr%s>%s</tr>" % (' class="default"' if row[0] == mark else "",
                                        "".join("<td>%s</td>" % c for c in row)))
    return "\n".join(lines) + "</table>"


def comparison(figures, light):
    """A table of the paper beside the results, natural and, where there are such sets, synthetic."""
    domains = [d for d in ("natural", "synthetic") if any(domain(r) == d for r in light)]
    head = ["descriptor", "bytes"]
    for d in domains:
        head += ["mAP, %s" % d, "mAR", '<span class="paper">paper\'s mAP</span>', '<span class="paper">mAR</span>']
    rows = []
    for name, theirs in figures.items():
        mine = [r for r in light if r["configuration"] == name]
        if not mine:
            continue
        row = [html.escape(name), mine[0]["bytes"]]
        for d in domains:
            of_domain = [r for r in mine if domain(r) == d]
            row += [cell(v) if of_domain else "" for v in scores(of_domain)[:2]]
            pair = (theirs[0:2] if d == "natural" else theirs[2:4]) if theirs else (None, None)
            row += ['<span class="paper">%s</span>' % cell(v) for v in pair]
        rows.append(row)
    return table(head, rows, "IIB")


def protocol_a(rows):
    light = [r for r in rows if r["kind"] == "light"]
    natural = [r for r in light if domain(r) == "natural"] or light
    by_name = {name: scores(members) for (name,), members in group(natural, "configuration").items()}
    out = ['<h2 id="a">Predefined points (protocol A)</h2><p class="note">FAST corners of the reference, sampled '
           "uniformly, projected by the homography; ROS of radius 32; mutual nearest neighbours; correct within the "
           "tolerance. Means over image pairs whose light changes. Descriptors that need their detector's own points "
           "(AKAZE, KAZE) are given those, and IIB is shown on the same. A point that a descriptor drops (BRISK, "
           "near borders) counts as not found. Grey: the paper's figures, on its own data.</p>"]
    if "IIB" in by_name:
        out.append('<p class="big">Default IIB: mAP <b>%.3f</b>, mAR <b>%.3f</b> over %d image pairs.</p>'
                   % by_name["IIB"])
    checks = orders({n: s[1] for n, s in by_name.items()}, {n: s[0] for n, s in by_name.items()}, paper.PEERS)
    if checks:
        out.append("<h3>The paper's order, in mAR</h3>" + table(
            ["statement", "holds", "figures"],
            [[s, '<span class="%s">%s</span>' % (("yes", "yes") if ok else ("no", "no")), f] for s, ok, f in checks]))
    known = set().union(paper.CHANNELS, paper.MAPPINGS, paper.OVERLAP, paper.GRANULARITY, paper.PEERS)
    learned = dict(paper.LEARNED)
    learned.update({n: None for n in by_name if n.startswith("IIB ") and n not in known and n not in learned
                    and "+depth" not in n and "+labels" not in n})
    for title, label, figures in (
            ("Image channels", "IIB_with_channels", paper.CHANNELS),
            ("Mappings", "IIB_with_mapping_rules", paper.MAPPINGS),
            ("Overlap", "IIB_with_overlaps", paper.OVERLAP),
            ("Granularity", "IIB_with_granularities", paper.GRANULARITY),
            ("Learned selections and presets", "IIB_with_adaboost", learned),
            ("Other descriptors", "binary_comparsion", paper.PEERS)):
        if title.startswith("Learned") and not any(n in by_name for n in learned if n != "IIB"):
            continue
        out.append('<h3>%s <span class="paper">(paper, table %s)</span></h3>' % (title, label))
        out.append(comparison(figures, light))
    out.append("<h3>Size against recall</h3>" + plots.size_against_recall(natural))
    with_maps = {(r["set"], r["sequence"], r["target"]) for r in light if r["configuration"].startswith("IIB +")}
    if with_maps:
        subset = [r for r in light if (r["set"], r["sequence"], r["target"]) in with_maps]
        names = [n for n in ("IIB", "IIB +depth", "IIB +labels", "IIB +depth+labels")
                 if any(r["configuration"] == n for r in subset)]
        out.append("<h3>Depth and segmentation as further channels</h3><p class=note>On the %d pairs that have such "
                   "maps.</p>%s" % (len(with_maps), plots.extra_channels(subset, names)))
    out.append("<h3>Default IIB by sequence</h3>" + table(
        ["sequence", "kind", "pairs", "mAP", "mAR"],
        [[html.escape("%s/%s" % key[:2]), key[2], str(len(m)), cell(scores(m)[0]), cell(scores(m)[1])]
         for key, m in group([r for r in rows if r["configuration"] == "IIB"], "set", "sequence", "kind").items()]))
    return "\n".join(out)


def presets(rows, warped, costs):
    """The presets beside the default: changed light, moved cameras, turns of the image, time."""
    chosen = [r for r in rows if r["configuration"] in paper.PRESETS]
    columns = [("changed light, natural", [r for r in chosen if r["kind"] == "light" and domain(r) == "natural"
                                           and r["set"] not in paper.TRAINED_ON]),
               ("synthetic", [r for r in chosen if r["kind"] == "light" and domain(r) == "synthetic"])]
    columns += [(name, [r for r in chosen if r["sequence"] == name]) for name in ("wall", "graf")]
    columns += [("turned by %d&deg;" % angle, [r for r in warped if r["kind"] == "turn" and r["target"] == str(angle)])
                for angle in (5, 10, 15)]
    columns = [(title, group(members, "configuration")) for title, members in columns if members]
    time = {r["configuration"]: float(r["milliseconds"]) for r in costs}
    lines = []
    for name in paper.PRESETS:
        of_preset = [r for r in chosen if r["configuration"] == name]
        if of_preset:
            lines.append([html.escape(name), of_preset[0]["bytes"]] +
                         ["%.3f / %.3f" % scores(by_name[(name,)])[:2] if (name,) in by_name else ""
                          for _, by_name in columns] +
                         [cell(time[name] / time["IIB"], 2) if name in time and "IIB" in time else ""])
    return ('<h2 id="s">Presets</h2><p class="note">Protocol A, upright: mAP / mAR, without the sets that presets were '
            "trained on, which the table of learned selections above includes. Time: all keypoints of the largest "
            "image, in parts of the default's; see Cost.</p>"
            + table(["preset", "bytes"] + [title for title, _ in columns] + ["time"], lines, "IIB"))


def protocol_b(rows):
    out = ['<h2 id="b">With detectors (protocol B)</h2><p class="note">The strongest points of each detector in both '
           "images, upright; its own descriptor (ORB's for FAST and AGAST) against IIB on the same points, with the "
           "paper's scale factors. Two points correspond within the tolerance and with an overlap error of their "
           "sizes below 50 %. Compare the paper's figures fig_performance_with_detector_real and _virtual.</p>"]
    for name in ("natural", "synthetic"):
        members = [r for r in rows if domain(r) == name]
        if not members:
            continue
        lines = [[html.escape("%s + %s" % key), m[0]["bytes"], "%.0f" % mean(int(r["correct"]) for r in m),
                  cell(scores(m)[0]), cell(scores(m)[1]), str(len(m))]
                 for key, m in group(members, "detector", "descriptor").items()]
        out.append("<h3>%s images</h3>" % name.capitalize())
        out.append(table(["detector + descriptor", "bytes", "correct matches", "mAP", "mAR", "pairs"], lines))
        out.append(plots.detector_curves(members))
    return "\n".join(out)


def matching(rows):
    out = ['<h2 id="m">Hierarchical matching</h2><p class="note">Default IIB, protocol A. H-t-x: a pair goes on to the '
           "next level within x of the bits of each (paper, figure fig_H_matching). MC: bits compared, in parts of "
           "brute force. A pair without a match has precision 0.</p>"]
    for name in ("natural", "synthetic"):
        members = [r for r in rows if domain(r) == name]
        if not members:
            continue
        lines = [[matcher, cell(scores(m)[0]), cell(scores(m)[1]), cell(mean(float(r["cost"]) for r in m))]
                 for (matcher,), m in group(members, "matcher").items()]
        out.append("<h3>%s images</h3>" % name.capitalize())
        out.append(table(["matcher", "mAP", "mAR", "MC"], lines) + plots.matching(members))
    return "\n".join(out)


def robustness(rows):
    rows = [r for r in rows if r["configuration"] not in paper.PRESETS or r["configuration"] in ("IIB", "IIB BALANCED")]
    names = list(dict.fromkeys(r["configuration"] for r in rows))
    lines = []
    for (kind, sequence), members in group([r for r in rows if r["kind"] not in ("turn", "scale")],
                                           "kind", "sequence").items():
        by_name = group(members, "configuration")
        lines.append(["%s: %s" % (kind, html.escape(sequence))] +
                     ["%.3f / %.3f" % scores(by_name[(n,)])[:2] if (n,) in by_name else "" for n in names])
    return ('<h2 id="r">Beyond the paper: view, blur, compression</h2><p class="note">Protocol A without scale or '
            "angle given; <i>oriented</i>: the angle is estimated in each image from the intensity centroid of the "
            "ROS. mAP / mAR.</p>" + (table(["change"] + names, lines) if lines else "")
            + "<h3>Turned and scaled references</h3>" + plots.warps(rows, "turn", "degrees")
            + plots.warps(rows, "scale", "factor"))


def cost(rows):
    reference = next((float(r["milliseconds"]) for r in rows if r["configuration"] == "ORB"), None)
    lines = [[html.escape(r["configuration"]), r["bytes"], r["keypoints"], "%.2f" % float(r["milliseconds"]),
              cell(float(r["milliseconds"]) / reference, 2) if reference else "",
              cell(float(r["microseconds_per_further_keypoint"]), 2)
              if r["microseconds_per_further_keypoint"] else ""] for r in rows]
    return ('<h2 id="c">Cost</h2><p class="note">One image of %s, one thread, all descriptors interleaved in one '
            "run, minima. Read the ratios; the milliseconds are of one machine.</p>" % rows[0]["image"]
            + table(["descriptor", "bytes", "keypoints", "ms in all", "ratio to ORB", "&micro;s a further keypoint"],
                    lines) + plots.costs(rows))


def gallery(rows, folder):
    out = ['<h2 id="p">Worst and best pairs</h2><p class="note">Default IIB; green: correct matches, red: wrong.</p>']
    for (name,), members in group(rows, "set").items():
        out.append("<h3>%s</h3><div class=gallery>" % html.escape(name))
        for r in sorted(members, key=lambda r: (r["rank"].split()[0] != "worst", int(r["rank"].split()[1]))):
            with open(os.path.join(folder, r["file"]), "rb") as file:
                data = base64.b64encode(file.read()).decode()
            out.append('<figure><img src="data:image/jpeg;base64,%s" alt=""><figcaption>%s: %s, image %s, %s of %s '
                       "matches correct, %s points</figcaption></figure>"
                       % (data, r["rank"], html.escape(r["sequence"]), html.escape(r["target"]), r["correct"],
                          r["putative"], r["correspondences"]))
        out.append("</div>")
    return "\n".join(out)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("results", help="folder of iib_evaluation's CSV files")
    parser.add_argument("--no-pictures", action="store_true", help="leave photographs out of the page")
    arguments = parser.parse_args()
    sections = []
    tables = {name: read(arguments.results, name)
              for name in ("protocol_a", "protocol_b", "matching", "robustness", "cost")}
    for name, make in (("protocol_a", protocol_a), ("protocol_b", protocol_b), ("matching", matching),
                       ("robustness", robustness), ("cost", cost)):
        if tables[name]:
            sections.append(make(tables[name]))
        if name == "protocol_a" and tables[name]:
            sections.append(presets(tables[name], tables["robustness"], tables["cost"]))
    pictures = [] if arguments.no_pictures else read(arguments.results, "pictures")
    if pictures:
        sections.append(gallery(pictures, arguments.results))
    if not sections:
        sys.exit("%s: no results of iib_evaluation" % arguments.results)
    with open(os.path.join(arguments.results, "settings.txt")) as file:
        settings = file.read().strip().replace("\n", ", ")
    page = os.path.join(arguments.results, "index.html")
    with open(page, "w") as file:
        file.write('<!DOCTYPE html><html lang="en"><head><meta charset="utf-8"><meta name="viewport" '
                   'content="width=device-width"><title>IIB evaluation</title><style>%s</style></head><body>'
                   "<h1>Evaluation of the IIB descriptor</h1><nav><a href='#a'>Predefined points</a><a href='#s'>Presets</a>"
                   "<a href='#b'>"
                   "Detectors</a><a href='#m'>Matching</a><a href='#r'>Robustness</a><a href='#c'>Cost</a>%s</nav>"
                   "<p class=note>Settings: %s. Written by scripts/evaluate.sh from the CSV files beside this page."
                   "</p>%s</body></html>\n"
                   % (STYLE, "<a href='#p'>Pictures</a>" if pictures else "", html.escape(settings),
                      "\n".join(sections)))
    print(page)


if __name__ == "__main__":
    main()
