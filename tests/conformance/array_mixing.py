"""Methods mixing and categories of docs/format.md, section 14."""

from __future__ import annotations

import math
from bisect import bisect_left

from elementary import Reader, require
from mixed_bits import MixedBits
from neighbours import MEAN8, Predictor, Ranks, size_class
from range_coder import RangeDecoder, stream_of
from words import WordType

MASK = 0xFFFFFFFF


def limited(x: int, most: int) -> int:
    """x limited to ± most, plus most."""
    return min(max(x, -most), most) + most


class Slot:
    """How the error of a component follows from that of the one before."""

    def __init__(self) -> None:
        self.products, self.squares, self.slope = 0.0, 1.0, 0.0

    def learn(self, error: float, before: float) -> None:
        self.products = self.products * 0.9995 + error * before
        self.squares = self.squares * 0.9995 + before * before
        self.slope = self.products / (self.squares + 1)


class Mixing:
    def __init__(self, kind: WordType, components: int, ranks: Ranks, known: list[list[int]]):
        self.kind, self.components, self.ranks = kind, components, ranks
        self.known = known
        self.slots = [Slot() for _ in range(4)]
        self.misses: dict[int, list[int]] = {}
        new = len(ranks.order) - ranks.known
        self.table_bits = min(max((new * components).bit_length() + 1, 8), 14)
        self.bits = MixedBits(7, 15603)

    def decode(self, reader: Reader) -> list[list[int]]:
        """The tuples of all points by rank."""
        words = list(range(256))
        if self.kind.bits > 8:
            words = self._value_list(reader)
        self.tuples = [[min(bisect_left(words, w), len(words) - 1) for w in t] for t in self.known]
        self.values = len(words)
        coder = stream_of(reader.rest())
        for rank, near, weights in Predictor(MEAN8).weighted(self.ranks):
            self._point(coder, rank, near, weights)
        coder.finish()
        new = [[words[v] for v in t] for t in self.tuples[self.ranks.known :]]
        return self.known + new

    def _value_list(self, reader: Reader) -> list[int]:
        count = reader.u8()
        words = [reader.varint()]
        for _ in range(count):
            words.append(words[-1] + 1 + reader.varint())
        require(words[-1] <= self.kind.mask, "a word has more bits than its type")
        return words

    def _point(self, coder: RangeDecoder, rank: int, near: list[int], weights: list[float]) -> None:
        values: list[int] = []
        misses: list[int] = []
        before = 0.0
        for c in range(self.components):
            slot = min(c, 3)
            n = [self.tuples[r][c] for r in near]
            mean = 0.0
            for w, v in zip(weights, n):
                mean += w * v
            corrected = mean + self.slots[slot].slope * before if c else mean
            guess = min(max(math.floor(corrected + 0.5), 0), 255)
            contexts = self._contexts(c, n, near, values, guess)
            first = n[0] if n else 0
            value = self._value(coder, slot, contexts, first)
            require(value < self.values, "a value beyond the list")
            error = value - mean
            if c:
                self.slots[slot].learn(error, before)
            before = float(math.floor(error + 0.5))
            values.append(value)
            misses.append(abs(value - guess))
        self.tuples.append(values)
        self.misses[rank] = misses

    def _contexts(self, c: int, n: list[int], near: list[int], values: list[int], guess: int) -> list[int]:
        first = n[:3] + [n[-1] if n else 0] * max(0, 3 - len(n))
        ahead, second, third = guess - first[0], first[1] - first[0], first[2] - first[0]
        last = step1 = step2 = 0
        if c > 0:
            last = values[c - 1]
            step1 = last - (self.tuples[near[0]][c - 1] if near else 0)
        if c > 1:
            step2 = values[c - 2] - (self.tuples[near[0]][c - 2] if near else 0)
        new = [self.misses[r][c] for r in near if r in self.misses]
        miss = min(15, size_class(2 * sum(new) // len(new))) if new else 0
        spread = min(15, size_class(max(n) - min(n))) if n else 0
        contexts = [
            256 * first[0] + last,
            64 * limited(step1, 31) + limited(step2, 31),
            16 * (32 * limited(step1, 15) + limited(second, 15)) + limited(ahead, 7),
            16 * limited(ahead, 31) + miss,
            64 * limited(step1, 31) + limited(ahead, 31),
            64 * limited(second, 31) + limited(third, 31),
            16 * first[0] + spread,
        ]
        return [_context_hash(v, min(c, 3), k) for k, v in enumerate(contexts)]

    def _bit(self, coder: RangeDecoder, slot: int, contexts: list[int], node: int) -> int:
        groups = 1 << self.table_bits
        places = [16 * ((h + 0x9E5 * (node // 16)) % groups) + node % 16 for h in contexts]
        return self.bits.decode(coder, (slot, node), places)

    def _value(self, coder: RangeDecoder, slot: int, contexts: list[int], first: int) -> int:
        length = 0
        while length < 8 and not self._bit(coder, slot, contexts, length):
            length += 1
        z = 1 if length else 0
        for b in reversed(range(length - 1)):
            node = 8 + 16 * length + z if b + 4 >= length else 152 + 8 * length + b
            z = z << 1 | self._bit(coder, slot, contexts, node)
        difference = z // 2 if z % 2 == 0 else 255 - z // 2
        return (first + difference) % 256


def _context_hash(v: int, slot: int, k: int) -> int:
    h = ((4 * v + slot + 1) * 0x9E3779B1 + k * 0x85EBCA6B) & MASK
    h = (h ^ h >> 15) * 0x2C1B3C6D & MASK
    return h >> 16


def _mix(v: int) -> int:
    v = (v ^ v >> 15) * 0x2C1B3C6D & MASK
    return v ^ v >> 13


class Categories:
    def __init__(self, kind: WordType, components: int, ranks: Ranks, known: list[list[int]]):
        self.kind, self.components, self.ranks, self.known = kind, components, ranks, known
        self.new = len(ranks.order) - ranks.known
        self.table_bits = min(max((self.new * components).bit_length() + 3, 10), 18)
        self.bits = MixedBits(3, 22000)

    def decode(self, reader: Reader) -> tuple[bool, list[list[int]]]:
        """Whether in the order of the input, and the new tuples: in that order or by rank."""
        flags = reader.u8()
        require(flags < 8 and flags & 3 != 2, "reserved flags of method categories")
        in_order, differences, self.escapes = flags & 1, flags & 2, flags >> 2
        count = reader.u8()
        self.words = [reader.unsigned(self.kind.size) for _ in range(count)]
        self.symbols = count + self.escapes
        require(self.symbols >= 1, "no symbols")
        self.coder = stream_of(reader.rest())
        tuples = self._in_input_order() if in_order else self._by_rank()
        self.coder.finish()
        if differences:
            for before, after in zip(tuples, tuples[1:]):
                for c in range(self.components):
                    after[c] = (after[c] + before[c]) & self.kind.mask
        return bool(in_order), tuples

    def _in_input_order(self) -> list[list[int]]:
        tuples, symbols = [], []
        for t in range(self.new):
            near = [symbols[t - i] for i in (1, 2, 3) if t >= i]
            told, words = self._tuple(near)
            symbols.append(told)
            tuples.append(words)
        return tuples

    def _by_rank(self) -> list[list[int]]:
        number: dict[int, int] = {}
        for i, w in enumerate(self.words):
            number.setdefault(w, i)
        symbols = [[number.get(w, len(self.words)) for w in t] for t in self.known]
        tuples = []
        for _, near in self.ranks.neighbours(8, 3):
            told, words = self._tuple([symbols[r] for r in near[:3]])
            symbols.append(told)
            tuples.append(words)
        return tuples

    def _tuple(self, near: list[list[int]]) -> tuple[list[int], list[int]]:
        told, words = [], []
        for c in range(self.components):
            s = [n[c] for n in near]
            s += [s[-1] if s else 0] * (3 - len(s))
            symbol = self._symbol(min(c, 3), s)
            told.append(symbol)
            escaped = symbol == len(self.words)
            words.append(self.coder.wide(self.kind.bits) if escaped else self.words[symbol])
        return told, words

    def _symbol(self, slot: int, s: list[int]) -> int:
        one = 256 * slot + s[0]
        mixture = s[0] * 0x9E3779B1 ^ s[1] * 0x85EBCA6B ^ s[2] * 0xC2B2AE35 ^ slot * 0x27D4EB2F
        contexts = [_mix(one), _mix(256 * one + s[1] + (1 << 30) & MASK), _mix(mixture & MASK)]
        equal = (s[0] == s[1]) + 2 * (s[0] == s[2])
        node = 1
        bits = (self.symbols - 1).bit_length()
        for _ in range(bits):
            places = [
                ((c + node * 0x9E3779B1) * 0x85EBCA6B & MASK) >> (32 - self.table_bits) for c in contexts
            ]
            node = node << 1 | self.bits.decode(self.coder, (slot, equal, node), places)
        symbol = node - (1 << bits)
        require(symbol < self.symbols, "a symbol beyond the last")
        return symbol
