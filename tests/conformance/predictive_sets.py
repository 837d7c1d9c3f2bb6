"""Mirrored copies and range images of method predictive, docs/format.md, section 13."""

from __future__ import annotations

import math

from elementary import require
from predictive_model import Evidence, PlainMixer
from predictive_scene import Phases
from predictive_tree import Point
from range_coder import AdaptiveBit, AdaptiveBits, RangeDecoder
from reals import Counters, real

EMPTY = -1
UNREST = (1, 2, 3, 4, 6, 9, 14, 24, 50)


class Mirror:
    """The copies of points in a plane across an axis."""

    def __init__(self, coder: RangeDecoder, extent: list[int]):
        self.coder, self.extent = coder, extent
        self.axis = coder.part(3)
        most = 2 * extent[self.axis]
        self.sum = coder.wide(most.bit_length())
        require(self.sum <= most, "a mirror plane lies outside of its tile")
        self.bits = AdaptiveBits()
        self.last: Point | None = None
        self.last_had, self.steps = 1, {}

    def copy(self, original: Point, phases: list[Phases]) -> Point | None:
        apart = self.sum - 2 * original[self.axis]
        require(apart >= 0, "a point lies behind its mirror")
        again = original == self.last
        self.last = original
        had = self.coder.adaptive(self.bits["copy", min(apart, 3), self.last_had, again])
        self.last_had = had
        if not had:
            return None
        result, moved = list(original), 0
        for place in range(3):
            axis = (self.axis + place) % 3
            image = self.sum - original[axis] if place == 0 else original[axis]
            key = (place, original[axis] % 65536)
            context = (place, _likely(image, phases[axis]), self.steps.get(key), min(moved, 2))
            step = 0
            if self.coder.adaptive(self.bits["off", context]):
                step = 1 if self.coder.adaptive(self.bits["up", context]) else -1
                moved += 1
            self.steps[key] = step
            result[axis] = image + step
            require(0 <= result[axis] <= self.extent[axis], "a mirrored point lies outside of its tile")
        return result[0], result[1], result[2]


def _likely(image: int, phases: Phases) -> int:
    if not phases.frequency:
        return 0
    weights = [phases.weight((image + step) & 0xFFFFFFFF) for step in (0, -1, 1)]
    return 1 + weights.index(max(weights))


def slope(difference: int) -> int:
    """q of a difference."""
    size = abs(difference)
    size = size if size < 3 else 3 if size < 5 else 4
    return 4 - size if difference < 0 else 4 + size


