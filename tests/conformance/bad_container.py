"""Bad files: one rule each of docs/format.md, sections 1 to 7, is broken; checksums are right."""

from __future__ import annotations

import struct
from typing import Callable, Iterator

from container import END, INDEX
from draft import Draft, block, svarint, text, varint, zstd_frame

BadFile = tuple[str, str, bytes]  # what is wrong, kind of error, the file
CORRUPT, UNSUPPORTED, TRUNCATED, NOT_BSPC = "corrupt", "unsupported", "truncated", "not a .bspc file"
LATER_OPTIONAL, LATER_REQUIRED = 200, 100
RATIONAL, AFFINE, FLOAT_BITS = 0, 16, 32
SHARED, WITH_BASES = 64, 128


class Cases:
    """Drafts of a good file, each changed in one way."""

    def __init__(self, good: bytes):
        self.good = good
        self.files: list[BadFile] = []

    def add(self, what: str, change: Callable[[Draft], object], kind: str = CORRUPT) -> None:
        draft = Draft(self.good)
        change(draft)
        self.files.append((what, kind, draft.bytes()))

    def set(self, what: str, kind: str = CORRUPT, tile: int | None = None, **fields) -> None:
        def change(draft: Draft) -> None:
            for name, value in fields.items():
                setattr(draft if tile is None else draft.tiles[tile], name, value)

        self.add(what, change, kind)

    def tile(self, what: str, kind: str = CORRUPT, **fields: bytes) -> None:
        """Fields of the first tile's record, as bytes."""
        self.add(what, lambda draft: draft.tiles[0].overrides.update(fields), kind)


def file_rules(good: bytes) -> Iterator[BadFile]:
    """Section 2, of a progressive file."""
    cases = Cases(good)
    cases.set("a signature that lost its top bit", NOT_BSPC, signature=b"\x0bBSP\r\n\x1a\n")
    cases.set("a signature with changed line ends", NOT_BSPC, signature=b"\x8bBSP\n\x1a\n\n")
    cases.set("an unknown major version", UNSUPPORTED, version=b"\x63\0")
    cases.set("a draft of before version 1.0", UNSUPPORTED, version=b"\0\1")
    cases.set("bytes behind the end", tail=b"\0")
    cases.set("trailing blocks without an End block", TRUNCATED, flags=Draft(good).flags | 128)
    cases.set("streaming and trailing blocks", flags=Draft(good).flags | 160)
    cases.set("a block of no content behind the chunks", tail=block(LATER_OPTIONAL, b""))

    def trailing(*blocks: tuple[int, bytes]) -> Callable[[Draft], None]:
        def change(draft: Draft) -> None:
            draft.flags |= 128
            draft.trailing = list(blocks)

        return change

    cases.add("a required block that is unknown", trailing((LATER_REQUIRED, b""), (END, bytes(8))), UNSUPPORTED)
    cases.add("an Index block in the progressive layout", trailing((INDEX, b"\0"), (END, bytes(8))))
    cases.add("an End block that is short", trailing((END, bytes(7))))
    cases.add("an End block with an offset in the progressive layout", trailing((END, b"\1" + bytes(7))))
    yield from cases.files
    yield "an empty file", NOT_BSPC, b""
    yield "seven bytes of another file", NOT_BSPC, b"ply\nfor"
    for size in (1, 7, 8, 9, 10, 11, 30, len(good) - 1):
        yield f"a file that ends after {size} bytes", TRUNCATED, good[:size]
    damaged = bytearray(good)
    damaged[14] ^= 1
    yield "a damaged head", CORRUPT, bytes(damaged)
    damaged = bytearray(good)
    damaged[9] ^= 1
    yield "a damaged minor version, which the head's checksum covers", CORRUPT, bytes(damaged)
    damaged = bytearray(good)
    damaged[-1] ^= 1
    yield "a damaged chunk", CORRUPT, bytes(damaged)


