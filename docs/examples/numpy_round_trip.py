"""Writes NumPy arrays to a .bspc file, and reads them back as NumPy arrays and in a VTK pipeline."""

import sys

import bspc
import numpy
from vtkmodules.vtkFiltersCore import vtkMaskPoints

if len(sys.argv) != 2:
    sys.exit("Usage: numpy_round_trip.py FILE.bspc")
path = sys.argv[1]

random = numpy.random.default_rng(1)
points = random.uniform(-10, 10, (100_000, 3))
height = points[:, 2].astype(numpy.float32)
report = bspc.write(
    path, points, {"height": height}, precision=0.001, metadata={"CRS": "EPSG:25832"}
)
print(f"{report.points} points in {report.bytes} bytes, greatest error {max(report.max_error)}")

scan = bspc.read(path, box=((0, 0, 0), (10, 10, 10)))
print(f"{len(scan.points)} points are in the box, the first at {scan.points[0]}")
print(f"they are in {scan.metadata['CRS']}, at most {scan.arrays['height'].max()} high")

reader = bspc.vtkBSPReader()
reader.SetFileName(path)
mask = vtkMaskPoints()
mask.SetInputConnection(reader.GetOutputPort())
mask.SetOnRatio(10)
mask.Update()
print(f"every tenth of {reader.GetNumberOfPointsInFile()}: {mask.GetOutput().GetNumberOfPoints()}")
