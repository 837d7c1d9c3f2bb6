"""The plugin in pvbatch: opening, levels, boxes, arrays, rendering, saving, series, extractors."""

import os
import unittest

from paraview_support import GOLDEN, ParaViewTest

# A cloud with arrays of its own, large enough for several tiles and levels.
CLOUD = """
cloud = ProgrammableSource()
cloud.OutputDataSetType = 'vtkPolyData'
cloud.Script = '''
import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import vtkPoints
count = 20000
t = np.arange(count)
xyz = np.stack([500000 + (t % 200) * 0.5, 7000000 + (t // 200) * 0.5,
                np.round(10 * np.sin(t % 200 / 20.0), 2)], axis=1)
points = vtkPoints()
points.SetData(numpy_to_vtk(np.ascontiguousarray(xyz), deep=1))
output.VTKObject.SetPoints(points)
for name, values in [('class', (t % 7).astype(np.int32)),
                     ('time', 1e9 + t * 0.25),
                     ('RGB', np.stack([t % 256, t // 256, t % 13], axis=1).astype(np.uint8))]:
    array = numpy_to_vtk(np.ascontiguousarray(values), deep=1)
    array.SetName(name)
    output.VTKObject.GetPointData().AddArray(array)
'''
"""


class Batch(ParaViewTest):
    def test_a_file_opens_with_its_arrays_and_bounds(self):
        out = self.batch(
            f"""
reader = OpenDataFile({os.path.join(GOLDEN, "fast_arrays.bspc")!r})
print('type', type(reader).__name__)
print('points', points_of(reader))
print('arrays', len(arrays_of(reader)))
names = list(reader.PointArrayStatus.Available)
reader.PointArrayStatus = names[:1]
reader.UpdatePipeline()
print('left', arrays_of(reader) == names[:1])
"""
        )
        self.assertEqual(self.told(out, "type"), ["BSPCReader"])
        self.assertGreater(int(self.told(out, "points")[0]), 100)
        self.assertGreater(int(self.told(out, "arrays")[0]), 5)
        self.assertEqual(self.told(out, "left"), ["True"])

    def test_saved_data_come_back_as_they_were(self):
        out = self.batch(
            CLOUD
            + """
SaveData('cloud.bspc', proxy=cloud)
reader = OpenDataFile('cloud.bspc')
print('points', points_of(reader))
def rows(source):
    import numpy as np
    return sorted(zip(values_of(source, 'time').tolist(), values_of(source, 'class').tolist(),
                      map(tuple, values_of(source, 'RGB').tolist()),
                      map(tuple, values_of(source, 'Points').tolist())))
print('same', rows(reader) == rows(cloud))
print('type', values_of(reader, 'Points').dtype)
SaveData('small.bspc', proxy=cloud, GridMode=1, Bits=8, Effort=1)
small = OpenDataFile('small.bspc')
print('small', points_of(small), len(set(values_of(small, 'Points')[:, 0].tolist())))
"""
        )
        self.assertEqual(self.told(out, "points"), ["20000"])
        self.assertEqual(self.told(out, "same"), ["True"])
        self.assertEqual(self.told(out, "type"), ["float64"])
        small, places = map(int, self.told(out, "small")[0].split())
        self.assertEqual(small, 20000)
        self.assertLessEqual(places, 256)  # 8 bits along the longest side

    def test_levels_limits_and_boxes_show_parts(self):
        out = self.batch(
            CLOUD
            + """
SaveData('cloud.bspc', proxy=cloud, NumberOfLevels=3, Method='fast')
reader = OpenDataFile('cloud.bspc')
print('range', list(reader.GetProperty('LevelRange')))
print('finest', reader.LevelOfDetail, points_of(reader))
reader.LevelOfDetail = 1
print('coarse', points_of(reader))
reader.LevelOfDetail = 2
reader.MaximumNumberOfPoints = 500
print('limited', points_of(reader))
reader.LimitPoints = 0
print('unlimited', points_of(reader))
print('box', list(reader.BoxPosition), list(reader.BoxSize))
reader.UseBox = 1
reader.BoxPosition = [500000, 7000000, -20]
reader.BoxSize = [10, 10, 40]
print('inside', points_of(reader))
reader.GenerateCellIds = 1
reader.GeneratePointCounts = 1
reader.UpdatePipeline()
print('more', [name for name in arrays_of(reader) if name in ('CellId', 'PointCount')])
"""
        )
        self.assertEqual(self.told(out, "range"), ["[0, 2]"])
        self.assertEqual(self.told(out, "finest"), ["2 20000"])
        coarse = int(self.told(out, "coarse")[0])
        self.assertTrue(10 < coarse < 2000, coarse)
        self.assertTrue(0 < int(self.told(out, "limited")[0]) <= 500)
        self.assertEqual(self.told(out, "unlimited"), ["20000"])
        self.assertIn("[500000.0, 7000000.0, ", self.told(out, "box")[0])
        self.assertEqual(self.told(out, "inside"), ["441"])  # 21 x 21 points, half a unit apart
        self.assertEqual(self.told(out, "more"), ["['CellId', 'PointCount']"])

    def test_points_are_seen(self):
        out = self.batch(
            f"""
reader = OpenDataFile({os.path.join(GOLDEN, "fast_terrain.bspc")!r})
view = GetActiveViewOrCreate('RenderView')
view.ViewSize = [300, 200]
view.Background = [0, 0, 0]
view.UseColorPaletteForBackground = 0
view.OrientationAxesVisibility = 0
Show(reader, view).AmbientColor = [1, 1, 1]
view.ResetCamera()
Render()
SaveScreenshot('seen.png', view)
from paraview.vtk.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOImage import vtkPNGReader
png = vtkPNGReader()
png.SetFileName('seen.png')
png.Update()
pixels = vtk_to_numpy(png.GetOutput().GetPointData().GetScalars())
print('share', (pixels[:, :3].max(axis=1) > 50).mean())
""",
            screen=True,
        )
        self.assertGreater(float(self.told(out, "share")[0]), 0.02)

    def test_numbered_files_and_series_files_have_times(self):
        out = self.batch(
            """
import json
names = [f'step_{i}.bspc' for i in range(3)]
for i, name in enumerate(names):
    SaveData(name, proxy=Sphere(ThetaResolution=8 + i), DropCells=1)
reader = OpenDataFile(names)
reader.UpdatePipeline()
print('steps', list(reader.TimestepValues))
json.dump({'file-series-version': '1.0',
           'files': [{'name': n, 'time': 0.5 * i} for i, n in enumerate(names)]},
          open('run.bspc.series', 'w'))
series = OpenDataFile('run.bspc.series')
series.UpdatePipeline()
print('times', list(series.TimestepValues))
counts = []
for time in series.TimestepValues:
    series.UpdatePipeline(time)
    counts.append(series.GetDataInformation().GetNumberOfPoints())
print('counts', counts)
"""
        )
        self.assertEqual(self.told(out, "steps"), ["[0.0, 1.0, 2.0]"])
        self.assertEqual(self.told(out, "times"), ["[0.0, 0.5, 1.0]"])
        counts = eval(self.told(out, "counts")[0])  # pylint: disable=eval-used
        self.assertTrue(counts[0] < counts[1] < counts[2], counts)

    def test_extractors_write(self):
        out = self.batch(
            CLOUD
            + """
extractor = CreateExtractor('BSPC', cloud, registrationName='points')
extractor.Writer.FileName = 'extract_{timestep:03d}.bspc'
SaveExtracts(ExtractsOutputDirectory='extracts')
print('points', points_of(OpenDataFile('extracts/extract_000.bspc')))
"""
        )
        self.assertEqual(self.told(out, "points"), ["20000"])

    def test_cells_are_not_dropped_silently(self):
        # An unstructured grid of tetrahedra: what no block of the format holds.
        out = self.batch(
            """
tetrahedra = Delaunay3D(Input=Sphere())
try:
    SaveData('cells.bspc', proxy=tetrahedra)
except RuntimeError as error:
    print('refused')
import os
print('there', os.path.exists('cells.bspc'))
SaveData('cells.bspc', proxy=tetrahedra, DropCells=1)
print('points', points_of(OpenDataFile('cells.bspc')) == points_of(tetrahedra))
"""
        )
        self.assertEqual(self.told(out, "there"), ["False"], out)
        self.assertIn("DropCells", out)
        self.assertEqual(self.told(out, "points"), ["True"])


if __name__ == "__main__":
    unittest.main()
