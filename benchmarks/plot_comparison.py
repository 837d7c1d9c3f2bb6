"""Plots the results of benchmarks/compare.py: size against speed with the Pareto front, and scaling.

Usage: plot_comparison.py RESULTS.tsv FOLDER
"""

import csv
import math
import pathlib
import statistics
import sys
from typing import Dict, List, NamedTuple, Tuple

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (the backend is chosen before)
from matplotlib.ticker import NullLocator, ScalarFormatter  # noqa: E402

Row = Dict[str, str]

FAMILIES = (  # how the name of a codec begins; label, colour, marker
    ("bspc", ".bspc, efforts 1 to 9", "#c0392b", "o"),
    ("Draco kd-tree", "Draco kd-tree, speeds 0 to 10", "#2471a3", "s"),
    ("Draco sequential", "Draco sequential, speeds 0 to 10", "#85c1e9", "D"),
    ("VTK", "VTK .vtp: LZ4, ZLib, LZMA", "#7d3c98", "^"),
    ("zstd", "zstd, sorted points", "#b7950b", "v"),
    ("xz", "xz, sorted points", "#1e8449", "P"),
)
# Efforts that have their number beside their mark: the others stand close to these.
ANNOTATED = ["bspc effort %d" % effort for effort in (1, 2, 3, 5, 9)]
TICKS = (1, 2, 3, 5, 7, 10, 15, 20, 30, 50, 70, 100)  # bits per point
OTHER = ("", "other codecs", "#555555", "*")
TITLES = {"surface": "surface scan", "lines": "terrain in scan lines", "depth": "depth camera",
          "cad": "CAD", "random": "random", "models": "models"}


class Mark(NamedTuple):
    codec: str
    speed: float
    bits: float


def family(codec: str) -> Tuple[str, str, str, str]:
    return next((f for f in FAMILIES if codec.startswith(f[0])), OTHER)


def marks_of(rows: List[Row], column: str) -> List[Mark]:
    """One for each codec that has coded all sets: means over the sets."""
    sets = {row["set"] for row in rows}
    marks = []
    for codec in dict.fromkeys(row["codec"] for row in rows):
        own = [row for row in rows if row["codec"] == codec and not row["note"]]
        if len(own) == len(sets):
            speeds = [math.log(float(row[column])) for row in own]
            marks.append(Mark(codec, math.exp(statistics.fmean(speeds)),
                              statistics.fmean(float(row["bits_per_point"]) for row in own)))
    return marks


def pareto(marks: List[Mark]) -> List[Mark]:
    """Those that no other one beats in both size and speed, from the quickest on."""
    front: List[Mark] = []
    for mark in sorted(marks, key=lambda m: (-m.speed, m.bits)):
        if not front or mark.bits < front[-1].bits:
            front.append(mark)
    return front


def draw_marks(axes, marks: List[Mark]) -> None:
    front = pareto(marks)
    axes.plot([m.speed for m in front], [m.bits for m in front], color="#999999", linewidth=1,
              drawstyle="steps-post", zorder=1)
    for prefix, label, colour, marker in (*FAMILIES, OTHER):
        own = [m for m in marks if family(m.codec)[0] == prefix]
        if own:
            axes.scatter([m.speed for m in own], [m.bits for m in own], s=16, color=colour,
                         marker=marker, label=label, zorder=2, linewidths=0)
        for mark in [m for m in own if m.codec in ANNOTATED]:
            axes.annotate(mark.codec.split()[-1], (mark.speed, mark.bits), fontsize=6,
                          xytext=(2, 3), textcoords="offset points", color=colour)
    axes.set_xscale("log")
    axes.set_yscale("log")
    lowest, highest = axes.get_ylim()
    axes.set_yticks([bits for bits in TICKS if lowest <= bits <= highest])
    axes.yaxis.set_major_formatter(ScalarFormatter())
    axes.yaxis.set_minor_locator(NullLocator())
    axes.grid(True, which="major", linewidth=0.3)
    axes.tick_params(labelsize=7)


def legend(figure, axes_list, rows: int) -> None:
    found = {}
    for axes in axes_list:
        for handle, label in zip(*axes.get_legend_handles_labels()):
            found.setdefault(label, handle)
    figure.legend(found.values(), found.keys(), loc="lower center",
                  ncol=math.ceil(len(found) / rows), fontsize=7, frameon=False)


