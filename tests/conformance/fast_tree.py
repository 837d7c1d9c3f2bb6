"""The tree of a slab, sets of kind 1 of method fast (docs/format.md, section 10)."""

from __future__ import annotations

from elementary import require
from fast_entropy import RawBits
from range_coder import AdaptiveBits, RangeDecoder

Place = tuple[int, int]


class Around:
    """The counts around a cell that its split is predicted from."""

    __slots__ = ("near", "far", "ahead", "side0", "side1", "opposite", "depth_class")

    def __init__(self, depth_class: int):
        self.near = self.far = self.ahead = self.side0 = self.side1 = self.opposite = 0
        self.depth_class = depth_class

    def ends(self) -> int:
        return 3 * min(self.near, 2) + min(self.ahead, 2)

    def balance(self) -> int:
        before, after = 2 * self.near + self.side0, self.ahead + self.side1
        return 0 if before > after else 2 if before < after else 1


class SlabTrees:
    """The trees of all slabs of a set, which share a stream and its models."""

    def __init__(self, payload: bytes, bits: RawBits, extra_levels: int):
        self.coder = RangeDecoder(payload)
        self.models = AdaptiveBits()
        self.bits = bits
        self.extra_levels = extra_levels

    def points(self, n: int, lengths: list[int], scales: list[int]) -> list[Place]:
        """The (u, v) of the n points of a slab of 2^lengths[0] by 2^lengths[1]."""
        require(n <= 65535, "a slab with a tree has too many points")
        lengths = list(lengths)
        depths = min(sum(lengths), n.bit_length() + self.extra_levels, 20)
        cells: dict[Place, int] = {(0, 0): n}
        for depth in range(depths):
            axis = self._axis(lengths, scales)
            lengths[axis] -= 1
            depth_class = min(max(depth - n.bit_length() + 7, 0), 13)
            cells = self._halve(cells, axis, depth_class)
        points: list[Place] = []
        for (u, v), count in cells.items():
            start = (u << lengths[0], v << lengths[1])
            self._rest(count, start, lengths, points)
        return points

    @staticmethod
    def _axis(lengths: list[int], scales: list[int]) -> int:
        if lengths[0] == 0 or lengths[1] == 0:
            return 0 if lengths[0] else 1
        return 0 if lengths[0] + scales[0] >= lengths[1] + scales[1] else 1

    def _halve(self, cells: dict[Place, int], axis: int, depth_class: int) -> dict[Place, int]:
        """The cells of the next depth that have points, in order."""
        halves: dict[Place, int] = {}

        def moved(cell: Place, along: int, by: int) -> Place:
            return (cell[0] + by, cell[1]) if along == 0 else (cell[0], cell[1] + by)

        def halves_of(cell: Place) -> tuple[Place, Place]:
            lower = (2 * cell[0], cell[1]) if axis == 0 else (cell[0], 2 * cell[1])
            return lower, moved(lower, axis, 1)

        for cell, n in cells.items():
            around = Around(depth_class)
            lower, upper = halves_of(moved(cell, axis, -1))
            around.near, around.far = halves.get(upper, 0), halves.get(lower, 0)
            around.ahead = cells.get(moved(cell, axis, 1), 0)
            lower, upper = halves_of(moved(cell, 1 - axis, -1))
            around.side0, around.side1 = halves.get(lower, 0), halves.get(upper, 0)
            around.opposite = cells.get(moved(cell, 1 - axis, 1), 0)
            in_lower = self._lower_one(around) if n == 1 else self._lower_count(n, around)
            lower, upper = halves_of(cell)
            if in_lower:
                halves[lower] = in_lower
            if n - in_lower:
                halves[upper] = n - in_lower
        return halves

    def _lower_one(self, a: Around) -> int:
        context = (a.depth_class, a.ends(), a.far > 0, a.side0 > 0, a.side1 > 0, a.opposite > 0)
        return self.coder.adaptive(self.models["one", context])

    def _lower_count(self, n: int, a: Around, balance: int | None = None) -> int:
        if n == 2:
            context = (a.depth_class, a.ends(), a.side0 > 0, a.side1 > 0)
            if self.coder.adaptive(self.models["parted", context]):
                return 1
            return 2 * self.coder.adaptive(self.models["both", context])
        if n < 16:
            return self._bisected(n, a.depth_class, a.balance() if balance is None else balance)
        size_class = 0 if n < 64 else 1 if n < 256 else 2 if n < 1024 else 3
        node = 1
        for _ in range(4):
            node = node << 1 | self.coder.adaptive(self.models["bucket", size_class, node])
        bucket = node - 16
        first = (bucket * (n + 1) + 15) // 16
        last = ((bucket + 1) * (n + 1) + 15) // 16 - 1
        return first + self.coder.uniform(last - first)

    def _bisected(self, n: int, depth_class: int, balance: int) -> int:
        low, high, node = 0, n, 1
        while low < high:
            middle = (low + high + 1) // 2
            bit = self.coder.adaptive(self.models["some", depth_class, n, balance, node])
            if bit:
                low = middle
            else:
                high = middle - 1
            node = 2 * node + bit
            if node > 15:
                node = 8 + node % 8
        return low

    def _rest(self, n: int, start: Place, lengths: list[int], points: list[Place]) -> None:
        """The points of a cell by the bits that are left."""
        left_u, left_v = lengths
        if left_u + left_v == 0:
            points += [start] * n
        elif n == 1:
            raw = self.bits.field(left_u + left_v)
            points.append((start[0] + (raw >> left_v), start[1] + (raw & ((1 << left_v) - 1))))
        else:
            axis = 1 if left_v > left_u else 0
            in_lower = self._lower_count(n, Around(13), balance=1)
            left = [left_u, left_v]
            left[axis] -= 1
            if in_lower:
                self._rest(in_lower, start, left, points)
            if n - in_lower:
                at = list(start)
                at[axis] += 1 << left[axis]
                self._rest(n - in_lower, (at[0], at[1]), left, points)
