"""Bad files: one rule each of docs/format.md, sections 8 to 15, is broken; checksums are right."""

from __future__ import annotations

import struct
from typing import Callable, Iterator

from arrays import ArrayPayload, Layer
from bad_container import CORRUPT, UNSUPPORTED, BadFile, Cases
from container import File, MeshRecord
from draft import Draft, MeshDraft, varint, zstd_frame
from elementary import FormatError, Reader
from range_coder import AdaptiveBits
from scripted import Script, adaptive_number, number
from surface import Surface

GEOMETRY, ORDER = (0, 0, 0), (1, 1, 0)
LAST_LAYER = 1
# Places of the arrays in Testing/Data/frozen_1.0/kd_arrays.bspc.
FLOAT32, INT8, UINT8, BIT, STRING = 0, 2, 3, 10, 11


class PayloadCases(Cases):
    def payload(self, what: str, column: tuple[int, int, int], payload: bytes, kind: str = CORRUPT) -> None:
        """Another payload of a chunk of the first tile."""
        self.add(what, lambda draft: draft.tiles[0].chunks.update({column: payload}), kind)

    def array(self, what: str, array: int, payload: bytes, kind: str = CORRUPT) -> None:
        self.payload(what, (LAST_LAYER, 2, array), payload, kind)


def stream_rules(name: str, good: bytes) -> Iterator[BadFile]:
    """Section 8, of a file of any method whose first payload is one range coder stream."""
    cases = PayloadCases(good)
    payload = Draft(good).tiles[0].chunks[GEOMETRY]
    cases.payload(f"{name}: a payload that goes on", GEOMETRY, payload + bytes(9))
    cases.payload(f"{name}: no payload", GEOMETRY, b"")
    cases.payload(f"{name}: a payload that ends early", GEOMETRY, payload[:4])
    yield from cases.files


def partition_rules(good: dict[str, bytes]) -> Iterator[BadFile]:
    """Sections 9, 11 and 12."""
    for name, number in (("kd", 1), ("bsp", 3), ("octree", 4), ("gencode", 5)):
        cases = PayloadCases(good[name])
        version = varint(number << 4 | 9)
        cases.tile(f"{name}: an unknown version", UNSUPPORTED, coder=version)
        tile = Draft(good[name]).tiles[0]
        content = bytes(8)
        cases.tile(f"{name}: 2^32 points in a tile", points=varint(1 << 32), content=content)
        if name != "kd":
            flags = bytes([0b101010])
            cases.tile(f"{name}: 22 bits of extent", flags=flags, extent=b"\xff\xff\x3f" * 3)
        # A box that is smaller than its points.
        cases.tile(f"{name}: another box", extent=bytes([1]) + tile.extent[1:])
        yield from cases.files
        yield from stream_rules(name, good[name])


def fast_rules(slabs: bytes, trees: bytes, layers: bytes) -> Iterator[BadFile]:
    """Section 10, of files of one tile: slabs with gaps, slabs with trees, and one of two layers."""
    cases = PayloadCases(slabs)
    payload = Draft(slabs).tiles[0].chunks[GEOMETRY]
    cases.tile("fast: an unknown version", UNSUPPORTED, coder=varint(2 << 4 | 1))
    cases.payload("fast: reserved flags", GEOMETRY, b"\x20" + payload[1:])
    cases.payload("fast: a scale of 32", GEOMETRY, b"\x08\0\0\x20" + payload[1:])
    cases.payload("fast: no header", GEOMETRY, b"")
    cases.payload("fast: a header without its scales", GEOMETRY, b"\x08\0")
    cases.payload("fast: no set", GEOMETRY, b"\0")
    cases.payload("fast: an unknown kind of set", GEOMETRY, b"\0\3" + payload[2:])
    cases.payload("fast: extra levels of a set without trees", GEOMETRY, b"\0\x10" + payload[2:])
    cases.payload("fast: sections that are longer than their set", GEOMETRY, b"\0\0" + varint(1 << 20) * 5)
    cases.payload("fast: raw bits that go on", GEOMETRY, payload + b"\0")
    cases.payload("fast: raw bits that end early", GEOMETRY, payload[:-2])
    for name, values in (("one value", b"\1\0\0"), ("more values than points", varint(1 << 20) + b"\0\0")):
        section = varint(len(values)) + values
        cases.payload(f"fast: an axis of {name}", GEOMETRY, b"\1" + section + payload[1:])
    cases.payload("fast: a values section that is longer than its tile", GEOMETRY, b"\1" + varint(1 << 30))
    yield from cases.files

    cases = PayloadCases(trees)
    payload = Draft(trees).tiles[0].chunks[GEOMETRY]
    cases.payload("fast: seven extra levels", GEOMETRY, payload[:1] + b"\x71" + payload[2:])
    yield from cases.files

    cases = PayloadCases(layers)
    payload = Draft(layers).tiles[0].chunks[GEOMETRY]
    for ratio in (0, 17):
        cases.payload(f"fast: a ratio of {ratio}", GEOMETRY, payload[:1] + bytes([ratio]) + payload[2:])
    yield from cases.files


