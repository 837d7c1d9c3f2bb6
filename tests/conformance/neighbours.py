"""Ranks, neighbours and predictors of docs/format.md, section 14."""

from __future__ import annotations

import math
from typing import Iterator

from elementary import require

Point = tuple[int, int, int]
NEAREST, MEAN3, MEAN8, PLANE, QUADRIC = range(5)


def interleaved(x: int, y: int, z: int) -> int:
    code = 0
    for j in range(21):
        code |= (x >> j & 1) << 3 * j | (y >> j & 1) << 3 * j + 1 | (z >> j & 1) << 3 * j + 2
    return code


def size_class(v: int) -> int:
    """h(v)."""
    return v if v < 4 else 2 * (v.bit_length() - 1) + (v >> (v.bit_length() - 2) & 1)


class Ranks:
    """The points of a tile up to a layer along the Morton curve; the first `known` are known."""

    def __init__(self, points: list[Point], known: int):
        greatest = max((max(p) for p in points), default=0).bit_length()
        self.code_shift, self.position_shift = max(0, greatest - 21), max(0, greatest - 30)
        self.known = known
        codes = [interleaved(*(v >> self.code_shift for v in p)) for p in points]
        self.order = sorted(range(known), key=lambda i: (codes[i], i))
        self.order += sorted(range(known, len(points)), key=lambda i: (codes[i], i))
        self.codes = [codes[i] for i in self.order]  # from here on by rank
        self.positions = [tuple(v >> self.position_shift for v in points[i]) for i in self.order]

    def cut(self, mean: int) -> int:
        """How many bits of each coordinate do not count in cells of this mean."""
        s = 0
        while s < 20 and len({c >> 3 * s for c in self.codes}) > len(self.codes) // mean:
            s += 1
        return s

    def cell(self, position: tuple[int, ...], s: int) -> Point:
        shift = self.code_shift - self.position_shift + s
        return position[0] >> shift, position[1] >> shift, position[2] >> shift

    def distance(self, rank: int, place: tuple[int, ...]) -> int:
        p = self.positions[rank]
        return (p[0] - place[0]) ** 2 + (p[1] - place[1]) ** 2 + (p[2] - place[2]) ** 2

    def neighbours(self, wanted: int, mean: int) -> Iterator[tuple[int, list[int]]]:
        """Every new rank with the ranks of its neighbours, nearest first."""
        s = self.cut(mean)
        cells: dict[Point, list[int]] = {}
        for rank, position in enumerate(self.positions):
            cell = self.cell(position, s)
            if rank >= self.known:
                near: list[int] = []
                for around in cells_around(cell):
                    near += cells.get(around, [])[-24:]
                near.sort(key=lambda r: (self.distance(r, position), r))
                near = near[:wanted]
                for below in (rank - 1, rank - 2):
                    if len(near) < 2 and below >= 0 and below not in near:
                        near.append(below)
                yield rank, near
            cells.setdefault(cell, []).append(rank)


def cells_around(cell: Point) -> Iterator[Point]:
    for x in (-1, 0, 1):
        for y in (-1, 0, 1):
            for z in (-1, 0, 1):
                yield cell[0] + x, cell[1] + y, cell[2] + z


class Predictor:
    def __init__(self, number: int, stiffness: int = 0):
        require(number <= QUADRIC, "an unknown predictor")
        self.number, self.stiffness = number, stiffness
        self.wanted, self.mean = (20, 6) if number == QUADRIC else (8, 3)

    def weighted(self, ranks: Ranks) -> Iterator[tuple[int, list[int], list[float]]]:
        """Every new rank, its neighbours, and weights of the first of them."""
        for rank, near in ranks.neighbours(self.wanted, self.mean):
            yield rank, near, self._weights(ranks, rank, near)

    def _weights(self, ranks: Ranks, rank: int, near: list[int]) -> list[float]:
        used = near[: (1, 3, 8, 8, 20)[self.number]]
        if len(used) == 1:
            return [1.0]
        at = ranks.positions[rank]
        squares = [ranks.distance(r, at) for r in used]
        offsets = [tuple(a - b for a, b in zip(ranks.positions[r], at)) for r in used]
        weights = None
        if self.number == QUADRIC and len(used) >= 12:
            weights = fitted(squares, offsets, 10, self.stiffness)
        if weights is None and self.number >= PLANE and len(squares) >= 4:
            weights = fitted(squares, offsets, 4, self.stiffness)
        return inverse_distances(squares) if weights is None else weights


def inverse_distances(squares: list[int]) -> list[float]:
    weights = [1.0 / (float(d) + 1.0) for d in squares]
    total = 0.0
    for w in weights:
        total += w
    return [w / total for w in weights]


def fitted(squares: list[int], offsets: list, size: int, stiffness: int) -> list[float] | None:
    """The weights of a fit, or None if it fails."""
    total = 0.0
    for d in squares:
        total += float(d)
    mean = max(total / len(squares), 1.0)
    unit = 1.0 / math.sqrt(mean)
    importance = [1.0 / (float(d) / mean + 0.1) for d in squares]
    terms = []
    for offset in offsets:
        x, y, z = (float(v) * unit for v in offset)
        row = [1.0, x, y, z]
        terms.append(row if size == 4 else row + [x * x, y * y, z * z, x * y, y * z, x * z])
    matrix = [[0.0] * size for _ in range(size)]
    whole = 0.0
    for w, t in zip(importance, terms):
        whole += w
        for a in range(size):
            weighted = w * t[a]
            for b in range(a + 1):
                matrix[a][b] += weighted * t[b]
    slope, bend = ((2**-6, 2**-4), (2**-12, 2**-9), (2**-16, 2**-13), (2**-20, 2**-17))[stiffness]
    for a in range(1, size):
        matrix[a][a] += (slope if a <= 3 else bend) * whole
    solution = solved(matrix)
    if solution is None:
        return None
    weights = []
    for w, t in zip(importance, terms):
        value = 0.0
        for b, term in zip(solution, t):
            value += b * term
        weights.append(value * w)
    return weights


def solved(matrix: list[list[float]]) -> list[float] | None:
    """The solution for the right side (1, 0, …) by L D Lᵀ, or None if that fails."""
    size = len(matrix)
    lower = [[0.0] * size for _ in range(size)]
    diagonal = []
    for i in range(size):
        sums: list[float] = []
        for j in range(i):
            s = matrix[i][j]
            for k in range(j):
                s -= sums[k] * lower[j][k]
            sums.append(s)
        d = matrix[i][i]
        for j in range(i):
            lower[i][j] = sums[j] / diagonal[j]
            d -= sums[j] * lower[i][j]
        if not d > 2**-46:
            return None
        diagonal.append(d)
    b = [1.0]
    for i in range(1, size):
        value = 0.0
        for j in range(i):
            value -= lower[i][j] * b[j]
        b.append(value)
    for i in reversed(range(size)):
        b[i] = b[i] / diagonal[i]
    for i in reversed(range(size)):
        for j in range(i + 1, size):
            b[i] -= lower[j][i] * b[j]
    return b
