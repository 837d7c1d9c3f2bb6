"""Rows of float32 numbers: each operation rounds every entry (docs/format.md, section 13)."""

from __future__ import annotations

import math
from array import array
from operator import add, mul, sub, truediv
from typing import Iterable, Sequence

from reals import real

Row = array


def row(values: Iterable[float] = ()) -> Row:
    return array("f", values)


def plus(a: Sequence[float], b: Sequence[float]) -> Row:
    return array("f", map(add, a, b))


def less(a: Sequence[float], b: Sequence[float]) -> Row:
    return array("f", map(sub, a, b))


def times(a: Sequence[float], b: Sequence[float]) -> Row:
    return array("f", map(mul, a, b))


def over(a: Sequence[float], b: Sequence[float]) -> Row:
    return array("f", map(truediv, a, b))


def scaled(a: Sequence[float], factor: float) -> Row:
    return array("f", [x * factor for x in a])


def shifted(a: Sequence[float], by: float) -> Row:
    return array("f", [x + by for x in a])


def inverted(a: Sequence[float]) -> Row:
    return array("f", [1.0 / x for x in a])


def bell(t: Sequence[float]) -> Row:
    a = array("f", map(add, map(abs, t), times(t, t)))
    return array("f", map(math.copysign, over(a, shifted(a, 1.0)), t))


def bell_of(t: float) -> float:
    a = real(abs(t) + real(t * t))
    return math.copysign(real(a / real(1.0 + a)), t)


def squares(x: Sequence[float], y: Sequence[float], z: Sequence[float]) -> Row:
    return plus(plus(times(x, x), times(y, y)), times(z, z))


def total(values: Sequence[float]) -> float:
    """The sum over entries in eight lanes."""
    lanes = array("f", [0.0] * 8)
    for i in range(0, len(values), 8):
        part = values[i : i + 8]
        added = array("f", map(add, lanes, part))
        lanes = added if len(added) == 8 else added + lanes[len(added) :]
    pairs = plus(lanes[:4], lanes[4:])
    return real(real(pairs[0] + pairs[2]) + real(pairs[1] + pairs[3]))
