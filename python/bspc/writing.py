"""Writing NumPy arrays to .bspc files."""

from __future__ import annotations

import os
from typing import Any, Dict, List, Mapping, NamedTuple, Optional, Tuple, Union

import numpy
from numpy.typing import ArrayLike
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkPolyData

from .conversion import to_vtk
from .errors import ErrorLog
from .vtkBSPWriter import vtkBSPWriter


class WriteReport(NamedTuple):
    """What was written."""

    points: int
    bytes: int
    exact: bool
    """Whether every coordinate comes back as the number that went in (-0 as 0)."""
    max_error: Tuple[float, float, float]
    """Greatest error along x, y and z, in units of the data."""
    array_errors: Dict[str, float]
    """Greatest error of a value by name of the array (of normals: greatest angle, in degrees)."""


def write(
    path: Union[str, "os.PathLike[str]"],
    points: ArrayLike,
    arrays: Optional[Mapping[str, ArrayLike]] = None,
    **options: Any,
) -> WriteReport:
    """Writes points, and arrays with one row a point, to a .bspc file.

    points is of shape (n, 3) and any type of integer or float. Arrays are integers, floats, bools or
    strings of shape (n,) or (n, components). The file is there whole or not at all.

    Coordinates that lie on a lattice come back exactly; others to float32 precision, or to 31 bits of
    the extent if they are float64. One of these changes that:

    bits         the largest extent spans 2**bits - 1 steps
    precision    steps of that size, in units of the data
    exact        True: bit for bit

    Other options:

    tolerances   greatest errors of values by name of the array; default: bit for bit
    normals, scalars, colours, texture_coordinates
                 names of the arrays that are these
    metadata     texts and arrays by name; "CRS" and "LengthUnit" have a place of their own
    keep_order   keep the order of the points (else it is the coder's)
    original_ids  True: add an array "OriginalPointIds", the row of ``points`` that each point was
    effort       how much time smallness is worth, from 1 (quickest)
    method       name of the method that codes positions
    levels       levels of detail, 1 to 32
    tile_points  most points of a tile, which is what parts are read by
    streaming    True: the index at the end of the file
    drop_nonfinite  True: leave out points with NaN or infinite coordinates
    threads      how many to encode with; default: as many as the machine has

    Raises bspc.Error, and TypeError or ValueError for arguments that cannot be.
    """
    writer = _writer(points, arrays, **options)
    writer.SetFileName(os.fspath(path))
    return _run(writer)


def encode(
    points: ArrayLike, arrays: Optional[Mapping[str, ArrayLike]] = None, **options: Any
) -> bytes:
    """The bytes of the file that ``write`` would write; takes the same options."""
    writer = _writer(points, arrays, **options)
    writer.WriteToOutputStringOn()
    _run(writer)
    return bytes(writer.GetOutputString())


def _run(writer: vtkBSPWriter) -> WriteReport:
    log = ErrorLog(writer)
    log.check(writer.Write() == 1)
    return WriteReport(
        writer.GetNumberOfPointsWritten(),
        writer.GetNumberOfBytesWritten(),
        bool(writer.GetExact()),
        writer.GetMaximumError(),
        {name: writer.GetMaximumArrayError(name) for name in _array_names(writer)},
    )


def _array_names(writer: vtkBSPWriter) -> List[str]:
    attributes = writer.GetInput().GetPointData()
    return [attributes.GetArrayName(i) for i in range(attributes.GetNumberOfArrays())]


