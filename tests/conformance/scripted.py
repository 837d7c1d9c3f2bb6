"""Streams of the range coder with symbols that are told, for files that no encoder makes.

A decoder that is given a script instead of a stream takes its symbols from there, and the script
writes the stream in which another decoder finds them.
"""

from __future__ import annotations

import random
from typing import Iterable

from elementary import bit_length
from range_coder import MASK64, AdaptiveSymbol, RangeDecoder


class TooLong(Exception):
    """A random script does not come to its end."""


class Script(RangeDecoder):
    """Raw bits and parts are told by their values, symbols by their numbers, bits by 0 and 1."""

    def __init__(self, values: Iterable[int]) -> None:
        self.values = list(values)
        self.next, self.low, self.size, self.range = 0, 0, 8, MASK64

    def left(self) -> int:
        return len(self.values) - self.next

    def _value(self, limit: int, odds: float = 0.5) -> int:
        """Which of so many comes; `odds`: how likely a 1 is, if it is a bit. Zeros come behind the
        last value."""
        self.next += 1
        return self.values[self.next - 1] if self.left() >= 0 else 0

    def _take(self, start: int, width: int) -> None:
        self.low, self.range = self.low + start, width
        if self.range < 1 << 32:
            self.low, self.range, self.size = self.low << 32, self.range << 32, self.size + 4

    def part(self, total: int) -> int:
        value, step = self._value(total), self.range // total
        self._take(step * value, step)
        return value

    def symbol(self, model: AdaptiveSymbol) -> int:
        value, step = self._value(len(model.frequencies)), self.range // model.total
        self._take(step * sum(model.frequencies[:value]), step * model.frequencies[value])
        model.learn(value)
        return value

    def bit(self, probability: int) -> int:
        value, bound = self._value(2, probability / 65536), (self.range >> 16) * probability
        self._take(0 if value else bound, bound if value else self.range - bound)
        return value

    def raw(self, bits: int) -> int:
        value, step = self._value(1 << bits) & ((1 << bits) - 1), self.range >> bits
        self._take(step * value, step)
        return value

    def finish(self) -> None:
        pass

    def stream(self) -> bytes:
        """As short as it can be: what was told stands in it, and zeros behind it need not."""
        stream = self.low.to_bytes(self.size, "big")
        return stream[: self.size - 8] + stream[self.size - 8 :].rstrip(b"\0")


class RandomScript(Script):
    """Random symbols behind those that are told."""

    MOST = 20000

    def __init__(self, rng: random.Random, values: Iterable[int] = ()) -> None:
        super().__init__(values)
        self.rng = rng
        self.boldness = rng.choice((0.0, 0.2, 1.0))  # how little is thought of the models' odds

    def _value(self, limit: int, odds: float = 0.5) -> int:
        if self.left() > 0:
            return super()._value(limit, odds)
        self.next += 1
        if self.next > self.MOST:
            raise TooLong
        if limit == 2:
            return int(self.rng.random() < odds + self.boldness * (0.5 - odds))
        return self.rng.randrange(limit)


def number(value: int) -> list[int]:
    """Values for a *number* of section 15 of up to 24 bits."""
    return [bit_length(value), value] if value else [0]


def adaptive_number(value: int) -> list[int]:
    """Values for an *adaptive number* of up to 24 bits below the top one."""
    length = bit_length(value)
    rest = [value & ((1 << (length - 1)) - 1)] if length > 1 else []
    return [1] * length + [0] + rest