def streaming_rules(good: bytes) -> Iterator[BadFile]:
    """Section 2, of a streaming file of two tiles or more."""
    cases = Cases(good)
    first = Draft(good)
    cases.set("an index of other tiles", index=varint(1) + first.tiles[0].record())
    other = varint(len(first.tiles)) + b"".join(t.record() for t in reversed(first.tiles))
    cases.set("an index of tiles in another order", index=other)
    whole = varint(len(first.tiles)) + b"".join(t.record() for t in first.tiles)
    cases.set("an index that goes on", index=whole + b"\0")
    cases.set("an End block that leads elsewhere", index_offset=struct.pack("<Q", 12))
    cases.set("an End block that leads beyond the file", index_offset=struct.pack("<Q", 1 << 63))
    # What does not end with an End block may have been cut short.
    cases.set("an End block that is short", TRUNCATED, index_offset=bytes(7))
    cases.set("bytes behind the End block", TRUNCATED, tail=b"\0")
    cases.set("a required block that is unknown", UNSUPPORTED, before_index=[(LATER_REQUIRED, b"")])
    cases.set("a head that goes on", head_tail=b"\0")
    cases.set("an optional block between tiles", behind_first=[(LATER_OPTIONAL, b"")])
    cases.tile("chunks that reach into the index", sizes=varint(1 << 20))
    yield from cases.files
    yield "a streaming file without its End block", TRUNCATED, good[:-14]


def head_rules(good: bytes) -> Iterator[BadFile]:
    """Section 3, of a progressive file without records."""
    cases = Cases(good)

    def records(*records: tuple[int, bytes], count: bytes | None = None) -> Callable[[Draft], None]:
        def change(draft: Draft) -> None:
            draft.flags |= 64
            draft.records = list(records)
            draft.record_count = count

        return change

    optional = (LATER_OPTIONAL, b"anything")
    cases.set("a head that goes on behind its tiles", head_tail=b"\0")
    cases.add("an empty list of records", records())
    cases.add("a number of records that is not in its shortest form", records(optional, count=b"\x81\0"))
    cases.add("a number of records of more than 64 bits", records(optional, count=b"\x80" * 9 + b"\2"))
    cases.add("a number of eleven bytes", records(optional, count=b"\x80" * 10 + b"\1"))
    cases.add("more records than there are", records(optional, count=b"\2"))
    cases.add("a record twice", records(optional, optional))
    cases.add("records that are not in order", records(optional, (128, bytes(6))))
    cases.add("a required record that is unknown", records((LATER_REQUIRED, b"")), UNSUPPORTED)
    cases.add("a kept order with content", records((2, b"\0")))
    cases.add("a kept order that no tile knows", _with_array_fields(records((2, b"")), b"\0"))
    for what, content, kind in _metadata():
        cases.add(what, records((128, content)), kind)
    yield from cases.files
    for what, table, kind in _array_tables():
        cases = Cases(good)
        cases.add(what, records((1, table)), kind)
        yield from cases.files


def _with_array_fields(change: Callable[[Draft], None], fields: bytes) -> Callable[[Draft], None]:
    def changed(draft: Draft) -> None:
        change(draft)
        for tile in draft.tiles:
            tile.with_arrays = True
            tile.overrides.update(array_flags=fields, order_size=b"", arrays=b"")

    return changed


