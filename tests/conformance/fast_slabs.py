"""Sets of points as slabs, kinds 0 and 1 of method fast (docs/format.md, section 10)."""

from __future__ import annotations

from elementary import Reader, require
from fast_entropy import FIELD_DEFAULT, RansDecoder, RawBits, ValueCode, class_default, read_table
from fast_entropy import unzigzag
from fast_tree import SlabTrees

CHUNK = 40
CONSTANT, PLANE, QUADRIC, DELTA = range(4)
GAP_CLASS, MODE, RESIDUAL_CLASS, HEIGHT, SLOPES, BENDS, FLAT_HEIGHT = 0, 1, 2, 3, 4, 6, 9
FIELD_CODE = ValueCode(0, 2)


def signed32(value: int) -> int:
    return (value + (1 << 31) & 0xFFFFFFFF) - (1 << 31)


def signed64(value: int) -> int:
    return (value + (1 << 63) & 0xFFFFFFFFFFFFFFFF) - (1 << 63)


def shifted(value: int, power: int) -> int:
    """value · 2^power; negative powers are shifts to the right."""
    return value << power if power >= 0 else value >> -power


def limited(value: int) -> int:
    return min(max(value, -(1 << 30)), 1 << 30)


class ClassedValues:
    """Gaps or residuals: values whose tables and shifts follow from a class."""

    def __init__(self, start: int, greatest: int, plain: int, direct: int):
        self.current, self.greatest, self.plain = start, greatest, plain
        self.direct = direct
        self.code = ValueCode(direct, 1)
        self.tables: list = []

    def read_tables(self, bits: RawBits) -> None:
        count = self.plain + 2
        self.tables = [read_table(bits, class_default(t, count, self.direct)) for t in range(count)]

    def change(self, by: int) -> None:
        self.current += by
        require(0 <= self.current <= self.greatest, "a class is out of range")

    def run(self, stream: RansDecoder, bits: RawBits, count: int) -> list[int]:
        c, shift = self.current, 0
        table = self.tables[c] if c < self.plain else self.tables[self.plain + c % 2]
        if c >= self.plain:
            shift = c // 2 - self.plain // 2 + 1
        return [self.code.value(s, bits, shift) for s in stream.run(table, count)]


class Curve:
    """Hilbert's curve over the upper bits of u and v, then their lowest bits as they are."""

    def __init__(self, lengths: list[int], scales: list[int], points: int):
        top = max(lengths[0] + scales[0], lengths[1] + scales[1])
        fine = max(0, top - (12 if points > 4096 else 8))
        self.low = [min(max(0, fine - scales[k]), lengths[k]) for k in range(2)]
        widest = max(lengths[k] - self.low[k] for k in range(2))
        require(widest <= 12, "a curve of more than 12 bits")
        self.bits = next(h for h in (4, 8, 12) if h >= widest)

    def place(self, u: int, v: int) -> int:
        swap = flip = code = 0
        high_u, high_v = u >> self.low[0], v >> self.low[1]
        for level in reversed(range(self.bits)):
            x, y = (high_u >> level & 1) ^ flip, (high_v >> level & 1) ^ flip
            if swap:
                x, y = y, x
            code = code << 2 | (3 * x) ^ y
            if y == 0:
                swap ^= 1
                flip ^= x
        low_u, low_v = u & ((1 << self.low[0]) - 1), v & ((1 << self.low[1]) - 1)
        return (code << self.low[0] | low_u) << self.low[1] | low_v

    def at(self, place: int) -> tuple[int, int]:
        low_v = place & ((1 << self.low[1]) - 1)
        place >>= self.low[1]
        low_u = place & ((1 << self.low[0]) - 1)
        place >>= self.low[0]
        require(place < 1 << 2 * self.bits, "a code is beyond its curve")
        swap = flip = u = v = 0
        for level in reversed(range(self.bits)):
            digit = place >> 2 * level & 3
            x, y = ((0, 0), (0, 1), (1, 1), (1, 0))[digit]
            bit_u, bit_v = (y, x) if swap else (x, y)
            u, v = u << 1 | bit_u ^ flip, v << 1 | bit_v ^ flip
            if y == 0:
                swap ^= 1
                flip ^= x
        return u << self.low[0] | low_u, v << self.low[1] | low_v


