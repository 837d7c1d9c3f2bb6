"""What benchmarks/compare.py measures, and how: every step in a process of its own.

compare_codec (peers/compare_codec.cpp) does the work; here codecs take turns, and slow ones stop.
"""

import os
import pathlib
import re
import shlex
import signal
import statistics
import subprocess
import sys
from typing import Dict, List, NamedTuple, Optional

COLUMNS = (
    "group", "set", "points", "bits", "codec", "threads", "bytes", "bits_per_point",
    "encode_seconds", "decode_seconds", "encode_mpts", "decode_mpts", "encode_mib", "decode_mib",
    "runs", "note",
)
# Sets of fewer points are one tile, or little work.
LEAST_FOR_THREADS = 100_000
# What is measured of every size: the kinds of codecs, not each of their settings.
SCALED = r"^bspc|kd-tree speed (0|10)$|sequential speed 0$|LZ4|LZMA$|zstd -3|xz -6"


class PointSet(NamedTuple):
    group: str
    name: str
    path: pathlib.Path
    points: int
    bits: int


class Codec(NamedTuple):
    name: str
    uses_threads: bool
    encode: Optional[str] = None  # commands of codecs that are programs of their own
    decode: Optional[str] = None


def external_codec(name, encode, decode):
    return Codec(name, False, encode, decode)


def tmc3_codecs(path):
    """G-PCC's reference software, without loss and with no attributes."""
    program = shlex.quote(path)
    encode = (program + " --mode=0 --positionQuantizationScale=1 --mergeDuplicatedPoints=0"
              " --disableAttributeCoding=1 --uncompressedDataPath={in.ply}"
              " --compressedStreamPath={out.bin}")
    octree = (" --trisoupNodeSizeLog2=0 --neighbourAvailBoundaryLog2=8"
              " --intra_pred_max_node_size_log2=6 --inferredDirectCodingMode=1"
              " --maxNumQtBtBeforeOt=4 --minQtbtSizeLog2=0 --planarEnabled=1 --planarModeIdcmUse=0")
    decode = (program + " --mode=1 --compressedStreamPath={out.bin}"
              " --reconstructedDataPath={back.ply} --outputBinaryPly=1")
    return [
        Codec("G-PCC octree", False, encode + octree, decode),
        Codec("G-PCC predictive", False,
              encode + " --geomTreeType=1 --predGeomSort=2 --predGeomAzimuthSortPrecision=8", decode),
    ]


class StepFailed(Exception):
    """A step of a codec has failed; says why."""


class OverLimit(Exception):
    """A step of a codec took longer than it may."""


def run_step(program, *words, timeout=None) -> Dict[str, float]:
    """What compare_codec printed, as numbers by name."""
    # A session of its own, so that the programs that a command has started end with it.
    with subprocess.Popen([program, *map(str, words)], stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, start_new_session=True) as process:
        try:
            output, errors = process.communicate(timeout=timeout)
        except subprocess.TimeoutExpired as error:
            raise OverLimit() from error
        finally:
            if process.poll() is None:
                os.killpg(process.pid, signal.SIGKILL)
    if process.returncode != 0:
        message = errors.decode("utf-8", "replace").strip().splitlines()
        raise StepFailed(message[-1] if message else "ended with %d" % process.returncode)
    pairs = (pair.split("=") for pair in output.decode("ascii").split())
    return {name: float(value) for name, value in pairs}


class PointSets:
    """Points as files of whole numbers, one at a time."""

    def __init__(self, program, scratch, bits, least):
        self.program = program
        self.path = scratch / "points.i32"
        self.bits = bits
        self.least = least  # points of a model that is one of many

    def kinds(self) -> List[str]:
        return subprocess.run([self.program, "kinds"], stdout=subprocess.PIPE, check=True,
                              encoding="ascii").stdout.split()

    def models(self, folder) -> List[pathlib.Path]:
        """Those that are of a format that bspc reads, each content once."""
        found, seen = [], set()
        for path in sorted(folder.rglob("*")):
            if path.suffix.lower() not in (".off", ".ply", ".xyz"):
                continue
            content = path.read_bytes()
            if content not in seen:
                seen.add(content)
                found.append(path)
        return found

    def _made(self, group, name, *words) -> PointSet:
        made = run_step(self.program, *words, self.path)
        return PointSet(group, name, self.path, int(made["points"]), int(made["bits"]))

    def generated(self, kind, points, group="generated") -> PointSet:
        return self._made(group, kind, "generate", kind, points)

    def from_file(self, group, path) -> Optional[PointSet]:
        """None if the model cannot be read, or is one of the smallest of many."""
        try:
            points = self._made(group, pathlib.Path(path).name, "read", path, self.bits)
        except StepFailed as error:
            if group == "files":
                sys.exit("compare: %s" % error)
            print("compare: left out: %s" % error, file=sys.stderr)
            return None
        return points if group == "files" or points.points >= self.least else None


class Runs:
    """What the runs of one codec on one set have given."""

    def __init__(self, codec, threads):
        self.codec = codec
        self.threads = threads
        self.size = 0
        self.steps = {"encode": [], "decode": []}
        self.note = ""

    def seconds(self, what) -> float:
        """Processor time of one thread, which other work disturbs least; else what passed."""
        key = "processor" if self.threads == 1 and not self.codec.encode else "seconds"
        return statistics.median(step[key] for step in self.steps[what])

    def memory(self, what) -> float:
        return max(step["memory"] for step in self.steps[what]) / 1024