def _metadata() -> Iterator[tuple[str, bytes, str]]:
    yield "metadata without their form", b"", CORRUPT
    yield "metadata in an unknown form", b"\2" + bytes(4), CORRUPT
    yield "metadata that end early", b"\0" + bytes(3), CORRUPT
    yield "metadata that go on", b"\0" + bytes(5), CORRUPT
    yield "metadata in a zstd frame that is none", b"\1" + bytes(12), CORRUPT
    for what, frame in (
        ("two frames", zstd_frame(bytes(3)) + zstd_frame(bytes(2))),
        ("a skippable frame", b"\x50\x2a\x4d\x18\5\0\0\0" + bytes(5)),
        ("a skippable frame before a frame", b"\x50\x2a\x4d\x18\0\0\0\0" + zstd_frame(bytes(5))),
        ("a frame of a window above 2^23", zstd_frame(bytes(5), window=0x69)),
        ("a frame with a dictionary", zstd_frame(bytes(1) + zstd_frame(bytes(5))[6:], descriptor=1)),
    ):
        yield f"metadata in {what}", b"\1" + frame, CORRUPT
    twice = (text(b"key") + text(b"value")) * 2
    yield "two entries with one key", b"\0\0\0\2" + twice + b"\0", CORRUPT
    array = text(b"field") + b"\x0a\1\1"
    yield "a bit of field data that is neither 0 nor 1", b"\0\0\0\0\1" + array + b"\2", CORRUPT
    yield "field data that end early", b"\0\0\0\0\1" + text(b"field") + b"\3\1\5" + bytes(4), CORRUPT
    yield "two arrays of field data with one name", b"\0\0\0\0\2" + (array + b"\0") * 2, CORRUPT


def _array_tables() -> Iterator[tuple[str, bytes, str]]:
    yield "an array without a name", b"\1\0\0\1", CORRUPT
    yield "two arrays with one name", b"\2" + (text(b"a") + b"\0\1") * 2, CORRUPT
    yield "an array of an unknown type", b"\1" + text(b"a") + b"\x0c\1", UNSUPPORTED
    yield "an array without components", b"\1" + text(b"a") + b"\0\0", CORRUPT
    yield "an array of 65,537 components", b"\1" + text(b"a") + b"\0" + varint(65537), CORRUPT
    yield "more arrays than there are", b"\2" + text(b"a") + b"\0\1", CORRUPT
    yield "an array table that goes on", b"\1" + text(b"a") + b"\0\1\0", CORRUPT
    for number in (0.0, -1.0, float("inf"), float("nan")):
        tolerance = struct.pack("<d", number)
        yield f"a tolerance of {number}", b"\1" + text(b"a") + b"\x80\1" + tolerance, CORRUPT


def grid_rules(good: bytes) -> Iterator[BadFile]:
    """Section 4, of a progressive file."""
    cases = Cases(good)

    def rational(p: int, q: int, e: int) -> bytes:
        return bytes([RATIONAL | SHARED]) + varint(p) + varint(q) + svarint(e)

    one = b"\1\1\0"
    for kind in range(10, 16):
        cases.set(f"coordinates of type {kind}", UNSUPPORTED, grid=bytes([kind | SHARED]) + one)
    cases.set("a grid of form 3", UNSUPPORTED, grid=bytes([48 | SHARED]) + one)
    large = svarint((1 << 62) + 1)
    cases.set("a base above 2^62", grid=bytes([SHARED | WITH_BASES]) + large + b"\0\0" + one)
    cases.set("a base below -2^62", grid=bytes([SHARED | WITH_BASES]) + b"\0" + svarint(-(1 << 62) - 1) + b"\0" + one)
    cases.set("an odd part that is even", grid=rational(2, 1, 0))
    cases.set("an odd part that is 0", grid=rational(1, 0, 0))
    cases.set("a step that is not in lowest terms", grid=rational(9, 3, 0))
    cases.set("an odd part of 54 bits", grid=rational((1 << 53) + 1, 1, 0))
    cases.set("a numerator above 2^62", grid=rational(3, 1, 61))
    cases.set("a denominator above 2^62", grid=rational(1, 1, -63))
    cases.set("an exponent of 2^40", grid=rational(1, 1, 1 << 40))
    nan, infinity = struct.pack("<d", float("nan"))[6:], struct.pack("<d", float("inf"))[6:]
    for what, codes, numbers in (
        ("an origin of an unknown encoding", b"\x0a\x20", b"\xf0\x3f"),
        ("an origin that is infinite", b"\x02\x20", infinity + b"\xf0\x3f"),
        ("an origin that is no number", b"\x02\x20", nan + b"\xf0\x3f"),
        ("a step of 0", b"\0\0", b""),
        ("a negative step", b"\0\x20", b"\xf0\xbf"),
        ("an infinite step", b"\0\x20", infinity),
    ):
        cases.set(what, grid=bytes([1 | AFFINE | SHARED]) + codes + numbers)
    cases.set("float bits of integers", grid=bytes([6 | FLOAT_BITS]))
    cases.set("float bits with a step", grid=bytes([FLOAT_BITS | SHARED]))
    cases.set("float bits with a negative base", grid=bytes([FLOAT_BITS | WITH_BASES]) + svarint(-1) * 3)
    cases.set("float bits with a base of 2^32", grid=bytes([FLOAT_BITS | WITH_BASES]) + svarint(1 << 32) * 3)
    cases.set("float bits of numbers that are not finite", grid=bytes([FLOAT_BITS]))
    cases.set("float bits beyond the last number", grid=bytes([FLOAT_BITS | WITH_BASES]) + svarint((1 << 32) - 1) * 3)
    yield from cases.files


