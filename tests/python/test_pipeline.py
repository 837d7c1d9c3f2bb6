"""A VTK pipeline from Python: source, writer, reader, picture. Needs a display (xvfb-run)."""

import os
import pathlib
import tempfile
import unittest

import bspc
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401 (chooses how to render)
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkFiltersCore import vtkElevationFilter
from vtkmodules.vtkFiltersSources import vtkSphereSource
from vtkmodules.vtkImagingCore import vtkImageDifference
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkRenderingCore import (
    vtkActor,
    vtkPolyDataMapper,
    vtkRenderer,
    vtkRenderWindow,
    vtkWindowToImageFilter,
)

# Where the pictures are kept to be looked at; by default nowhere.
PICTURES = os.environ.get("BSPC_PICTURES")


def sphere():
    source = vtkSphereSource()
    source.SetThetaResolution(120)
    source.SetPhiResolution(90)
    source.SetRadius(10)
    source.GenerateNormalsOff()
    return source


def picture(algorithm, name):
    """Renders what an algorithm gives, coloured by height."""
    elevation = vtkElevationFilter()
    elevation.SetInputConnection(algorithm.GetOutputPort())
    elevation.SetLowPoint(0, 0, -10)
    elevation.SetHighPoint(0, 0, 10)
    mapper = vtkPolyDataMapper()
    mapper.SetInputConnection(elevation.GetOutputPort())
    actor = vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetRepresentationToPoints()
    actor.GetProperty().SetPointSize(3)
    actor.GetProperty().LightingOff()
    renderer = vtkRenderer()
    renderer.AddActor(actor)
    renderer.SetBackground(0.1, 0.1, 0.2)
    window = vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(0)
    window.SetSize(300, 300)
    window.AddRenderer(renderer)
    renderer.GetActiveCamera().SetPosition(30, 20, 15)
    renderer.GetActiveCamera().SetViewUp(0, 0, 1)
    renderer.ResetCamera(-10, 10, -10, 10, -10, 10)
    window.Render()
    image = vtkWindowToImageFilter()
    image.SetInput(window)
    image.ReadFrontBufferOff()
    image.Update()
    if PICTURES:
        writer = vtkPNGWriter()
        writer.SetInputConnection(image.GetOutputPort())
        writer.SetFileName(str(pathlib.Path(PICTURES) / name))
        writer.Write()
    return image


def foreground(image):
    """The share of pixels that are not background."""
    pixels = vtk_to_numpy(image.GetOutput().GetPointData().GetScalars())
    return float((pixels[:, :3].max(axis=1) > 80).mean())


class Pipeline(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.path = str(pathlib.Path(self.folder.name) / "sphere.bspc")

    def write(self, source, **properties):
        writer = bspc.vtkBSPWriter()
        writer.SetInputConnection(source.GetOutputPort())
        writer.SetFileName(self.path)
        writer.DropCellsOn()
        for name, value in properties.items():
            getattr(writer, "Set" + name)(value)
        self.assertEqual(writer.Write(), 1)

    def reader(self):
        reader = bspc.vtkBSPReader()
        reader.SetFileName(self.path)
        return reader

    def difference(self, first, second):
        """Mean difference of the pixels of two pictures, 0 to 1 a pixel."""
        difference = vtkImageDifference()
        difference.SetInputConnection(first.GetOutputPort())
        difference.SetImageConnection(second.GetOutputPort())
        difference.Update()
        return difference.GetThresholdedError() / (300 * 300)

    def test_what_is_read_looks_like_what_was_written(self):
        source = sphere()
        self.write(source)
        before = picture(source, "source.png")
        after = picture(self.reader(), "read.png")
        self.assertGreater(foreground(before), 0.2)
        self.assertLess(self.difference(before, after), 0.005)

    def test_the_comparison_sees_a_difference(self):
        source = sphere()
        self.write(source, GridMode=1, Bits=4)
        before = picture(source, "source.png")
        after = picture(self.reader(), "coarse.png")
        self.assertGreater(self.difference(before, after), 0.02)

    def test_without_vertices_nothing_is_seen(self):
        self.write(sphere())
        reader = self.reader()
        reader.GenerateVerticesOff()
        image = picture(reader, "no_vertices.png")
        self.assertEqual(foreground(image), 0)

    def test_a_preview_covers_the_same_place_with_fewer_points(self):
        self.write(sphere(), NumberOfLevels=3, Method="fast")
        reader = self.reader()
        reader.SetLevelOfDetail(1)
        preview = picture(reader, "preview.png")
        whole = picture(self.reader(), "read.png")
        self.assertGreater(foreground(preview), 0.005)
        self.assertLess(foreground(preview), foreground(whole))


if __name__ == "__main__":
    unittest.main()
