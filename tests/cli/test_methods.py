"""`bspc encode --method` and its lossy stops, from outside."""

import json
import math
import re
import unittest

from command_support import CommandTest, lattice_cloud, read_points, write_ply

METHODS = ("kd", "bsp", "octree", "gencode")


class Methods(CommandTest):
    def test_each_brings_the_points_back(self):
        write_ply(self.path("a.ply"), lattice_cloud(700))
        for method in METHODS:
            for layers in ("1", "4"):
                self.succeed("encode", "a.ply", "a.bspc", "-f", "--method", method, "--layers", layers)
                self.succeed("verify", "a.bspc", "--against", "a.ply")
                self.succeed("decode", "a.bspc", "b.ply", "-f")
                self.assertEqual(read_points(self.path("b.ply")), read_points(self.path("a.ply")))
                info = json.loads(self.succeed("info", "--json", "a.bspc"))
                self.assertEqual(info["points"], 700)

    def test_a_grid_that_is_too_fine_is_refused_and_others_named(self):
        write_ply(self.path("a.ply"), [(0.0, 0.0, 0.0), (1.0 + 2.0**-40, 2.0, 3.0)], scalar="double")
        for method in ("bsp", "octree", "gencode"):
            error = self.fail_with(1, "encode", "a.ply", "a.bspc", "--method", method, "--bits", "30")
            self.assertIn("kd", error)


class LossyStops(CommandTest):
    def setUp(self):
        super().setUp()
        self.points = lattice_cloud(900)
        write_ply(self.path("a.ply"), self.points)

    def test_the_report_and_verify_tell_the_error(self):
        for method in ("kd", "bsp"):
            for stop in (("--stop-points", "5"), ("--stop-level", "7")):
                report = self.run_bspc("encode", "a.ply", "a.bspc", "-f", "--method", method, *stop).stderr
                error = float(re.search(rb"greatest error ([0-9.]+)", report).group(1))
                self.fail_with(1, "verify", "a.bspc", "--against", "a.ply")
                told = self.succeed("verify", "a.bspc", "--against", "a.ply", "--lossy")
                distance = float(re.search(rb"farther than ([0-9.]+)", told).group(1))
                self.assertLessEqual(distance, error * math.sqrt(3))
                self.succeed("decode", "a.bspc", "b.ply", "-f")
                back = read_points(self.path("b.ply"))
                self.assertEqual(len(back), 900)
                greatest = max(min(math.dist(p, q) for q in set(back)) for p in self.points)
                self.assertAlmostEqual(distance, greatest, places=3)

    def test_a_method_without_them_says_so(self):
        self.fail_with(1, "encode", "a.ply", "a.bspc", "--method", "octree", "--stop-points", "2")

    def test_another_number_of_points_is_an_error(self):
        self.succeed("encode", "a.ply", "a.bspc", "--method", "bsp", "--stop-points", "5")
        write_ply(self.path("b.ply"), self.points[1:])
        self.fail_with(1, "verify", "a.bspc", "--against", "b.ply", "--lossy")


if __name__ == "__main__":
    unittest.main()