def predictive_rules(good: bytes) -> Iterator[BadFile]:
    """Section 13: the features in front, of a file of one tile."""
    cases = PayloadCases(good)
    cases.tile("predictive: an unknown version", UNSUPPORTED, coder=varint(6 << 4 | 1))
    cases.tile("predictive: 2^32 points in a tile", points=varint(1 << 32), content=bytes(8))
    # Raw bits of a fresh range coder stream stand in it as they are.
    for what, start in (
        ("effort 4", "48"),
        ("effort 10", "A8"),
        ("unknown flags", "F8000000006101000018"),
        ("no cell points", "F0000000000101000018"),
        ("25 near points", "F0000000006191000018"),
        ("no near points", "F0000000006001000018"),
        ("an unknown refit", "F0000000006101003800"),
    ):
        cases.payload(f"predictive: {what}", GEOMETRY, bytes.fromhex(start) + bytes(40))
    cases.payload("predictive: no payload", GEOMETRY, b"")
    yield from cases.files


def _surface_stream(points: int, values: list[int]) -> bytes:
    """The start of a payload of method surface, up to what must be refused in it."""
    script = Script(values)
    try:
        Surface(script, points)
    except FormatError:
        return script.stream()
    raise AssertionError("nothing is wrong with this surface")


def surface_rules(good: bytes, layers: bytes) -> Iterator[BadFile]:
    """Section 16, of files of one tile, one of them with coarse layers."""
    cases = PayloadCases(good)
    draft = Draft(good)
    cases.tile("surface: an unknown version", UNSUPPORTED, coder=varint(7 << 4 | 1))
    cases.tile("surface: 2^32 - 16 points in a tile", points=varint((1 << 32) - 16), content=bytes(8))
    cases.payload("surface: no payload", GEOMETRY, b"")
    points = File(good).tiles[0].points
    one_face, new_edge, another = [*number(1), 1], [1, 1], [0]
    for what, values in (
        ("a first edge of no vertex", [*one_face, 0]),
        ("a vertex twice in a face", [*one_face, *new_edge, *another, 2, 0]),
        ("a first edge that has a face", [*number(2), 1, *new_edge, 1, 1, 1, 1, 0, 0, 0, 1]),
        ("a way along gates that ends early", [*one_face, *new_edge, *another, 0, *adaptive_number(0)]),
        ("a way of 1,026 gates", [*one_face, *new_edge, *another, 1, *adaptive_number(1025)]),
        ("a face of more corners than points", [*number(1), 0, *new_edge, 11, *number(points - 10)]),
        ("a face of two corners", [*number(1), 0, *new_edge, 2]),
    ):
        cases.payload(f"surface: {what}", GEOMETRY, _surface_stream(points, values))

    def fewer(changed: Draft) -> None:
        changed.tiles[0].overrides["points"] = b"\2"
        changed.tiles[0].chunks[GEOMETRY] = _surface_stream(2, [*one_face, *new_edge, 1])

    cases.add("surface: more vertices than points", fewer)

    def kept_order(changed: Draft) -> None:
        changed.records = [(2, b""), *changed.records]
        for tile in changed.tiles:
            tile.with_arrays = True
            tile.overrides["array_flags"] = b"\2"

    cases.add("surface: its faces in a file that keeps the order", kept_order)
    yield from cases.files
    cases = PayloadCases(layers)
    cases.payload("surface: a coarse layer with a payload", GEOMETRY, b"\0")
    yield from cases.files


def _residual_of_255() -> bytes:
    """Its length, three bits behind the leading one, and four more."""
    script, models = Script([1, 0, 0, 0, 1, 1, 1, 15]), AdaptiveBits()
    for place in range(7):
        script.adaptive(models[place])
    script.wide(4)
    return script.stream()