def tile_rules(good: bytes) -> Iterator[BadFile]:
    """Section 5, of a progressive file of one tile and two layers without arrays."""
    cases = Cases(good)
    first = Draft(good).tiles[0]
    flags, n = first.flags[0], 0
    cases.tile("a tile without points", points=varint(n))
    cases.tile("an unknown method", UNSUPPORTED, coder=varint(100 << 4))
    cases.tile("method 0", UNSUPPORTED, coder=varint(0))
    cases.tile("an unknown version of a method", UNSUPPORTED, coder=varint(1 << 4 | 9))
    cases.tile("a coder of 2^32", coder=varint(1 << 32))
    cases.tile("a lower corner of zeros", flags=bytes([flags | 64]), lower=bytes(3))
    cases.tile("an extent of zeros in two bytes", flags=b"\x15", extent=bytes(6))
    far = varint((1 << 32) - 1)
    cases.tile("a box that leaves the grid", flags=bytes([flags | 64]), lower=far * 3)
    cases.tile("a lower corner above 32 bits", flags=bytes([flags | 64]), lower=varint(1 << 32) * 3)
    cases.tile("a tile that lacks no layer", flags=bytes([flags | 128]), lacking=b"\0")
    cases.tile("a tile that lacks all layers", flags=bytes([flags | 128]), lacking=b"\2")
    cases.tile("a layer without representatives", layers=b"\0\1")
    cases.tile("a layer of more representatives than points", layers=varint(1 << 40) + b"\1")
    cases.tile("a layer of other representatives than told", layers=b"\1\1")
    cases.tile("a spread of 2^32", layers=first.layers[:1] + varint(1 << 32))
    cases.tile("another content", content=bytes(len(first.content)))
    cases.tile("another number of points", points=varint(299))
    cases.tile("a size of 2^64 - 1", sizes=b"\1" + varint((1 << 64) - 1))
    cases.tile("sizes that add up to more than 64 bits", TRUNCATED, sizes=varint(1 << 63) * 2)
    cases.tile("chunks that are longer than the file", TRUNCATED, sizes=varint(1 << 40) * 2)
    cases.set("more tiles than there are", tile_count=b"\2")
    cases.set("fewer tiles than there are", tile_count=b"\0")
    cases.set("a number of tiles that their records cannot have", tile_count=varint(1 << 20))
    yield from cases.files


def array_field_rules(good: bytes) -> Iterator[BadFile]:
    """Section 5, of a progressive file that keeps the order and has arrays in the last layer."""
    cases = Cases(good)
    cases.tile("reserved flags of arrays", array_flags=b"\x0a")
    cases.tile("an order of kind 3", array_flags=b"\3")
    cases.tile("no order in a file that keeps it", array_flags=b"\0")
    contents = Draft(good).tiles[0].array_contents
    wrong = [bytes(len(contents[0])), *contents[1:]]
    cases.set("another content of an array", tile=0, array_contents=wrong)
    cases.tile("a chunk of an order of 2^64 - 1 bytes", order_size=varint((1 << 64) - 1))
    yield from cases.files