def plot_sizes(rows: List[Row], folder: pathlib.Path) -> None:
    panels: Dict[str, List[Row]] = {}
    for row in rows:
        if row["group"] != "scaling" and row["threads"] == "1":
            panels.setdefault("models" if row["group"] == "models" else row["set"], []).append(row)
    if not panels:
        return
    across = min(3, len(panels))
    down = math.ceil(len(panels) / across)
    for what in ("decode", "encode"):
        figure, grid = plt.subplots(down, across, figsize=(3.3 * across, 2.6 * down + 0.7),
                                    squeeze=False)
        cells = list(grid.flat)
        for axes, (name, own) in zip(cells, panels.items()):
            draw_marks(axes, marks_of(own, what + "_mpts"))
            points = {int(row["points"]) for row in own}
            count = "%d sets" % len({row["set"] for row in own}) if len(points) > 1 else \
                "{:,} points".format(points.pop())
            axes.set_title("%s (%s)" % (TITLES.get(name, name), count), fontsize=8)
        for axes in cells[len(panels):]:
            axes.set_visible(False)
        for line in grid:
            line[0].set_ylabel("bits per point", fontsize=7)
        for axes in grid[-1]:
            axes.set_xlabel("%sd, million points a second (one thread)" % what, fontsize=7)
        figure.tight_layout(rect=(0, 0.55 / (2.6 * down + 0.7), 1, 1))
        legend(figure, cells, 2)
        figure.savefig(folder / ("size_%s.png" % what), dpi=110)
        plt.close(figure)


SCALED = (
    ("bspc effort 2", "#e67e22"), ("bspc effort 5", "#c0392b"), ("bspc effort 9", "#641e16"),
    ("Draco kd-tree speed 0", "#1a5276"), ("Draco kd-tree speed 10", "#2e86c1"),
    ("Draco sequential speed 0", "#85c1e9"), ("VTK .vtp LZ4", "#bb8fce"),
    ("VTK .vtp LZMA", "#6c3483"), ("zstd -3, sorted", "#b7950b"), ("xz -6, sorted", "#1e8449"),
)
CURVES = (
    ("bits_per_point", "bits per point", False), ("encode_mpts", "encoded, Mpts/s", True),
    ("decode_mpts", "decoded, Mpts/s", True), ("encode_mib", "most memory to encode, MiB", True),
)


def plot_scaling(rows: List[Row], folder: pathlib.Path) -> None:
    scaled = [row for row in rows if row["group"] == "scaling" and not row["note"]]
    for name in dict.fromkeys(row["set"] for row in scaled):
        figure, grid = plt.subplots(2, 2, figsize=(9, 6.6))
        for axes, (column, title, is_log) in zip(grid.flat, CURVES):
            for codec, colour in SCALED:
                for threads in sorted({row["threads"] for row in scaled}):
                    own = sorted((int(row["points"]), float(row[column])) for row in scaled
                                 if (row["set"], row["codec"], row["threads"]) ==
                                 (name, codec, threads))
                    # More threads: for .bspc alone, dashed.
                    if not own or (threads != "1" and not codec.startswith("bspc")):
                        continue
                    axes.plot(*zip(*own), color=colour, marker="o", markersize=2.5, linewidth=1,
                              linestyle="-" if threads == "1" else "--",
                              label=codec if threads == "1" else
                              "%s, threads: %s" % (codec, threads))
            axes.set_xscale("log")
            if is_log:
                axes.set_yscale("log")
            else:
                axes.set_ylim(bottom=0)
            axes.set_title(title, fontsize=8)
            axes.grid(True, which="major", linewidth=0.3)
            axes.tick_params(labelsize=7)
        for axes in grid[-1]:
            axes.set_xlabel("points (%s)" % TITLES.get(name, name), fontsize=7)
        figure.tight_layout(rect=(0, 0.09, 1, 1))
        legend(figure, list(grid.flat), 3)
        figure.savefig(folder / ("scaling_%s.png" % name), dpi=110)
        plt.close(figure)


def main() -> int:
    if len(sys.argv) != 3:
        print(__doc__, file=sys.stderr)
        return 2
    with open(sys.argv[1], encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file, delimiter="\t"))
    plot_sizes(rows, pathlib.Path(sys.argv[2]))
    plot_scaling(rows, pathlib.Path(sys.argv[2]))
    return 0


if __name__ == "__main__":
    sys.exit(main())
