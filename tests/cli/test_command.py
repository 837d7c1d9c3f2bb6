"""What `bspc` does for its user: what it says, keeps, refuses and leaves behind."""

import json
import os
import signal
import subprocess
import time
import unittest

from command_support import (
    BSPC,
    CommandTest,
    column,
    lattice_cloud,
    parse_ply,
    read_ply,
    read_points,
    write_las,
    write_ply,
)


class Usage(CommandTest):
    def test_help_and_version_succeed(self):
        self.assertIn(b"encode", self.succeed("--help"))
        self.assertTrue(self.succeed("--version").startswith(b"bspc "))
        for command in ("encode", "decode", "info", "verify"):
            self.assertIn(b"--", self.succeed(command, "--help"))

    def test_wrong_usage_ends_with_2_and_writes_nothing(self):
        write_ply(self.path("a.ply"), lattice_cloud(10))
        for arguments in (
            (),
            ("explode",),
            ("encode",),
            ("encode", "a.ply"),
            ("encode", "a.ply", "a.bspc", "--sideways"),
            ("encode", "a.ply", "a.bspc", "--bits", "0"),
            ("encode", "a.ply", "a.bspc", "--bits", "33"),
            ("encode", "a.ply", "a.bspc", "--bits", "many"),
            ("encode", "a.ply", "a.bspc", "--precision", "-1"),
            ("encode", "a.ply", "a.bspc", "--layers", "0"),
            ("encode", "a.ply", "a.bspc", "--layers", "33"),
            ("encode", "a.ply", "a.bspc", "--layout", "sorted"),
            ("encode", "a.ply", "a.bspc", "--method", "guess"),
            ("encode", "a.ply", "a.bspc", "--bits", "12", "--precision", "0.1"),
            ("encode", "a.ply", "a.bspc", "--bits", "12", "--grid", "b.bspc"),
            ("encode", "a.unknown", "a.bspc"),
            ("decode", "a.bspc"),
            ("decode", "a.bspc", "a.unknown"),
            ("decode", "a.bspc", "a.out", "--to", "unknown"),
            ("decode", "a.bspc", "a.laz"),
            ("info",),
            ("verify",),
        ):
            with self.subTest(arguments):
                self.fail_with(2, *arguments)

    def test_a_precision_that_is_no_number_is_refused(self):
        write_ply(self.path("a.ply"), lattice_cloud(10))
        for value in ("nan", "inf"):
            with self.subTest(value):
                done = self.run_bspc("encode", "a.ply", "a.bspc", "--precision", value)
                self.assertIn(done.returncode, (1, 2))
                self.assertIn(b"precision", done.stderr)
                self.assertEqual(self.files(), ["a.ply"])

    def test_quiet_prints_nothing(self):
        write_ply(self.path("a.ply"), lattice_cloud(5000))
        for arguments in (
            ("encode", "a.ply", "a.bspc", "--quiet"),
            ("decode", "a.bspc", "b.ply", "--quiet"),
            ("verify", "a.bspc", "--against", "a.ply", "--quiet"),
        ):
            with self.subTest(arguments):
                done = self.run_bspc(*arguments)
                self.assertEqual((done.returncode, done.stdout, done.stderr), (0, b"", b""))

    def test_reports_go_to_standard_error(self):
        write_ply(self.path("a.ply"), lattice_cloud(5000))
        done = self.run_bspc("encode", "a.ply", "a.bspc")
        self.assertEqual(done.stdout, b"")
        for piece in (b"a.bspc", b"5,000 points", b"bits per point", b"exact"):
            self.assertIn(piece, done.stderr)


