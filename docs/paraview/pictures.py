"""Renders the pictures of docs/paraview.md. Run by scripts/paraview_pictures.sh, in pvbatch."""

import os
import sys

from paraview.simple import *  # pylint: disable=wildcard-import,unused-wildcard-import

plugin, model, folder = sys.argv[1:4]
LoadPlugin(plugin, remote=False, ns=globals())

SIZE = [420, 420]


def new_view():
    view = CreateView("RenderView")
    view.ViewSize = SIZE
    view.UseColorPaletteForBackground = 0
    view.Background = [1, 1, 1]
    view.OrientationAxesVisibility = 0
    return view


def look_at(view):
    view.CameraPosition = [1, -1.6, 0.9]
    view.CameraFocalPoint = [0, 0, 0]
    view.CameraViewUp = [0, 0, 1]
    view.ResetCamera()


def show(reader, view, array=None, point_size=4):
    display = Show(reader, view)
    display.PointSize = point_size
    if array is None:
        display.AmbientColor = display.DiffuseColor = [0.15, 0.3, 0.6]
        display.ColorArrayName = [None, ""]
    else:
        ColorBy(display, ("POINTS", array))
        lut = GetColorTransferFunction(array)
        lut.ApplyPreset("Rainbow Desaturated", True)
        display.RescaleTransferFunctionToDataRange(False, True)
    display.SetScalarBarVisibility(view, False)
    return display


def save(view, name):
    look_at(view)
    Render(view)
    SaveScreenshot(os.path.join(folder, name), view, ImageResolution=SIZE)


scan = OpenDataFile(model)
file = os.path.join(os.environ.get("TMPDIR", "/tmp"), f"pictures_{os.getpid()}.bspc")
SaveData(file, proxy=scan, DropCells=1, GridMode=1, Bits=12, Method="bsp", NumberOfLevels=12)

reader = OpenDataFile(file)
view = new_view()
show(reader, view)
save(view, "open.png")

# The cells of four levels, as in the figures of the paper.
reader.GenerateCellIds = 1
for name, level in (("cells_a.png", 6), ("cells_b.png", 7), ("cells_c.png", 8), ("cells_d.png", 9)):
    reader.CellIdLevel = level
    view = new_view()
    show(reader, view, "CellId", 5)
    save(view, name)

coarse = OpenDataFile(file)
coarse.LevelOfDetail = 9
view = new_view()
show(coarse, view, point_size=6)
save(view, "coarse.png")

box = OpenDataFile(file)
box.UseBox = 1
box.BoxSize = [length / 2 for length in box.BoxSize]
view = new_view()
show(box, view, point_size=5)
save(view, "box.png")

os.remove(file)
