"""Arrays, metadata and the order of points through the command."""

import json
import os
import random
import struct
import unittest

from command_support import CommandTest, float32, lattice_cloud, read_ply, write_las, write_pcd, write_ply

AXES = [(axis, "float") for axis in "xyz"]
COLUMNS = AXES + [
    ("red", "uchar"),
    ("green", "uchar"),
    ("blue", "uchar"),
    ("nx", "float"),
    ("ny", "float"),
    ("nz", "float"),
    ("time", "double"),
    ("class", "short"),
    ("intensity", "ushort"),
    ("label", "int"),
    ("id", "uint"),
    ("quality", "char"),
]


def rows_of(count, seed=1):
    source = random.Random(seed)
    rows = []
    for i, point in enumerate(lattice_cloud(count, seed)):
        normal = tuple(float32(source.uniform(-1, 1)) for _ in range(3))
        rows.append(
            point
            + (source.randrange(256), source.randrange(256), 7)
            + normal
            + (i * 0.1, source.randrange(-5, 5), source.randrange(65536))
            + (source.randrange(-(2**31), 2**31), source.randrange(2**32), -128)
        )
    return rows


class ArrayTest(CommandTest):
    def setUp(self):
        super().setUp()
        self.rows = rows_of(1300)
        write_ply(self.path("in.ply"), self.rows, COLUMNS)

    def restore(self, *options, decoding=()):
        self.succeed("encode", "in.ply", "file.bspc", "--force", *options)
        self.succeed("decode", "file.bspc", "back.ply", "--force", *decoding)
        return read_ply(self.path("back.ply"))

    def assert_same_rows(self, restored, given):
        """In any order. A difference is told in short: showing all rows takes unittest minutes."""
        missing = set(given) - set(restored)
        self.assertEqual((len(restored), len(missing)), (len(given), 0), list(missing)[:2])
        self.assertTrue(sorted(restored) == sorted(given))

    def info(self):
        return json.loads(self.succeed("info", "file.bspc", "--json"))

    def names(self):
        return [array["name"] for array in self.info()["arrays"]]


class Properties(ArrayTest):
    def test_come_back_with_names_types_and_order(self):
        columns, rows = self.restore()
        self.assertEqual(columns, COLUMNS)
        self.assert_same_rows(rows, self.rows)
        report = self.succeed("verify", "file.bspc", "--against", "in.ply").decode()
        self.assertIn("with 8 arrays", report)

    def test_are_arrays_that_info_lists(self):
        self.restore()
        arrays = {array["name"]: array for array in self.info()["arrays"]}
        self.assertEqual(
            list(arrays),
            ["RGB", "Normals", "time", "class", "intensity", "label", "id", "quality"],
        )
        self.assertEqual(arrays["Normals"]["semantic"], "normals")
        self.assertEqual(arrays["RGB"]["componentNames"], ["red", "green", "blue"])
        self.assertEqual((arrays["RGB"]["type"], arrays["RGB"]["components"]), ("uint8", 3))
        self.assertGreater(arrays["label"]["bitsPerValue"], 30)
        text = self.succeed("info", "file.bspc").decode()
        for piece in ("3 x float32", "Normals", "nx, ny, nz", "bits a value"):
            self.assertIn(piece, text)

    def test_can_be_chosen_when_encoding(self):
        self.assertEqual(self.restore("--arrays", "class, RGB")[0], AXES + COLUMNS[3:6] + COLUMNS[10:11])
        self.succeed("verify", "file.bspc", "--against", "in.ply")
        without = ("--no-array", "Normals", "--no-array", "id", "--no-array", "RGB")
        self.assertEqual(
            self.restore(*without)[0],
            AXES + [c for c in COLUMNS[9:] if c[0] != "id"],
        )
        self.assertEqual(self.restore("--positions-only")[0], AXES)
        self.assertEqual(self.info()["metadata"]["entries"], {})

    def test_can_be_chosen_when_decoding(self):
        columns, rows = self.restore(decoding=("--arrays", "class,intensity"))
        self.assertEqual(columns, AXES + COLUMNS[10:12])
        self.assert_same_rows(rows, [row[:3] + row[10:12] for row in self.rows])
        self.assertEqual(self.restore(decoding=("--positions-only",))[0], AXES)
        self.assertEqual(self.restore(decoding=("--arrays", ""))[0], AXES)

    def test_that_are_not_there_are_named(self):
        for options in (("--arrays", "clas"), ("--no-array", "clas"), ("--array-precision", "clas=1")):
            with self.subTest(options):
                message = self.fail_with(2, "encode", "in.ply", "a.bspc", *options)
                self.assertIn('"clas"', message)
                self.assertIn("intensity", message)
        self.succeed("encode", "in.ply", "file.bspc")
        self.assertIn("clas", self.fail_with(2, "decode", "file.bspc", "a.ply", "--arrays", "clas"))
        message = self.fail_with(2, "encode", "in.ply", "a.bspc", "--no-array", "nx")
        self.assertIn("Normals", message)

    def test_of_a_part_come_with_its_points(self):
        box = (1000, 1000, 1000, 3000, 3000, 3000)
        _, rows = self.restore(decoding=("--box", ",".join(map(str, box))))
        wanted = [r for r in self.rows if all(box[k] <= r[k] <= box[k + 3] for k in range(3))]
        self.assert_same_rows(rows, wanted)

    def test_go_through_csv_and_xyz(self):
        self.restore()
        for kind in ("csv", "xyz"):
            with self.subTest(kind):
                self.succeed("decode", "file.bspc", "back." + kind)
                self.succeed("encode", "back." + kind, "text.bspc", "--force")
                self.succeed("decode", "text.bspc", "again.ply", "--force")
                columns, rows = read_ply(self.path("again.ply"))
                self.assertEqual([name for name, _ in columns], [name for name, _ in COLUMNS])
                # Text does not say that a number was a float32, so it comes back as a float64.
                rounded = [row[:6] + tuple(map(float32, row[6:9])) + row[9:] for row in rows]
                self.assert_same_rows(rounded, self.rows)

    def test_stay_with_their_points_in_small_memory(self):
        self.rows = rows_of(60000)
        write_ply(self.path("in.ply"), self.rows, COLUMNS)
        columns, rows = self.restore("--layout", "streaming", "--tile-points", "5000")
        self.assert_same_rows(rows, self.rows)
        self.assertEqual(columns, COLUMNS)

    def test_of_formats_that_cannot_hold_them_are_refused(self):
        self.succeed("encode", "in.ply", "file.bspc")
        for kind in ("obj", "off"):
            with self.subTest(kind):
                message = self.refuse("out." + kind, "decode", "file.bspc", "out." + kind)
                self.assertIn("--positions-only", message)
                self.succeed("decode", "file.bspc", "out." + kind, "--positions-only")


