"""The decoded content of a file, level by level, and its hash.

Testing/Data/conformance/README.md says what is hashed; content_of.cpp does the same in C++.
"""

from __future__ import annotations

import struct

from arrays import ArrayPayload, Layer
from container import File
from elementary import require
from mesh_cells import centres, decode_cells
from surface import SurfaceMethod
from tiles import DecodedTile, values_as_bytes
from xxh3 import checksum_width, xxh3


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

    def values(self, array, tuples: list) -> None:
        self.number(len(tuples))
        self.parts.append(values_as_bytes(array, tuples))

    def hash(self) -> str:
        return f"{xxh3(b''.join(self.parts)):016x}"


def checksum_of_cells(sorts: tuple) -> int:
    numbers: list[int] = []
    for cells in sorts:
        numbers += [len(cell) for cell in cells]
        numbers += [point for cell in cells for point in cell]
    width = checksum_width(16 * sum(len(cells) for cells in sorts))
    return xxh3(struct.pack(f"<{len(numbers)}I", *numbers)) % (1 << 8 * width)


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
        head, last = self.head, layer == self.head.layers - 1
        points: list = []
        low_halves: list = []
        counts: list[int] = []
        tuples: list[list] = [[] for _ in head.arrays]
        with_values = all(all(layer in t for t in tile.tuples) for tile in self.tiles)
        for tile in self.tiles:
            own, own_counts = tile.at(layer)
            lower = tile.tile.lower
            order = range(len(own))
            if last and head.keeps_order:
                order = tile.order
            points += [tuple(own[i][k] + lower[k] for k in range(3)) for i in order]
            counts += own_counts
            if not with_values:
                continue
            arrays = [[t[layer][i] for i in order] for t in tile.tuples]
            if head.grid.has_low_halves():
                low_halves += arrays.pop(0)
            for values, new in zip(tuples, arrays):
                values += new
        row.number(len(points))
        for i, p in enumerate(points):
            low = low_halves[i] if low_halves else (0, 0, 0)
            row.parts.append(struct.pack("<3d", *(head.grid.coordinate(k, p[k], low[k]) for k in range(3))))
        row.numbers(counts)
        for array, values in zip(head.arrays, tuples):
            if with_values:
                row.text(array.name)
                row.values(array, values)
        if last:
            self._add_cells(row, points)

    def _add_cells(self, row: Row, points: list) -> None:
        """The cells of all blocks: vertex cells, then lines, then faces; then arrays beside them."""
        sorts: list[list[list[int]]] = [[], [], []]
        arrays = self.head.mesh.arrays if self.head.mesh else []
        values: list[list[list]] = [[[], [], []] for _ in arrays]
        starts = [0]
        for tile in self.file.tiles:
            starts.append(starts[-1] + tile.points)
        for block in self.file.mesh_blocks:
            first = starts[block.first_tile]
            own = points[first : starts[block.first_tile + block.tiles]]
            tiles = [t.geometry for t in self.tiles[block.first_tile : block.first_tile + block.tiles]]
            one = tiles[0] if len(tiles) == 1 and not self.head.keeps_order else None
            surface = one.faces if isinstance(one, SurfaceMethod) else None
            cells = decode_cells(block.cells, own, self.head.grid, surface)
            require([len(c) for c in cells] == block.counts, "a block has other cells than it says")
            require(checksum_of_cells(cells) == block.content, "the cells are not as their checksum says")
            for all_of_sort, new in zip(sorts, cells):
                all_of_sort += [[first + i for i in cell] for cell in new]
            layer = Layer(centres(own, [c for new in cells for c in new]), 0, None)
            for a, (array, payload) in enumerate(zip(arrays, block.values)):
                tuples = ArrayPayload(layer, array.scalar_type, array.components).decode(payload, [])
                width = 8 * array.content_width(len(tuples))
                found = xxh3(values_as_bytes(array, tuples)) % (1 << width)
                require(found == block.value_contents[a], "values of cells are not as their checksum says")
                for sort, new in enumerate(cells):
                    values[a][sort] += tuples[: len(new)]
                    tuples = tuples[len(new) :]
        for cells_of_sort in sorts:
            row.number(len(cells_of_sort))
            for cell in cells_of_sort:
                row.numbers([len(cell), *cell])
        for array, of_sorts in zip(arrays, values):
            row.description(array)
            row.values(array, of_sorts[0] + of_sorts[1] + of_sorts[2])