def _large_residual() -> bytes:
    """A payload of bytes that begins with the residual 255: its length, three bits, the rest."""
    start, script = b"\3\0", Script([1, 0, 0, 0, 1, 1, 1, 15])
    try:
        ArrayPayload(Layer([(0, 0, 0)], 0, None), UINT8, 1).decode(Reader(start, tail=script), [])
    except FormatError:
        return start + script.stream()
    raise AssertionError("nothing is wrong with this residual")


def array_rules(good: bytes) -> Iterator[BadFile]:
    """Section 14, of Testing/Data/frozen_1.0/kd_arrays.bspc."""
    cases = PayloadCases(good)
    n = 144
    cases.array("an array without a payload", UINT8, b"")
    cases.array("an unknown method for arrays", UINT8, b"\x09", UNSUPPORTED)
    cases.array("an unknown version of a method for arrays", UINT8, b"\x10" + bytes(4), UNSUPPORTED)
    cases.array("constant: a payload that goes on", UINT8, b"\0" + bytes(5))
    cases.array("constant: a payload that ends early", UINT8, b"\0" + bytes(3))
    cases.array("constant: a bit that is neither 0 nor 1", BIT, b"\0" + b"\2" * 3)
    cases.array("strings of numbers", UINT8, b"\6\0")
    cases.array("numbers of strings", STRING, b"\0" + bytes(4))
    cases.array("bytes: reserved flags", UINT8, b"\1\x08\0\0")
    cases.array("bytes: a row that ends early", UINT8, b"\1\0\1" + bytes(4 * n - 1))
    cases.array("bytes: a row that goes on", UINT8, b"\1\0\1" + bytes(4 * n + 1))
    cases.array("bytes: a row in a frame that is none", UINT8, b"\1\0\x09" + bytes(9))
    for what, frame in (
        ("two frames", zstd_frame(bytes(n)) + zstd_frame(bytes(3 * n))),
        ("a frame of a window above 2^23", zstd_frame(bytes(4 * n), window=0x69)),
    ):
        cases.array(f"bytes: a row in {what}", UINT8, b"\1\0" + varint(len(frame)) + frame)
    cases.array("bytes: a row that is longer than its payload", UINT8, b"\1\0" + varint(1 << 30))
    cases.array("quick: an unknown domain", UINT8, b"\2\3" + bytes(8))
    cases.array("quick: reserved flags", UINT8, b"\2\x10" + bytes(8))
    cases.array("quick: numbers of integers", UINT8, b"\2\1" + bytes(8))
    cases.array("quick: unit of one component", FLOAT32, b"\2\2" + bytes(8))
    cases.array("residual: an unknown predictor", UINT8, b"\3\5" + bytes(8))
    cases.array("residual: reserved flags", UINT8, b"\3\x80" + bytes(8))
    cases.array("residual: numbers of integers", UINT8, b"\3\x20" + bytes(8))
    cases.array("residual: unit of one component", FLOAT32, b"\3\x40" + bytes(8))
    cases.array("residual: sphere outside of a sphere", UINT8, b"\3\x60" + bytes(8))
    cases.array("residual: a residual longer than its word", UINT8, b"\3\0" + bytes(3000))
    cases.array("residual: a residual of more than half of its word", UINT8, b"\3\0" + _residual_of_255())
    cases.array("residual: a residual beyond half of its range", UINT8, _large_residual())
    cases.array("residual: a stream that goes on", UINT8, b"\3\0" + b"\xff" * 3000)
    cases.array("mixing: a stream that goes on", UINT8, b"\4" + bytes(3000))
    cases.array("mixing: values beyond the type", 4, b"\4\1" + varint(65535) + b"\0" + bytes(3000))
    cases.array("categories: reserved flags", UINT8, b"\5\x08\1\0" + bytes(8))
    cases.array("categories: differences without the order of the input", UINT8, b"\5\2\1\0" + bytes(8))
    cases.array("categories: no symbols", UINT8, b"\5\0\0" + bytes(8))
    cases.array("categories: words that end early", UINT8, b"\5\0\x20" + bytes(8))
    cases.array("strings: an unknown form", STRING, b"\6\2" + bytes(8))
    cases.array("strings: fewer bytes of lengths than strings", STRING, b"\6\0\1\1\0\1")
    cases.array("strings: an empty table", STRING, b"\6\1\0" + bytes(8))
    cases.array("strings: a table larger than the array", STRING, b"\6\1" + varint(1 << 20) + bytes(8))
    table = b"\6\1\1" + b"\1\1\1" + b"\1a"
    cases.array("strings: a place beyond the table", STRING, table + b"\0" + b"\1" * 4)
    cases.array("strings: a table of strings inside of strings", STRING, table + b"\6\0")
    yield from cases.files
    yield from _lossy_array_rules(good, n)
    yield from _order_rules(good)


