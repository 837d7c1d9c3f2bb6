"""`bspc bench`: what it measures is what `encode` writes, and it ends when it is told to."""

import csv
import io
import os
import signal
import subprocess
import time
import unittest

from command_support import BSPC, CommandTest, lattice_cloud, write_ply, write_text

TETRAHEDRON = "OFF\n4 4 0\n0 0 0\n9 0 0\n0 9 0\n0 0 9\n3 0 1 2\n3 0 1 3\n3 0 2 3\n3 1 2 3\n"


class Bench(CommandTest):
    def table(self, *arguments, **options):
        """The rows of --tsv."""
        text = self.succeed("bench", *arguments, "--tsv", "--quiet", **options).decode("utf-8")
        return list(csv.DictReader(io.StringIO(text), delimiter="\t"))

    def encoded_size(self, *arguments):
        self.succeed("encode", *arguments, "out.bspc", "--force", "--quiet")
        return os.path.getsize(self.path("out.bspc"))


class Sizes(Bench):
    def test_are_those_of_the_files_that_encode_writes(self):
        columns = [("x", "float"), ("y", "float"), ("z", "float"), ("quality", "uchar")]
        rows = [point + (i % 7,) for i, point in enumerate(lattice_cloud(500))]
        write_ply(self.path("a.ply"), rows, columns)
        self.write_bytes("mesh.off", TETRAHEDRON.encode("ascii"))
        for options in (
            ("a.ply",),
            ("a.ply", "--bits", "8", "--keep-order"),
            ("a.ply", "--positions-only", "--precision", "3"),
            ("mesh.off",),
            ("mesh.off", "--no-faces"),
        ):
            rows = self.table(*options, "--efforts", "1-2,9", "--repeat", "1")
            self.assertEqual([row["effort"] for row in rows], ["1", "2", "9"])
            for row in rows:
                with self.subTest(options=options, effort=row["effort"]):
                    size = self.encoded_size(*options, "--effort", row["effort"])
                    self.assertEqual(int(row["bytes"]), size)
                    bits = 8 * size / int(row["points"])
                    self.assertAlmostEqual(float(row["bits_per_point"]), bits, places=3)

    def test_of_the_first_points_are_those_of_a_model_that_ends_there(self):
        points = lattice_cloud(3000)
        write_ply(self.path("all.ply"), points)
        write_ply(self.path("first.ply"), points[:2000])
        (row,) = self.table("all.ply", "--points", "2000", "--efforts", "2", "--repeat", "1")
        self.assertEqual(row["points"], "2000")
        self.assertEqual(int(row["bytes"]), self.encoded_size("first.ply", "--effort", "2"))

    def test_a_model_cut_short_has_no_faces(self):
        self.write_bytes("mesh.off", TETRAHEDRON.encode("ascii"))
        write_text(self.path("first.off"), [(0, 0, 0), (9, 0, 0), (0, 9, 0)], "off")
        for points, model in (("3", "first.off"), ("4", "mesh.off"), ("5", "mesh.off")):
            with self.subTest(points):
                (row,) = self.table("mesh.off", "--points", points, "--efforts", "2",
                                    "--repeat", "1")
                self.assertEqual(int(row["bytes"]), self.encoded_size(model, "--effort", "2"))

    def test_of_a_pipe_are_those_of_a_file(self):
        write_ply(self.path("a.ply"), lattice_cloud(300))
        (row,) = self.table("-", "--from", "ply", "--efforts", "3", "--repeat", "1",
                            input=self.read_bytes("a.ply"))
        self.assertEqual(int(row["bytes"]), self.encoded_size("a.ply", "--effort", "3"))


class Runs(Bench):
    def test_are_as_many_as_were_asked_for(self):
        write_ply(self.path("a.ply"), lattice_cloud(100))
        for row in self.table("a.ply", "--efforts", "1,5", "--repeat", "4", "--threads", "1"):
            self.assertEqual((row["runs"], row["threads"]), ("4", "1"))
            self.assertGreater(float(row["encode_seconds"]), 0)
            self.assertGreater(float(row["decode_seconds"]), 0)

    def test_are_three_at_least(self):
        write_ply(self.path("a.ply"), lattice_cloud(50))
        for row in self.table("a.ply", "--efforts", "1"):
            self.assertGreaterEqual(int(row["runs"]), 3)

    def test_are_none_once_the_time_is_over(self):
        write_ply(self.path("a.ply"), lattice_cloud(100))
        message = self.refuse("a.ply", "bench", "a.ply", "--seconds", "1e-9")
        self.assertIn("--seconds", message)

    def wait_for_handler(self, pid, number):
        """Until then a signal would end the process as the system does it."""
        deadline = time.monotonic() + 60
        while time.monotonic() < deadline:
            with open("/proc/%d/status" % pid, encoding="ascii") as file:
                caught = next(line for line in file if line.startswith("SigCgt")).split()[1]
            if int(caught, 16) >> (number - 1) & 1:
                return
            time.sleep(0.01)
        self.fail("the command catches no signals")

    def test_end_with_an_interrupt(self):
        write_ply(self.path("a.ply"), lattice_cloud(20000))
        process = subprocess.Popen(
            [BSPC, "bench", "a.ply", "--seconds", "900", "--repeat", "1000"],
            cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
        )
        try:
            self.wait_for_handler(process.pid, signal.SIGINT)
            time.sleep(0.2)
            process.send_signal(signal.SIGINT)
            _, message = process.communicate(timeout=60)
        finally:
            process.kill()
        self.assertEqual(process.returncode, 1, message)
        self.assertIn(b"stopped as asked", message)
        self.assertEqual(self.files(), ["a.ply"])


class Report(Bench):
    def test_tells_people_what_was_measured(self):
        write_ply(self.path("a.ply"), lattice_cloud(1500))
        text = self.succeed("bench", "a.ply", "--efforts", "2,5", "--repeat", "1").decode("utf-8")
        self.assertIn("a.ply: 1,500 points in ", text)
        self.assertIn("; exact; step 1 from (", text)
        lines = [line.split() for line in text.splitlines()]
        methods = {words[0]: words[1] for words in lines if words and words[0] in ("2", "5")}
        self.assertEqual(methods, {"2": "fast", "5": "predictive"})

    def test_says_that_memory_holds_a_part_alone(self):
        write_ply(self.path("a.ply"), lattice_cloud(2000))
        done = self.run_bspc("bench", "a.ply", "--efforts", "1", "--repeat", "1", "--memory", "1e-4")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn(b"--memory", done.stderr)
        self.assertIn(b"a.ply: the first ", done.stdout)

    def test_wrong_usage_ends_with_2(self):
        write_ply(self.path("a.ply"), lattice_cloud(10))
        for options in (
            ("--efforts", "0"),
            ("--efforts", "9-1"),
            ("--efforts", "1,"),
            ("--efforts", "10"),
            ("--repeat", "0"),
            ("--points", "0"),
            ("--seconds", "nan"),
            ("--bits", "8", "--exact"),
            ("--keep-order", "--any-order"),
        ):
            with self.subTest(options):
                self.fail_with(2, "bench", "a.ply", *options)

    def test_a_model_without_points_is_refused(self):
        write_ply(self.path("none.ply"), [])
        self.refuse("none.ply", "bench", "none.ply")


if __name__ == "__main__":
    unittest.main()
