# This file is part of OpenCV project.
# It is subject to the license terms in the LICENSE file found in the top-level directory
# of this distribution and at http://opencv.org/license.html.

"""SVG figures, as text that stands in an HTML page."""
import io
import math

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
from results import curve, group, mean, scores

matplotlib.rcParams.update({
    "svg.hashsalt": "iib", "font.size": 9, "axes.spines.top": False, "axes.spines.right": False,
    "axes.grid": True, "grid.alpha": 0.3, "legend.frameon": False, "svg.fonttype": "none"})
IIB_COLOUR, OTHER_COLOUR = "#c2410c", "#1d4ed8"


def svg(figure):
    buffer = io.StringIO()
    figure.savefig(buffer, format="svg", bbox_inches="tight", metadata={"Date": None})
    plt.close(figure)
    text = buffer.getvalue()
    return text[text.index("<svg"):]


def size_against_recall(rows):
    """Each configuration's mAR over the bytes of a descriptor."""
    figure, axes = plt.subplots(figsize=(9, 5.5))
    points = [(int(members[0]["bytes"]), scores(members)[1], name)
              for (name,), members in group(rows, "configuration").items()]
    labels = {}  # sizes that share a column: heights taken by labels
    for size, recall, name in sorted(points, key=lambda p: -p[1]):
        ours = name.startswith("IIB")
        axes.plot(size, recall, "o" if ours else "s", color=IIB_COLOUR if ours else OTHER_COLOUR, markersize=4)
        column = labels.setdefault(round(2 * math.log2(size)), [])
        height = min([recall] + [taken - 0.022 for taken in column])
        column.append(height)
        axes.annotate(name.replace("IIB ", "") if ours else name, (size, height), fontsize=7, va="center",
                      xytext=(5, 0), textcoords="offset points")
    axes.set_xscale("log", base=2)
    ticks = [8, 16, 32, 64, 128, 256, 512]
    axes.set_xticks(ticks, [str(t) for t in ticks])
    axes.set(xlabel="bytes of a descriptor", ylabel="mAR")
    axes.plot([], [], "o", color=IIB_COLOUR, label="IIB")
    axes.plot([], [], "s", color=OTHER_COLOUR, label="others")
    axes.legend(loc="lower right")
    return svg(figure)


def extra_channels(rows, names):
    """mAP and mAR with and without further maps, on the pairs that have them."""
    figure, axes = plt.subplots(1, 2, figsize=(9, 2.6))
    for axis, column, title in zip(axes, ("precision", "recall"), ("mAP", "mAR")):
        values = [mean(float(r[column]) for r in rows if r["configuration"] == n) for n in names]
        axis.barh(names[::-1], values[::-1], color=IIB_COLOUR, height=0.6)
        for i, value in enumerate(values[::-1]):
            axis.text(value, i, " %.3f" % value, va="center", fontsize=8)
        axis.set(title=title, xlim=(min(values) - 0.05, min(1.02, max(values) + 0.05)))
        axis.grid(axis="y", visible=False)
    axes[1].set_yticklabels([])
    return svg(figure)


def detector_curves(rows):
    """Recall against 1-precision, a panel a detector."""
    detectors = group(rows, "detector")
    columns = 4
    lines = -(-len(detectors) // columns)
    figure, axes = plt.subplots(lines, columns, figsize=(11, 2.8 * lines), squeeze=False)
    for axis in axes.flat[len(detectors):]:
        axis.set_visible(False)
    for axis, ((detector,), members) in zip(axes.flat, detectors.items()):
        for (descriptor,), mine in sorted(group(members, "descriptor").items()):
            correct = mean(int(r["correct"]) for r in mine)
            axis.plot(*curve(mine), color=IIB_COLOUR if descriptor == "IIB" else OTHER_COLOUR,
                      label="%s, %.0f correct" % (descriptor, correct))
        axis.set_title(detector)
        axis.set(xlabel="1 - precision", ylabel="recall", xlim=(0, None), ylim=(0, None))
        axis.legend(fontsize=7, loc="best")
    figure.tight_layout()
    return svg(figure)


def matching(rows):
    """Precision, recall and cost over the threshold; EXACT and ADAPTIVE as levels."""
    thresholded = {float(name[4:]): members for (name,), members in group(rows, "matcher").items()
                   if name.startswith("H-t-")}
    figure, axes = plt.subplots(1, 3, figsize=(11, 2.8))
    for axis, column in zip(axes, ("precision", "recall", "cost")):
        xs = sorted(thresholded)
        axis.plot(xs, [mean(float(r[column]) for r in thresholded[x]) for x in xs], "o-", color=IIB_COLOUR,
                  label="THRESHOLD")
        for name, style in (("EXACT", "--"), ("ADAPTIVE", ":")):
            level = mean(float(r[column]) for r in rows if r["matcher"] == name)
            axis.axhline(level, color=OTHER_COLOUR, linestyle=style, label="%s %.3f" % (name, level))
        axis.set(xlabel="threshold", title="match cost MC" if column == "cost" else "mean " + column)
        axis.legend(fontsize=7)
    figure.tight_layout()
    return svg(figure)


def warps(rows, kind, label):
    """Recall over turns or scales."""
    figure, axis = plt.subplots(figsize=(5.4, 3.2))
    for (name,), members in sorted(group([r for r in rows if r["kind"] == kind], "configuration").items()):
        amounts = sorted({float(r["target"]) for r in members})
        recalls = [mean(float(r["recall"]) for r in members if float(r["target"]) == a) for a in amounts]
        axis.plot(amounts, recalls, "o--" if name.endswith("oriented") else "o-", markersize=3, label=name,
                  color=IIB_COLOUR if name.startswith("IIB") else
                  OTHER_COLOUR if name.startswith("ORB") else "#4d7c0f")
    if kind == "scale":
        axis.set_xscale("log")
        axis.set_xticks(amounts, ["%g" % a for a in amounts])
        axis.minorticks_off()
    axis.set(xlabel=label, ylabel="mAR", ylim=(0, 1.02))
    axis.legend(fontsize=7)
    return svg(figure)


def costs(rows):
    """Milliseconds of each descriptor in all."""
    rows = sorted(rows, key=lambda r: float(r["milliseconds"]))
    figure, axis = plt.subplots(figsize=(9, 0.22 * len(rows) + 0.6))
    colours = [IIB_COLOUR if r["configuration"].startswith("IIB") else OTHER_COLOUR for r in rows]
    axis.barh([r["configuration"] for r in rows], [float(r["milliseconds"]) for r in rows], color=colours)
    axis.invert_yaxis()
    axis.set_xscale("log")
    axis.set_xlabel("milliseconds")
    axis.grid(axis="y", visible=False)
    return svg(figure)
