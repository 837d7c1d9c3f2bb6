"""benchmarks/compare.py without its program: who takes turns, what stops, what a report says.

A script stands in for compare_codec; it says what it was told to say.
"""

import argparse
import contextlib
import csv
import io
import os
import pathlib
import sys
import tempfile
import time
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "benchmarks"))
import comparison_report  # noqa: E402  (found by the path above)
from comparison import Comparison, PointSets, external_codec, tmc3_codecs  # noqa: E402

# "slow" takes its seconds from the number of points; "bad" gives other points back.
STAND_IN = """#!/usr/bin/python3
import os, pathlib, subprocess, sys, time
log = open(os.environ["LOG"], "a")
print(*sys.argv[1:4], file=log)
what, words = sys.argv[1], sys.argv[2:]
if what == "list":
    print("bspc effort 1\\tthreads\\nslow\\tone thread\\nbad\\tone thread")
elif what == "generate":
    pathlib.Path(words[2]).write_text(words[1])
    print("points=%s bits=10" % words[1])
elif what == "export":
    pathlib.Path(words[1]).write_text(pathlib.Path(words[0]).read_text())
elif what == "same":
    sys.exit(pathlib.Path(words[0]).read_text() != pathlib.Path(words[1]).read_text())
elif what == "run":
    subprocess.run(words[0], shell=True, check=True)
    print("runs=1 seconds=0.5 processor=0.25 memory=2048 bytes=0")
else:
    points = int(pathlib.Path(words[3]).read_text()) if what == "encode" else 0
    if words[0] == "slow" and points > 5000:
        time.sleep(30)
    if words[0] == "bad" and what == "decode" and words[4] != "-":
        sys.exit("other points came back")
    if what == "encode":
        pathlib.Path(words[4]).write_text("0")
    print("runs=1 seconds=%s processor=0.001 memory=1024 bytes=%d" % (
        "0.5" if words[0] == "slow" else "0.002", points))
"""


class ComparisonTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.program = self.folder / "compare_codec"
        self.program.write_text(STAND_IN)
        self.program.chmod(0o755)
        os.environ["LOG"] = str(self.folder / "log")
        messages = contextlib.redirect_stderr(io.StringIO())
        messages.__enter__()
        self.addCleanup(messages.__exit__, None, None, None)
        self.sets = PointSets(self.program, self.folder, 12, 1000)

    def comparison(self, codecs="", external=(), limit=20.0, rounds=2):
        self.arguments = argparse.Namespace(codecs=codecs, limit=limit, rounds=rounds, seconds=0)
        comparison = Comparison(self.program, self.folder, self.arguments, list(external))
        self.table = open(self.folder / "results.tsv", "w", encoding="utf-8")
        self.addCleanup(self.table.close)
        comparison.write_to(self.table)
        return comparison

    def rows(self):
        with open(self.folder / "results.tsv", encoding="utf-8", newline="") as file:
            return list(csv.DictReader(file, delimiter="\t"))

    def log(self):
        return (self.folder / "log").read_text().splitlines()

    def test_codecs_take_turns(self):
        self.comparison("bspc|slow").measure(self.sets.generated("any", 1000))
        steps = [line for line in self.log() if line.startswith("encode")]
        self.assertEqual(steps, ["encode bspc effort 1 1", "encode slow 1"] * 2)

    def test_sizes_and_speeds_are_per_point(self):
        self.comparison("bspc").measure(self.sets.generated("any", 1000))
        (row,) = self.rows()
        self.assertEqual((row["points"], row["bytes"], row["runs"]), ("1000", "1000", "2"))
        self.assertEqual(float(row["bits_per_point"]), 8)
        # One thread counts in processor time, a millisecond here.
        self.assertEqual(float(row["encode_mpts"]), 1)
        self.assertEqual(float(row["encode_mib"]), 1)

    def test_other_points_are_a_failure(self):
        comparison = self.comparison("bad")
        comparison.measure(self.sets.generated("any", 1000))
        (row,) = self.rows()
        self.assertEqual(comparison.failures, 1)
        self.assertEqual((row["bytes"], row["note"]), ("", "failed: other points came back"))

    def test_what_has_become_too_slow_is_not_tried_on_larger_sets(self):
        # Half a second for 1,000 points is expected to be five for ten times as many.
        external = external_codec("slow", "cp {in.ply} {out}", "cp {out} {back.ply}")
        comparison = self.comparison("bspc|slow", [external], limit=4.5, rounds=1)
        comparison.scale(self.sets, "any", 10000)
        rows = [(row["points"], row["codec"]) for row in self.rows() if row["threads"] == "1"]
        self.assertEqual(rows, [("1000", "bspc effort 1"), ("1000", "slow"),
                                ("10000", "bspc effort 1")])

    def test_another_program_gets_its_files(self):
        copy = external_codec("copy", "cp {in.ply} {out.x}", "cp {out.x} {back.ply}")
        loses = external_codec("loses", "cp {in.ply} {out}", "echo > {back.ply}; test -s {out}")
        comparison = self.comparison("copy|loses", [copy, loses], rounds=1)
        comparison.measure(self.sets.generated("any", 1000))
        kept, lost = self.rows()
        self.assertEqual((kept["bytes"], kept["note"]), ("4", ""))
        self.assertEqual(float(kept["encode_seconds"]), 0.5)
        self.assertTrue(lost["note"].startswith("failed: "))
        self.assertEqual([path.name for path in self.folder.glob("*.ply")], [])

    def test_a_program_over_the_limit_ends(self):
        pid_file = self.folder / "pid"
        command = "sleep 300 & echo $! > %s; cat {in.ply} > {out}; wait" % pid_file
        comparison = self.comparison("endless", [external_codec("endless", command, "true")], 3.0)
        comparison.measure(self.sets.generated("any", 1000))
        self.assertEqual(self.rows()[0]["note"], "over 3 s")
        pid = int(pid_file.read_text())
        deadline = time.monotonic() + 30
        while self.is_running(pid) and time.monotonic() < deadline:
            time.sleep(0.05)
        self.assertFalse(self.is_running(pid))

    @staticmethod
    def is_running(pid):
        try:
            with open("/proc/%d/stat" % pid, encoding="ascii") as file:
                return file.read().rpartition(")")[2].split()[0] != "Z"
        except OSError:
            return False

    def test_gpcc_is_called_without_loss(self):
        script = self.folder / "tmc3"
        script.write_text('#!/bin/sh\nfor a in "$@"; do case $a in *Path=*) eval "${a#--}";; esac\n'
                          'done\ncase $1 in --mode=0) cp "$uncompressedDataPath" '
                          '"$compressedStreamPath";; *) cp "$compressedStreamPath" '
                          '"$reconstructedDataPath";; esac\n')
        script.chmod(0o755)
        comparison = self.comparison("G-PCC", tmc3_codecs(str(script)), rounds=1)
        comparison.measure(self.sets.generated("any", 1000))
        self.assertEqual([(row["codec"], row["note"]) for row in self.rows()],
                         [("G-PCC octree", ""), ("G-PCC predictive", "")])

    def test_a_codec_over_the_limit_is_out_and_a_report_compares_whole_sets_alone(self):
        comparison = self.comparison("bspc|slow", limit=4.0, rounds=1)
        for kind, points in (("surface", 1000), ("lines", 10000)):
            comparison.measure(self.sets.generated(kind, points))
        self.assertEqual([row["note"] for row in self.rows()], ["", "", "", "over 4 s"])
        self.assertEqual(comparison.failures, 0)
        comparison_report.write(self.folder, ["--generated"], self.arguments)
        report = (self.folder / "report.md").read_text(encoding="utf-8")
        self.assertIn("`benchmarks/compare.py --generated`", report)
        self.assertIn("| bits per point | surface scan | terrain in scan lines |", report)
        self.assertIn("| bspc effort 1 | 8.00 | 8.00 |", report)
        self.assertIn("| slow | 8.00 | - |", report)


if __name__ == "__main__":
    unittest.main()
