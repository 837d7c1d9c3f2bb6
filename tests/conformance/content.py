"""The decoded content of a file, level by level, and its hash.

Testing/Data/conformance/README.md says what is hashed; content_of.cpp does the same in C++.
"""

from __future__ import annotations

import struct

from bsp import Bsp
from container import File, METHODS, Tile
from elementary import FormatError, require
from fast import Fast
from partition_methods import Kd, Occupancy
from xxh3 import checksum, xxh3

Point = tuple[int, int, int]


def geometry_of(tile: Tile):
    """The decoder of a tile's geometry."""
    name = METHODS.get(tile.method)
    require(name is not None, f"unknown method {tile.method}", "unsupported")
    require(tile.points < 1 << 32, "too many points for a tile")
    arguments = (tile.points, tile.extent, tile.version)
    if name == "kd":
        return Kd(*arguments)
    if name == "fast":
        return Fast(*arguments, tile.layers)
    if name == "bsp":
        return Bsp(*arguments)
    if name in ("octree", "gencode"):
        return Occupancy(*arguments, name == "octree")
    raise NotImplementedError(f"geometry of method {name}")


class DecodedTile:
    """A tile's points and tuples in every layer that it has, in decoded order."""

    def __init__(self, tile: Tile, layers: int):
        self.tile = tile
        self.points: list[list[Point]] = []
        self.counts: list[list[int]] = []
        self.array_orders: list[list[int] | None] = []
        geometry = geometry_of(tile)
        for own, layer in enumerate(range(tile.lacking, layers)):
            last = own == tile.layers - 1
            points, counts = geometry.layer(tile.chunks[layer, 0, 0], last)
            require(len(points) == tile.representatives[own], "a layer has other points than told")
            require(sum(counts) == tile.points, "points do not add up")
            require(all(p[k] <= tile.extent[k] for p in points for k in range(3)), "outside of the box")
            self.points.append(points)
            self.counts.append(counts)
            order = getattr(geometry, "array_order", None)
            self.array_orders.append(order() if order else None)
        content = b"".join(struct.pack("<3I", *p) for p in self.points[-1])
        require(checksum(content) == tile.content, "the content of a tile is not as told")

    def at(self, layer: int) -> tuple[list[Point], list[int]]:
        """The representatives up to a layer of the file, and their counts."""
        own = layer - self.tile.lacking
        if own < 0:
            middle = tuple(e // 2 for e in self.tile.extent)
            return [middle], [self.tile.points]
        return self.points[own], self.counts[own]


class Row:
    """What a file holds as one row of bytes."""

    def __init__(self) -> None:
        self.parts: list[bytes] = []

    def number(self, value: int) -> None:
        self.parts.append(struct.pack("<Q", value))

    def numbers(self, values: list[int]) -> None:
        self.parts.append(struct.pack(f"<{len(values)}Q", *values))

    def real(self, value: float) -> None:
        self.parts.append(struct.pack("<d", value))

    def text(self, text: bytes) -> None:
        self.number(len(text))
        self.parts.append(bytes(text))

    def description(self, array) -> None:
        self.text(array.name)
        self.numbers([array.scalar_type, array.components, len(array.component_names)])
        for name in array.component_names:
            self.text(name)
        self.text(array.unit)
        self.number(array.semantic if array.semantic <= 5 else 0)
        self.real(array.tolerance)

    def values(self, array, values) -> None:
        """Bytes of numbers, or a list of strings."""
        if isinstance(values, list):
            self.number(len(values) // array.components)
            for text in values:
                self.text(text)
        else:
            self.number(len(values) // (array.value_size() * array.components))
            self.parts.append(bytes(values))

    def hash(self) -> str:
        return f"{xxh3(b''.join(self.parts)):016x}"


class Content:
    def __init__(self, data: bytes):
        self.file = File(data)
        self.head = self.file.head
        self.tiles = [DecodedTile(t, self.head.layers) for t in self.file.tiles]

    def hash(self) -> str:
        row = Row()
        metadata = self.head.metadata
        row.number(self.head.grid.scalar_type)
        row.text(metadata.crs)
        row.text(metadata.unit)
        row.number(len(metadata.entries))
        for key, value in metadata.entries:
            row.text(key)
            row.text(value)
        row.number(len(metadata.field_data))
        for array, values in metadata.field_data:
            row.description(array)
            row.values(array, values)
        row.number(len(self.head.arrays))
        for array in self.head.arrays:
            row.description(array)
        for layer in range(self.head.layers):
            self._add_layer(row, layer)
        return row.hash()

    def _add_layer(self, row: Row, layer: int) -> None:
        last = layer == self.head.layers - 1
        points, counts = [], []
        for tile in self.tiles:
            own, own_counts = tile.at(layer)
            lower = tile.tile.lower
            points += [tuple(p[k] + lower[k] for k in range(3)) for p in own]
            counts += own_counts
        if self.head.arrays or self.head.grid.has_low_halves() or self.head.keeps_order or self.head.mesh:
            raise NotImplementedError("arrays, order and cells")
        grid = self.head.grid
        row.number(len(points))
        for p in points:
            row.parts.append(struct.pack("<3d", *(grid.coordinate(k, p[k]) for k in range(3))))
        row.numbers(counts)
        if last:
            row.numbers([0, 0, 0])


__all__ = ["Content", "FormatError"]
