"""Method fast of docs/format.md, section 10."""

from __future__ import annotations

from elementary import Reader, require
from fast_entropy import FIELD_DEFAULT, RansDecoder, RawBits, ValueCode, read_table
from fast_slabs import SlabSet
from partition_methods import Kd
from range_coder import AdaptiveBits, RangeDecoder, stream_of

Point = tuple[int, int, int]


class Fast:
    def __init__(self, points: int, extent: list[int], version: int, layers: int):
        require(version == 0, "unknown version of fast", "unsupported")
        require(points < 1 << 32, "too many points for method fast")
        self.n, self.box, self.layers = points, list(extent), layers
        self.header: Header | None = None
        self.next_layer = 0
        self.points: list[Point] = []
        self.sequence: dict[int, Point] = {}  # by place in the input, if that is the sequence

    def stride(self, layer: int) -> int:
        return 1 << min(self.header.ratio * (self.layers - 1 - layer), 63)

    def places(self, layer: int) -> list[int]:
        """The places of the sequence that the layers up to this one have."""
        return list(range(0, self.n, self.stride(layer)))

    def new_places(self, layer: int) -> list[int]:
        if layer == 0:
            return self.places(0)
        before = self.stride(layer - 1)
        return [p for p in self.places(layer) if p % before]

    def layer(self, payload: bytes, last: bool) -> tuple[list[Point], list[int]]:
        layer = self.next_layer
        self.next_layer += 1
        reader = Reader(payload)
        if layer == 0:
            self.header = Header(reader, self.layers, self.n, self.box)
        new = self.new_places(layer)
        body = reader.rest()
        if not new:
            require(not body, "a layer without points has bytes")
        elif self.header.input_order:
            self._in_input_order(body, layer)
        else:
            self.points += [self._restored(p) for p in self._set(body, len(new))]
        if self.header.input_order:
            self.points = [self._restored(self.sequence[p]) for p in self.places(layer)]
        return list(self.points), self._counts(layer)

    def array_order(self) -> list[int] | None:
        """The numbers of the decoded points in array order, if they differ."""
        if not self.header.input_order or self.layers == 1:
            return None
        layer = self.next_layer - 1
        number = {place: i for i, place in enumerate(self.places(layer))}
        return [number[p] for l in range(layer + 1) for p in self.new_places(l)]

    def _restored(self, point: Point) -> Point:
        values = self.header.values
        x, y, z = (values[k][point[k]] if values[k] else point[k] for k in range(3))
        return x, y, z

    def _set(self, body: bytes, n: int) -> list[Point]:
        require(body, "a set without its kind")
        kind, levels = body[0] & 15, body[0] >> 4
        require(kind <= 2, "a reserved kind of set")
        require(levels <= (6 if kind == 1 else 0), "wrong extra levels")
        extent = self.header.extent
        if kind == 2:
            return Kd(n, extent, 0).layer(body[1:], True)[0]
        return SlabSet(body[1:], n, extent, self.header.scales, levels if kind == 1 else None).decode()

    def _counts(self, layer: int) -> list[int]:
        """How many points each of the points so far stands for."""
        stride, counts = self.stride(layer), [0] * len(self.points)
        numbers = range(len(self.points))
        if not self.header.input_order:
            numbers = sorted(numbers, key=lambda i: (hilbert_place(self.points[i], self.box), self.points[i]))
        for i, number in enumerate(numbers):
            counts[number] = min(stride, self.n - i * stride)
        return counts

    def _in_input_order(self, payload: bytes, layer: int) -> None:
        coder = stream_of(payload)
        axes = [OrderedAxis(k, e) for k, e in enumerate(self.header.extent)]
        bits = AdaptiveBits()
        for place in self.places(layer):
            known = self.sequence.get(place)
            surprises: list[int] = []
            point = []
            for k, axis in enumerate(axes):
                beside = 0 if k == 0 else 1 + max(surprises)
                value, surprise = axis.next(coder, bits, beside, known[k] if known else None)
                point.append(value)
                surprises.append(surprise)
            self.sequence[place] = (point[0], point[1], point[2])
        coder.finish()


