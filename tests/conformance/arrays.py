"""Payloads of arrays, docs/format.md, section 14."""

from __future__ import annotations

import math
import struct
from functools import cached_property

import zstd
from array_mixing import Categories, Mixing
from array_residual import Residual
from elementary import BIT, STRING, UINT8, UINT16, UINT32, UINT64, Reader, reader_of, require
from neighbours import Point, Ranks
from sphere import Sphere
from words import UnitPrediction, WordType

CONSTANT, BYTES, QUICK, RESIDUAL, MIXING, CATEGORIES, STRINGS, QUANTISED, SPHERE = range(9)


def row(reader: Reader, size: int) -> bytes:
    told = reader.varint()
    if told == 0:
        return bytes([reader.u8()]) * size
    if told == 1:
        return reader.bytes(size)
    return zstd.one_frame(reader.bytes(told), size)


class Layer:
    """What the decoder of a chunk knows: the points up to the layer, the first `known` of them
    known, and which of the new ones is at each place of the input (None if that is not known)."""

    def __init__(self, points: list[Point], known: int, order: list[int] | None):
        self.points, self.known, self.order = points, known, order
        self.new = len(points) - known

    @cached_property
    def ranks(self) -> Ranks:
        return Ranks(self.points, self.known)

    def by_rank(self, tuples: list) -> list:
        """Tuples of known points by rank."""
        return [tuples[i] for i in self.ranks.order[: self.known]]

    def new_from_rank(self, tuples: list) -> list:
        """New tuples by rank, in array order."""
        result: list = [None] * self.new
        for rank in range(self.known, len(self.points)):
            result[self.ranks.order[rank] - self.known] = tuples[rank - self.known]
        return result

    def new_from_input(self, tuples: list) -> list:
        require(self.order is not None, "the order of the input is not known")
        result: list = [None] * self.new
        for place, i in enumerate(self.order):
            result[i] = tuples[place]
        return result


