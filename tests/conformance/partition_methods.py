"""Methods kd, octree and gencode of docs/format.md, sections 9 and 12.

Each method is a class with `layer(payload, last)`, called for one layer after the other, which
returns the representatives (or points) relative to the tile's lower corner, and how many points
each stands for.
"""

from __future__ import annotations

from elementary import require
from range_coder import AdaptiveBit, AdaptiveBits, AdaptiveSymbol, RangeDecoder, stream_of

Corner = tuple[int, int, int]


class StopRule:
    def __init__(self, points: int | None = None, level: int | None = None) -> None:
        self.points, self.level = points, level

    @classmethod
    def read(cls, coder: RangeDecoder) -> "StopRule":
        points = coder.wide(32) if coder.raw(1) else None
        level = coder.raw(10) if coder.raw(1) else None
        return cls(points, level)

    def stops(self, points: int, level: int) -> bool:
        return (self.points is not None and points <= self.points) or (
            self.level is not None and level >= self.level
        )


class CountModels:
    """The number of points in a lower half (section 9)."""

    def __init__(self) -> None:
        self.bits = AdaptiveBits()
        self.buckets = {}

    def lower_count(self, coder: RangeDecoder, n: int, history: int, size_class: int) -> int:
        if n <= 16:
            fewer = 0
            while fewer < n // 2 and coder.adaptive(self.bits["few", n, size_class, history, fewer]):
                fewer += 1
            if 2 * fewer == n:
                return fewer
            return n - fewer if coder.adaptive(self.bits["side", n, fewer, size_class]) else fewer
        z = min(n.bit_length(), 33)
        if coder.adaptive(self.bits["one empty", z, history]):
            return n if coder.adaptive(self.bits["upper", z]) else 0
        bucket = coder.symbol(self.buckets.setdefault(z, AdaptiveSymbol(16)))
        first, end = bucket * (n - 1) // 16, (bucket + 1) * (n - 1) // 16
        require(first < end, "an empty bucket")
        return 1 + first + coder.uniform(end - first - 1)


class Box:
    """The cells of section 9: the axis and the halved side of each depth."""

    def __init__(self, extent: list[int]) -> None:
        self.extent = extent
        bits = [e.bit_length() for e in extent]
        self.bits = [tuple(bits)]
        self.axes = []
        while any(bits):
            axis = max(range(3), key=lambda k: (bits[k], -k))
            bits[axis] -= 1
            self.axes.append(axis)
            self.bits.append(tuple(bits))
        self.depth = len(self.axes)

    def inside(self, lower: Corner, axis: int, bits: int) -> int:
        """Steps of a cell inside the box along an axis."""
        return min(1 << bits, self.extent[axis] + 1 - lower[axis])

    def middle(self, lower: Corner, depth: int) -> Corner:
        return tuple(
            lower[k] + (self.inside(lower, k, self.bits[depth][k]) - 1) // 2 for k in range(3)
        )

    def place(self, coder: RangeDecoder, lower: Corner, depth: int) -> Corner:
        """The place of a point in a cell, method kd."""
        point = []
        for k in range(3):
            bits = self.bits[depth][k]
            inside = self.inside(lower, k, bits)
            if bits == 0:
                point.append(lower[k])
            elif inside == 1 << bits:
                point.append(lower[k] + coder.wide(bits))
            else:
                point.append(lower[k] + coder.uniform(inside - 1))
        return tuple(point)

    def upper(self, lower: Corner, axis: int, bits: int) -> Corner:
        corner = list(lower)
        corner[axis] += 1 << bits
        return tuple(corner)


