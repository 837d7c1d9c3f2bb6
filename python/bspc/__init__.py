"""Compressed point sets (.bspc) for VTK and NumPy.

The classes ``vtkBSPReader`` and ``vtkBSPWriter`` are used like those of ``vtkmodules``. For NumPy
there are ``read`` and ``write``, and ``encode`` for bytes in memory::

    import bspc

    bspc.write("scan.bspc", points, {"RGB": colours}, precision=0.001, colours="RGB")
    scan = bspc.read("scan.bspc", box=((0, 0, 0), (10, 10, 10)))
    scan.points, scan.arrays["RGB"]
"""

from .vtkBSPReader import vtkBSPReader
from .vtkBSPWriter import vtkBSPWriter
from .errors import Error
from .reading import PointSet, read
from .writing import WriteReport, encode, write

__all__ = [
    "Error",
    "PointSet",
    "WriteReport",
    "encode",
    "read",
    "vtkBSPReader",
    "vtkBSPWriter",
    "write",
]
