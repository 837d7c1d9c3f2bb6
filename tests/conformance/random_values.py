"""Random payloads of arrays and orders for random_streams.py."""

from __future__ import annotations

import math
import random
import struct
from typing import Callable

from arrays import CATEGORIES, MIXING, QUANTISED, RESIDUAL, SPHERE, ArrayPayload, Layer
from container import ArrayDescription
from draft import svarint, varint
from elementary import BIT, FLOAT32, FLOAT64, SCALAR_TYPES, FormatError, Reader, is_float
from neighbours import Point
from orders import decoded_order
from scripted import RandomScript
from tiles import values_as_bytes
from words import WordType
from xxh3 import xxh3


def _payload(rng: random.Random, start: Callable[[], bytes], reading: Callable) -> tuple[bytes, object]:
    """What `reading` takes at random behind some bytes, and what it returns or throws. Most
    payloads are tried again until they make sense."""
    for _ in range(rng.choice((1, 30, 30))):
        told, script = start(), RandomScript(rng)
        try:
            result = reading(Reader(told, tail=script))
            return told + script.stream(), result
        except FormatError as error:
            last = error
    return told + script.stream(), last


def _word(rng: random.Random, bits: int) -> int:
    return rng.getrandbits(rng.choice((bits, bits // 2, 3)))


def _start(rng: random.Random, kind: WordType, components: int, inner: bool = False, sphere: bool = False) -> bytes:
    """What stands in front of the stream of an array."""
    methods = [RESIDUAL, MIXING, CATEGORIES]
    if not inner and is_float(kind.scalar_type):
        methods += [QUANTISED, SPHERE] if components == 3 else [QUANTISED]
    method = rng.choice(methods)
    if method == RESIDUAL:
        domains = [0, 1] if is_float(kind.scalar_type) else [0, 0, 3] if sphere else [0]
        domain = rng.choice(domains + [2] * (is_float(kind.scalar_type) and components == 3))
        return bytes([method, rng.randrange(5) | rng.randrange(4) << 3 | domain << 5])
    if method == MIXING:
        if kind.bits == 8:
            return bytes([method])
        gaps = [rng.randrange(1000) for _ in range(rng.choice((0, 1, 5, 255)))]
        return bytes([method, len(gaps)]) + b"".join(varint(g) for g in [_word(rng, kind.bits // 2), *gaps])
    if method == CATEGORIES:
        words = b"".join(_word(rng, kind.bits).to_bytes(kind.size, "little") for _ in range(rng.randrange(9)))
        flags = rng.choice((0, 1, 3)) | (4 if not words else rng.choice((0, 4)))
        return bytes([method, flags, len(words) // kind.size]) + words
    if method == QUANTISED:
        step = math.ldexp(rng.random() + 0.5, rng.choice((0, -3, 40, -1000)))
        base = rng.randrange(-(1 << 52), 1 << 52) >> rng.choice((0, 45))
        size = rng.choice((1, 2, 4, 8))
        within = WordType({1: 3, 2: 5, 4: 7, 8: 9}[size])
        return (
            bytes([method]) + struct.pack("<d", step) + svarint(base) + bytes([size, 0])
            + _start(rng, within, components, inner=True)
        )  # fmt: skip
    size = rng.choice((1, 127, 128, rng.randrange(1, 1 << 23)))
    within = WordType(3 if 2 * size <= 255 else 5 if 2 * size <= 65535 else 7)
    return bytes([method]) + varint(size) + b"\0" + _start(rng, within, 2, inner=True, sphere=True)


class RandomValues:
    """The order of a tile's points, and an array beside them."""

    def __init__(self, rng: random.Random):
        self.rng = rng
        self.order_kind = rng.randrange(3)
        scalar_type = rng.choice((*SCALAR_TYPES, FLOAT32, FLOAT64, BIT))
        self.array = ArrayDescription(b"a", scalar_type, rng.choice((1, 2, 3, 3, 5)))
        self.order_payload, self.payload, self.content = b"", b"", 0

    def fill(self, points: list[Point]) -> None:
        """Throws FormatError if the payloads, which are there then, make no sense."""
        rng, array, order = self.rng, self.array, None
        if self.order_kind == 1:

            def start() -> bytes:
                return rng.choice((b"\1", bytes([2, rng.randrange(3) | rng.randrange(1, 5) << 2])))

            self.order_payload, order = _payload(rng, start, lambda reader: decoded_order(reader, points))
        elif self.order_kind == 2:
            order = list(range(len(points)))
        if isinstance(order, FormatError):
            raise order
        coder = ArrayPayload(Layer(points, 0, order), array.scalar_type, array.components)
        self.payload, tuples = _payload(
            rng,
            lambda: _start(rng, WordType(array.scalar_type), array.components),
            lambda reader: coder.decode(reader, []),
        )
        if isinstance(tuples, FormatError):
            raise tuples
        self.content = xxh3(values_as_bytes(array, tuples))

    def table(self) -> bytes:
        """The record of the head."""
        return b"\1\1a" + bytes([self.array.scalar_type]) + varint(self.array.components)

    def fields(self, points: int) -> bytes:
        """Those of the tile's record about arrays."""
        stored = self.order_kind == 1
        out = bytes([self.order_kind]) + (varint(len(self.order_payload)) if stored else b"")
        width = self.array.content_width(points)
        out += (self.content % (1 << 8 * width)).to_bytes(width, "little")
        return out + varint(2 * len(self.payload) + 1 if stored else len(self.payload))

    def payloads(self) -> list[bytes]:
        return ([self.order_payload] if self.order_kind == 1 else []) + [self.payload]
