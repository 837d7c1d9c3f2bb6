"""Raw bits, value codes, rANS and tables of method fast (docs/format.md, section 10)."""

from __future__ import annotations

from bisect import bisect_right
from functools import lru_cache
from itertools import accumulate

from elementary import require

SYMBOLS = 128
WHOLE = 2048


def unzigzag(value: int) -> int:
    return value >> 1 if value & 1 == 0 else -(value >> 1) - 1


class RawBits:
    """Fields of bits, the lowest bit first."""

    def __init__(self, data: bytes):
        self.value = int.from_bytes(data, "little")
        self.size = 8 * len(data)
        self.position = 0

    def field(self, bits: int) -> int:
        require(self.position + bits <= self.size, "raw bits end early")
        value = self.value >> self.position & ((1 << bits) - 1)
        self.position += bits
        return value

    def unary(self) -> int:
        """Ones, ended by a zero."""
        ones = 0
        while self.field(1):
            ones += 1
        return ones

    def finish(self) -> None:
        require(self.size - self.position < 8, "raw bits go on after their end")
        require(self.value >> self.position == 0, "raw bits are not filled with zeros")


class ValueCode:
    def __init__(self, direct: int, mantissa: int):
        self.direct, self.mantissa = direct, mantissa

    def value(self, symbol: int, bits: RawBits, shift: int = 0) -> int:
        """The value of a symbol that codes it without its lowest `shift` bits."""
        extra, base = 0, symbol
        if symbol >= self.direct + (1 << self.mantissa):
            quotient, rest = divmod(symbol - self.direct, 1 << self.mantissa)
            extra = quotient - 1
            base = self.direct + ((1 << self.mantissa | rest) << extra)
        require(extra + shift <= 56, "a value of more than 56 raw bits")
        raw = bits.field(extra + shift)
        return (base << shift) + raw


class Table:
    """Frequencies, as the ends of the symbols' parts."""

    def __init__(self, weights: list[int]):
        frequencies = _frequencies(weights)
        self.ends = list(accumulate(frequencies))
        self.frequencies = frequencies

    def find(self, place: int) -> tuple[int, int, int]:
        """The symbol at a place, its frequency, and the place within its part."""
        symbol = bisect_right(self.ends, place)
        frequency = self.frequencies[symbol]
        return symbol, frequency, place - (self.ends[symbol] - frequency)


def _frequencies(weights: list[int]) -> list[int]:
    total = sum(weights)
    if total == 0:
        return [WHOLE] + [0] * (SYMBOLS - 1)
    result = [max((WHOLE * w + total // 2) // total, 1) if w else 0 for w in weights]
    left = WHOLE - sum(result)
    while left:
        greatest = max(result)
        at = result.index(greatest)
        step = min(abs(left), max(greatest // 16, 1))
        result[at] += step if left > 0 else -step
        left += -step if left > 0 else step
    return result


@lru_cache(maxsize=None)
def geometric(direct: int, mean: int) -> Table:
    weights, p = [], 1 << 20
    for _ in range(direct):
        weights.append(p + 8)
        p = p * mean // (mean + 100)
    tail = 4 * p + 2000
    for _ in range(direct, SYMBOLS):
        weights.append(tail // 256 + 2)
        tail = 7 * tail // 10
    return Table(weights)


FIELD_DEFAULT = (12, 560)


def class_default(table: int, tables: int, direct: int) -> tuple[int, int]:
    """The default of table t of T for gaps or residuals."""
    if table == 0:
        return direct, 20
    height = 141 if table % 2 else 100
    return direct, 13 * height * 2 ** min(table // 2, tables // 2 - 2) // 10


def read_table(bits: RawBits, default: tuple[int, int]) -> Table:
    if not bits.field(1):
        return geometric(*default)
    last = bits.field(7)
    weights, length = [], 6
    for _ in range(last + 1):
        length += unzigzag(bits.unary())
        require(0 <= length <= 12, "a weight is too long")
        if length < 2:
            weights.append(length)
            continue
        told = min(length - 1, 2)
        weights.append((1 << told | bits.field(told)) << (length - 1 - told))
    return Table(weights + [0] * (SYMBOLS - len(weights)))


class RansDecoder:
    LOWEST = 1 << 15

    def __init__(self, data: bytes, lanes: int):
        require(len(data) >= 4 * lanes, "an rANS stream ends early")
        require(len(data) % 2 == 0, "an rANS stream has half a word")
        self.data = data
        self.states = [int.from_bytes(data[4 * i : 4 * i + 4], "little") for i in range(lanes)]
        for state in self.states:
            require(self.LOWEST <= state < 1 << 31, "a state of rANS is out of range")
        self.position = 4 * lanes

    def symbol(self, table: Table, lane: int = 0) -> int:
        state = self.states[lane]
        symbol, frequency, rest = table.find(state % WHOLE)
        state = frequency * (state // WHOLE) + rest
        if state < self.LOWEST:
            require(self.position < len(self.data), "an rANS stream ends early")
            word = int.from_bytes(self.data[self.position : self.position + 2], "little")
            self.position += 2
            state = state << 16 | word
        self.states[lane] = state
        return symbol

    def run(self, table: Table, count: int) -> list[int]:
        lanes = len(self.states)
        return [self.symbol(table, i % lanes) for i in range(count)]

    def finish(self) -> None:
        require(all(s == self.LOWEST for s in self.states), "an rANS stream ends in a wrong state")
        require(self.position == len(self.data), "an rANS stream goes on after its end")
