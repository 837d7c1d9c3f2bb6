"""The points and tuples of a tile, layer by layer."""

from __future__ import annotations

import struct

from arrays import ArrayPayload, Layer
from bsp import Bsp
from container import METHODS, Tile
from elementary import STRING, require
from fast import Fast
from neighbours import Point
from orders import decoded_order
from partition_methods import Kd, Occupancy
from predictive import Predictive
from surface import SurfaceMethod
from words import WordType
from xxh3 import checksum, xxh3


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
    if name == "predictive":
        return Predictive(*arguments)
    return SurfaceMethod(*arguments)


def values_as_bytes(array, tuples: list) -> bytes:
    """The values as section 14 says for content checksums."""
    if array.scalar_type == STRING:
        return b"".join(struct.pack("<Q", len(v)) + v for t in tuples for v in t)
    return WordType(array.scalar_type).bytes_of([w for t in tuples for w in t])


class DecodedTile:
    """A tile's points and tuples in every layer that it has, in decoded order."""

    def __init__(self, tile: Tile, layers: int):
        self.tile, self.first = tile, tile.lacking
        self.points: list[list[Point]] = []
        self.counts: list[list[int]] = []
        self.array_orders: list[list[int]] = []
        geometry = geometry_of(tile)
        self.geometry = geometry
        for own, layer in enumerate(range(tile.lacking, layers)):
            points, counts = geometry.layer(tile.chunks[layer, 0, 0], layer == layers - 1)
            require(len(points) == tile.representatives[own], "a layer has other points than told")
            require(sum(counts) == tile.points, "points do not add up")
            require(all(p[k] <= tile.extent[k] for p in points for k in range(3)), "outside of the box")
            self.points.append(points)
            self.counts.append(counts)
            order = geometry.array_order() if isinstance(geometry, Fast) else None
            self.array_orders.append(order or list(range(len(points))))
        content = b"".join(struct.pack("<3I", *p) for p in self.points[-1])
        require(checksum(content) == tile.content, "the content of a tile is not as told")
        self.order = self._order(layers)
        self.tuples = [self._array(a, layers) for a in range(len(tile.arrays))]

    def _order(self, layers: int) -> list[int] | None:
        """For each place of the input the number of its point, if that is known."""
        if self.tile.order_kind == 1:
            return decoded_order(self.tile.chunks[layers - 1, 1, 0], self.points[-1])
        return list(range(self.tile.points)) if self.tile.order_kind == 2 else None

    def _array(self, a: int, layers: int) -> dict[int, list]:
        """The tuples of an array for each layer that has values, in decoded order."""
        tile, array = self.tile, self.tile.arrays[a]
        in_all = tile.values_in_all_layers
        tuples: list = []
        result = {}
        for layer in range(tile.lacking if in_all else layers - 1, layers):
            last = layer == layers - 1
            points = self.points[layer - tile.lacking]
            numbers = self.array_orders[layer - tile.lacking] if in_all else list(range(len(points)))
            known = len(tuples)
            order = self._order_of_new(numbers, known) if last else None
            chunk = Layer([points[i] for i in numbers], known, order)
            payload = ArrayPayload(chunk, array.scalar_type, array.components)
            tuples += payload.decode(tile.chunks[layer, 2, a], tuples)
            placed: list = [None] * len(points)
            for i, t in zip(numbers, tuples):
                placed[i] = t
            result[layer] = placed
        width = array.content_width(tile.points)
        told = xxh3(values_as_bytes(array, tuples)) & ((1 << 8 * width) - 1)
        require(told == tile.array_contents[a], "the content of an array is not as told")
        return result

    def _order_of_new(self, numbers: list[int], known: int) -> list[int] | None:
        if self.order is None:
            return None
        place = {number: i for i, number in enumerate(numbers)}
        return [place[i] - known for i in self.order if place[i] >= known]

    def at(self, layer: int) -> tuple[list[Point], list[int]]:
        """The representatives up to a layer of the file, and their counts."""
        own = layer - self.tile.lacking
        if own < 0:
            middle = tuple(e // 2 for e in self.tile.extent)
            return [middle], [self.tile.points]
        return self.points[own], self.counts[own]
