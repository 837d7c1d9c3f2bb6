"""Points through `bspc encode` and back: formats, types, grids, degenerate sets."""

import json
import random
import unittest

from command_support import (
    FORMATS,
    CommandTest,
    float32,
    greatest_error,
    jittered_lattice,
    lattice_cloud,
    read_ply,
    read_points,
    write_las,
    write_pcd,
    write_ply,
    write_text,
)


class RoundTripTest(CommandTest):
    def restore(self, *options, model="in.ply", restored="back.ply"):
        self.succeed("encode", model, "file.bspc", "--force", *options)
        self.succeed("decode", "file.bspc", restored, "--force")
        return read_points(self.path(restored))


class Formats(RoundTripTest):
    POINTS = [(x / 8 - 20, y / 4, -z / 2) for x, y, z in lattice_cloud(300, size=999)]

    def test_every_ply_encoding_comes_back(self):
        for encoding in ("ascii", "binary_little_endian", "binary_big_endian"):
            with self.subTest(encoding):
                write_ply(self.path("in.ply"), self.POINTS, encoding=encoding)
                self.assertEqual(self.restore(), sorted(self.POINTS))

    def test_every_text_format_comes_back(self):
        for kind in ("obj", "off", "xyz", "csv"):
            with self.subTest(kind):
                write_text(self.path("in." + kind), self.POINTS, kind)
                self.assertEqual(self.restore(model="in." + kind), sorted(self.POINTS))

    def test_every_format_is_written_and_read_again(self):
        write_ply(self.path("in.ply"), self.POINTS)
        for kind in FORMATS:
            with self.subTest(kind):
                name = "back." + kind
                self.assertEqual(self.restore(restored=name), sorted(self.POINTS))
                self.succeed("verify", "file.bspc", "--against", name)

    def test_decimals_of_text_come_back_as_the_numbers_they_spell(self):
        points = [(12.34, -0.07, 100000.01), (0.1, 0.2, 0.3), (7.0, 1e-2, -3.99)] * 5
        write_text(self.path("in.xyz"), points, "xyz")
        for kind in FORMATS:
            with self.subTest(kind):
                self.assertEqual(self.restore(model="in.xyz", restored="b." + kind), sorted(points))

    def test_the_format_can_be_named_where_the_name_does_not_tell(self):
        write_text(self.path("points"), self.POINTS, "xyz")
        self.succeed("encode", "points", "file.bspc", "--from", "xyz")
        self.succeed("decode", "file.bspc", "restored", "--to", "csv")
        self.assertEqual(self.read_bytes("restored").count(b","), 2 * (len(self.POINTS) + 1))


class Scans(RoundTripTest):
    """The formats of scanners, which are read only."""

    def check_las(self, scale, offset):
        source = random.Random(8)
        counts = [tuple(source.randint(-(10**6), 10**6) for _ in range(3)) for _ in range(3000)]
        write_las(self.path("in.las"), counts, scale, offset)
        points = [tuple(n * s + o for n, s, o in zip(c, scale, offset)) for c in counts]
        self.assertEqual(self.restore("--positions-only", model="in.las"), sorted(points))
        self.assertIn(b"exact", self.succeed("verify", "file.bspc", "--against", "in.las"))
        steps = json.loads(self.succeed("info", "file.bspc", "--json"))["step"]
        for step, wanted in zip(steps, scale):
            self.assertAlmostEqual(step / wanted, 1, places=12)

    def test_las_is_exact_at_the_step_of_its_scale(self):
        self.check_las((0.01,) * 3, (0, 0, 0))
        self.check_las((0.01,) * 3, (637000, 851000, 0))
        self.check_las((0.001, 0.001, 0.0005), (637123.456, 4851234.567, 12.5))
        self.check_las((0.0003048006096012192,) * 3, (100000.25, 200000.125, 1 / 3))

    def test_las_goes_through_a_pipe(self):
        write_las(self.path("in.las"), [(1, 2, 3), (4, 5, 6)], (1, 1, 1), (0, 0, 0))
        data = self.read_bytes("in.las")
        self.succeed("encode", "-", "a.bspc", "--from", "las", "--positions-only", input=data)
        self.succeed("decode", "a.bspc", "back.ply")
        self.assertEqual(read_points(self.path("back.ply")), [(1, 2, 3), (4, 5, 6)])

    def test_pcd_comes_back(self):
        points = [(x / 8, y / 4, -z / 2) for x, y, z in lattice_cloud(300, size=999)]
        write_pcd(self.path("in.pcd"), points)
        self.assertEqual(self.restore(model="in.pcd"), sorted(points))
        self.assertEqual(read_ply(self.path("back.ply"))[0][0], ("x", "float"))

    def test_empty_places_of_an_organised_cloud_can_be_left_out(self):
        points = lattice_cloud(300)
        write_pcd(self.path("in.pcd"), points + [(float("nan"),) * 3] * 20, height=10)
        self.refuse("in.pcd", "encode", "in.pcd", "a.bspc", "--positions-only")
        options = ("--positions-only", "--drop-nonfinite")
        self.assertEqual(self.restore(*options, model="in.pcd"), sorted(points))


