"""Random grids for random_streams.py."""

from __future__ import annotations

import math
import random
import struct
from math import gcd

from draft import svarint, varint

SHARED, WITH_BASES, RATIONAL, AFFINE = 64, 128, 0, 16


def _base(rng: random.Random) -> int:
    return rng.choice((-1, 1)) * rng.choice((0, 5, 1 << 62, rng.getrandbits(rng.randrange(1, 62))))


def _ratio(rng: random.Random) -> bytes:
    while True:
        p, q = (rng.getrandbits(rng.choice((0, 3, 20, 52))) | 1 for _ in range(2))
        if gcd(p, q) == 1:
            break
    room = 62 - max(p.bit_length(), q.bit_length())
    exponent = rng.choice((0, 0, rng.randrange(-room, room + 1)))
    return varint(p) + varint(q) + svarint(exponent)


def _number(rng: random.Random, positive: bool) -> float:
    if not positive and rng.randrange(3) == 0:
        return 0.0
    value = math.ldexp(rng.choice((1.0, 1.5, 1 + rng.random())), rng.choice((0, -3, 30, rng.randrange(-300, 1000))))
    if rng.randrange(3) == 0 and value < 1e38:
        value = struct.unpack("<f", struct.pack("<f", value))[0] or 1.0
    return value if positive or rng.randrange(2) else -value


def _numbers(values: list[float]) -> bytes:
    nibbles, body = [], b""
    for value in values:
        double = struct.pack(">d", value)
        leading = double.rstrip(b"\0")
        narrow = abs(value) < 1e38 and struct.unpack("<f", struct.pack("<f", value))[0] == value
        if narrow and len(leading) > 4:
            nibbles.append(9)
            body += struct.pack("<f", value)
        else:
            nibbles.append(len(leading))
            body += leading[::-1]
    return bytes(low | high << 4 for low, high in zip(nibbles[::2], nibbles[1::2])) + body


def random_grid(rng: random.Random) -> bytes:
    """The record of a grid of rational or affine form, of any scalar type."""
    kind, bases = rng.randrange(10), b""
    if rng.randrange(2):
        kind, bases = kind | WITH_BASES, b"".join(svarint(_base(rng)) for _ in range(3))
    steps = rng.choice((1, 3))
    kind |= SHARED * (steps == 1)
    if rng.randrange(2):
        return bytes([kind | RATIONAL]) + bases + b"".join(_ratio(rng) for _ in range(steps))
    numbers = [_number(rng, False) for _ in range(3)] + [_number(rng, True) for _ in range(steps)]
    return bytes([kind | AFFINE]) + bases + _numbers(numbers)