class Files(CommandTest):
    def setUp(self):
        super().setUp()
        self.points = lattice_cloud(50)
        write_ply(self.path("a.ply"), self.points)
        self.succeed("encode", "a.ply", "a.bspc")

    def test_an_existing_output_is_kept_without_force(self):
        self.write_bytes("mine.bspc", b"mine")
        self.write_bytes("mine.ply", b"mine")
        self.assertIn("--force", self.refuse("mine.bspc", "encode", "a.ply", "mine.bspc"))
        self.refuse("mine.ply", "decode", "a.bspc", "mine.ply")
        self.assertEqual(self.read_bytes("mine.bspc"), b"mine")
        self.assertEqual(self.read_bytes("mine.ply"), b"mine")
        self.succeed("encode", "a.ply", "mine.bspc", "--force")
        self.succeed("decode", "mine.bspc", "mine.ply", "--force")
        self.assertEqual(read_points(self.path("mine.ply")), sorted(self.points))

    def test_a_failed_command_keeps_the_output_that_it_was_to_replace(self):
        self.write_bytes("bad.ply", b"ply\nnonsense\n")
        good = self.read_bytes("a.bspc")
        self.refuse("bad.ply", "encode", "bad.ply", "a.bspc", "--force")
        self.assertEqual(self.read_bytes("a.bspc"), good)

    def test_a_missing_file_is_named(self):
        self.refuse("none.ply", "encode", "none.ply", "b.bspc")
        self.refuse("none.bspc", "decode", "none.bspc", "b.ply")
        self.refuse("none.bspc", "info", "none.bspc")
        self.refuse("none.bspc", "verify", "none.bspc")
        self.refuse("none.ply", "verify", "a.bspc", "--against", "none.ply")
        self.refuse("none.bspc", "encode", "a.ply", "b.bspc", "--grid", "none.bspc")

    def test_a_folder_is_neither_input_nor_output(self):
        os.mkdir(self.path("folder.ply"))
        self.refuse("folder.ply", "encode", "folder.ply", "b.bspc")
        self.refuse("folder.ply", "decode", "a.bspc", "folder.ply")
        self.refuse("folder.ply", "decode", "a.bspc", "folder.ply", "--force")

    def test_an_output_in_a_folder_that_is_not_there_is_named(self):
        self.refuse("none/b.bspc", "encode", "a.ply", "none/b.bspc")

    def test_a_full_device_is_an_error(self):
        self.refuse("/dev/full", "encode", "a.ply", "/dev/full")
        self.refuse("/dev/full", "decode", "a.bspc", "/dev/full", "--to", "ply")
        with open("/dev/full", "wb") as full:
            self.refuse("standard output", "encode", "a.ply", "-", stdout=full)
            self.refuse("standard output", "decode", "a.bspc", "-", stdout=full)

    def test_a_device_is_written_to_and_not_replaced(self):
        self.succeed("decode", "a.bspc", "/dev/null", "--to", "ply")
        self.assertFalse(os.path.isfile("/dev/null"))


class Content(CommandTest):
    def test_a_point_that_is_not_finite_is_refused_by_its_index(self):
        points = lattice_cloud(40)
        for value in (float("nan"), float("inf"), float("-inf")):
            with self.subTest(value):
                broken = points[:17] + [(1.0, value, 2.0)] + points[17:]
                write_ply(self.path("a.ply"), broken)
                self.assertRegex(self.refuse("a.ply", "encode", "a.ply", "a.bspc"), r"\b17\b")
                self.succeed("encode", "a.ply", "a.bspc", "--drop-nonfinite")
                self.refuse("a.ply", "verify", "a.bspc", "--against", "a.ply")
                self.succeed("verify", "a.bspc", "--against", "a.ply", "--drop-nonfinite")
                self.succeed("decode", "a.bspc", "b.ply", "--force")
                self.assertEqual(read_points(self.path("b.ply")), sorted(points))
                os.remove(self.path("a.bspc"))

    def check_other_content(self, name, *expected):
        message = self.refuse(name, "encode", name, "a.bspc")
        self.assertIn("--positions-only", message)
        for piece in expected:
            self.assertIn(piece, message)
        self.succeed("encode", name, "a.bspc", "--positions-only", "--force")
        self.succeed("decode", "a.bspc", "b.ply", "--force")
        os.remove(self.path("a.bspc"))
        return read_points(self.path("b.ply"))

    def test_columns_without_names_are_refused_unless_left_out_by_name(self):
        self.write_bytes("a.xyz", b"1 2 3 4\n5 6 7 8\n")
        self.assertEqual(self.check_other_content("a.xyz", "column 4"), [(1, 2, 3), (5, 6, 7)])

    def test_what_hangs_on_faces_is_refused_unless_left_out_by_name(self):
        corners = [(0.0, 0.0, 0.0), (0.0, 1.0, 0.0), (1.0, 0.0, 0.0)]
        self.write_bytes("a.off", b"OFF\n3 1 0\n0 0 0\n0 1 0\n1 0 0\n3 0 1 2 255 0 0\n")
        self.assertEqual(self.check_other_content("a.off", "colours of 1 face"), corners)
        self.write_bytes("a.obj", b"v 0 0 0\nv 0 1 0\nv 1 0 0\nvn 0 0 1\nf 1//1 2//1 3//1\n")
        self.assertEqual(self.check_other_content("a.obj", "1 normal"), corners)

    def test_laz_is_refused_with_the_way_out(self):
        write_las(self.path("a.laz"), [(1, 2, 3)], (1, 1, 1), (0, 0, 0), mark=128)
        message = self.refuse("a.laz", "encode", "a.laz", "a.bspc")
        for piece in ("LAZ", "las2las", "pdal"):
            self.assertIn(piece, message)

    def test_verify_tells_the_original_from_another_model(self):
        points = lattice_cloud(500)
        write_ply(self.path("a.ply"), points)
        write_ply(self.path("shuffled.ply"), points[::-1])
        write_ply(self.path("moved.ply"), points[:-1] + [(9.0, 9.0, 9999.0)])
        write_ply(self.path("fewer.ply"), points[:-1])
        write_ply(self.path("twice.ply"), points[:-1] + points[:1])
        self.succeed("encode", "a.ply", "a.bspc")
        self.assertIn(b"500 points", self.succeed("verify", "a.bspc"))
        self.assertIn(b"exact", self.succeed("verify", "a.bspc", "--against", "a.ply"))
        self.succeed("verify", "a.bspc", "--against", "shuffled.ply")
        for name in ("moved.ply", "fewer.ply", "twice.ply"):
            with self.subTest(name):
                self.refuse(name, "verify", "a.bspc", "--against", name)

    def test_verify_tells_the_greatest_error(self):
        points = [(x / 7, y / 7, z / 7) for x, y, z in lattice_cloud(300)]
        write_ply(self.path("a.ply"), points, scalar="double")
        self.succeed("encode", "a.ply", "a.bspc", "--precision", "0.5")
        report = self.succeed("verify", "a.bspc", "--against", "a.ply").decode()
        self.assertRegex(report, r"greatest error 0\.2[0-9]*\n$")


