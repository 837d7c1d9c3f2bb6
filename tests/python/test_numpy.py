"""bspc.read, bspc.write and bspc.encode: NumPy arrays in and out."""

import ast
import pathlib
import tempfile
import unittest

import bspc
import numpy
from vtkmodules.vtkCommonMisc import vtkErrorCode


def rows(array):
    """Rows in ascending order."""
    return array[numpy.lexsort(array.T[::-1])]


class Numpy(unittest.TestCase):
    def setUp(self):
        self.random = numpy.random.default_rng(7)
        self.points = self.random.integers(0, 1000, (5000, 3)) * 0.01
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.path = pathlib.Path(self.folder.name) / "points.bspc"

    def test_points_come_back_exactly(self):
        report = bspc.write(self.path, self.points)
        self.assertEqual(report.points, 5000)
        self.assertEqual(report.bytes, self.path.stat().st_size)
        self.assertTrue(report.exact)
        back = bspc.read(self.path)
        self.assertEqual(back.points.dtype, numpy.float64)
        numpy.testing.assert_array_equal(rows(back.points), rows(self.points))
        self.assertEqual(back.arrays, {})
        self.assertEqual(back.metadata, {})

    def test_bytes_in_memory_are_those_of_the_file(self):
        data = bspc.encode(self.points)
        bspc.write(self.path, self.points)
        self.assertEqual(data, self.path.read_bytes())
        numpy.testing.assert_array_equal(bspc.read(data).points, bspc.read(self.path).points)
        self.assertEqual(len(bspc.read(bytearray(data)).points), 5000)

    def test_every_type_and_layout_of_points_is_taken(self):
        whole = self.random.integers(0, 100, (500, 3))
        for dtype in ("f4", "f8", ">f8", "i1", "u1", "i2", "u2", "i4", "u4", "i8", "u8"):
            points = whole.astype(dtype)
            back = bspc.read(bspc.encode(points))
            numpy.testing.assert_array_equal(rows(back.points), rows(whole), err_msg=dtype)
        for points in (numpy.asfortranarray(whole), whole[::-1], whole.tolist()):
            back = bspc.read(bspc.encode(points))
            numpy.testing.assert_array_equal(rows(back.points), rows(whole))
        self.assertEqual(bspc.read(bspc.encode(whole.astype("f4"))).points.dtype, numpy.float32)

    def test_no_points_come_back_as_no_points(self):
        back = bspc.read(bspc.encode(numpy.empty((0, 3))))
        self.assertEqual(back.points.shape, (0, 3))

    def test_results_outlive_what_made_them(self):
        points = bspc.read(bspc.encode(self.points)).points
        copy = points.copy()
        bspc.read(bspc.encode(self.points * 2))
        numpy.testing.assert_array_equal(points, copy)

    def test_precision_and_bits_bound_the_error(self):
        points = self.random.random((2000, 3)) * 100
        self.assertLessEqual(max(bspc.write(self.path, points, precision=0.5).max_error), 0.25)
        self.assertLessEqual(max(bspc.write(self.path, points, bits=10).max_error), 50 / 1023)

    def test_exact_coordinates_keep_every_bit(self):
        points = self.random.normal(size=(1000, 3)) ** 5
        for dtype in ("f4", "f8"):
            report = bspc.write(self.path, points.astype(dtype), exact=True)
            self.assertTrue(report.exact)
            back = bspc.read(self.path).points
            self.assertEqual(back.dtype, dtype)
            numpy.testing.assert_array_equal(rows(back), rows(points.astype(dtype)))

    def test_arrays_and_metadata_come_back_with_their_points(self):
        count = len(self.points)
        arrays = {
            "row": numpy.arange(count, dtype="u4"),
            "RGB": self.random.integers(0, 256, (count, 3), dtype="u1"),
            "normals": self.random.normal(size=(count, 3)).astype("f4"),
            "time": 10**15 + self.random.integers(0, 10**6, count).cumsum(),
            "seen": self.random.random(count) < 0.5,
            "label": numpy.array(["ground", "Bäume", ""])[self.random.integers(0, 3, count)],
            "big": self.random.random((count, 2)).astype(">f8"),
        }
        metadata = {
            "CRS": "EPSG:25832",
            "LengthUnit": "m",
            "operator": "Grün",
            "matrix": numpy.eye(4) / 3,
            "stations": ["a", "b"],
        }
        bspc.write(self.path, self.points, arrays, metadata=metadata, colours="RGB", normals="normals")
        back = bspc.read(self.path)
        row = back.arrays["row"]
        numpy.testing.assert_array_equal(numpy.sort(row), arrays["row"])
        numpy.testing.assert_array_equal(back.points, self.points[row])
        for name, values in arrays.items():
            numpy.testing.assert_array_equal(back.arrays[name], values[row], err_msg=name)
        self.assertEqual(back.arrays["seen"].dtype, bool)
        self.assertEqual(back.arrays["RGB"].dtype, numpy.uint8)
        self.assertEqual(set(back.metadata), set(metadata))
        for name in ("CRS", "LengthUnit", "operator"):
            self.assertEqual(back.metadata[name], metadata[name])
        numpy.testing.assert_array_equal(back.metadata["matrix"], metadata["matrix"])
        self.assertEqual(list(back.metadata["stations"]), ["a", "b"])
        self.assertEqual(list(bspc.read(self.path, arrays=["time"]).arrays), ["time"])
        bspc.write(self.path, self.points, arrays, keep_order=True)
        kept = bspc.read(self.path)
        numpy.testing.assert_array_equal(kept.points, self.points)
        numpy.testing.assert_array_equal(kept.arrays["label"], arrays["label"])

    def test_tolerances_bound_the_errors_of_arrays(self):
        values = self.random.random(5000)
        row = numpy.arange(5000, dtype="u4")
        report = bspc.write(
            self.path, self.points, {"v": values, "row": row}, tolerances={"v": 0.01}
        )
        back = bspc.read(self.path).arrays
        error = numpy.abs(back["v"] - values[back["row"]]).max()
        self.assertLessEqual(error, 0.01)
        self.assertLessEqual(error, report.array_errors["v"])
        self.assertEqual(report.array_errors["row"], 0)

    def test_parts_are_read_on_their_own(self):
        data = bspc.encode(self.points, tile_points=500, levels=3)
        box = bspc.read(data, box=((1, 2, 3), (5, 5, 9))).points
        low, high = (1, 2, 3), (5, 5, 9)
        inside = ((self.points >= low) & (self.points <= high)).all(axis=1)
        numpy.testing.assert_array_equal(rows(box), rows(self.points[inside]))
        preview = bspc.read(data, level=0, counts=True)
        self.assertLess(len(preview.points), 2500)
        self.assertEqual(preview.arrays["PointCount"].sum(), 5000)
        self.assertLessEqual(len(bspc.read(data, max_points=100).points), 100)
        cells = bspc.read(data, cell_ids=0).arrays["CellId"]
        self.assertEqual(len(numpy.unique(cells)), len(preview.points))
        self.assertEqual(len(bspc.read(data, cell_ids=True).arrays["CellId"]), 5000)

    def test_options_of_the_coder_are_passed_on(self):
        whole = bspc.encode(self.points, method="kd")
        self.assertNotEqual(whole, bspc.encode(self.points, method="fast", effort=1))
        self.assertEqual(whole, bspc.encode(self.points, method="kd", threads=3))
        self.assertNotEqual(whole, bspc.encode(self.points, method="kd", streaming=True))

    def test_original_ids_tell_which_row_each_point_was(self):
        scan = bspc.read(bspc.encode(self.points, original_ids=True))
        numpy.testing.assert_array_equal(
            scan.points, self.points[scan.arrays["OriginalPointIds"]]
        )

    def test_files_that_cannot_be_read_raise_what_is_wrong(self):
        with self.assertRaisesRegex(FileNotFoundError, "none.bspc"):
            bspc.read(self.path.with_name("none.bspc"))
        data = bspc.encode(self.points, levels=2)
        with self.assertRaisesRegex(bspc.Error, "ends early") as caught:
            bspc.read(data[:-100])
        self.assertEqual(caught.exception.code, vtkErrorCode.PrematureEndOfFileError)
        self.assertGreater(len(bspc.read(data[:-100], partial=True).points), 0)
        with self.assertRaisesRegex(bspc.Error, "signature"):
            bspc.read(b"ply\nformat ascii 1.0\n")

    def test_levels_beyond_the_finest_are_the_finest(self):
        data = bspc.encode(self.points, levels=2)
        self.assertLess(len(bspc.read(data, level=0).points), len(self.points))
        self.assertEqual(len(bspc.read(data, level=7).points), len(self.points))

    def test_places_that_cannot_be_written_raise(self):
        with self.assertRaisesRegex(bspc.Error, "cannot be created"):
            bspc.write(self.path.with_name("no") / "folder.bspc", self.points)
        with self.assertRaises(bspc.Error) as caught:
            bspc.write("/dev/full", self.points)
        self.assertEqual(caught.exception.code, vtkErrorCode.OutOfDiskSpaceError)

    def test_points_without_a_place_are_named_or_left_out(self):
        self.points[17, 1] = numpy.nan
        with self.assertRaisesRegex(bspc.Error, "17"):
            bspc.write(self.path, self.points)
        report = bspc.write(self.path, self.points, drop_nonfinite=True)
        self.assertEqual(report.points, 4999)

    def test_arguments_that_cannot_be_raise(self):
        for points in (numpy.zeros((4, 2)), numpy.zeros(3), numpy.zeros((2, 3, 3))):
            with self.assertRaisesRegex(ValueError, "shape"):
                bspc.write(self.path, points)
        with self.assertRaises(TypeError):
            bspc.write(self.path, numpy.zeros((4, 3), dtype=complex))
        with self.assertRaises(TypeError):
            bspc.write(self.path, self.points, unknown=1)
        for wrong in (
            {"bits": 12, "precision": 0.1},
            {"bits": 33},
            {"effort": 0},
            {"normals": "no such array"},
            {"tolerances": {"no such array": 1}},
        ):
            with self.assertRaises(ValueError, msg=str(wrong)):
                bspc.write(self.path, self.points, **wrong)
        with self.assertRaisesRegex(ValueError, "4999 rows for 5000"):
            bspc.write(self.path, self.points, {"a": numpy.zeros(4999)})
        with self.assertRaises(TypeError):
            bspc.write(self.path, self.points, {"a": numpy.zeros(5000, dtype="M8[s]")})
        with self.assertRaisesRegex(ValueError, "no array"):
            bspc.read(bspc.encode(self.points), arrays=["a"])
        self.assertFalse(self.path.exists())

    def test_the_classes_have_documentation_and_type_stubs(self):
        for cls in (bspc.vtkBSPReader, bspc.vtkBSPWriter):
            path = pathlib.Path(bspc.__file__).with_name(cls.__name__ + ".pyi")
            (stub,) = (
                node for node in ast.parse(path.read_text()).body if isinstance(node, ast.ClassDef)
            )
            stubbed = {node.name for node in stub.body if isinstance(node, ast.FunctionDef)}
            methods = {
                name
                for name, value in vars(cls).items()
                if not name.startswith("_") and callable(value) and not isinstance(value, type)
            }
            self.assertEqual(stubbed, methods)
        self.assertIn("its faces belong to it", bspc.vtkBSPReader.SetUseBox.__doc__)
        self.assertIn("keep", bspc.vtkBSPWriter.SetKeepOrder.__doc__.lower())
        for function in (bspc.read, bspc.write, bspc.encode):
            self.assertGreater(len(function.__doc__), 50)


if __name__ == "__main__":
    unittest.main()