class Types(RoundTripTest):
    def test_integer_types_come_back_as_themselves(self):
        bounds = {
            "char": (-128, 127),
            "uchar": (0, 255),
            "short": (-32768, 32767),
            "ushort": (0, 65535),
            "int": (-(2**31), 2**31 - 1),
            "uint": (0, 2**32 - 1),
        }
        source = random.Random(3)
        for scalar, (low, high) in bounds.items():
            with self.subTest(scalar):
                points = [tuple(source.randint(low, high) for _ in range(3)) for _ in range(50)]
                points += [(low, low, low), (high, high, high)]
                write_ply(self.path("in.ply"), points, scalar=scalar)
                self.assertEqual(self.restore(), sorted(points))
                columns, _ = read_ply(self.path("back.ply"))
                self.assertEqual(columns, [(axis, scalar) for axis in "xyz"])

    def test_utm_doubles_on_a_centimetre_lattice_are_exact(self):
        source = random.Random(2)
        bases = (500000, 7027188, 100)
        points = [
            tuple(float("%d.%02d" % (base + source.randrange(900), source.randrange(100)))
                  for base in bases)
            for _ in range(2000)
        ]
        write_ply(self.path("in.ply"), points, scalar="double")
        self.assertEqual(self.restore(), sorted(points))
        self.assertEqual(read_ply(self.path("back.ply"))[0][0], ("x", "double"))
        self.assertIn(b"exact", self.succeed("verify", "file.bspc", "--against", "in.ply"))

    def test_float32_decimals_are_exact(self):
        source = random.Random(4)
        points = [tuple(float32(source.randrange(9000) / 1000) for _ in range(3)) for _ in range(999)]
        write_ply(self.path("in.ply"), points)
        self.assertEqual(self.restore(), sorted(points))
        self.assertIn(b"exact", self.succeed("verify", "file.bspc", "--against", "in.ply"))

    def test_floats_on_no_lattice_keep_float_precision(self):
        points = [tuple(map(float32, point)) for point in jittered_lattice(8)]
        write_ply(self.path("in.ply"), points)
        # The spacing of floats from 4 to 8, where the largest coordinates are, is 2^-21.
        self.assertLessEqual(greatest_error(points, self.restore()), 2**-22)


