"""Renders the paper's Figures 1, 2, 6 and 7 from points coloured by cell, as `paper figures` writes
them. Needs a screen; benchmarks/paper.sh pictures gives it one.

Usage: paper_pictures.py FIGURES FOLDER
"""

import pathlib
import sys
from typing import List, NamedTuple, Tuple


import matplotlib  # for its fonts
from PIL import Image, ImageDraw, ImageFont
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkPolyData
from vtkmodules.vtkFiltersGeneral import vtkVertexGlyphFilter
from vtkmodules.vtkIOPLY import vtkPLYReader
from vtkmodules.vtkRenderingCore import (
    vtkActor,
    vtkPolyDataMapper,
    vtkRenderer,
    vtkRenderWindow,
    vtkWindowToImageFilter,
)
from vtkmodules.vtkRenderingOpenGL2 import vtkEDLShading, vtkRenderStepsPass


class View(NamedTuple):
    """Where the camera stands, seen from the middle of the model, and what is up."""

    position: Tuple[float, float, float]
    up: Tuple[float, float, float]
    zoom: float


class Panel(NamedTuple):
    path: pathlib.Path
    label: str
    plain: bool  # in one colour


SIDE = 260  # of a panel, in pixels

BUNNY = View((0.2, 0.15, 1), (0, 1, 0), 1.35)
TRICERATOPS = View((-0.8, 0.35, 1), (0, 1, 0), 1.2)
ARMADILLO = View((-0.15, 0.1, -1), (0, 1, 0), 1.35)


def read(path: pathlib.Path) -> vtkPolyData:
    reader = vtkPLYReader()
    reader.SetFileName(str(path))
    vertices = vtkVertexGlyphFilter()
    vertices.SetInputConnection(reader.GetOutputPort())
    vertices.Update()
    if vertices.GetOutput().GetNumberOfPoints() == 0:
        sys.exit("paper_pictures: %s has no points" % path)
    return vertices.GetOutput()


def render(window: vtkRenderWindow, data: vtkPolyData, view: View, size: float,
           plain: bool) -> Image.Image:
    mapper = vtkPolyDataMapper()
    mapper.SetInputData(data)
    mapper.SetScalarVisibility(not plain)
    actor = vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetColor(0.25, 0.45, 0.75)
    actor.GetProperty().SetPointSize(size)
    actor.GetProperty().LightingOff()
    renderer = vtkRenderer()
    renderer.SetBackground(1, 1, 1)
    renderer.AddActor(actor)
    camera = renderer.GetActiveCamera()
    camera.SetPosition(*view.position)
    camera.SetViewUp(*view.up)
    camera.SetViewAngle(10)
    renderer.ResetCamera()
    camera.Zoom(view.zoom)
    window.AddRenderer(renderer)
    flat = pixels(window)
    # Points have no normals: depth is shown by darkening what lies behind an edge.
    shading = vtkEDLShading()
    shading.SetDelegatePass(vtkRenderStepsPass())
    renderer.SetPass(shading)
    shaded = pixels(window)
    window.RemoveRenderer(renderer)
    return Image.blend(flat, shaded, 0.4).resize((SIDE, SIDE), Image.Resampling.LANCZOS)


def pixels(window: vtkRenderWindow) -> Image.Image:
    window.Render()
    picture = vtkWindowToImageFilter()
    picture.SetInput(window)
    picture.ReadFrontBufferOff()
    picture.Update()
    values = vtk_to_numpy(picture.GetOutput().GetPointData().GetScalars())
    width, height = window.GetSize()
    return Image.fromarray(values.reshape(height, width, 3)[::-1].copy())


def save(window: vtkRenderWindow, path: pathlib.Path, panels: List[Panel], view: View,
         across: int, size: float) -> None:
    font = ImageFont.truetype(matplotlib.get_data_path() + "/fonts/ttf/DejaVuSans.ttf", 13)
    strip = 20  # for the label, under each picture
    down = (len(panels) + across - 1) // across
    sheet = Image.new("RGB", (across * SIDE, down * (SIDE + strip)), "white")
    draw = ImageDraw.Draw(sheet)
    for i, panel in enumerate(panels):
        x, y = i % across * SIDE, i // across * (SIDE + strip)
        sheet.paste(render(window, read(panel.path), view, size, panel.plain), (x, y))
        draw.text((x + SIDE / 2, y + SIDE + strip / 2), panel.label, "#222222", font, anchor="mm")
    sheet.quantize(96, dither=Image.Dither.NONE).save(path, optimize=True)


def rates(folder: pathlib.Path) -> List[Panel]:
    """The four rates: points coloured by cell, and under them what the decoder makes of them."""
    coloured, restored = [], []
    for line in (folder / "rates.txt").read_text(encoding="ascii").splitlines():
        name, bits, cells = line.split("\t")
        coloured.append(Panel(folder / (name + ".ply"), "{:,} cells".format(int(cells)), False))
        restored.append(Panel(folder / (name + "_restored.ply"), bits + " bits per point", True))
    return coloured + restored


def levels(folder: pathlib.Path, numbers: List[int]) -> List[Panel]:
    return [Panel(folder / ("level_%02d.ply" % number), "level %d" % number, False)
            for number in numbers]


def main() -> int:
    if len(sys.argv) != 3:
        print(__doc__, file=sys.stderr)
        return 2
    figures, folder = map(pathlib.Path, sys.argv[1:])
    window = vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(0)
    window.SetSize(2 * SIDE, 2 * SIDE)
    save(window, folder / "figure1.png", rates(figures / "bunny00"), BUNNY, 4, 7)
    save(window, folder / "figure2.png",
         levels(figures / "triceratops", [1, 2, 3, 4, 5, 6, 7, 8]), TRICERATOPS, 4, 9)
    save(window, folder / "figure6.png",
         levels(figures / "bunny00", [0, 1, 2, 3, 4, 5, 7, 9]), BUNNY, 4, 7)
    save(window, folder / "figure7.png",
         levels(figures / "armadillo", [0, 1, 2, 3, 4, 5, 7, 9]), ARMADILLO, 4, 6)
    return 0


if __name__ == "__main__":
    sys.exit(main())