class Precision(ArrayTest):
    def test_bounds_the_error_of_an_array(self):
        options = ("--array-precision", "time=0.01", "--array-precision", "Normals=2", "--keep-order")
        _, rows = self.restore(*options)
        for given, restored in zip(self.rows, rows):
            self.assertLessEqual(abs(given[9] - restored[9]), 0.01 + 1e-9)
            self.assertEqual(given[10:], restored[10:])
        self.succeed("verify", "file.bspc", "--against", "in.ply")

    def test_is_for_numbers_with_a_fraction(self):
        for wish in ("class=1", "time", "time=-1", "time=nan"):
            with self.subTest(wish):
                self.fail_with(2, "encode", "in.ply", "a.bspc", "--array-precision", wish)


class Order(ArrayTest):
    def test_is_kept_on_request(self):
        _, rows = self.restore("--keep-order")
        self.assertTrue(rows == self.rows)
        self.assertTrue(self.info()["keepsOrder"])
        self.assertIn(b"order", self.succeed("info", "file.bspc"))
        self.assertIn(b"in their order", self.succeed("verify", "file.bspc", "--against", "in.ply"))
        write_ply(self.path("turned.ply"), self.rows[::-1], COLUMNS)
        self.refuse("turned.ply", "verify", "file.bspc", "--against", "turned.ply")

    def test_can_be_an_array(self):
        columns, rows = self.restore("--original-ids")
        self.assertEqual(columns[-1][0], "OriginalPointIds")
        for row in rows:
            self.assertEqual(row[:-1], self.rows[int(row[-1])])
        self.succeed("verify", "file.bspc", "--against", "in.ply")

    def test_of_rows_is_kept_without_asking(self):
        points = lattice_cloud(600)
        write_pcd(self.path("in.pcd"), points, height=20)
        self.succeed("encode", "in.pcd", "file.bspc")
        self.succeed("decode", "file.bspc", "back.pcd")
        self.assertEqual(
            self.read_bytes("back.pcd").split(b"DATA binary\n")[1],
            self.read_bytes("in.pcd").split(b"DATA binary\n")[1],
        )
        self.assertIn(b"WIDTH 30\nHEIGHT 20\n", self.read_bytes("back.pcd"))
        self.succeed("encode", "in.pcd", "file.bspc", "--any-order", "--force")
        self.assertFalse(self.info()["keepsOrder"])
        self.succeed("decode", "file.bspc", "back.pcd", "--force")
        self.assertIn(b"WIDTH 600\nHEIGHT 1\n", self.read_bytes("back.pcd"))

    def test_is_kept_or_not(self):
        self.fail_with(2, "encode", "in.ply", "a.bspc", "--keep-order", "--any-order")