class Comparison:
    def __init__(self, program, scratch, arguments, external):
        self.program = program
        self.scratch = scratch
        self.arguments = arguments
        self.failures = 0
        self.table = None
        listed = subprocess.run([program, "list"], stdout=subprocess.PIPE, check=True,
                                encoding="utf-8").stdout.splitlines()
        codecs = [Codec(name, kind == "threads")
                  for name, kind in (line.split("\t") for line in listed)]
        self.codecs = [codec for codec in codecs + external
                       if re.search(arguments.codecs, codec.name)]
        if not self.codecs:
            sys.exit("compare: no codec has %s in its name" % arguments.codecs)

    def write_to(self, table):
        self.table = table
        print("\t".join(COLUMNS), file=table, flush=True)

    def scale(self, sets, kind, greatest):
        """Ever larger sets; what has become too slow is not tried again."""
        points = 1000
        candidates = self._entrants([c for c in self.codecs if c.encode or
                                     re.search(SCALED, c.name)], LEAST_FOR_THREADS)
        while points <= greatest:
            points_set = sets.generated(kind, points, "scaling")
            entrants = [(codec, threads) for codec, threads in candidates
                        if threads == 1 or points >= LEAST_FOR_THREADS]
            out = set()
            for runs in self.measure(points_set, entrants):
                last = max((step["seconds"] for steps in runs.steps.values() for step in steps),
                           default=float("inf"))
                if runs.note or last * 10 > self.arguments.limit:
                    out.add((runs.codec, runs.threads))
            candidates = [entrant for entrant in candidates if entrant not in out]
            points *= 10

    def _entrants(self, codecs, points):
        threads = os.cpu_count() or 1
        entrants = [(codec, 1) for codec in codecs]
        if threads > 1 and points >= LEAST_FOR_THREADS:
            entrants += [(codec, threads) for codec in codecs if codec.uses_threads]
        return entrants

    def measure(self, points: Optional[PointSet], entrants=None) -> List[Runs]:
        """Rounds in which all take turns; writes a line for each."""
        if points is None:
            return []
        print("compare: %s, %d points" % (points.name, points.points), file=sys.stderr)
        entrants = self._entrants(self.codecs, points.points) if entrants is None else entrants
        all_runs = [Runs(codec, threads) for codec, threads in entrants]
        for first in [True] + [False] * (self.arguments.rounds - 1):
            for runs in all_runs:
                # A run that takes long is no matter of chance: it is not repeated.
                if runs.note or (not first and self._is_slow(runs)):
                    continue
                self._run_once(points, runs, first)
        for runs in all_runs:
            self._write(points, runs)
        return all_runs

    def _is_slow(self, runs):
        return any(runs.seconds(what) > self.arguments.limit / 6 for what in runs.steps)

    def _run_once(self, points, runs, check):
        try:
            step = self._run_external if runs.codec.encode else self._run_own
            step(points, runs, check)
        except OverLimit:
            runs.note = "over %g s" % self.arguments.limit
        except StepFailed as error:
            runs.note = "failed: %s" % error
            self.failures += 1
            print("compare: %s: %s: %s" % (points.name, runs.codec.name, error), file=sys.stderr)

    def _run_own(self, points, runs, check):
        coded = self.scratch / "coded"
        common = (runs.codec.name, runs.threads, self.arguments.seconds)
        limit = self.arguments.limit + self.arguments.seconds
        encoded = run_step(self.program, "encode", *common, points.path, coded, timeout=limit)
        decoded = run_step(self.program, "decode", *common, coded, points.path if check else "-",
                           timeout=limit)
        runs.size = int(encoded["bytes"])
        runs.steps["encode"].append(encoded)
        runs.steps["decode"].append(decoded)

    def _run_external(self, points, runs, check):
        names: Dict[str, str] = {}

        def path(match):
            what, ending = match.group(1), match.group(2) or ""
            names[what] = str(self.scratch / (what + ending))
            if what == "in" and not os.path.exists(names[what]):
                run_step(self.program, "export", points.path, names[what])
            return shlex.quote(names[what])

        try:
            for what, command in (("encode", runs.codec.encode), ("decode", runs.codec.decode)):
                filled = re.sub(r"\{(in|out|back)(\.\w+)?\}", path, command)
                runs.steps[what].append(run_step(self.program, "run", filled,
                                                 timeout=self.arguments.limit))
                if what == "encode":
                    if not os.path.exists(names.get("out", "")):
                        raise StepFailed("the command for encoding has written no {out}")
                    runs.size = os.path.getsize(names["out"])
            if check:
                if "back" not in names:
                    raise StepFailed("the command for decoding names no {back.EXT}")
                run_step(self.program, "same", points.path, names["back"])
        finally:
            for name in names.values():
                if os.path.exists(name):
                    os.remove(name)

    def _write(self, points, runs):
        line = {"group": points.group, "set": points.name, "points": points.points,
                "bits": points.bits, "codec": runs.codec.name, "threads": runs.threads,
                "runs": len(runs.steps["decode"]), "note": runs.note.replace("\t", " ")}
        if not runs.note:
            line["bytes"] = runs.size
            line["bits_per_point"] = "%.4f" % (8 * runs.size / points.points)
            for what in ("encode", "decode"):
                seconds = max(runs.seconds(what), 1e-9)
                line[what + "_seconds"] = "%.6g" % seconds
                line[what + "_mpts"] = "%.4g" % (points.points / seconds / 1e6)
                line[what + "_mib"] = "%.1f" % runs.memory(what)
        print("\t".join(str(line.get(column, "")) for column in COLUMNS), file=self.table,
              flush=True)