def _lossy_array_rules(good: bytes, n: int) -> Iterator[BadFile]:
    cases = PayloadCases(good)

    def quantised(step: float, base: int, size: int, rest: bytes) -> bytes:
        zigzag = varint(2 * base if base >= 0 else -2 * base - 1)
        return b"\7" + struct.pack("<d", step) + zigzag + bytes([size]) + rest

    inner = b"\0" + b"\0"
    cases.array("quantised: integers", UINT8, quantised(1, 0, 1, b"\0\0" + bytes(4)))
    for step in (0.0, -1.0, float("inf"), float("nan")):
        cases.array(f"quantised: a step of {step}", FLOAT32, quantised(step, 0, 1, b"\0" + inner))
    cases.array("quantised: a base above 2^52", FLOAT32, quantised(1, (1 << 52) + 1, 1, b"\0" + inner))
    cases.array("quantised: integers of three bytes", FLOAT32, quantised(1, 0, 3, b"\0" + inner))
    cases.array("quantised: too many exceptions", FLOAT32, quantised(1, 0, 1, varint(n + 1) + bytes(8)))
    far = b"\1\2" + b"\1" + varint(n) + b"\1" + bytes(4)
    cases.array("quantised: an exception beyond the last", FLOAT32, quantised(1, 0, 1, far + inner))
    cases.array("quantised: inside of quantised", FLOAT32, quantised(1, 0, 1, b"\0\7" + bytes(12)))
    cases.array("sphere: of one component", FLOAT32, b"\x08\x08\0\0\0\0")
    yield from cases.files


def _order_rules(good: bytes) -> Iterator[BadFile]:
    cases = PayloadCases(good)
    cases.payload("an order without a payload", ORDER, b"")
    cases.payload("an unknown method for orders", ORDER, b"\3", UNSUPPORTED)
    cases.payload("an unknown version of a method for orders", ORDER, b"\x10", UNSUPPORTED)
    cases.payload("identity: a payload that goes on", ORDER, b"\0\0")
    cases.payload("uniform: a stream that ends early", ORDER, b"\1\1")
    cases.payload("path: a momentum of 3", ORDER, b"\2\7" + bytes(200))
    for coarser in (0, 5):
        cases.payload(f"path: coarse cells of {coarser} bits more", ORDER, b"\2" + bytes([4 * coarser]) + bytes(200))
    cases.payload("path: a step of 63 bits", ORDER, b"\2\4" + bytes(2000))
    cases.payload("path: a stream that goes on", ORDER, b"\2\4" + b"\xff" * 2000)
    cases.payload("path: no parameters", ORDER, b"\2")
    yield from cases.files


def mesh_rules(good: bytes) -> Iterator[BadFile]:
    """Section 15, of a progressive file of one tile with one Mesh block."""
    cases = PayloadCases(good)
    draft = Draft(good)
    record = dict(draft.records)[3]
    block = draft.mesh_blocks[0]

    def with_record(what: str, content: bytes, kind: str = CORRUPT) -> None:
        records = [(tag, content if tag == 3 else old) for tag, old in draft.records]
        cases.set(what, kind, records=records)

    with_record("a mesh record that ends early", record[:2])
    with_record("a mesh record that goes on", record + b"\0")
    with_record("2^60 cells", varint(1 << 60) * 3 + record[3:])
    with_record("a mesh without blocks", record[:-2] + b"\0" + record[-1:])
    with_record("other numbers of cells than the blocks have", b"\1" + record[1:])
    cases.set("no Mesh block", "truncated", mesh_blocks=[])
    cases.set("a Mesh block twice", mesh_blocks=[block, block])
    cases.set("a Mesh block of tiles that there are not", mesh_blocks=[b"\1" + block[1:]])
    cases.set("a Mesh block of too many tiles", mesh_blocks=[block[:1] + b"\2" + block[2:]])
    cases.set("a Mesh block that goes on", mesh_blocks=[block + b"\0"])
    cases.set("a Mesh block that ends early", mesh_blocks=[block[:-1]])
    cases.set("a Mesh block without a mesh", flags=draft.flags & ~64)
    cases.set("an optional block in front of the Mesh block", before_mesh=[(200, b"")])
    cases.set("another content of the cells", mesh_blocks=[block[:5] + bytes(4) + block[9:]])
    # Raw bits of a fresh range coder stream stand in it as they are: the version, two numbers of
    # length 0, no lines and no vertex cells, "faces", "order kept", then numbers of faces and flags.
    for what, start, kind in (
        ("cells of an unknown version", "20", UNSUPPORTED),
        ("cells of version 1 over a tile without faces", "10002080", CORRUPT),
        ("cells that are fewer than the block says", "00000080", CORRUPT),
        ("faces without neighbours", "0000200000000080", CORRUPT),
        ("vertex cells that are not one for each point", "00300480", CORRUPT),
    ):
        cells = bytes.fromhex(start).ljust(8, b"\0")
        changed = block[:9] + varint(len(cells)) + cells
        cases.set(f"mesh: {what}", kind, mesh_blocks=[changed])
    yield from cases.files