class Surface:
    """What a chunk's heights are predicted from."""

    def __init__(self, slab: "Slab", residual_class: int, points: list[tuple[int, int]]):
        self.precision = residual_class // 2 + 2
        self.centre, self.half = [], []
        for k in range(2):
            low, high = min(p[k] for p in points), max(p[k] for p in points)
            self.centre.append(low + (high - low) // 2)
            self.half.append((high - self.centre[k]).bit_length())
        p = self.precision
        way = sum(slab.slopes[k] * (self.centre[k] - slab.centre[k]) for k in range(2))
        self.height = limited(signed64(slab.height + way) >> (13 + p))
        self.slopes = [
            limited(signed64(shifted(slab.slopes[k], self.half[k] - 14 - p))) for k in range(2)
        ]
        self.bends = [0, 0, 0]

    def read(self, fields: "Fields", mode: int) -> None:
        self.height += unzigzag(fields.read(FLAT_HEIGHT if mode == CONSTANT else HEIGHT))
        if mode == CONSTANT:
            self.slopes = [0, 0]
            return
        for k in range(2):
            self.slopes[k] += unzigzag(fields.read(SLOPES + k))
        if mode == QUADRIC:
            self.bends = [unzigzag(fields.read(BENDS + k)) for k in range(3)]

    def keep(self, slab: "Slab") -> None:
        p = self.precision
        slab.height = signed64(self.height << (p + 13))
        slab.slopes = [
            signed64(shifted(self.slopes[k], 14 + p - self.half[k])) for k in range(2)
        ]
        slab.centre = self.centre

    def at(self, u: int, v: int) -> int:
        x = signed32(shifted(u - self.centre[0], 12 - self.half[0]))
        y = signed32(shifted(v - self.centre[1], 12 - self.half[1]))
        squares = (signed32(x * x) >> 12, signed32(x * y) >> 12, signed32(y * y) >> 12)
        bend = sum(b * s for b, s in zip(self.bends, squares))
        tilt = signed32(self.slopes[0] * x + self.slopes[1] * y + 2 * bend)
        tilt = shifted(tilt, self.precision - 11)
        return signed32((self.height << self.precision) + tilt) >> 3


class Slab:
    """A piece of a set: its cell, and what is carried from chunk to chunk."""

    def __init__(self, lower: list[int], lengths: list[int], axis: int, points: int):
        self.axes = [(axis + 1) % 3, (axis + 2) % 3, axis]  # u, v, w
        self.lower = [lower[k] for k in self.axes]
        whole = [lengths[k] for k in self.axes]
        self.cut = [max(l - 22, 0) for l in whole]
        self.lengths = [l - c for l, c in zip(whole, self.cut)]
        self.points = points
        middle = [(1 << l) // 2 for l in self.lengths]
        self.last = middle[2]
        self.height, self.slopes, self.centre = middle[2] << 16, [0, 0], middle[:2]
        self.code = 0

    def point(self, coordinates: tuple[int, int, int], low: list[int]) -> tuple[int, int, int]:
        point = [0, 0, 0]
        for k in range(3):
            point[self.axes[k]] = self.lower[k] + (coordinates[k] << self.cut[k] | low[k])
        return point[0], point[1], point[2]


class Fields:
    def __init__(self, data: bytes, tables: list, bits: RawBits):
        self.stream, self.tables, self.bits = RansDecoder(data, 1), tables, bits

    def read(self, number: int) -> int:
        return FIELD_CODE.value(self.stream.symbol(self.tables[number]), self.bits)


class SlabSet:
    def __init__(self, body: bytes, n: int, extent: list[int], scales: list[int], levels: int | None):
        """`levels` are the extra ones of trees, None for gaps."""
        reader = Reader(body)
        sizes = [reader.varint() for _ in range(5)]
        tables, tree, plane, residuals, fields = (reader.bytes(s) for s in sizes)
        self.bits = RawBits(reader.rest())
        self.n, self.extent, self.scales = n, extent, scales
        self.gaps = ClassedValues(20, 98, 8, 24)
        self.residuals = ClassedValues(8, 57, 10, 32)
        table_bits = RawBits(tables)
        if levels is None:
            self.gaps.read_tables(table_bits)
        self.residuals.read_tables(table_bits)
        field_tables = [read_table(table_bits, FIELD_DEFAULT) for _ in range(10)]
        table_bits.finish()
        lanes = 1 if n < 4096 else 8
        self.residual_stream = RansDecoder(residuals, lanes)
        self.fields = Fields(fields, field_tables, self.bits)
        self.trees = None if levels is None else SlabTrees(plane, self.bits, levels)
        self.gap_stream = RansDecoder(plane, lanes) if levels is None else None
        self.tree_bits = RawBits(tree)
        self.points: list[tuple[int, int, int]] = []

    def decode(self) -> list[tuple[int, int, int]]:
        self._cell([0, 0, 0], [e.bit_length() for e in self.extent], self.n)
        self.tree_bits.finish()
        (self.gap_stream or self.trees.coder).finish()
        self.residual_stream.finish()
        self.fields.stream.finish()
        self.bits.finish()
        return self.points

    def _cell(self, lower: list[int], lengths: list[int], n: int) -> None:
        if self.tree_bits.field(1):
            axis = self.tree_bits.field(2)
            require(axis < 3, "a slab over no plane")
            self._slab(Slab(lower, lengths, axis, n))
            return
        require(any(lengths), "a cell of one position is no slab")
        in_lower = self.tree_bits.field(n.bit_length())
        require(in_lower <= n, "a half has more points than its cell")
        axis = max((k for k in range(3) if lengths[k]), key=lambda k: lengths[k] + self.scales[k])
        shorter = list(lengths)
        shorter[axis] -= 1
        if in_lower:
            self._cell(lower, shorter, in_lower)
        if n - in_lower:
            upper = list(lower)
            upper[axis] += 1 << shorter[axis]
            self._cell(upper, shorter, n - in_lower)

    def _slab(self, slab: Slab) -> None:
        scales = [self.scales[k] for k in slab.axes]
        curve = Curve(slab.lengths, scales, slab.points)
        places = None
        if self.trees is not None:
            places = [(0, 0)] * slab.points
            if slab.lengths[0] + slab.lengths[1]:
                places = self.trees.points(slab.points, slab.lengths[:2], scales)
                places.sort(key=lambda p: curve.place(*p))
        for start in range(0, slab.points, CHUNK):
            count = min(CHUNK, slab.points - start)
            if places is None:
                self._chunk(slab, self._gapped(slab, curve, count))
            else:
                self._chunk(slab, places[start : start + count])

    def _gapped(self, slab: Slab, curve: Curve, count: int) -> list[tuple[int, int]]:
        self.gaps.change(unzigzag(self.fields.read(GAP_CLASS)))
        places = []
        for gap in self.gaps.run(self.gap_stream, self.bits, count):
            slab.code += gap
            places.append(curve.at(slab.code))
        return places

    def _chunk(self, slab: Slab, places: list[tuple[int, int]]) -> None:
        mode = self.fields.read(MODE)
        require(mode <= DELTA, "an unknown surface")
        self.residuals.change(unzigzag(self.fields.read(RESIDUAL_CLASS)))
        surface = None
        if mode != DELTA:
            surface = Surface(slab, self.residuals.current, places)
            surface.read(self.fields, mode)
        values = self.residuals.run(self.residual_stream, self.bits, len(places))
        errors = [0, 0]
        for (u, v), value in zip(places, values):
            w = unzigzag(value)
            if surface is None:
                w += slab.last
            else:
                if mode != CONSTANT:
                    w += signed32(45 * errors[0] + 26 * errors[1] + 64) >> 7
                w = signed32(w)
                errors = [w, errors[0]]
                w += surface.at(u, v)
            slab.last = w & 0xFFFFFFFF
            self.points.append((u, v, slab.last))  # made whole by _cut_bits
        if surface is None:
            slab.height, slab.centre = slab.last << 16, list(places[-1])  # the slopes stay
        else:
            surface.keep(slab)
        self._cut_bits(slab, len(places))

    def _cut_bits(self, slab: Slab, count: int) -> None:
        for i in range(len(self.points) - count, len(self.points)):
            low = [self.bits.field(c) for c in slab.cut]
            point = slab.point(self.points[i], low)
            for k in range(3):
                require(point[k] <= self.extent[k], "a point lies outside of its tile")
            self.points[i] = point
