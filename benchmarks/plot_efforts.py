"""Plots bits per point against decode time of every effort from the table of efforts_benchmark.

Usage: plot_efforts.py EFFORTS.tsv PLOT.svg
"""

import csv
import sys
from collections import defaultdict
from typing import Dict, List, Tuple

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt  # noqa: E402  (the backend is chosen before)

Point = Tuple[int, float, float]  # effort, microseconds, bits per point


def read_table(path: str) -> Dict[str, List[Point]]:
    models: Dict[str, List[Point]] = defaultdict(list)
    with open(path, encoding="utf-8", newline="") as file:
        for row in csv.DictReader(file, delimiter="\t"):
            point = (int(row["effort"]), float(row["decode us"]), float(row["bpp"]))
            models[row["model"]].append(point)
    return models


def plot(models: Dict[str, List[Point]], path: str) -> None:
    figure, axes = plt.subplots(figsize=(9, 6))
    for name, points in models.items():
        points = sorted(points)
        times = [time for _, time, _ in points]
        bits = [size for _, _, size in points]
        axes.plot(times, bits, marker="o", markersize=3, linewidth=1, label=name)
        for effort, time, size in points:
            axes.annotate(str(effort), (time, size), fontsize=6, xytext=(2, 2),
                          textcoords="offset points")
    axes.set_xscale("log")
    axes.set_xlabel("decoding, µs a point (one core)")
    axes.set_ylabel("bits per point, whole file")
    axes.grid(True, which="both", linewidth=0.3)
    axes.legend(fontsize=7, ncol=2)
    axes.set_title("Efforts 1 to 4: method fast; 5 to 9: method predictive")
    figure.tight_layout()
    figure.savefig(path)


def main() -> int:
    if len(sys.argv) != 3:
        print(__doc__, file=sys.stderr)
        return 2
    plot(read_table(sys.argv[1]), sys.argv[2])
    return 0


if __name__ == "__main__":
    sys.exit(main())