class RangeImage:
    def __init__(self, coder: RangeDecoder, extent: list[int], points: int):
        self.coder, self.extent = coder, extent
        self.depth_axis = coder.part(3)
        self.depth_offset = self._signed(52)
        self.pitch, self.offset, self.centre = [0, 0], [0, 0], [0, 0]
        for k in range(2):
            self.pitch[k], self.offset[k], self.centre[k] = (self._signed(b) for b in (52, 52, 18))
        self.first, self.size = [0, 0], [0, 0]
        for k in range(2):
            self.first[k] = self._signed(16)
            self.size[k] = coder.raw(16) + 1
        require(self.size[0] * self.size[1] // 16 <= points, "a range image has too many pixels")
        self.bits = AdaptiveBits()
        self.depths, self.shifts = [], []
        self._read_depths()
        usual = (0.02, 60.0, 0.003)
        self.masks, self.ranks = PlainMixer(0.3, usual), PlainMixer(0.15, usual)
        self.counters = Counters()
        width = self.size[0] + 5
        self.rows = [[EMPTY] * width for _ in range(3)]  # three pixels before, two behind
        self.errors = [0] * self.size[0]
        self.last_rank = 0

    def _signed(self, bits: int) -> int:
        return self.coder.wide(bits) - (1 << bits - 1)

    def _number(self, context: str) -> int:
        length = 0
        while length < 19 and self.coder.adaptive(self.bits[context, length]):
            length += 1
        return (1 << length | self.coder.raw(length)) - 1

    def _read_depths(self) -> None:
        after, shifted = 0, AdaptiveBit()
        for _ in range(self.coder.raw(16) + 1):
            depth = after + self._number("depth")
            require(depth <= self.extent[self.depth_axis], "a depth lies outside of its tile")
            self.depths.append(depth)
            after = depth + 1
            self.shifts.append(self.coder.part(41) - 20 if self.coder.adaptive(shifted) else 0)

    def points(self, most: int) -> list[Point]:
        found: list[Point] = []
        for y in range(self.size[1]):
            self.rows = [[EMPTY] * (self.size[0] + 5), self.rows[0], self.rows[1]]
            before = 0
            for x in range(self.size[0]):
                error = 0
                around = self._around(x)
                if self._there(around):
                    rank, error = self._rank(around, before, self.errors[x])
                    found.append(self._point(x, y, rank))
                    require(len(found) <= most, "a tile has more points than it says")
                    self.rows[0][x + 3] = self.last_rank = rank
                self.errors[x] = before = error
        return found

    def _point(self, x: int, y: int, rank: int) -> Point:
        point = [0, 0, 0]
        point[self.depth_axis] = self.depths[rank]
        z = float(self.depths[rank]) + self.depth_offset / 65536.0 + self.shifts[rank] / 32.0
        for k, pixel in enumerate((x, y)):
            width = z * (self.pitch[k] / 1099511627776.0)
            place = float(self.first[k] + pixel) + self.centre[k] / 65536.0
            error = 0
            if self.coder.adaptive(self.bits["error", k]):
                error = 1 if self.coder.adaptive(self.bits["positive", k]) else -1
            value = math.floor(place * width - self.offset[k] / 65536.0 + 0.5) + error
            axis = (self.depth_axis + 1 + k) % 3
            require(0 <= value <= self.extent[axis], "a pixel's point lies outside of its tile")
            point[axis] = value
        return point[0], point[1], point[2]

    def _around(self, x: int) -> dict[str, int]:
        here, above, top = self.rows
        i = x + 3
        return {
            "w": here[i - 1], "n": above[i], "nw": above[i - 1], "ne": above[i + 1],
            "ww": here[i - 2], "nn": top[i], "nne": top[i + 1], "nww": above[i - 2],
            "nee": above[i + 2], "www": here[i - 3],
        }  # fmt: skip

    def _there(self, a: dict[str, int]) -> int:
        m = sum((rank != EMPTY) << i for i, rank in enumerate(a.values()))
        west = slope(a["w"] - a["n"]) + 1 if EMPTY not in (a["w"], a["n"]) else 0
        east = slope(a["n"] - a["ne"]) + 1 if EMPTY not in (a["n"], a["ne"]) else 0
        deepest = max(a["w"], a["n"], a["nw"], a["ne"], 0)
        e = Evidence(self.counters, 255)
        e.add(real(0.3))
        e.context("mask", 0, m)
        e.context("mask", 1, m % 256, west)
        e.context("mask", 2, m % 64, west, east)
        e.context("mask", 3, m % 16, deepest // 4 % 128)
        return e.learn(self.masks.decode(self.coder, e.inputs, (m % 256, west)))

    def _expected(self, a: dict[str, int]) -> int:
        w, n, nw = a["w"], a["n"], a["nw"]
        if EMPTY not in (w, n):
            if nw == EMPTY:
                return (w + n) // 2
            low, high = min(w, n), max(w, n)
            return low if nw >= high else high if nw <= low else w + n - nw
        there = [a[k] for k in ("w", "n", "ne", "nw", "nn") if a[k] != EMPTY]
        return there[0] if there else self.last_rank

    def _rank(self, a: dict[str, int], error_w: int, error_n: int) -> tuple[int, int]:
        """The rank, and by how much it is not as expected."""
        e = self._expected(a)
        missing = (a["w"] == EMPTY) + 2 * (a["n"] == EMPTY)
        w, n, nw, ne = (e if a[k] == EMPTY else a[k] for k in ("w", "n", "nw", "ne"))
        ww = w if a["ww"] == EMPTY else a["ww"]
        nn = n if a["nn"] == EMPTY else a["nn"]
        nee = ne if a["nee"] == EMPTY else a["nee"]
        unrest = abs(w - nw) + abs(n - nw) + abs(n - ne) + abs(ww - w)
        active = sum(unrest >= bound for bound in UNREST)
        plane = (3 * (w + n) - 2 * nw + 2) >> 2
        contexts = [
            (slope(w - e), slope(n - e)),
            (slope(ne - e), slope(nw - e)),
            (slope(ww - w), slope(nn - n)),
            (active, missing),
            (min(e // 6, 63), min(active // 2, 2)),
            (slope(error_w), slope(error_n)),
            (slope(plane - e), slope(2 * w - ww - e)),
            (slope(2 * n - nn - e), slope(nee - e), min(active // 3, 3)),
            (slope(w - e), slope(n - e), slope(ne - e)),
        ]

        def decide(number: int) -> int:
            evidence = Evidence(self.counters, 255)
            evidence.add(real(0.3))
            for i, context in enumerate(contexts):
                evidence.context("rank", i, number, *context)
            selected = ((number, active), (number, slope(error_w)), (number, missing))
            return evidence.learn(self.ranks.decode(self.coder, evidence.inputs, selected))

        if not decide(0):
            return e, 0
        behind, size = decide(1), 0
        while size < 14 and decide(2 + size):
            size += 1
        if size == 14:
            size += self._number("rank")
        error = size + 1 if behind else -(size + 1)
        require(0 <= e + error < len(self.depths), "a pixel has a depth that is none")
        return e + error, error
