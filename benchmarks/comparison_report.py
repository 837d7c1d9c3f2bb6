"""Writes the report of benchmarks/compare.py: tables in Markdown from its results."""

import csv
import datetime
import math
import os
import pathlib
import platform
import re
import shlex
import statistics
import subprocess
from typing import Dict, List, Tuple

Row = Dict[str, str]

# Of Draco's speeds: the smallest, what its command takes by default, the quickest.
SHOWN = r"^(?!Draco)|speed (0|3|10)$"
# What smaller sets take is the time to begin.
LEAST_FOR_SPEED = 20_000
UNNAMED = {"surface": "surface scan", "lines": "terrain in scan lines", "depth": "depth camera",
           "cad": "CAD", "random": "random"}


def read(path: pathlib.Path) -> List[Row]:
    with open(path, encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file, delimiter="\t"))


def machine() -> str:
    model = platform.processor() or platform.machine()
    try:
        with open("/proc/cpuinfo", encoding="utf-8") as file:
            model = next(line.split(":")[1].strip() for line in file if "model name" in line)
    except (OSError, StopIteration):
        pass
    return "%s, %d threads, Linux %s" % (model, os.cpu_count() or 1, platform.release())


def revision() -> str:
    root = pathlib.Path(__file__).resolve().parent
    done = subprocess.run(["git", "-C", root, "describe", "--always", "--dirty"],
                          stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, check=False)
    return done.stdout.decode("ascii").strip() or "unknown"


def geometric(values: List[float]) -> float:
    return math.exp(statistics.fmean(map(math.log, values)))


def number(value: float) -> str:
    digits = 2 if value >= 1 else 3
    return "%.*f" % (digits, value)


def table(head: List[str], rows: List[List[str]]) -> str:
    lines = ["| " + " | ".join(head) + " |", "| --- |" + " ---: |" * (len(head) - 1)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows]) + "\n"


def group_title(group: str, name: str) -> str:
    return UNNAMED.get(name, name) if group == "generated" else name


def of_one_thread(rows: List[Row]) -> List[Row]:
    return [row for row in rows if row["threads"] == "1"]


def codecs_of(rows: List[Row]) -> List[str]:
    """In the order in which they were measured."""
    return [name for name in dict.fromkeys(row["codec"] for row in rows) if re.search(SHOWN, name)]


def sizes(rows: List[Row]) -> str:
    """Bits per point: a column for each set, models as their mean."""
    columns: Dict[Tuple[str, str], Dict[str, List[float]]] = {}
    complete: Dict[Tuple[str, str], set] = {}
    for row in of_one_thread(rows):
        if row["group"] == "scaling":
            continue
        key = ("models", "models") if row["group"] == "models" else (row["group"], row["set"])
        complete.setdefault(key, set()).add(row["set"])
        if row["bits_per_point"]:
            columns.setdefault(key, {}).setdefault(row["codec"], []).append(
                float(row["bits_per_point"]))
    if not columns:
        return ""
    head = ["bits per point"]
    for key in columns:
        count = len(complete[key])
        head.append("%d models" % count if key[0] == "models" else group_title(*key))
    body = []
    for codec in codecs_of(rows):
        cells = [codec]
        for key, by_codec in columns.items():
            values = by_codec.get(codec, [])
            # A mean over some of the models would not compare.
            whole = len(values) == len(complete[key])
            cells.append("%.2f" % statistics.fmean(values) if whole and values else "-")
        body.append(cells)
    return "## Sizes\n\n" + table(head, body) + "\n"


def speeds(rows: List[Row], threads: str) -> str:
    """Speeds and memory over all sets that are not small, as geometric means."""
    chosen = [row for row in rows if row["threads"] == threads and row["group"] != "scaling"
              and int(row["points"]) >= LEAST_FOR_SPEED]
    sets = {(row["group"], row["set"]) for row in chosen}
    body = []
    for codec in codecs_of(chosen):
        own = [row for row in chosen if row["codec"] == codec and not row["note"]]
        if len(own) != len(sets):
            continue
        cells = [codec]
        for column in ("encode_mpts", "decode_mpts", "encode_mib", "decode_mib"):
            cells.append(number(geometric([float(row[column]) for row in own])))
        body.append(cells)
    if not body:
        return ""
    title = "## Speed and memory, threads: %s\n\n" % threads
    title += "Geometric means over %d %s of %s points or more.\n\n" % (
        len(sets), "set" if len(sets) == 1 else "sets", "{:,}".format(LEAST_FOR_SPEED))
    return title + table(["", "encode Mpts/s", "decode Mpts/s", "encode MiB", "decode MiB"],
                         body) + "\n"


def pictures(output: pathlib.Path, prefix: str) -> str:
    names = sorted(path.name for path in output.glob(prefix + "*.png"))
    return "".join("![%s](%s)\n\n" % (name[:-4].replace("_", " "), name) for name in names)


def scaling(rows: List[Row], plots: str) -> str:
    text = ""
    scaled = [row for row in rows if row["group"] == "scaling"]
    for name in dict.fromkeys(row["set"] for row in scaled):
        own = [row for row in scaled if row["set"] == name]
        counts = sorted({int(row["points"]) for row in own})
        for title, column in (("bits per point", "bits_per_point"),
                              ("encoded Mpts/s", "encode_mpts"), ("decoded Mpts/s", "decode_mpts"),
                              ("MiB to encode", "encode_mib"), ("MiB to decode", "decode_mib")):
            body = []
            for codec, threads in dict.fromkeys((row["codec"], row["threads"]) for row in own):
                if column == "bits_per_point" and threads != "1":
                    continue
                cells = [codec if threads == "1" else "%s, threads: %s" % (codec, threads)]
                for count in counts:
                    found = [row for row in own if int(row["points"]) == count and
                             (row["codec"], row["threads"]) == (codec, threads)]
                    value = found[0][column] if found and not found[0]["note"] else ""
                    cells.append(number(float(value)) if value else "-")
                body.append(cells)
            text += "### %s, %s\n\n" % (UNNAMED.get(name, name), title)
            text += table([""] + ["{:,}".format(count) for count in counts], body) + "\n"
    return "## Scaling\n\n" + plots + text if text else ""


def write(output: pathlib.Path, words: List[str], arguments) -> None:
    rows = read(output / "results.tsv")
    command = shlex.join(["benchmarks/compare.py", *words])
    text = "# Comparison\n\n`%s`\n\n" % command
    text += "%s; version %s; %s.\n\n" % (machine(), revision(), datetime.date.today().isoformat())
    text += (
        "Every file was decoded and holds the points that went in. The codecs took turns, in"
        " --rounds %d; each number is the median. Times are those between points and bytes in"
        " memory: processor time for one thread, time that passed for more, and for codecs that are"
        " programs of their own the whole run of the program. Memory is the most that the process"
        " had, with the points. `-`: longer than %g s for one run (or expected to be, from a set a"
        " tenth as large), or not for all sets.\n\n" % (arguments.rounds, arguments.limit)
    )
    text += pictures(output, "size_")
    text += sizes(rows)
    for threads in dict.fromkeys(row["threads"] for row in rows):
        text += speeds(rows, threads)
    text += scaling(rows, pictures(output, "scaling_"))
    failed = [row for row in rows if row["note"].startswith("failed")]
    if failed:
        text += "## Failures\n\n" + table(
            ["set", "codec", "what"], [[row["set"], row["codec"], row["note"]] for row in failed])
    with open(output / "report.md", "w", encoding="utf-8") as file:
        file.write(text.rstrip("\n") + "\n")