class Info(CommandTest):
    def test_json_says_what_the_file_holds(self):
        write_ply(self.path("a.ply"), lattice_cloud(6000) + [(0.0, 0.0, 0.0), (4095.0,) * 3])
        self.succeed("encode", "a.ply", "a.bspc", "--layers", "3")
        info = json.loads(self.succeed("info", "a.bspc", "--json"))
        size = os.path.getsize(self.path("a.bspc"))
        self.assertEqual(info["version"], "1.0")
        self.assertEqual(info["layout"], "progressive")
        self.assertEqual(info["points"], 6002)
        self.assertEqual(info["fileBytes"], size)
        self.assertAlmostEqual(info["bitsPerPoint"], 8 * size / 6002)
        self.assertEqual(info["scalarType"], "float32")
        self.assertEqual(info["step"], [1, 1, 1])
        self.assertEqual(info["bounds"], [[0, 4095]] * 3)
        self.assertEqual((info["methods"], info["tiles"]), ({"predictive": 1}, 1))
        self.assertEqual(info["wholeLayers"], 3)
        self.assertEqual(len(info["layers"]), 3)
        self.assertEqual(info["layers"][2]["points"], 6002)
        self.assertEqual(info["layers"][2]["spreadSteps"], 0)
        self.assertEqual(info["geometryBytes"], sum(layer["bytes"] for layer in info["layers"]))

    def test_text_says_it_for_people(self):
        write_ply(self.path("a.ply"), lattice_cloud(6000))
        self.succeed("encode", "a.ply", "a.bspc", "--layout", "streaming")
        text = self.succeed("info", "a.bspc")
        for piece in (b"a.bspc", b"streaming", b"6,000", b"float32", b"predictive"):
            self.assertIn(piece, text)


