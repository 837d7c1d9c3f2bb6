"""Ordered words: the numbers of arrays as unsigned integers (docs/format.md, section 14)."""

from __future__ import annotations

import math
import struct

from elementary import BIT, FLOAT32, SCALAR_TYPES, float32, is_float, value_size

FLOAT32_GREATEST = struct.unpack("<f", b"\xff\xff\x7f\x7f")[0]
FLOAT64_GREATEST = struct.unpack("<d", b"\xff\xff\xff\xff\xff\xff\xef\x7f")[0]


class WordType:
    """How numbers of a scalar type become words of W bits."""

    def __init__(self, scalar_type: int):
        self.scalar_type = scalar_type
        self.size = value_size(scalar_type)
        self.bits = 8 * self.size
        self.mask = (1 << self.bits) - 1
        self.top = 1 << (self.bits - 1)
        self.is_float = is_float(scalar_type)
        name = "bit" if scalar_type == BIT else SCALAR_TYPES[scalar_type][0]
        self.is_signed = name.startswith("int")
        self.zero = self.top if self.is_float or self.is_signed else 0
        self.letters = "<f", "<I"
        self.greatest = FLOAT32_GREATEST
        if scalar_type != FLOAT32:
            self.letters = "<d", "<Q"
            self.greatest = FLOAT64_GREATEST

    def from_bits(self, bits: int) -> int:
        if self.is_float:
            return bits ^ (self.mask if bits & self.top else self.top)
        return bits ^ self.top if self.is_signed else bits

    def to_bits(self, word: int) -> int:
        if self.is_float:
            return word ^ (self.top if word & self.top else self.mask)
        return word ^ self.top if self.is_signed else word

    def signed(self, word: int) -> int:
        word &= self.mask
        return word - (1 << self.bits) if word & self.top else word

    def number(self, word: int) -> float:
        return struct.unpack(self.letters[0], struct.pack(self.letters[1], self.to_bits(word)))[0]

    def word_of(self, number: float) -> int:
        """The word of float(number)."""
        if self.scalar_type == FLOAT32:
            number = float32(number)
        return self.from_bits(struct.unpack(self.letters[1], struct.pack(self.letters[0], number))[0])

    def predicted(self, number: float, instead: int) -> int:
        """The word of float(number), or `instead` if that is no finite number of the type."""
        return self.word_of(number) if abs(number) <= self.greatest else instead

    def words_in(self, data: bytes) -> list[int]:
        size = self.size
        return [
            self.from_bits(int.from_bytes(data[i : i + size], "little"))
            for i in range(0, len(data), size)
        ]

    def bytes_of(self, words: list[int]) -> bytes:
        return b"".join(self.to_bits(w).to_bytes(self.size, "little") for w in words)


class UnitPrediction:
    """Domain unit: the component of greatest size follows from the other two."""

    def __init__(self, means: list[float]):
        last = 0
        for k in (1, 2):
            if abs(means[k]) > abs(means[last]):
                last = k
        self.means = means
        self.order = [k for k in range(3) if k != last] + [last]

    def last_word(self, kind: WordType, a: float, b: float) -> int:
        t = (1 - a * a) - b * b
        root = math.sqrt(t) if t > 0 else 0.0
        return kind.word_of(-root if self.means[self.order[2]] < 0 else root)