class CellCases(PayloadCases):
    """Of a file with one Mesh block and arrays beside its cells."""

    def __init__(self, name: str, good: bytes):
        super().__init__(good)
        self.name, self.draft = name, Draft(good)
        self.record = MeshRecord(dict(self.draft.records)[3])

    def changed(self, what: str, change: Callable[[MeshDraft], None], kind: str = CORRUPT) -> None:
        mesh = MeshDraft(self.draft.mesh_blocks[0], self.record)
        change(mesh)
        self.set(f"{self.name}: {what}", kind, mesh_blocks=[mesh.bytes()])

    def arrays(self) -> None:
        for number, array in enumerate(self.record.arrays):
            name = array.name.decode()
            wrong = bytes(array.content_width(sum(self.record.counts)))
            self.changed(
                f"another content of the array {name}", lambda m: m.value_contents.__setitem__(number, wrong)
            )
            self.changed(f"the array {name} without a payload", lambda m: m.values.__setitem__(number, b""))
            self.changed(
                f"the array {name} of no method", lambda m: m.values.__setitem__(number, b"\x09"), UNSUPPORTED
            )


def cell_array_rules(good: bytes, joined: bytes) -> Iterator[BadFile]:
    """Section 15, of a file with arrays beside its cells, and of one with two Mesh blocks."""
    cases = CellCases("cells", good)
    cases.arrays()
    cases.changed("2^60 in a block", lambda m: setattr(m, "counts", varint(1 << 60) * 3))
    cases.changed(
        "other numbers of each sort", lambda m: setattr(m, "counts", m.counts[1:2] + m.counts[:1] + m.counts[2:])
    )
    yield from cases.files

    cases = PayloadCases(joined)
    draft = Draft(joined)
    record = MeshRecord(dict(draft.records)[3])
    cases.set("Mesh blocks in another order", mesh_blocks=draft.mesh_blocks[::-1])
    second = MeshDraft(draft.mesh_blocks[1], record)
    second.first_tile = b"\0"
    cases.set("Mesh blocks that overlap", mesh_blocks=[draft.mesh_blocks[0], second.bytes()])
    cases.set("a Mesh block too few", "truncated", mesh_blocks=draft.mesh_blocks[:1])
    yield from cases.files


def surface_array_rules(good: bytes) -> Iterator[BadFile]:
    """Sections 15 and 16, of a tile of method surface with arrays beside its cells."""
    cases = CellCases("cells of a surface", good)
    cases.arrays()
    mesh = MeshDraft(cases.draft.mesh_blocks[0], cases.record)
    mesh.tiles = varint(2)
    cases.set("cells of version 1 over two surfaces", tiles=cases.draft.tiles * 2, mesh_blocks=[mesh.bytes()])
    yield from cases.files


def streaming_mesh_rules(good: bytes) -> Iterator[BadFile]:
    """Sections 2 and 15, of a streaming file with a Mesh block."""
    content = Draft(good).mesh_blocks[0]
    size = varint(len(content))
    for what, more in (("the index", 8), ("the End block", 40), ("nowhere", 60)):
        longer = varint(len(content) + more)
        assert len(longer) == len(size)
        data = good.replace(b"\5" + size + content, b"\5" + longer + content)
        yield f"a Mesh block that reaches into {what}", CORRUPT, data