class DegenerateSets(RoundTripTest):
    SETS = {
        "no point": [],
        "one point": [(1.5, -2.0, 3.0)],
        "two points": [(0.0, 0.0, 0.0), (1.0, 1.0, 1.0)],
        "one place": [(7.0, 7.0, 7.0)] * 5000,
        "a line": [(float(i), 0.0, 0.0) for i in range(100)],
        "a plane": [(i % 10.0, i // 10.0, 5.0) for i in range(100)],
        "every point thrice": lattice_cloud(500) * 3,
        "far apart": [(0.0, 0.0, 0.0), (0.0, 0.0, 4294967295.0), (1.0, 2.0, 3.0)],
    }

    def test_they_come_back(self):
        for name, points in self.SETS.items():
            with self.subTest(name):
                write_ply(self.path("in.ply"), points, scalar="double")
                self.assertEqual(self.restore(), sorted(points))
                self.succeed("verify", "file.bspc", "--against", "in.ply")

    def test_they_come_back_in_layers_and_streaming(self):
        for name, points in self.SETS.items():
            with self.subTest(name):
                write_ply(self.path("in.ply"), points, scalar="double")
                options = ("--layers", "5", "--layout", "streaming")
                self.assertEqual(self.restore(*options), sorted(points))

    def test_an_empty_set_has_an_answer_in_every_format(self):
        write_ply(self.path("in.ply"), [])
        for kind in FORMATS:
            with self.subTest(kind):
                self.assertEqual(self.restore(restored="back." + kind), [])
        self.assertEqual(json.loads(self.succeed("info", "file.bspc", "--json"))["points"], 0)


class Grids(RoundTripTest):
    def test_precision_bounds_the_error(self):
        for scalar in ("float", "double"):
            for precision in (0.25, 0.01, 0.0003):
                with self.subTest(scalar=scalar, precision=precision):
                    points = jittered_lattice(9, jitter=0.2)
                    if scalar == "float":
                        points = [tuple(map(float32, point)) for point in points]
                    write_ply(self.path("in.ply"), points, scalar=scalar)
                    restored = self.restore("--precision", str(precision))
                    # 4e-7: what rounding the restored coordinate to a float can add.
                    slack = 4e-7 if scalar == "float" else 1e-12
                    self.assertLessEqual(greatest_error(points, restored), precision / 2 + slack)

    def test_bits_give_that_many_steps_along_the_largest_extent(self):
        points = [(x, y / 3, z / 9) for x, y, z in jittered_lattice(9)]
        write_ply(self.path("in.ply"), points, scalar="double")
        extent = max(x for x, _, _ in points) - min(x for x, _, _ in points)
        for bits in (4, 12, 20, 32):
            with self.subTest(bits):
                self.restore("--bits", str(bits))
                info = json.loads(self.succeed("info", "file.bspc", "--json"))
                for step in info["step"]:
                    self.assertAlmostEqual(step * (2**bits - 1) / extent, 1, places=6)

    def test_neighbours_on_one_grid_meet(self):
        source = random.Random(6)
        seam = [(100 + source.random(), source.random() * 50, source.random()) for _ in range(200)]
        west = [(source.random() * 100, source.random() * 50, source.random()) for _ in range(300)]
        # Below and beyond the first file's box, so that the base of the grid has to move.
        east = [(102 + source.random() * 100, source.random() * 90 - 40, -5.0) for _ in range(300)]
        write_ply(self.path("west.ply"), west + seam, scalar="double")
        write_ply(self.path("east.ply"), east + seam, scalar="double")
        self.succeed("encode", "west.ply", "west.bspc", "--precision", "0.0123")
        self.succeed("encode", "east.ply", "east.bspc", "--grid", "west.bspc")
        restored = {}
        for name in ("west", "east"):
            self.succeed("decode", name + ".bspc", name + "_back.ply")
            self.succeed("verify", name + ".bspc", "--against", name + ".ply")
            on_seam = lambda point: 99.99 <= point[0] <= 101.01 and point[2] >= -0.1
            restored[name] = [p for p in read_points(self.path(name + "_back.ply")) if on_seam(p)]
        self.assertEqual(restored["east"], [p for p in restored["west"] if p in restored["east"]])
        self.assertGreaterEqual(len(restored["east"]), len(seam))
        info = [
            json.loads(self.succeed("info", name + ".bspc", "--json")) for name in ("west", "east")
        ]
        self.assertEqual(info[0]["step"], info[1]["step"])

    def test_a_point_outside_the_reach_of_a_grid_is_an_error(self):
        write_ply(self.path("near.ply"), [(0.0, 0.0, 0.0), (0.001, 0.002, 0.003)], scalar="double")
        write_ply(self.path("far.ply"), [(0.0, 0.0, 0.0), (1e9, 0.0, 0.0)], scalar="double")
        self.succeed("encode", "near.ply", "near.bspc", "--precision", "0.001")
        self.refuse("far.ply", "encode", "far.ply", "far.bspc", "--grid", "near.bspc")


if __name__ == "__main__":
    unittest.main()