class OrderedAxis:
    """Coordinates along an axis in the order of the input."""

    def __init__(self, axis: int, extent: int):
        self.axis, self.extent = axis, extent
        self.last = [0, 0, 0]
        self.losses = [0, 0, 0, 0]
        self.size = 0
        self.sign = 1

    def next(self, coder: RangeDecoder, bits: AdaptiveBits, beside: int, known: int | None) -> tuple[int, int]:
        """The next value, coded unless it is known, and its surprise."""
        a, b, c = self.last
        guesses = (a, a + (a - b), a + ((a - b) >> 1), a + ((a - c) >> 1))
        guesses = [min(max(g, 0), self.extent) for g in guesses]
        guess = guesses[self.losses.index(min(self.losses))]
        now = size_class(self.size)
        error = self._error(coder, bits, now, beside) if known is None else known - guess
        value = guess + error
        require(0 <= value <= self.extent, "a coordinate lies outside of its tile")
        self.sign = 1 + (error > 0) - (error < 0)
        self.losses = [l + 16 * abs(value - g) - l // 16 for l, g in zip(self.losses, guesses)]
        self.last = [value, a, b]
        self.size = (3 * self.size + 16 * abs(error) + 2) // 4
        then = size_class(16 * abs(error))
        return value, sum(then >= now + step for step in (-4, -2, 2, 4))

    def _error(self, coder: RangeDecoder, bits: AdaptiveBits, now: int, beside: int) -> int:
        length = 0
        while length < 33 and coder.adaptive(bits["longer", self.axis, now, beside, length]):
            length += 1
        if length == 0:
            return 0
        negative = coder.adaptive(bits["negative", self.axis, length, self.sign])
        size = 1
        told = min(length - 1, 2)
        for _ in range(told):
            size = size << 1 | coder.adaptive(bits["size", self.axis, length, size])
        rest = length - 1 - told
        if rest:
            size = size << rest | coder.wide(rest)
        return -size if negative else size


def size_class(size: int) -> int:
    length = size.bit_length()
    behind = size >> (length - 2) & 1 if length >= 2 else 0
    return min(2 * length + behind, 39)


class Header:
    def __init__(self, reader: Reader, layers: int, n: int, box: list[int]):
        flags = reader.u8()
        require(flags < 32, "reserved flags of method fast")
        self.input_order = bool(flags & 16)
        self.ratio = 1
        if layers > 1:
            self.ratio = reader.u8()
            require(1 <= self.ratio <= 16, "a wrong ratio of layers")
        self.scales = [reader.u8() for _ in range(3)] if flags & 8 else [0, 0, 0]
        require(all(s <= 31 for s in self.scales), "a scale is too large")
        ranked = [k for k in range(3) if flags >> k & 1]
        self.extent = list(box)
        self.values: list[list[int] | None] = [None, None, None]
        if ranked:
            section = Reader(reader.bytes(reader.varint()))
            for k, values in zip(ranked, _values(section, len(ranked), n)):
                require(values[-1] == box[k], "the last value of an axis is not its extent")
                self.values[k] = values
                self.extent[k] = len(values) - 1


def _values(section: Reader, axes: int, n: int) -> list[list[int]]:
    counts = [section.varint() for _ in range(axes)]
    require(all(2 <= c <= n for c in counts), "a wrong number of values")
    sizes = section.varint(), section.varint()
    head = RawBits(section.bytes(sizes[0]))
    steps = RansDecoder(section.bytes(sizes[1]), 1)
    bits = RawBits(section.rest())
    pattern = head.field(2)
    require(pattern < 3, "an unknown pattern of steps")
    tables = [read_table(head, FIELD_DEFAULT) for _ in range((8, 128, 128)[pattern])]
    head.finish()
    code = ValueCode(40, 1)
    result = []
    for count in counts:
        values, last = [0], []
        for _ in range(count - 1):
            table = tables[step_context(pattern, last)]
            step = 1 + code.value(steps.symbol(table), bits)
            last.insert(0, step)
            values.append(values[-1] + step)
        result.append(values)
    steps.finish()
    bits.finish()
    return result


def step_context(pattern: int, last: list[int]) -> int:
    newest = last + [0, 0, 0]
    if pattern == 0:
        return min(newest[0], 7)
    if pattern == 1:
        near = [min(max(g, 2), 5) - 2 for g in newest[1:3]]
        return 16 * min(newest[0], 7) + 4 * near[0] + near[1]
    run = 0
    while run < 15 and run + 1 < len(last) and last[run + 1] == last[0]:
        run += 1
    return 16 * min(newest[0], 7) + run


def hilbert_place(point: Point, extent: list[int]) -> int:
    entries, turns = (0, 0, 0, 3, 3, 6, 6, 5), (0, 1, 1, 2, 2, 1, 1, 0)

    def rotated(value: int, by: int) -> int:
        by %= 3
        return (value << by | value >> (3 - by)) & 7

    bits = max(extent).bit_length()
    corner = axis = place = 0
    for level in range(bits - 1, bits - 1 - min(bits, 16), -1):
        octant = sum((point[k] >> level & 1) << k for k in range(3))
        turned = rotated(octant ^ corner, 3 - (axis + 1) % 3)
        digit = turned ^ turned >> 1 ^ turned >> 2
        place = place << 3 | digit
        corner ^= rotated(entries[digit], axis + 1)
        axis = (axis + turns[digit] + 1) % 3
    return place
