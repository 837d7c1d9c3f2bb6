"""The grid of docs/format.md, section 4."""

from __future__ import annotations

import math
import struct
from math import gcd

from elementary import FLOAT32, FLOAT64, SCALAR_TYPES, Reader, float32, is_float, require
from words import FLOAT32_GREATEST

RATIONAL, AFFINE, FLOAT_BITS = 0, 1, 2


class Grid:
    def __init__(self, reader: Reader) -> None:
        kind = reader.u8()
        self.scalar_type = kind & 15
        require(self.scalar_type < 10, "unknown scalar type", "unsupported")
        self.form = kind >> 4 & 3
        require(self.form < 3, "unknown form of grid", "unsupported")
        shared = kind >> 6 & 1
        self.bases = [0, 0, 0]
        if kind >> 7:
            self.bases = [reader.svarint() for _ in range(3)]
            require(all(abs(b) <= 1 << 62 for b in self.bases), "a base is too large")
        if self.form == RATIONAL:
            self.steps = [_ratio(reader) for _ in range(1 if shared else 3)]
            self.steps *= 3 if shared else 1
        elif self.form == AFFINE:
            numbers = _numbers(reader, 4 if shared else 6)
            self.origins = numbers[:3]
            self.steps = numbers[3:] * (3 if shared else 1)
            require(all(s > 0 for s in self.steps), "a step is not positive")
        else:
            require(not shared, "float bits have no steps")
            require(is_float(self.scalar_type), "float bits of integers")
            require(all(0 <= b < 1 << 32 for b in self.bases), "a base is too large")

    def has_low_halves(self) -> bool:
        return self.form == FLOAT_BITS and self.scalar_type == FLOAT64

    def check_box(self, lower: list[int], upper: list[int]) -> None:
        if self.form != FLOAT_BITS:
            return
        for corner in (lower, upper):
            for k in range(3):
                place = self.bases[k] + corner[k]
                require(place < 1 << 32, "a place is beyond the floats")
                value = self._float_at(place, 0)
                require(math.isfinite(value), "a corner of a box is not finite")

    def _float_at(self, place: int, low: int) -> float:
        if self.scalar_type == FLOAT32:
            bits = place - (1 << 31) if place >> 31 else place ^ 0xFFFFFFFF
            return struct.unpack("<f", struct.pack("<I", bits))[0]
        place = place << 32 | low
        bits = place - (1 << 63) if place >> 63 else place ^ 0xFFFFFFFFFFFFFFFF
        return struct.unpack("<d", struct.pack("<Q", bits))[0]

    def coordinate(self, axis: int, i: int, low: int = 0) -> float:
        place = self.bases[axis] + i
        if self.form == FLOAT_BITS:
            return self._float_at(place, low)
        if self.form == RATIONAL:
            p, q = self.steps[axis]
            value = (float(place) * float(p)) / float(q)
        else:
            value = self.origins[axis] + float(place) * self.steps[axis]
        return self._rounded(value)

    def _rounded(self, value: float) -> float:
        if self.scalar_type == FLOAT64:
            return value + 0.0
        if self.scalar_type == FLOAT32:
            return float32(min(max(value, -FLOAT32_GREATEST), FLOAT32_GREATEST)) + 0.0
        name, size, _ = SCALAR_TYPES[self.scalar_type]
        signed = not name.startswith("u")
        low, high = (-(1 << 8 * size - 1), (1 << 8 * size - 1) - 1) if signed else (0, (1 << 8 * size) - 1)
        if math.isinf(value):
            return float(high if value > 0 else low)
        whole = math.trunc(value)
        if abs(value - whole) >= 0.5:
            whole += 1 if value > 0 else -1
        return float(min(max(whole, low), high))


def _ratio(reader: Reader) -> tuple[int, int]:
    odd_p, odd_q, exponent = reader.varint(), reader.varint(), reader.svarint()
    for odd in (odd_p, odd_q):
        require(odd % 2 == 1 and odd < 1 << 53, "a part of a step is not odd or too large")
    require(gcd(odd_p, odd_q) == 1, "a step is not in lowest terms")
    require(abs(exponent) <= 62, "a step is too large")
    p, q = odd_p << max(exponent, 0), odd_q << max(-exponent, 0)
    require(p <= 1 << 62 and q <= 1 << 62, "a step is too large")
    return p, q


def _numbers(reader: Reader, count: int) -> list[float]:
    packed = reader.bytes(count // 2)
    numbers = []
    for i in range(count):
        nibble = packed[i // 2] >> (4 * (i % 2)) & 15
        require(nibble < 10, "a reserved nibble")
        if nibble == 9:
            value = struct.unpack("<f", reader.bytes(4))[0]
        else:
            bits = reader.unsigned(nibble) << (64 - 8 * nibble)
            value = struct.unpack("<d", struct.pack("<Q", bits))[0]
        require(math.isfinite(value), "a number of the grid is not finite")
        numbers.append(value)
    return numbers