class Comparison(ArrayTest):
    def test_finds_a_value_that_differs(self):
        self.succeed("encode", "in.ply", "file.bspc")
        changed = list(self.rows)
        changed[1234] = changed[1234][:10] + (99,) + changed[1234][11:]
        write_ply(self.path("changed.ply"), changed, COLUMNS)
        message = self.refuse("changed.ply", "verify", "file.bspc", "--against", "changed.ply")
        self.assertIn("class", message)
        self.assertIn("1,234", message)

    def test_finds_values_at_other_points(self):
        self.succeed("encode", "in.ply", "file.bspc")
        turned = [a[:3] + b[3:] for a, b in zip(self.rows, self.rows[1:] + self.rows[:1])]
        write_ply(self.path("turned.ply"), turned, COLUMNS)
        self.refuse("turned.ply", "verify", "file.bspc", "--against", "turned.ply")

    def test_matches_points_at_the_same_place_by_their_values(self):
        rows = [(1.0, 2.0, 3.0) + row[3:] for row in self.rows[:500]]
        write_ply(self.path("in.ply"), rows, COLUMNS)
        self.succeed("encode", "in.ply", "file.bspc", "--array-precision", "time=0.5")
        self.succeed("verify", "file.bspc", "--against", "in.ply")

    def test_finds_an_array_of_another_type(self):
        self.succeed("encode", "in.ply", "file.bspc")
        columns = [(n, "int" if n == "class" else t) for n, t in COLUMNS]
        write_ply(self.path("other.ply"), self.rows, columns)
        message = self.refuse("other.ply", "verify", "file.bspc", "--against", "other.ply")
        self.assertIn("int32", message)


class Metadata(ArrayTest):
    def test_a_coordinate_system_can_be_given(self):
        self.restore("--crs", "EPSG:25832")
        self.assertEqual(self.info()["metadata"]["crs"], "EPSG:25832")
        self.assertIn(b"EPSG:25832", self.succeed("info", "file.bspc"))

    def test_comments_come_back(self):
        data = self.read_bytes("in.ply").replace(
            b"element vertex", b"comment made in a hurry\nobj_info 7\nelement vertex"
        )
        self.write_bytes("in.ply", data)
        self.restore()
        back = self.read_bytes("back.ply")
        self.assertIn(b"comment made in a hurry\n", back)
        self.assertIn(b"obj_info 7\n", back)


class Scans(CommandTest):
    def setUp(self):
        super().setUp()
        source = random.Random(4)
        self.counts = [tuple(source.randint(-(10**6), 10**6) for _ in range(3)) for _ in range(2000)]
        self.attributes = [bytes(source.randrange(256) for _ in range(22)) for _ in self.counts]
        write_las(
            self.path("in.las"),
            self.counts,
            (0.01, 0.01, 0.001),
            (637000, 851000.25, 0),
            point_format=3,
            attributes=self.attributes,
        )

    def test_las_comes_back_byte_for_byte(self):
        self.succeed("encode", "in.las", "file.bspc", "--keep-order")
        self.succeed("verify", "file.bspc", "--against", "in.las")
        self.succeed("decode", "file.bspc", "back.las")
        self.assertTrue(self.read_bytes("back.las")[227:] == self.read_bytes("in.las")[227:])

    def test_las_points_come_back_whole_in_any_order(self):
        self.succeed("encode", "in.las", "file.bspc")
        self.succeed("decode", "file.bspc", "back.las")
        records = [
            [data[at : at + 34] for at in range(227, len(data), 34)]
            for data in (self.read_bytes("in.las"), self.read_bytes("back.las"))
        ]
        self.assertTrue(sorted(records[0]) == sorted(records[1]))
        self.succeed("verify", "file.bspc", "--against", "back.las")

    def test_las_goes_to_a_pipe_and_to_ply(self):
        self.succeed("encode", "in.las", "file.bspc")
        data = self.succeed("decode", "file.bspc", "-", "--to", "las")
        self.write_bytes("piped.las", data)
        self.succeed("verify", "file.bspc", "--against", "piped.las")
        self.succeed("decode", "file.bspc", "back.ply")
        columns = dict(read_ply(self.path("back.ply"))[0])
        self.assertEqual((columns["red"], columns["GpsTime"]), ("ushort", "double"))

    def test_coordinates_that_las_rounds_are_told(self):
        self.succeed("encode", "in.las", "file.bspc", "--positions-only")
        self.assertNotIn(b"rounded", self.run_bspc("decode", "file.bspc", "a.las").stderr)
        self.succeed("encode", "in.las", "file.bspc", "--precision", "0.0007", "--force")
        self.assertIn(b"rounded", self.run_bspc("decode", "file.bspc", "b.las").stderr)

    def test_laz_is_not_written(self):
        self.succeed("encode", "in.las", "file.bspc")
        self.assertIn("LAS", self.fail_with(2, "decode", "file.bspc", "a.laz"))


