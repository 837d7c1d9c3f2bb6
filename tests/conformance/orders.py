"""Payloads of orders, docs/format.md, section 14."""

from __future__ import annotations

from bisect import bisect_left

from elementary import Reader, reader_of, require
from neighbours import Point, Ranks, cells_around
from range_coder import AdaptiveBits, RangeDecoder, stream_of


def decoded_order(payload: bytes | Reader, points: list[Point]) -> list[int]:
    """For each place of the input, the number of its point in decoded order."""
    reader = reader_of(payload)
    code = reader.u8()
    require(code < 16, "an unknown version of a method for orders", "unsupported")
    require(code <= 2, "an unknown method for orders", "unsupported")
    if code == 0:
        reader.finish()
        return list(range(len(points)))
    if code == 1:
        return _uniform(reader.rest(), len(points))
    ranks = Ranks(points, 0)
    return [ranks.order[r] for r in Path(reader, ranks).decode()]


def _uniform(payload: bytes, n: int) -> list[int]:
    coder = stream_of(payload)
    left = list(range(n))
    result = [left.pop(coder.uniform(len(left) - 1)) for _ in range(n)]
    coder.finish()
    return result


class NumberModel:
    """Numbers by their length, the bits behind the leading one, and the rest."""

    def __init__(self, length_bits: int):
        self.length_bits = length_bits
        self.bits = AdaptiveBits()

    def decode(self, coder: RangeDecoder, context: tuple) -> int:
        node = 1
        for _ in range(self.length_bits):
            node = node << 1 | coder.adaptive(self.bits["length", context, node])
        length = node - (1 << self.length_bits)
        if length == 0:
            return 0
        require(length <= 33, "a number is too long")
        value, told = 1, min(length - 1, 4)
        for _ in range(told):
            value = value << 1 | coder.adaptive(self.bits["value", length, value])
        rest = length - 1 - told
        return value << rest | coder.wide(rest) if rest else value


class CellLists:
    """Points of each cell that did not occur yet."""

    def __init__(self, ranks: Ranks, s: int):
        self.ranks, self.s = ranks, s
        self.cells: dict[Point, list[int]] = {}
        for rank, position in enumerate(ranks.positions):
            self.cells.setdefault(ranks.cell(position, s), []).append(rank)

    def around(self, place: list[int]) -> list[int]:
        found: list[int] = []
        for cell in cells_around(self.ranks.cell(place, self.s)):
            found += self.cells.get(cell, [])[:64]
        return found

    def remove(self, rank: int) -> None:
        points = self.cells[self.ranks.cell(self.ranks.positions[rank], self.s)]
        last = points.pop()
        if last != rank:
            points[points.index(rank)] = last


class Path:
    def __init__(self, reader: Reader, ranks: Ranks):
        flags = reader.u8()
        self.momentum, coarser = flags & 3, flags >> 2
        require(self.momentum <= 2 and 1 <= coarser <= 4, "wrong parameters of a path")
        self.ranks, self.coder = ranks, stream_of(reader.rest())
        s = ranks.cut(3)
        self.lists = [CellLists(ranks, s), CellLists(ranks, min(s + coarser, 20))]
        self.left = list(range(len(ranks.positions)))
        self.near, self.far = NumberModel(3), NumberModel(6)
        self.classes = (0, 0)

    def decode(self) -> list[int]:
        """Ranks in the order of the input."""
        path: list[int] = []
        was_far = True
        for _ in range(len(self.left)):
            rank = self._near(path, was_far) if path else None
            was_far = rank is None
            if was_far:
                rank = self._far(path[-1] if path else None)
            path.append(rank)
            del self.left[bisect_left(self.left, rank)]
            for cells in self.lists:
                cells.remove(rank)
        self.coder.finish()
        return path

    def _near(self, path: list[int], was_far: bool) -> int | None:
        positions = self.ranks.positions
        expected = list(positions[path[-1]])
        if len(path) > 1 and not was_far:
            for k in range(3):
                step = positions[path[-1]][k] - positions[path[-2]][k]
                expected[k] += step * self.momentum // 2
        candidates = self.lists[0].around(expected)
        if len(candidates) < 4:
            candidates = self.lists[1].around(expected)
        if not candidates:
            return None
        number = self.near.decode(self.coder, self.classes)
        require(number <= min(126, len(candidates)), "a place beyond the candidates")
        newest = 15
        if number:
            newest = 0 if number == 1 else (number - 1).bit_length() + 1
        self.classes = (newest, self.classes[0])
        if number == 0:
            return None
        candidates.sort(key=lambda r: (self.ranks.distance(r, tuple(expected)), r))
        return candidates[number - 1]

    def _far(self, before: int | None) -> int:
        start = 0 if before is None else bisect_left(self.left, before)
        number = self.far.decode(self.coder, ())
        place = start + (number // 2 if number % 2 == 0 else -(number // 2) - 1)
        require(0 <= place < len(self.left), "a point beyond the last")
        return self.left[place]