def _writer(
    points: ArrayLike,
    arrays: Optional[Mapping[str, ArrayLike]],
    *,
    bits: Optional[int] = None,
    precision: Optional[float] = None,
    exact: bool = False,
    tolerances: Optional[Mapping[str, float]] = None,
    normals: Optional[str] = None,
    scalars: Optional[str] = None,
    colours: Optional[str] = None,
    texture_coordinates: Optional[str] = None,
    metadata: Optional[Mapping[str, Union[str, ArrayLike]]] = None,
    keep_order: bool = False,
    original_ids: bool = False,
    effort: Optional[int] = None,
    method: Optional[str] = None,
    levels: int = 0,
    tile_points: int = 0,
    streaming: bool = False,
    drop_nonfinite: bool = False,
    threads: int = 0,
) -> vtkBSPWriter:
    writer = vtkBSPWriter()
    data = _poly_data(points, arrays or {})
    _activate(data.GetPointData(), normals, scalars, colours, texture_coordinates)
    for name, value in (metadata or {}).items():
        values = numpy.array([value], dtype=object) if isinstance(value, str) else value
        data.GetFieldData().AddArray(to_vtk(name, values))
    writer.SetInputData(data)
    _set_grid(writer, bits, precision, exact)
    for name, tolerance in (tolerances or {}).items():
        if not data.GetPointData().HasArray(name):
            raise ValueError(f'there is no array "{name}" for that tolerance')
        writer.SetArrayTolerance(name, tolerance)
    writer.SetKeepOrder(keep_order)
    writer.SetStoreOriginalPointIds(original_ids)
    if effort is not None:
        if not 1 <= effort <= 9:
            raise ValueError(f"effort is {effort} and must be 1 to 9")
        writer.SetEffort(effort)
    writer.SetMethod(method)
    writer.SetNumberOfLevels(levels)
    writer.SetPointsPerTile(tile_points)
    writer.SetLayout(writer.STREAMING if streaming else writer.PROGRESSIVE)
    writer.SetDropNonFinite(drop_nonfinite)
    writer.SetNumberOfThreads(threads)
    return writer


def _poly_data(points: ArrayLike, arrays: Mapping[str, ArrayLike]) -> vtkPolyData:
    positions = numpy.asarray(points)
    if positions.ndim != 2 or positions.shape[1] != 3:
        raise ValueError(f"points have the shape {positions.shape} instead of (n, 3)")
    if positions.dtype.kind not in "iuf":
        raise TypeError(f"points have values of type {positions.dtype}")
    data = vtkPolyData()
    coordinates = vtkPoints()
    coordinates.SetData(to_vtk("points", positions))
    data.SetPoints(coordinates)
    for name, values in arrays.items():
        array = to_vtk(name, values)
        if array.GetNumberOfTuples() != positions.shape[0]:
            raise ValueError(
                f'the array "{name}" has {array.GetNumberOfTuples()} rows for '
                f"{positions.shape[0]} points"
            )
        data.GetPointData().AddArray(array)
    return data


def _activate(
    attributes: Any,
    normals: Optional[str],
    scalars: Optional[str],
    colours: Optional[str],
    texture_coordinates: Optional[str],
) -> None:
    if scalars is not None and colours is not None:
        raise ValueError("scalars and colours exclude each other")
    for name, activate in (
        (normals, attributes.SetActiveNormals),
        (scalars, attributes.SetActiveScalars),
        (colours, attributes.SetActiveScalars),
        (texture_coordinates, attributes.SetActiveTCoords),
    ):
        if name is None:
            continue
        if not attributes.HasArray(name):
            raise ValueError(f'there is no array "{name}"')
        if activate(name) < 0:
            raise ValueError(f'the array "{name}" cannot be that')


def _set_grid(
    writer: vtkBSPWriter, bits: Optional[int], precision: Optional[float], exact: bool
) -> None:
    if (bits is not None) + (precision is not None) + exact > 1:
        raise ValueError("bits, precision and exact exclude each other")
    if bits is not None:
        if not 1 <= bits <= 32:
            raise ValueError(f"bits is {bits} and must be 1 to 32")
        writer.SetGridModeToBits()
        writer.SetBits(bits)
    elif precision is not None:
        writer.SetGridModeToPrecision()
        writer.SetPrecision(precision)
    elif exact:
        writer.SetGridModeToExact()