class OtherContent(CommandTest):
    def test_lists_are_refused_with_the_way_out(self):
        header = (
            b"ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
            b"property float z\nproperty list uchar int w\nproperty int n\nend_header\n"
        )
        self.write_bytes("a.ply", header + b"1 2 3 2 7 8 5\n4 5 6 0 6\n")
        message = self.refuse("a.ply", "encode", "a.ply", "a.bspc")
        for piece in ('"w"', "--drop-other", "--positions-only"):
            self.assertIn(piece, message)
        self.assertIn("--drop-other", self.refuse("a.ply", "encode", "a.ply", "a.bspc", "--no-faces"))
        self.succeed("encode", "a.ply", "a.bspc", "--drop-other")
        self.succeed("decode", "a.bspc", "b.ply")
        columns, rows = read_ply(self.path("b.ply"))
        self.assertEqual(columns, AXES + [("n", "int")])
        self.assertEqual(sorted(rows), [(1, 2, 3, 5), (4, 5, 6, 6)])

    def test_faces_can_be_left_out_alone(self):
        corners = [(0.0, 0.0, 0.0, 1), (0.0, 1.0, 0.0, 2), (1.0, 0.0, 0.0, 3)]
        face = b"\3" + struct.pack("<3i", 0, 1, 2)
        write_ply(self.path("a.ply"), corners, AXES + [("red", "uchar")], tail=face)
        self.succeed("encode", "a.ply", "a.bspc", "--no-faces")
        self.assertNotIn(b"mesh", self.succeed("info", "--json", "a.bspc"))
        self.succeed("decode", "a.bspc", "b.ply")
        self.assertEqual(sorted(read_ply(self.path("b.ply"))[1]), corners)


class Exactness(CommandTest):
    def check(self, scalar, points):
        write_ply(self.path("in.ply"), points, scalar=scalar)
        self.succeed("encode", "in.ply", "file.bspc", "--exact", "--force")
        self.assertIn(b"every bit", self.succeed("info", "file.bspc"))
        self.succeed("verify", "file.bspc", "--against", "in.ply")
        code = {"float": "<3f", "double": "<3d"}[scalar]
        bits = sorted(struct.pack(code, *point) for point in points)
        for kind in ("ply", "pcd"):
            self.succeed("decode", "file.bspc", "back." + kind, "--force")
            data = self.read_bytes("back." + kind)
            size = struct.calcsize(code)
            body = data[len(data) - size * len(points) :]
            restored = sorted(body[at : at + size] for at in range(0, len(body), size))
            self.assertTrue(restored == bits, kind)

    def test_keeps_every_bit_of_floats(self):
        source = random.Random(6)
        draw = lambda: source.gauss(0, 1) * 10 ** source.randrange(-20, 20)
        points = [tuple(draw() for _ in range(3)) for _ in range(500)] + [(-0.0, 0.0, 1e-310)]
        self.check("double", points)
        self.check("float", [tuple(map(float32, p)) for p in points])

    def test_tells_the_bits_apart(self):
        write_ply(self.path("in.ply"), [(0.1, 1 / 3, 1e-9), (-0.0, 2.0, 3.0)], scalar="double")
        write_ply(self.path("other.ply"), [(0.1, 1 / 3, 1e-9), (0.0, 2.0, 3.0)], scalar="double")
        self.succeed("encode", "in.ply", "file.bspc", "--exact")
        self.refuse("other.ply", "verify", "file.bspc", "--against", "other.ply")

    def test_excludes_other_grids(self):
        write_ply(self.path("in.ply"), lattice_cloud(10))
        self.fail_with(2, "encode", "in.ply", "a.bspc", "--exact", "--bits", "12")


class Streams(ArrayTest):
    def test_larger_than_memory_carry_arrays(self):
        self.rows = rows_of(130000)
        write_ply(self.path("in.ply"), self.rows, COLUMNS)
        columns, rows = self.restore("--memory", "0.03")
        self.assertEqual(columns, COLUMNS)
        self.assert_same_rows(rows, self.rows)


class Damage(ArrayTest):
    def test_of_arrays_is_found(self):
        self.succeed("encode", "in.ply", "file.bspc")
        good = self.read_bytes("file.bspc")
        source = random.Random(4)
        for _ in range(40):
            data = bytearray(good)
            data[source.randrange(len(data))] ^= 1 << source.randrange(8)
            self.write_bytes("bad.bspc", data)
            self.refuse("bad.bspc", "decode", "bad.bspc", "out.ply")
            self.assertFalse(os.path.exists(self.path("out.ply")))


if __name__ == "__main__":
    unittest.main()
