"""Arrays of VTK as arrays of NumPy, and back, without copying where the memory is the same."""

from __future__ import annotations

from typing import Any, Dict

import numpy
from numpy.typing import ArrayLike
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkAbstractArray, vtkBitArray, vtkStringArray


def to_numpy(array: vtkAbstractArray) -> numpy.ndarray:
    """Values of a VTK array: (n,) for one component, else (n, components)."""
    components = array.GetNumberOfComponents()
    if isinstance(array, vtkStringArray):
        values = numpy.array(
            [array.GetValue(i) for i in range(array.GetNumberOfValues())], dtype=object
        )
    elif isinstance(array, vtkBitArray):
        count = array.GetNumberOfValues()
        packed = numpy.frombuffer(array, dtype=numpy.uint8) if count else numpy.empty(0, "u1")
        values = numpy.unpackbits(packed, count=count).astype(bool)
    else:
        return vtk_to_numpy(array)
    return values if components == 1 else values.reshape(-1, components)


def to_vtk(name: str, values: ArrayLike) -> vtkAbstractArray:
    """A VTK array of values of shape (n,) or (n, components). Raises TypeError, ValueError."""
    array = numpy.asarray(values)
    if array.ndim not in (1, 2):
        raise ValueError(f'the array "{name}" has {array.ndim} dimensions instead of 1 or 2')
    if array.dtype.kind in "UO":
        result = _strings(name, array)
    elif array.dtype.kind == "b":
        result = _bits(array)
    elif array.dtype.kind in "iuf" and array.dtype.itemsize in (1, 2, 4, 8) and (
        array.dtype != numpy.float16
    ):
        native = numpy.ascontiguousarray(array, dtype=array.dtype.newbyteorder("="))
        result = numpy_to_vtk(native)
    else:
        raise TypeError(f'the array "{name}" has values of type {array.dtype}, '
                        "which cannot be stored")
    result.SetName(name)
    return result


def arrays_of(attributes: Any) -> Dict[str, numpy.ndarray]:
    """All arrays of VTK attributes or field data by name."""
    found = {}
    for i in range(attributes.GetNumberOfArrays()):
        array = attributes.GetAbstractArray(i)
        found[array.GetName()] = to_numpy(array)
    return found


def _components(array: numpy.ndarray) -> int:
    return 1 if array.ndim == 1 else array.shape[1]


def _strings(name: str, array: numpy.ndarray) -> vtkStringArray:
    result = vtkStringArray()
    result.SetNumberOfComponents(_components(array))
    result.SetNumberOfTuples(array.shape[0])
    for i, value in enumerate(array.flat):
        if not isinstance(value, str):
            raise TypeError(f'the array "{name}" has a value of type {type(value).__name__}; '
                            "arrays of objects hold strings only")
        result.SetValue(i, value)
    return result


def _bits(array: numpy.ndarray) -> vtkBitArray:
    result = vtkBitArray()
    result.SetNumberOfComponents(_components(array))
    result.SetNumberOfTuples(array.shape[0])
    for i, value in enumerate(array.flat):
        result.SetValue(i, int(value))
    return result