class ArrayPayload:
    """Decodes the new tuples of an array in a layer, as lists of words or strings."""

    def __init__(self, layer: Layer, scalar_type: int, components: int, sphere: Sphere | None = None):
        self.layer, self.scalar_type, self.components = layer, scalar_type, components
        self.kind = None if scalar_type == STRING else WordType(scalar_type)
        self.sphere = sphere

    def decode(self, payload: bytes | Reader, known: list[list], inner: bool = False) -> list[list]:
        reader = reader_of(payload)
        if self.layer.new == 0:
            require(not payload, "an array of no tuples has bytes")
            return []
        code = reader.u8()
        method = code & 15
        require(code < 16, "an unknown version of a method for arrays", "unsupported")
        require(method <= SPHERE, "an unknown method for arrays", "unsupported")
        require(not inner or method <= CATEGORIES, "a method inside of another")
        require((method == STRINGS) == (self.scalar_type == STRING), "a method for other types")
        decoders = (
            self._constant, self._bytes, self._quick, self._residual, self._mixing,
            self._categories, self._strings, self._quantised, self._sphere,
        )  # fmt: skip
        new = decoders[method](reader, known)
        reader.finish()
        if self.scalar_type == BIT:
            require(all(w < 2 for t in new for w in t), "a bit is neither 0 nor 1")
        return new

    def _constant(self, reader: Reader, known: list) -> list:
        words = self.kind.words_in(reader.bytes(self.components * self.kind.size))
        return [words] * self.layer.new

    def _bytes(self, reader: Reader, known: list) -> list:
        flags = reader.u8()
        require(flags < 8, "reserved flags of method bytes")
        n, size = self.layer.new, self.kind.size
        width = self.components * size
        if flags & 4:
            planes = [row(reader, n) for _ in range(width)]
            data = bytes(planes[i % width][i // width] for i in range(n * width))
        else:
            data = row(reader, n * width)
        flat = [int.from_bytes(data[i : i + size], "little") for i in range(0, len(data), size)]
        tuples = [flat[i : i + self.components] for i in range(0, len(flat), self.components)]
        if flags & 2:
            for before, after in zip(tuples, tuples[1:]):
                for c in range(self.components):
                    after[c] = (after[c] + before[c]) & self.kind.mask
        return self.layer.new_from_input(tuples) if flags & 1 else tuples

    def _quick(self, reader: Reader, known: list) -> list:
        flags = reader.u8()
        domain = flags & 3
        require(flags < 16 and domain < 3, "reserved flags of method quick")
        require(domain == 0 or self.kind.is_float, "numbers of integers")
        require(domain != 2 or self.components == 3, "unit of other than three components")
        planes = [row(reader, self.layer.new) for _ in range(self.components * self.kind.size)]
        quick = Quick(self.kind, self.components, domain, bool(flags & 4), bool(flags & 8))
        return quick.decode(planes, self.layer.points[self.layer.known :])

    def _residual(self, reader: Reader, known: list) -> list:
        by_rank = self.layer.by_rank(known)
        decoder = Residual(self.kind, self.components, self.layer.ranks, by_rank, self.sphere)
        return self.layer.new_from_rank(decoder.decode(reader)[self.layer.known :])

    def _mixing(self, reader: Reader, known: list) -> list:
        decoder = Mixing(self.kind, self.components, self.layer.ranks, self.layer.by_rank(known))
        return self.layer.new_from_rank(decoder.decode(reader)[self.layer.known :])

    def _categories(self, reader: Reader, known: list) -> list:
        by_rank = self.layer.by_rank(known)
        decoder = Categories(self.kind, self.components, self.layer.ranks, by_rank)
        in_order, tuples = decoder.decode(reader)
        return self.layer.new_from_input(tuples) if in_order else self.layer.new_from_rank(tuples)

    def _strings(self, reader: Reader, known: list) -> list:
        form = reader.u8()
        require(form < 2, "an unknown form of strings")
        count = self.layer.new * self.components
        if form == 0:
            flat = _string_list(reader, count)
            return [flat[i : i + self.components] for i in range(0, count, self.components)]
        size = reader.varint()
        require(1 <= size <= count, "a wrong size of a table of strings")
        table = _string_list(reader, size)
        places: dict[bytes, int] = {}
        for i, text in enumerate(table):
            places.setdefault(text, i)
        scalar_type = UINT8 if size <= 256 else UINT16 if size <= 65536 else UINT32
        inner = ArrayPayload(self.layer, scalar_type, self.components)
        told = [[places.get(text, 0) for text in t] for t in known]
        numbers = inner.decode(reader.inner(), told, inner=True)
        require(all(v < size for t in numbers for v in t), "a place beyond the table")
        return [[table[v] for v in t] for t in numbers]

    def _exceptions(self, reader: Reader, most: int, size: int) -> dict[int, bytes]:
        count = reader.varint()
        require(count <= most, "too many exceptions")
        if count == 0:
            return {}
        gaps = Reader(row(reader, reader.varint()))
        places, start = [], 0
        for _ in range(count):
            places.append(start + gaps.varint())
            start = places[-1] + 1
        gaps.finish()
        require(places[-1] < most, "an exception beyond the last number")
        contents = row(reader, count * size)
        return {p: contents[i * size : i * size + size] for i, p in enumerate(places)}

    def _quantised(self, reader: Reader, known: list) -> list:
        require(self.kind.is_float, "quantised integers")
        step = struct.unpack("<d", reader.bytes(8))[0]
        require(0 < step < math.inf, "a step is not positive and finite")
        base = reader.svarint()
        require(abs(base) <= 1 << 52, "a base is too large")
        size = reader.u8()
        require(size in (1, 2, 4, 8), "a wrong size of integers")
        exceptions = self._exceptions(reader, self.layer.new * self.components, self.kind.size)

        def integer(word: int) -> int:
            x = self.kind.number(word)
            quotient = 0 if math.isnan(x) else x / step + 0.5
            limit = 1 << 52
            whole = math.floor(min(max(quotient, -limit), limit))
            return min(max(whole - base, 0), (1 << 8 * size) - 1)

        scalar_type = {1: UINT8, 2: UINT16, 4: UINT32, 8: UINT64}[size]
        inner = ArrayPayload(self.layer, scalar_type, self.components)
        told = [[integer(w) for w in t] for t in known]
        result, place = [], 0
        for numbers in inner.decode(reader.inner(), told, inner=True):
            words = []
            for v in numbers:
                whole = (base + v + (1 << 63)) % (1 << 64) - (1 << 63)
                stored = exceptions.get(place)
                words.append(
                    self.kind.word_of(float(whole) * step) if stored is None else self.kind.words_in(stored)[0]
                )
                place += 1
            result.append(words)
        return result

    def _sphere(self, reader: Reader, known: list) -> list:
        require(self.kind.is_float and self.components == 3, "a sphere of other than three floats")
        size = reader.varint()
        require(1 <= size <= 1 << 23, "a wrong size of an octahedron")
        exceptions = self._exceptions(reader, self.layer.new, 3 * self.kind.size)
        sphere = Sphere(size)
        scalar_type = UINT8 if 2 * size <= 255 else UINT16 if 2 * size <= 65535 else UINT32
        inner = ArrayPayload(self.layer, scalar_type, 2, sphere)
        told = [list(sphere.place([self.kind.number(w) for w in t])) for t in known]
        result = []
        for i, place in enumerate(inner.decode(reader.inner(), told, inner=True)):
            if i in exceptions:
                result.append(self.kind.words_in(exceptions[i]))
            else:
                result.append([self.kind.word_of(v) for v in sphere.direction(place)])
        return result


def _string_list(reader: Reader, count: int) -> list[bytes]:
    size = reader.varint()
    require(count <= size <= 10 * count, "a wrong number of bytes of lengths")
    lengths = Reader(row(reader, size))
    sizes = [lengths.varint() for _ in range(count)]
    lengths.finish()
    texts = Reader(row(reader, sum(sizes)))
    return [texts.bytes(s) for s in sizes]


class Quick:
    def __init__(self, kind: WordType, components: int, domain: int, mean: bool, chained: bool):
        self.kind, self.components, self.domain = kind, components, domain
        self.mean, self.chained = mean, chained

    def decode(self, planes: list[bytes], points: list[Point]) -> list[list[int]]:
        size, mask = self.kind.size, self.kind.mask
        shift = max(0, max(max(p) for p in points).bit_length() - 25)
        places = [tuple(v >> shift for v in p) for p in points]
        tuples: list[list[int]] = []
        for i in range(len(points)):
            near = [tuples[j] for j in _nearest_before(places, i)]
            order, predict = self._prepare(near)
            words = [0] * self.components
            before = 0
            for number, c in enumerate(order):
                code = sum(planes[number * size + k][i] << 8 * k for k in range(size))
                residual = code >> 1 if code % 2 == 0 else mask - (code >> 1)
                if self.chained:
                    residual += before
                before = residual & mask
                words[c] = (predict(number, c, words) + residual) & mask
            tuples.append(words)
        return tuples

    def _prepare(self, near: list[list[int]]):
        """The order of the components, and what predicts them."""
        kind = self.kind
        order = list(range(self.components))
        if not near:
            return order, lambda number, c, words: kind.zero
        if self.domain == 0:
            return order, lambda number, c, words: self._word(near, c)
        if self.domain == 1:
            return order, lambda number, c, words: kind.predicted(self._number(near, c), near[0][c])
        unit = UnitPrediction([self._number(near, c) for c in range(3)])

        def predict(number: int, c: int, words: list[int]) -> int:
            if number < 2:
                return kind.predicted(unit.means[c], near[0][c])
            return unit.last_word(kind, *(kind.number(words[unit.order[j]]) for j in range(2)))

        return unit.order, predict

    def _word(self, near: list[list[int]], c: int) -> int:
        p, q, r = (t[c] for t in near)
        if not self.mean:
            return p
        return p + (((self.kind.signed(q - p) >> 1) + (self.kind.signed(r - p) >> 1) + 1) >> 1)

    def _number(self, near: list[list[int]], c: int) -> float:
        p, q, r = (self.kind.number(t[c]) for t in near)
        return ((p + p + q) + r) * 0.25 if self.mean else p


def _nearest_before(places: list[tuple], i: int) -> list[int]:
    """The nearest three of the sixteen points before, the last of them standing for those missing."""
    at = places[i]
    before = range(i - 1, max(i - 17, -1), -1)
    near = sorted(before, key=lambda j: sum(abs(a - b) for a, b in zip(places[j], at)))[:3]
    return near + near[-1:] * (3 - len(near)) if near else []


__all__ = ["ArrayPayload", "Layer"]
