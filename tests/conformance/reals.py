"""Arithmetic in single precision, counters and mixers (docs/format.md, sections 13 and 15).

A *real* is a float32 in a Python float; the operations are rounded by `real`.
"""

from __future__ import annotations

import math
import struct
from array import array

from range_coder import RangeDecoder

_FLOAT = struct.Struct("<f")
_WORD = struct.Struct("<I")
_CELL = array("f", [0.0])
Vector = tuple[float, float, float]


def real(x: float) -> float:
    """The nearest float32. Every sum, product, quotient and root of reals is rounded by it alone:
    their result in double precision is exact enough."""
    _CELL[0] = x
    return _CELL[0]


def bits_of(x: float) -> int:
    return _WORD.unpack(_FLOAT.pack(x))[0]


def real_of(bits: int) -> float:
    return _FLOAT.unpack(_WORD.pack(bits))[0]


_LN = [real(c) for c in (1.4426950, -0.7119, 0.4396, -0.2325, 0.0621)]
_EXP = [real(c) for c in (0.693147, 0.240227, 0.0555041, 0.0096181, 0.0013333)]
LN2, LOG2_E = real(0.693147181), real(1.44269504)


def clamp(x: float, low: float, high: float) -> float:
    return (x if x < high else high) if x > low else low


def class_of(x: float, scale: float, offset: float, classes: int) -> int:
    return int(clamp(real(real(x * real(scale)) + real(offset)), 0.0, float(classes - 1)))


def ln(x: float) -> float:
    bits = bits_of(x)
    exponent = float((bits >> 23) - 127)
    m = real(real_of(bits & 0x7FFFFF | 0x3F800000) - 1.0)
    value = _LN[4]
    for c in (_LN[3], _LN[2], _LN[1], _LN[0]):
        value = real(c + real(m * value))
    return real(real(exponent + real(m * value)) * LN2)


def exp2(x: float) -> float:
    x = clamp(x, -100.0, 100.0)
    whole = math.trunc(real(x - 1.0) if x < 0 else x)
    f = real(x - float(whole))
    value = _EXP[4]
    for c in (_EXP[3], _EXP[2], _EXP[1], _EXP[0]):
        value = real(c + real(f * value))
    value = real(1.0 + real(f * value))
    return real(value * real_of((whole + 127) << 23))


def squash(x: float) -> float:
    return real(1.0 / real(1.0 + exp2(real(-x * LOG2_E))))


def root(x: float) -> float:
    return real(math.sqrt(x))


def dot(a: Vector, b: Vector) -> float:
    return real(real(real(a[0] * b[0]) + real(a[1] * b[1])) + real(a[2] * b[2]))


def cross(a: Vector, b: Vector) -> Vector:
    return (
        real(real(a[1] * b[2]) - real(a[2] * b[1])),
        real(real(a[2] * b[0]) - real(a[0] * b[2])),
        real(real(a[0] * b[1]) - real(a[1] * b[0])),
    )


def minus(a: Vector, b: Vector) -> Vector:
    return real(a[0] - b[0]), real(a[1] - b[1]), real(a[2] - b[2])


STRETCH = [
    real(math.log((i + 0.5) / 4096) - math.log(1 - (i + 0.5) / 4096)) for i in range(4096)
]
CONFIDENCE = [real(float(a) / real(a + 1.5)) for a in range(256)]


class Counter:
    __slots__ = ("probability", "age")

    def __init__(self) -> None:
        self.probability, self.age = 1 << 23, 0

    def evidence(self) -> float:
        return real(STRETCH[self.probability >> 12] * CONFIDENCE[self.age])

    def confidence(self) -> float:
        return CONFIDENCE[self.age]

    def learn(self, bit: int, greatest_age: int = 255) -> None:
        step = (((1 << 24) - 1 if bit else 0) - self.probability) * (655360 // (10 * self.age + 16))
        self.probability += step // 65536 if step >= 0 else -(-step // 65536)
        if self.age < greatest_age:
            self.age += 1


class Counters(dict):
    """A counter for each context that occurs."""

    def __missing__(self, context: tuple) -> Counter:
        counter = self[context] = Counter()
        return counter


class Mixer:
    """The plain mixer of one selector."""

    def __init__(self, starts: list[float], rate: float, half_life: float, floor: float):
        self.starts = [real(w) for w in starts]
        self.rate, self.half_life, self.floor = real(rate), float(half_life), real(floor)
        self.weights: dict[object, list[float]] = {}
        self.seen: dict[object, int] = {}

    def decode(self, coder: RangeDecoder, inputs: list[float], selected: object) -> int:
        inputs = [clamp(x, -8.0, 8.0) for x in inputs]
        weights = self.weights.setdefault(selected, list(self.starts))
        lanes = [0.0] * 8
        for j, (w, x) in enumerate(zip(weights, inputs)):
            lanes[j % 8] = real(lanes[j % 8] + real(w * x))
        pairs = [real(lanes[i] + lanes[i + 4]) for i in range(4)]
        logit = real(real(pairs[0] + pairs[2]) + real(pairs[1] + pairs[3]))
        probability = squash(clamp(logit, -11.0, 11.0))
        bit = coder.bit(int(clamp(real(probability * 65536), 4.0, 65532.0)))
        seen = self.seen.get(selected, 0)
        rate = real(real(self.rate * self.half_life) / real(seen + self.half_life))
        step = real(real(rate + self.floor) * real(bit - probability))
        for j, x in enumerate(inputs):
            weights[j] = real(weights[j] + real(step * x))
        self.seen[selected] = min(seen + 1, 60000)
        return bit