class LevelsOfDetail(CommandTest):
    def setUp(self):
        super().setUp()
        write_ply(self.path("a.ply"), lattice_cloud(5000) + lattice_cloud(300) * 3)
        self.total = 5900
        self.succeed("encode", "a.ply", "a.bspc", "--layers", "4", "--method", "kd")
        self.layers = json.loads(self.succeed("info", "a.bspc", "--json"))["layers"]

    def decode(self, *options):
        self.succeed("decode", "a.bspc", "b.ply", "--force", *options)
        return self.path("b.ply")

    def test_a_level_gives_its_representatives_and_their_counts(self):
        before = 0
        for level, layer in enumerate(self.layers):
            with self.subTest(level):
                counts = column(self.decode("--level", str(level), "--counts"), "PointCount")
                self.assertEqual(len(counts), layer["points"])
                self.assertEqual(sum(counts), self.total)
                self.assertGreaterEqual(min(counts), 1)
                self.assertGreater(len(counts), before)
                before = len(counts)

    def test_a_level_that_is_not_there_is_an_error(self):
        self.refuse("a.bspc", "decode", "a.bspc", "c.ply", "--level", "4")

    def test_a_point_budget_is_kept_and_used(self):
        for level, layer in enumerate(self.layers):
            with self.subTest(level):
                self.assertEqual(
                    len(read_points(self.decode("--max-points", str(layer["points"])))),
                    layer["points"],
                )
        below = self.layers[2]["points"] - 1
        self.assertEqual(
            len(read_points(self.decode("--max-points", str(below)))), self.layers[1]["points"]
        )

    def test_a_budget_below_the_coarsest_level_is_kept_too(self):
        budget = self.layers[0]["points"] // 2
        counts = column(self.decode("--max-points", str(budget), "--counts"), "PointCount")
        self.assertTrue(0 < len(counts) <= budget, len(counts))
        self.assertEqual(sum(counts), self.total)

    def test_cells_of_a_level_cover_all_points(self):
        path = self.decode("--color-level", "1")
        cells = column(path, "CellId")
        self.assertEqual(len(cells), self.total)
        self.assertEqual(sorted(set(cells)), list(range(self.layers[1]["points"])))
        # Points of a cell lie together: within its spread of one of them, so within twice of all.
        reach = 2 * self.layers[1]["spreadSteps"]
        by_cell = {}
        for row, cell in zip(read_ply(path)[1], cells):
            by_cell.setdefault(cell, []).append(row[:3])
        for members in by_cell.values():
            for axis in range(3):
                values = [member[axis] for member in members]
                self.assertLessEqual(max(values) - min(values), reach)

    def test_a_cell_level_finer_than_the_decoded_one_is_an_error(self):
        self.refuse("a.bspc", "decode", "a.bspc", "c.ply", "--level", "1", "--color-level", "2")


class Pipes(CommandTest):
    def test_both_ways(self):
        points = lattice_cloud(5000)
        write_ply(self.path("a.ply"), points)
        packed = self.succeed("encode", "-", "-", "--from", "ply", input=self.read_bytes("a.ply"))
        self.write_bytes("a.bspc", packed)
        info = json.loads(self.succeed("info", "-", "--json", input=packed))
        self.assertEqual(info["layout"], "streaming")
        self.assertIn(b"5,000 points", self.succeed("verify", "-", input=packed))
        self.assertIn(b"exact", self.succeed("verify", "a.bspc", "--against", "a.ply"))
        _, rows = parse_ply(self.succeed("decode", "-", "-", input=packed))
        self.assertEqual(sorted(rows), sorted(points))

    def test_text_goes_through_them(self):
        points = b"0.5 1 2\n3 4 5\n"
        packed = self.succeed("encode", "-", "-", "--from", "xyz", input=points)
        lines = self.succeed("decode", "-", "-", "--to", "xyz", input=packed).splitlines()
        self.assertEqual(sorted(lines), points.splitlines())

    def test_an_error_names_standard_input(self):
        self.refuse("standard input", "decode", "-", "out.ply", input=b"not a bspc file")
        self.refuse("standard input", "info", "-", input=b"")

    def test_a_layout_can_be_asked_for(self):
        write_ply(self.path("a.ply"), lattice_cloud(100))
        packed = self.succeed("encode", "a.ply", "-", "--layout", "progressive")
        info = json.loads(self.succeed("info", "-", "--json", input=packed))
        self.assertEqual(info["layout"], "progressive")


class Interrupts(CommandTest):
    def interrupt(self, number):
        """Ends an encode of 20,000 points with a signal; returns its exit code and message.

        The points come through a pipe that stays open until the signal was sent, so the work
        cannot be over before it however fast the machine is.
        """
        write_ply(self.path("a.ply"), lattice_cloud(20000))
        data = self.read_bytes("a.ply")
        os.remove(self.path("a.ply"))
        process = subprocess.Popen(
            [BSPC, "encode", "-", "out.bspc", "--from", "ply"],
            cwd=self.folder,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
        )
        self.addCleanup(process.kill)
        process.stdin.write(data[:1000])
        process.stdin.flush()
        # Its temporary file is there: the command is at work, and its signal handlers stand.
        deadline = time.monotonic() + 60
        while not self.files() and time.monotonic() < deadline:
            time.sleep(0.01)
        self.assertNotEqual(self.files(), [])
        process.send_signal(number)
        _, errors = process.communicate(data[1000:], timeout=120)
        return process.returncode, errors.decode("utf-8")

    def test_leave_nothing_behind(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            with self.subTest(number):
                code, message = self.interrupt(number)
                self.assertEqual(code, 1, message)
                self.assertEqual(message.count("\n"), 1, message)
                self.assertEqual(self.files(), [])


if __name__ == "__main__":
    unittest.main()
