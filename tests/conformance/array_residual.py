"""Method residual of docs/format.md, section 14."""

from __future__ import annotations

import math

from elementary import Reader, require
from neighbours import Predictor, Ranks, size_class
from range_coder import AdaptiveBits, RangeDecoder, stream_of
from sphere import Chart, Sphere
from words import UnitPrediction, WordType

WORDS, NUMBERS, UNIT, SPHERE = range(4)


def quotient(a: int, b: int) -> int:
    """Towards zero."""
    return -(-a // b) if a < 0 else a // b


class Residual:
    def __init__(self, kind: WordType, components: int, ranks: Ranks, known: list[list[int]], sphere: Sphere | None):
        """`known` are the tuples of the known points by rank."""
        self.kind, self.components, self.ranks, self.sphere = kind, components, ranks, sphere
        self.tuples = list(known)
        self.residuals: dict[int, list[int]] = {}  # of new ranks, as coded
        self.bits = AdaptiveBits()

    def decode(self, reader: Reader) -> list[list[int]]:
        """The tuples of all points by rank."""
        flags = reader.u8()
        require(flags < 128, "reserved flags of method residual")
        domain = flags >> 5
        predictor = Predictor(flags & 7, flags >> 3 & 3)
        require(domain not in (NUMBERS, UNIT) or self.kind.is_float, "numbers of integers")
        require(domain != UNIT or self.components == 3, "unit of other than three components")
        require((domain == SPHERE) == (self.sphere is not None) or domain == WORDS, "sphere of no sphere")
        coder = stream_of(reader.rest())
        for rank, near, weights in predictor.weighted(self.ranks):
            self._point(coder, domain, rank, near[: len(weights)], weights)
        coder.finish()
        return self.tuples

    def _point(self, coder: RangeDecoder, domain: int, rank: int, near: list[int], weights: list[float]) -> None:
        order = list(range(self.components))
        words = [0] * self.components
        unit = None
        if domain == UNIT and near:
            unit = UnitPrediction([self._mean(k, near, weights) for k in range(3)])
            order = unit.order
        chart = self._chart(near, weights) if domain == SPHERE else None
        residuals: list[int] = []
        before = (0, 0)
        for i, k in enumerate(order):
            if chart:
                guess = chart.expected[k]
            elif not near:
                guess = self.kind.zero
            elif domain == WORDS:
                guess = self._words(k, near, weights)
            elif unit and i == 2:
                numbers = [self.kind.number(words[order[j]]) for j in range(2)]
                guess = unit.last_word(self.kind, *numbers)
            else:
                guess = self.kind.predicted(self._mean(k, near, weights), self.tuples[near[0]][k])
            expected, residual = self._residual(coder, i, near, residuals, before)
            before = (abs(residual), expected)
            residuals.append(residual)
            words[k] = (guess + residual) & self.kind.mask
        self.tuples.append(list(chart.turned_back(words)) if chart else words)
        self.residuals[rank] = residuals

    def _mean(self, k: int, near: list[int], weights: list[float]) -> float:
        mean = 0.0
        for r, w in zip(near, weights):
            mean += w * self.kind.number(self.tuples[r][k])
        return mean

    def _words(self, k: int, near: list[int], weights: list[float]) -> int:
        nearest, s = self.tuples[near[0]][k], 0.0
        for r, w in zip(near[1:], weights[1:]):
            s += w * float(self.kind.signed(self.tuples[r][k] - nearest))
        return nearest + math.floor(s + 0.5) if abs(s) < 2.0**62 else nearest

    def _chart(self, near: list[int], weights: list[float]) -> Chart:
        sums = [0.0, 0.0, 0.0]
        for r, w in zip(near, weights):
            direction = self.sphere.float32_direction(self.tuples[r])
            for k in range(3):
                sums[k] += w * direction[k]
        return Chart(self.sphere, sums)

    def _residual(
        self, coder: RangeDecoder, i: int, near: list[int], residuals: list[int], before: tuple[int, int]
    ) -> tuple[int, int]:
        """What was expected, and the residual."""
        slot = min(i, 3)
        new = [r for r in near if r in self.residuals]
        expected = 0
        if new:
            total = sum(min(abs(self.residuals[r][i]), 1 << 58) for r in new)
            expected = size_class(2 * total // len(new))
        surprise = 0
        if i > 0:
            size = size_class(2 * before[0] & 0xFFFFFFFFFFFFFFFF)
            surprise = min(max(quotient(size - before[1], 2) + 4, 1), 7)
        first = self.residuals[new[0]][i] if new else 0
        signs = 3 * sign(first) + (sign(residuals[-1]) if residuals else 1)
        bits = self.kind.bits
        node = 1
        for _ in range(bits.bit_length()):
            node = node << 1 | coder.adaptive(self.bits["length", slot, expected, surprise, node])
        length = node - (1 << bits.bit_length())
        require(length <= bits, "a residual is too long")
        if length == 0:
            return expected, 0
        size, told = 1, min(length - 1, 3)
        for _ in range(told):
            size = size << 1 | coder.adaptive(self.bits["size", slot, length, size])
        if length - 1 - told:
            size = size << (length - 1 - told) | coder.wide(length - 1 - told)
        require(size <= 1 << (bits - 1), "a residual is too great")
        require(size <= 1 << (bits - 1), "a residual is beyond half of its range")
        negative = coder.adaptive(self.bits["sign", slot, signs, min(length, 3)])
        return expected, -size if negative else size


def sign(value: int) -> int:
    return 1 + (value > 0) - (value < 0)
