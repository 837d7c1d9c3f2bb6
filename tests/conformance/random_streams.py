"""Streams of random symbols, which no encoder would write, as both decoders read them.

    CONTENT_OF=build/dev/bin/content_of \\
      python3 tests/conformance/random_streams.py [--seconds S] [--first SEED] [--count N]

The second decoder takes its symbols at random and writes down in which stream they stand. What it
then has, points or an error, the library must find in that stream too. This reaches what files of
an encoder hardly have: odd parameters, boxes that are not tight, numbers at their limits.
"""

from __future__ import annotations

import os
import random
import struct
import subprocess
import sys
import tempfile

import random_fast
import seed_runs
from bsp import Bsp
from content import Content, checksum_of_cells
from draft import block, text, varint, with_checksum
from elementary import FormatError, Reader
from grid import Grid
from mesh_cells import decode_cells
from partition_methods import Kd, Occupancy
from predictive import Predictive
from random_grids import random_grid
from random_values import RandomValues
from scripted import RandomScript, TooLong, number
from surface import Surface
from surface_places import Places
from xxh3 import checksum, checksum_width

SIGNATURE = bytes.fromhex("8B425350 0D0A1A0A 0100")


class Stream:
    """A tile of one method, with random streams for its layers."""

    def __init__(self, seed: int):
        rng = self.rng = random.Random(seed)
        self.method = rng.choice((1, 2, 2, 3, 4, 5, 6, 6, 7, 7))
        most_bits = 21 if self.method in (3, 4, 5) else 32
        most_points = {3: 60, 6: 40, 7: 30}.get(self.method, 300)
        self.layers = rng.choice((1, 1, 2, 4))
        self.points = rng.choice((1, 2, 3, rng.randrange(1, most_points)))
        bits = [rng.randrange(most_bits + 1) for _ in range(3)]
        if rng.randrange(2):
            bits = [max(bits)] * 3
        self.extent = [rng.randrange(1 << b) for b in bits]
        self.grid = random_grid(rng)
        self.version = rng.randrange(2) if self.method == 1 else 0
        self.payloads: list[bytes] = []
        self.counts: list[int] = []
        self.content = b""
        self.faces: list | None = None
        self.cells: tuple | None = None
        self.mesh = b""
        self.values: RandomValues | None = None

    def _decoder(self):
        arguments = (self.points, self.extent, self.version)
        if self.method in (4, 5):
            return Occupancy(*arguments, self.method == 4)
        return {1: Kd, 3: Bsp, 6: Predictive}[self.method](*arguments)

    def _start(self) -> list[int]:
        """Values in front of the stream, so that it makes sense."""
        rng = self.rng
        if self.method == 6:
            if rng.randrange(3):
                return [rng.randrange(5, 10)]
            features = [rng.randrange(256), rng.randrange(256)]
            return [15, *features, rng.randrange(1, 9), rng.randrange(1, 25), rng.choice((4, 20, 255)), rng.randrange(3)]
        return []

    def fill(self) -> None:
        """Throws FormatError if a symbol makes no sense; the stream up to there is filled in."""
        ways = {2: self._fast, 7: self._surface}
        result = ways.get(self.method, self._layers)()
        if len(result) != self.points or any(x > e for p in result for x, e in zip(p, self.extent)):
            raise FormatError("other points than told")
        self.content = b"".join(struct.pack("<3I", *p) for p in result)
        if self.rng.randrange(3) == 0:
            self.values = RandomValues(self.rng)
            self.values.fill(result)
        elif self.rng.randrange(2):
            self._add_cells(result)

    def _fast(self) -> list:
        made, result = random_fast.tile(self.rng, self.points, self.layers)
        self.payloads, self.counts, self.extent = made.payloads, made.counts, made.extent
        if isinstance(result, FormatError):
            raise result
        return result

    def _layers(self) -> list:
        decoder, result = self._decoder(), []
        for layer in range(self.layers):
            script = RandomScript(self.rng, () if layer else self._start())
            try:
                result, _ = decoder.layer(script, layer == self.layers - 1)
            finally:
                self.payloads.append(script.stream())
            self.counts.append(len(result))
        return result

    def _surface(self) -> list:
        """Coarse layers are empty; most surfaces are tried again until they make sense."""
        self.payloads, self.counts = [b""] * (self.layers - 1), [1] * (self.layers - 1)
        for tries in reversed(range(self.rng.choice((1, 20, 20)))):
            faces = self.rng.randrange(1, 2 * self.points + 2)
            script = RandomScript(self.rng, [*number(faces), self.rng.randrange(2), 1, 1])
            try:
                surface = Surface(script, self.points + 2)
                break
            except FormatError:
                if tries == 0:
                    self.payloads.append(script.stream())
                    raise
        self.faces = surface.front.faces
        self.points = surface.vertices + self.rng.choice((0, 0, 0, 1))
        try:
            return Places(script, self.faces, surface.vertices, self.points, self.extent).decode()
        finally:
            self.payloads.append(script.stream())

    def _add_cells(self, points: list) -> None:
        """A Mesh block over the points."""
        rng, grid, surface = self.rng, Grid(Reader(self.grid)), self.faces
        version = 1 if surface and rng.randrange(4) else 0
        start = [version, *number(rng.randrange(3)), *number(rng.randrange(4)), rng.randrange(2), rng.randrange(2)]
        if start[-2]:
            start += number(rng.randrange(4)) if version else number(rng.randrange(9)) + number(rng.randrange(3))
        script = RandomScript(rng, start)
        self.cells = ([], [], [])
        try:
            self.cells = decode_cells(script, points, grid, surface)
        finally:
            payload = script.stream()
            counts = b"".join(varint(len(c)) for c in self.cells)
            width = checksum_width(16 * sum(len(c) for c in self.cells))
            content = checksum_of_cells(self.cells).to_bytes(width, "little")
            self.mesh = b"\0\1" + counts + content + text(payload)

    def file(self) -> bytes:
        """A progressive file of the tile."""
        lengths = [max(1, (e.bit_length() + 7) // 8) for e in self.extent]
        record = bytes([sum((l - 1) << 2 * k for k, l in enumerate(lengths))])
        record += varint(self.method << 4 | self.version) + varint(self.points)
        record += b"".join(e.to_bytes(l, "little") for e, l in zip(self.extent, lengths))
        payloads = self.payloads + [b""] * (self.layers - len(self.payloads))
        counts = self.counts + [self.points] * (self.layers - len(self.counts))
        record += b"".join(varint(c) + varint((1 << 32) - 1) for c in counts[:-1])
        width = checksum_width(12 * self.points)
        record += checksum(self.content, 12 * self.points).to_bytes(width, "little")
        record += b"".join(varint(len(p)) for p in payloads)
        flags, records = self.layers - 1, b""
        if self.values is not None:
            record += self.values.fields(self.points)
            payloads += self.values.payloads()
            flags, records = flags | 64, b"\1\1" + text(self.values.table())
        if self.cells is not None:
            told = b"".join(varint(len(c)) for c in self.cells) + b"\1\0"
            flags, records = flags | 64, b"\1\3" + text(told)
        head = block(1, bytes([flags]) + self.grid + records + b"\1" + record, SIGNATURE)
        chunks = b"".join(with_checksum(p) for p in payloads)
        return SIGNATURE + head + chunks + (block(5, self.mesh) if self.cells is not None else b"")


def made(seed: int) -> tuple[bytes, str] | None:
    """A file, and "good" or the kind of error that it has; None if it does not come to an end."""
    stream = Stream(seed)
    try:
        stream.fill()
        return stream.file(), "good"
    except FormatError as error:
        return stream.file(), error.kind
    except TooLong:
        return None


class Comparison:
    def __init__(self, content_of: str, folder: str):
        self.path = os.path.join(folder, "stream.bspc")
        self.content_of = content_of
        self._start()

    def _start(self) -> None:
        pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE}
        self.library = subprocess.Popen([self.content_of], text=True, **pipes)

    def close(self) -> None:
        self.library.stdin.close()
        self.library.wait()
        self.library.stdout.close()

    def outcome(self, seed: int) -> tuple[str, str]:
        """"same points", "same error", "too long" or "different", and what was found."""
        result = made(seed)
        if result is None:
            return "too long", ""
        data, wanted = result
        try:
            second = ["good", Content(data).hash()]
        except FormatError as error:
            second = ["bad", error.kind]
        with open(self.path, "wb") as stream:
            stream.write(data)
        self.library.stdin.write(self.path + "\n")
        self.library.stdin.flush()
        library = self.library.stdout.readline().strip().split("\t")[1:]
        if not library:
            self.close()
            self._start()
            return "different", "the library ended"
        # The decoder that made the stream must find in it what it took, as the library must.
        if second != library[:2] or (second[0] if second[0] == "good" else second[1]) != wanted:
            return "different", f"made as {wanted}; library {library}; second decoder {second}"
        return "same points" if wanted == "good" else "same error", ""


def main() -> int:
    arguments = seed_runs.parser_of(__doc__).parse_args()
    with tempfile.TemporaryDirectory() as folder:
        comparison = Comparison(os.environ["CONTENT_OF"], folder)
        outcomes = seed_runs.run(arguments, comparison.outcome)
        if arguments.keep:
            os.replace(comparison.path, arguments.keep)
        comparison.close()
    return 1 if outcomes["different"] or outcomes["same points"] < outcomes["too long"] else 0


if __name__ == "__main__":
    sys.exit(main())
