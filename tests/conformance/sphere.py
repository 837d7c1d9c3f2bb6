"""Places on a sphere, method sphere of docs/format.md, section 14."""

from __future__ import annotations

import math
from typing import Sequence

from elementary import float32

Vector = tuple[float, float, float]
WholePoint = tuple[int, int, int]


class Sphere:
    """The octahedron |x| + |y| + |z| = H, unfolded to a square of places."""

    def __init__(self, size: int):
        self.size = size

    def point(self, place: Sequence[int]) -> WholePoint:
        h = self.size
        x, y = (min(v, 2 * h) - h for v in place)
        z = h - abs(x) - abs(y)
        if z < 0:
            x, y = _folded(x, y, h)
        return x, y, z

    def place_of_point(self, point: WholePoint) -> tuple[int, int]:
        x, y, z = point
        if z < 0:
            x, y = _folded(x, y, self.size)
        return x + self.size, y + self.size

    def direction(self, place: Sequence[int]) -> Vector:
        x, y, z = (float(v) for v in self.point(place))
        length = math.sqrt(x * x + y * y + z * z)
        return x / length, y / length, z / length

    def float32_direction(self, place: Sequence[int]) -> Vector:
        x, y, z = self.direction(place)
        return float32(x), float32(y), float32(z)

    def place(self, vector: Sequence[float]) -> tuple[int, int]:
        x, y, z = vector
        length = abs(x) + abs(y) + abs(z)
        h = float(self.size)
        if not 0 < length <= 2.0**1000:
            return self.size, self.size
        x, y = x / length, y / length
        if z < 0:
            x, y = _folded(x, y, 1.0)
        square = math.floor((x + 1.0) * h + 0.5), math.floor((y + 1.0) * h + 0.5)
        return self.place_of_point(self.point(square))


class Chart:
    """The octahedron turned so that an expected direction is in the middle of its square."""

    def __init__(self, sphere: Sphere, expected: Sequence[float]):
        m = 2
        for k in range(3):
            if abs(expected[k]) > abs(expected[m]):
                m = k
        self.sphere = sphere
        self.axes = ((m + 1) % 3, (m + 2) % 3, m)
        self.sign = -1 if expected[m] < 0 else 1
        a, b, m = self.axes
        self.expected = sphere.place((expected[a], expected[b], self.sign * expected[m]))

    def turned_back(self, place: Sequence[int]) -> tuple[int, int]:
        charted = self.sphere.point(place)
        point = [0, 0, 0]
        for axis, value in zip(self.axes, (charted[0], charted[1], self.sign * charted[2])):
            point[axis] = value
        return self.sphere.place_of_point((point[0], point[1], point[2]))


def _folded(x, y, whole):
    """Both coordinates behind the fold, of numbers or whole numbers."""
    sign_x, sign_y = (1 if v >= 0 else -1 for v in (x, y))
    return (whole - abs(y)) * sign_x, (whole - abs(x)) * sign_y
