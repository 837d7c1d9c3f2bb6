"""Files of many tiles: boxes, budgets, threads, joining, and models larger than memory."""

import json
import os
import unittest

from command_support import CommandTest, column, lattice_cloud, read_points, write_ply, write_text


class Parts(CommandTest):
    def setUp(self):
        super().setUp()
        self.points = lattice_cloud(20000)
        write_ply(self.path("a.ply"), self.points)
        self.succeed("encode", "a.ply", "a.bspc", "--tile-points", "1000", "--method", "kd")

    def inside(self, box):
        return sorted(p for p in self.points if all(box[k] <= p[k] <= box[k + 3] for k in range(3)))

    def test_a_box_gives_the_points_inside_it(self):
        top = max(max(p) for p in self.points)
        for box in ((0, 0, 0, top, top, top), (10, 20, 30, top / 2, top / 3, top), (-9, -9, -9, -1, -1, -1)):
            with self.subTest(box):
                self.succeed("decode", "a.bspc", "b.ply", "--force", "--box", ",".join(map(str, box)))
                self.assertEqual(read_points(self.path("b.ply")), self.inside(box))

    def test_a_box_that_is_none_is_wrong_usage(self):
        for box in ("1,2,3", "1,2,3,4,5,6,7", "1,2,3,4,5,six", "4,0,0,1,9,9", "nan,0,0,1,1,1", " "):
            with self.subTest(box):
                self.fail_with(2, "decode", "a.bspc", "b.ply", "--box=" + box)

    def test_a_query_tells_what_it_would_read(self):
        whole = json.loads(self.succeed("info", "a.bspc", "--query", "--json"))
        self.assertEqual(whole["bytesRead"], os.path.getsize(self.path("a.bspc")))
        self.assertEqual(whole["pointsAtMost"], len(self.points))
        part = json.loads(
            self.succeed("info", "a.bspc", "--query", "--json", "--box", "0,0,0,40,9999,9999")
        )
        self.assertLess(part["bytesRead"], whole["bytesRead"] / 2)
        self.assertLess(part["tiles"], whole["tiles"])
        self.assertIn(b"tiles", self.succeed("info", "a.bspc", "--query", "--level", "0"))
        self.fail_with(2, "info", "a.bspc", "--level", "0")

    def test_a_budget_is_kept(self):
        self.succeed("decode", "a.bspc", "b.ply", "--max-points", "3000", "--counts")
        counts = column(self.path("b.ply"), "PointCount")
        self.assertTrue(0 < len(counts) <= 3000)
        self.assertEqual(sum(counts), len(self.points))

    def test_any_number_of_threads_gives_the_same(self):
        for threads in ("1", "2", "5"):
            self.succeed("encode", "a.ply", "b.bspc", "--tile-points", "1000", "--method", "kd",
                         "--threads", threads, "--force")
            self.assertEqual(self.read_bytes("b.bspc"), self.read_bytes("a.bspc"))
            self.succeed("decode", "a.bspc", "b%s.ply" % threads, "--threads", threads)
            self.assertEqual(self.read_bytes("b%s.ply" % threads), self.read_bytes("b1.ply"))
            self.succeed("verify", "a.bspc", "--threads", threads)


class Joining(CommandTest):
    def test_joined_files_hold_all(self):
        points = lattice_cloud(3000)
        corners = [(0.0, 0.0, 0.0), (9999.0, 9999.0, 9999.0)]
        write_ply(self.path("a.ply"), points[:1000] + corners)
        write_ply(self.path("b.ply"), points[1000:] + corners)
        self.succeed("encode", "a.ply", "a.bspc")
        self.succeed("encode", "b.ply", "b.bspc", "--grid", "a.bspc", "--layout", "streaming")
        for layout in ("progressive", "streaming"):
            self.succeed("join", "a.bspc", "b.bspc", "-o", "c.bspc", "--layout", layout, "--force")
            self.succeed("decode", "c.bspc", "c.ply", "--force")
            self.assertEqual(read_points(self.path("c.ply")), sorted(points + corners * 2))
        self.refuse("c.bspc", "join", "a.bspc", "-o", "c.bspc")

    def test_what_cannot_be_joined_is_named(self):
        write_ply(self.path("a.ply"), lattice_cloud(100))
        write_ply(self.path("b.ply"), [(x / 7, y, z) for x, y, z in lattice_cloud(100)])
        self.succeed("encode", "a.ply", "a.bspc")
        self.succeed("encode", "b.ply", "b.bspc")
        self.assertIn("--grid", self.refuse("c.bspc", "join", "a.bspc", "b.bspc", "-o", "c.bspc"))
        self.refuse("a.ply", "join", "a.bspc", "a.ply", "-o", "c.bspc")
        self.refuse("none.bspc", "join", "none.bspc", "-o", "c.bspc")
        self.fail_with(2, "join", "-o", "c.bspc")
        self.fail_with(2, "join", "a.bspc")


class LargerThanMemory(CommandTest):
    """32 MiB are the least that the encoder takes; these sets need more."""

    def setUp(self):
        super().setUp()
        self.points = lattice_cloud(300000)

    def check(self, model, *options):
        done = self.run_bspc("encode", model, "a.bspc", "--memory", "0.001", *options)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn(b"streaming", done.stderr)
        self.assertEqual(json.loads(self.succeed("info", "a.bspc", "--json"))["layout"], "streaming")
        self.succeed("decode", "a.bspc", "b.ply")
        self.assertEqual(read_points(self.path("b.ply")), sorted(self.points))

    def test_ply(self):
        write_ply(self.path("a.ply"), self.points)
        self.check("a.ply")

    def test_text(self):
        write_text(self.path("a.xyz"), self.points, "xyz")
        self.check("a.xyz", "--tile-points", "20000")

    def test_temporary_files_do_not_stay(self):
        write_ply(self.path("a.ply"), self.points)
        os.mkdir(self.path("temporary"))
        environment = dict(os.environ, TMPDIR=self.path("temporary"))
        done = self.run_bspc("encode", "a.ply", "a.bspc", "--memory", "0.001", env=environment)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(os.listdir(self.path("temporary")), [])


if __name__ == "__main__":
    unittest.main()