def lower_half(coder: RangeDecoder, inside: int, bits: int) -> int:
    """Whether a single point lies in the lower half of 2^bits of `inside` steps."""
    return coder.bit(min((1 << bits + 16) // inside, 65535))


class Kd:
    def __init__(self, points: int, extent: list[int], version: int) -> None:
        require(version <= 1, "unknown version of kd", "unsupported")
        self.box = Box(extent)
        self.stop = None if version else StopRule()
        self.counts = CountModels()
        self.deeper = AdaptiveBit()
        self.cells = [((0, 0, 0), points, 0, 0)]  # lower corner, points, depth, history

    def layer(self, payload: bytes, last: bool) -> tuple[list[Corner], list[int]]:
        coder = stream_of(payload)
        if self.stop is None:
            self.stop = StopRule.read(coder)
        if last:
            points = [p for cell in self.cells for p in self._finish(coder, cell)]
            coder.finish()
            return points, [1] * len(points)
        while any(self._divisible(c) for c in self.cells) and coder.adaptive(self.deeper):
            self.cells = [h for c in self.cells for h in (self._split(coder, c) if self._divisible(c) else [c])]
        coder.finish()
        return [self.box.middle(c[0], c[2]) for c in self.cells], [c[1] for c in self.cells]

    def _divisible(self, cell: tuple) -> bool:
        return cell[2] < self.box.depth and not self.stop.stops(cell[1], cell[2])

    def _split(self, coder: RangeDecoder, cell: tuple) -> list[tuple]:
        lower, n, depth, history = cell
        axis = self.box.axes[depth]
        bits = self.box.bits[depth + 1][axis]
        inside = self.box.inside(lower, axis, bits + 1)
        if inside <= 1 << bits:
            return [(lower, n, depth + 1, history)]
        if n == 1:
            full = inside == 2 << bits
            in_lower = coder.raw(1) if full else lower_half(coder, inside, bits)
        else:
            in_lower = self.counts.lower_count(coder, n, history, min(bits, 3))
            history = (history << 1 | (in_lower in (0, n))) & 7
        halves = [(lower, in_lower), (self.box.upper(lower, axis, bits), n - in_lower)]
        return [(corner, count, depth + 1, history) for corner, count in halves if count]

    def _finish(self, coder: RangeDecoder, cell: tuple) -> list[Corner]:
        stack = [cell]
        points = []
        while stack:
            lower, n, depth, history = stack.pop()
            if self.stop.stops(n, depth):
                points += [self.box.middle(lower, depth)] * n
            elif depth == self.box.depth:
                points += [lower] * n
            elif n == 1 and self.stop.level is None:
                points.append(self.box.place(coder, lower, depth))
            else:
                stack += reversed(self._split(coder, (lower, n, depth, history)))
        return points


ONE, MANY, SOME = "one", "many", "some"


class Node:
    __slots__ = ("lower", "depth", "kind", "known", "history")

    def __init__(
        self, lower: Corner, depth: int, kind: str, known: int | None = None, history: int = 0
    ) -> None:
        self.lower, self.depth, self.kind = lower, depth, kind
        self.known, self.history = known, history

    def lone(self) -> bool:
        return self.kind == ONE or self.known == 1

    def fewest(self) -> int:
        return 2 if self.kind == MANY else 1


class Occupancy:
    """Methods octree and gencode."""

    def __init__(self, points: int, extent: list[int], version: int, octree: bool) -> None:
        require(version == 0, "unknown version of octree or gencode", "unsupported")
        require(all(e < 1 << 21 for e in extent), "extents above 21 bits")
        self.octree = octree
        self.box = Box(extent)
        self.deeper = AdaptiveBit()
        self.bits = AdaptiveBits()
        self.symbols = {}
        self.shares = CountModels()
        kind = ONE if points == 1 else SOME if octree else MANY
        self.cells = [Node((0, 0, 0), 0, kind, points)]

    def layer(self, payload: bytes, last: bool) -> tuple[list[Corner], list[int]]:
        coder = stream_of(payload)
        if last:
            points = []
            for cell in self.cells:
                before = len(points)
                self._finish(coder, cell, points)
                require(len(points) - before == cell.known, "a cell has not the points that are known")
            coder.finish()
            return points, [1] * len(points)
        groups = [[c] for c in self.cells]
        counts = [c.known for c in self.cells]
        depth = self.cells[0].depth
        while depth < self.box.depth and coder.adaptive(self.deeper):
            groups = [[child for c in group for child in self._split(coder, c)] for group in groups]
            depth = groups[0][0].depth
        for group, count in zip(groups, counts):
            excess = count - sum(c.fewest() for c in group)
            require(excess >= 0, "more cells than points")
            for c in group:
                c.known = c.fewest()
            self._share_out(coder, group, excess)
        coder.finish()
        self.cells = [c for group in groups for c in group]
        return [self.box.middle(c.lower, c.depth) for c in self.cells], [c.known for c in self.cells]

    def _share_out(self, coder: RangeDecoder, cells: list[Node], excess: int) -> None:
        if len(cells) == 1:
            require(excess == 0 or cells[0].kind != ONE, "points for a cell of one")
            cells[0].known += excess
            return
        if excess == 0:
            return
        parts = cells[: len(cells) // 2], cells[len(cells) // 2 :]
        open_parts = [any(c.kind != ONE for c in part) for part in parts]
        if open_parts[0] != open_parts[1]:
            first = excess if open_parts[0] else 0
        elif excess == 1:
            first = coder.adaptive(self.bits["share of one"])
        else:
            first = self.shares.lower_count(coder, excess, min(len(cells).bit_length(), 7), 0)
        self._share_out(coder, parts[0], first)
        self._share_out(coder, parts[1], excess - first)

    def _level(self, depth: int) -> list[int]:
        """The depths of the level that begins at a depth."""
        if not self.octree:
            return [depth]
        side = max(self.box.bits[depth])
        depths = [depth]
        while len(depths) < 3 and depths[-1] + 1 < self.box.depth and max(self.box.bits[depths[-1] + 1]) == side:
            depths.append(depths[-1] + 1)
        return depths

    def _halves(self, lower: Corner, depth: int) -> tuple[tuple[Corner, ...], int, int]:
        axis = self.box.axes[depth]
        bits = self.box.bits[depth + 1][axis]
        inside = self.box.inside(lower, axis, bits + 1)
        return (lower, self.box.upper(lower, axis, bits)) if inside > 1 << bits else (lower,), inside, bits

    def _split(self, coder: RangeDecoder, cell: Node) -> list[Node]:
        depths = self._level(cell.depth)
        end = depths[-1] + 1
        if cell.lone():
            lower = cell.lower
            for depth in depths:
                halves, inside, bits = self._halves(lower, depth)
                lower = halves[0] if len(halves) == 1 or lower_half(coder, inside, bits) else halves[1]
            return [Node(lower, end, ONE)]
        corners = [cell.lower]
        for depth in depths:
            corners = [half for c in corners for half in self._halves(c, depth)[0]]
        if self.octree:
            return self._split_some(coder, cell, corners, end)
        return self._split_many(coder, cell, corners, end)

    def _split_some(self, coder: RangeDecoder, cell: Node, corners: list[Corner], end: int) -> list[Node]:
        count = len(corners)
        found, bits = [], 0
        for i, corner in enumerate(corners):
            if i == count - 1 and not found:
                bit = 1
            else:
                bit = coder.adaptive(self.bits["some", cell.history, count, (1 << i) + bits])
            bits = bits << 1 | bit
            if bit:
                found.append(corner)
        history = cell.history
        if count > 1:
            history = min(history + 1, 3) if len(found) == 1 else 0
        return [Node(c, end, SOME, None, history) for c in found]

    def _split_many(self, coder: RangeDecoder, cell: Node, corners: list[Corner], end: int) -> list[Node]:
        if len(corners) == 1:
            return [Node(corners[0], end, MANY, None, cell.history)]
        bits = self.box.bits[end][self.box.axes[cell.depth]]
        model = self.symbols.setdefault((min(bits, 3), cell.history), AdaptiveSymbol(6))
        symbol = coder.symbol(model)
        kinds = ((None, MANY), (MANY, None), (ONE, ONE), (ONE, MANY), (MANY, ONE), (MANY, MANY))[symbol]
        history = (2 * cell.history + (symbol < 2)) % 8
        return [Node(c, end, k, None, history) for c, k in zip(corners, kinds) if k]

    def _finish(self, coder: RangeDecoder, cell: Node, points: list[Corner]) -> None:
        stack = [cell]
        while stack:
            cell = stack.pop()
            if cell.lone():
                bits = self.box.bits[cell.depth]
                points.append(
                    tuple(
                        cell.lower[k] + coder.uniform(self.box.inside(cell.lower, k, bits[k]) - 1)
                        for k in range(3)
                    )
                )
            elif cell.depth == self.box.depth:
                points += [cell.lower] * (cell.known or self._count(coder, cell))
            else:
                stack += reversed(self._split(coder, cell))

    def _count(self, coder: RangeDecoder, cell: Node) -> int:
        k = 0
        while k < 34 and coder.adaptive(self.bits["count", k]):
            k += 1
        return ((1 << k) | coder.wide(k)) - 1 + cell.fewest()
