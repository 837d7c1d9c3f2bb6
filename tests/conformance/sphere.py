"""Places on a sphere, method sphere of docs/format.md, section 14."""

from __future__ import annotations

import math
from typing import Sequence

from elementary import float32

Vector = tuple[float, float, float]


class Sphere:
    def __init__(self, bits: int):
        self.half = (1 << bits - 1) - 1

    def direction(self, place: Sequence[int]) -> Vector:
        half = float(self.half)
        x, y = (float(min(v, 2 * self.half)) / half - 1.0 for v in place)
        z = 1.0 - abs(x) - abs(y)
        if z < 0:
            x, y = _folded(x, y)
        length = math.sqrt(x * x + y * y + z * z)
        return x / length, y / length, z / length

    def float32_direction(self, place: Sequence[int]) -> Vector:
        x, y, z = self.direction(place)
        return float32(x), float32(y), float32(z)

    def place(self, vector: Sequence[float]) -> tuple[int, int]:
        x, y, z = vector
        length = abs(x) + abs(y) + abs(z)
        if not 0 < length <= 2.0**1000:
            return self.half, self.half
        x, y = x / length, y / length
        if z < 0:
            x, y = _folded(x, y)
        half = float(self.half)
        return math.floor((x + 1.0) * half + 0.5), math.floor((y + 1.0) * half + 0.5)


def _folded(x: float, y: float) -> tuple[float, float]:
    sign_x, sign_y = (1.0 if v >= 0 else -1.0 for v in (x, y))
    return (1.0 - abs(y)) * sign_x, (1.0 - abs(x)) * sign_y
