"""Reading .bspc files into NumPy arrays."""

from __future__ import annotations

import os
from typing import Dict, Iterable, NamedTuple, Optional, Sequence, Tuple, Union

import numpy

from .conversion import arrays_of, to_numpy
from .errors import ErrorLog
from .vtkBSPReader import vtkBSPReader

Box = Tuple[Sequence[float], Sequence[float]]


class PointSet(NamedTuple):
    """Points with their arrays."""

    points: numpy.ndarray
    """Positions, shape (n, 3), float32 where that holds them, else float64."""
    arrays: Dict[str, numpy.ndarray]
    """One row a point, by name: shape (n,) or (n, components); strings are objects."""
    metadata: Dict[str, Union[str, numpy.ndarray]]
    """What the file says beside its points: texts ("CRS", "LengthUnit", …) and arrays, by name."""


def read(
    source: Union[str, "os.PathLike[str]", bytes],
    *,
    level: Optional[int] = None,
    max_points: Optional[int] = None,
    box: Optional[Box] = None,
    arrays: Optional[Iterable[str]] = None,
    cell_ids: Union[bool, int] = False,
    counts: bool = False,
    partial: bool = False,
    threads: int = 0,
) -> PointSet:
    """Reads the points of a .bspc file, or of bytes that hold one.

    The cells of a mesh are not read; ``vtkBSPReader`` gives them.

    level       level of detail, 0 is the coarsest; default: every point, and so is what is beyond
                the finest, for files of a series differ in the number of their levels
    max_points  at most so many points, taken from a coarser level if need be
    box         ((x, y, z), (x, y, z)): only the points between these corners
    arrays      names of the arrays to read; default: all
    cell_ids    add an array "CellId" of the coder's cells: True, or the number of a level
    counts      add an array "PointCount": how many points of the file each one stands for
    partial     take what is whole of a file that ends early
    threads     how many to decode with; default: as many as the machine has

    Raises FileNotFoundError, bspc.Error, and ValueError for arrays that the file does not have.
    """
    reader = vtkBSPReader()
    log = ErrorLog(reader)
    if isinstance(source, (bytes, bytearray, memoryview)):
        reader.ReadFromInputStringOn()
        reader.SetInputString(bytes(source))
    else:
        reader.SetFileName(os.fspath(source))
    reader.SetAllowPartial(partial)
    reader.SetNumberOfThreads(threads)
    reader.SetGenerateVertices(False)
    reader.SetGeneratePointCounts(counts)
    if level is not None:
        reader.SetLevelOfDetail(_at_least("level", level, 0))
    if max_points is not None:
        reader.SetMaximumNumberOfPoints(_at_least("max_points", max_points, 1))
    if box is not None:
        (x0, y0, z0), (x1, y1, z1) = box
        reader.UseBoxOn()
        reader.SetBox(x0, x1, y0, y1, z0, z1)
    if cell_ids is not False:
        reader.GenerateCellIdsOn()
        if cell_ids is not True:
            reader.SetCellIdLevel(_at_least("cell_ids", cell_ids, 0))
    reader.UpdateInformation()
    log.check(True)
    if arrays is not None:
        _select(reader, list(arrays))
    reader.Update()
    log.check(True)
    return _point_set(reader)


def _at_least(name: str, value: int, least: int) -> int:
    if value < least:
        raise ValueError(f"{name} is {value} and must be at least {least}")
    return value


def _select(reader: vtkBSPReader, names: Sequence[str]) -> None:
    selection = reader.GetPointDataArraySelection()
    selection.DisableAllArrays()
    for name in names:
        if not selection.ArrayExists(name):
            raise ValueError(f'the file has no array "{name}"')
        selection.EnableArray(name)


def _point_set(reader: vtkBSPReader) -> PointSet:
    output = reader.GetOutput()
    metadata: Dict[str, Union[str, numpy.ndarray]] = {}
    for name, values in arrays_of(output.GetFieldData()).items():
        text = values.dtype == object and values.shape == (1,)
        metadata[name] = str(values[0]) if text else values
    points = to_numpy(output.GetPoints().GetData())
    return PointSet(points, arrays_of(output.GetPointData()), metadata)
