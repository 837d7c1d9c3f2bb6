"""Tiles of method fast with random symbols, for random_streams.py."""

from __future__ import annotations

import random
from unittest.mock import patch

import fast
import fast_slabs
import fast_tree
from draft import varint
from elementary import FormatError, Reader
from fast_entropy import WHOLE, RansDecoder, RawBits, Table
from partition_methods import Kd
from scripted import RandomScript, TooLong

Point = tuple[int, int, int]


class RandomBits(RawBits):
    """Random fields, which it packs."""

    def __init__(self, rng: random.Random):
        super().__init__(b"")
        self.rng, self.ones = rng, rng.choice((0.02, 0.1, 0.5))

    def field(self, bits: int) -> int:
        value = int(self.rng.random() < self.ones) if bits == 1 else self.rng.getrandbits(bits)
        self.value |= value << self.size
        self.size += bits
        if self.size > 1 << 20:
            raise TooLong
        return value

    def finish(self) -> None:
        pass

    def bytes(self) -> bytes:
        return self.value.to_bytes((self.size + 7) // 8, "little")


class RandomRans(RansDecoder):
    """Random symbols, which it codes once all are there."""

    def __init__(self, rng: random.Random, lanes: int):
        self.rng, self.lanes = rng, lanes
        self.states = [self.LOWEST] * lanes  # as many as run() wants
        self.wild = rng.choice((0.0, 0.0, 0.02, 0.3))  # how often symbols are anything
        self.taken: list[tuple[int, int, int]] = []  # lane, start and width of the part

    def symbol(self, table: Table, lane: int = 0) -> int:
        place = self.rng.randrange(WHOLE)
        if self.rng.random() < self.wild:
            present = [i for i, f in enumerate(table.frequencies) if f]
            place = table.ends[self.rng.choice(present)] - 1
        symbol, frequency, rest = table.find(place)
        self.taken.append((lane, place - rest, frequency))
        return symbol

    def finish(self) -> None:
        pass

    def bytes(self) -> bytes:
        states, words = [self.LOWEST] * self.lanes, []
        for lane, start, frequency in reversed(self.taken):
            state = states[lane]
            if state >= frequency << 20:
                words.append(state & 0xFFFF)
                state >>= 16
            states[lane] = state // frequency * WHOLE + start + state % frequency
        return b"".join(s.to_bytes(4, "little") for s in states) + b"".join(
            w.to_bytes(2, "little") for w in reversed(words)
        )


class Recorder:
    """Gives decoders streams of random symbols, and keeps them."""

    def __init__(self, rng: random.Random):
        self.rng, self.made = rng, []

    def _keep(self, stream):
        self.made.append(stream)
        return stream

    def bits(self, _: bytes) -> RandomBits:
        return self._keep(RandomBits(self.rng))

    def rans(self, _: bytes, lanes: int) -> RandomRans:
        return self._keep(RandomRans(self.rng, lanes))

    def coder(self, _: bytes) -> RandomScript:
        return self._keep(RandomScript(self.rng))

    def within(self, module):
        """In that module, decoders get these."""
        names = {"RawBits": self.bits, "RansDecoder": self.rans, "RangeDecoder": self.coder}
        return patch.multiple(module, **{n: f for n, f in names.items() if hasattr(module, n)})

    def contents(self) -> list[bytes]:
        return [s.stream() if isinstance(s, RandomScript) else s.bytes() for s in self.made]


class RandomFast:
    """A tile: its extent, the payloads of its layers, how many points they have, and the points."""

    def __init__(self, rng: random.Random, points: int, layers: int):
        self.rng, self.points, self.layers = rng, points, layers
        bits = rng.choice((3, 8, 12, 20, 27, 32))
        self.extent = [(1 << max(bits - rng.choice((0, 0, 3)), 1)) - 1 - rng.choice((0, 0, 1)) for _ in range(3)]
        self.payloads: list[bytes] = []
        self.counts: list[int] = []

    def _header(self) -> bytes:
        rng = self.rng
        ranked = [k for k in range(3) if self.points > 2 and rng.randrange(6) == 0]
        flags = sum(1 << k for k in ranked) | rng.choice((0, 8)) | rng.choice((0, 0, 16))
        header = bytes([flags]) + (bytes([rng.randrange(1, 17)]) if self.layers > 1 else b"")
        if flags & 8:
            header += bytes(rng.choice((0, 3, 31)) for _ in range(3))
        return header + (self._values(ranked) if ranked else b"")

    def _values(self, ranked: list[int]) -> bytes:
        counts = b"".join(varint(self.rng.randrange(2, self.points + 1)) for _ in ranked)
        recorder = Recorder(self.rng)
        with recorder.within(fast):
            values = fast._values(Reader(counts + b"\0\0"), len(ranked), self.points)
        for k, of_axis in zip(ranked, values):
            if of_axis[-1] >= 1 << 32:
                raise TooLong
            self.extent[k] = of_axis[-1]
        head, steps, bits = recorder.contents()
        section = counts + varint(len(head)) + varint(len(steps)) + head + steps + bits
        return varint(len(section)) + section

    def fill(self) -> list[Point]:
        """The points; throws FormatError if they make no sense, the payloads being there."""
        header = self._header()
        decoder = fast.Fast(self.points, self.extent, 0, self.layers)
        decoder.header = fast.Header(Reader(header), self.layers, self.points, self.extent)
        points: list[Point] = []
        for layer in range(self.layers):
            new = decoder.new_places(layer)
            self.payloads.append(header if layer == 0 else b"")
            self.counts.append(len(decoder.places(layer)))
            if decoder.header.input_order and new:
                script = RandomScript(self.rng)
                try:
                    decoder._in_input_order(script, layer)
                finally:
                    self.payloads[-1] += script.stream()
            elif new:
                points += [decoder._restored(p) for p in self._set(len(new), decoder.header)]
        if decoder.header.input_order:
            points = [decoder._restored(decoder.sequence[p]) for p in range(self.points)]
        return points

    def _set(self, n: int, header: fast.Header) -> list[Point]:
        kind = self.rng.choice((0, 0, 0, 1, 1, 1, 2))
        if kind == 2:
            script = RandomScript(self.rng)
            self.payloads[-1] += b"\2"
            try:
                return Kd(n, header.extent, 0).layer(script, True)[0]
            finally:
                self.payloads[-1] += script.stream()
        levels = self.rng.randrange(7) if kind == 1 else None
        self.payloads[-1] += bytes([kind + 16 * (levels or 0)])
        recorder = Recorder(self.rng)
        try:
            with recorder.within(fast_slabs), recorder.within(fast_tree):
                slabs = fast_slabs.SlabSet(bytes(5), n, header.extent, header.scales, levels)
                return slabs.decode()
        finally:
            contents = recorder.contents() + [b""] * 6  # it may have ended before all are there
            bits, tables, residuals, fields, plane, tree = contents[:6]
            sections = (tables, tree, plane, residuals, fields)
            self.payloads[-1] += b"".join(varint(len(s)) for s in sections) + b"".join(sections) + bits


def tile(rng: random.Random, points: int, layers: int) -> tuple[RandomFast, list[Point] | FormatError]:
    """Most tiles are tried again until they make sense."""
    for _ in range(rng.choice((1, 10, 10))):
        made = RandomFast(rng, points, layers)
        try:
            return made, made.fill()
        except FormatError as error:
            last = error
    return made, last
