"""Files put together field by field, with right checksums, so that one rule at a time can be broken.

A draft is made from a good file; its fields can then be changed, also to what the format forbids.
"""

from __future__ import annotations

from container import END, HEAD, INDEX, MESH, SIGNATURE, TILE, File, MeshBlock, MeshRecord, Tile
from xxh3 import checksum, checksum_width


def varint(value: int) -> bytes:
    out = bytearray()
    while True:
        out.append(value & 127 | (128 if value > 127 else 0))
        value >>= 7
        if not value:
            return bytes(out)


def svarint(value: int) -> bytes:
    return varint(2 * value if value >= 0 else -2 * value - 1)


def text(value: bytes) -> bytes:
    return varint(len(value)) + value


def with_checksum(payload: bytes) -> bytes:
    return payload + checksum(payload).to_bytes(checksum_width(len(payload)), "little")


def block(kind: int, content: bytes, before: bytes = b"") -> bytes:
    """A framed block; `before` is covered by its checksum too."""
    framed = bytes([kind]) + varint(len(content)) + content
    return framed + checksum(before + framed, len(content)).to_bytes(checksum_width(len(content)), "little")


def zstd_frame(content: bytes, window: int = 0x50, descriptor: int = 0) -> bytes:
    """A frame with one raw block; by default its window has 2^20 bytes."""
    block_header = (len(content) << 3 | 1).to_bytes(3, "little")
    return bytes.fromhex("28B52FFD") + bytes([descriptor, window]) + block_header + content


class TileDraft:
    """The fields of a tile record, each as its bytes, and the payloads of the chunks."""

    NAMES = ("flags", "coder", "points", "lower", "extent", "lacking", "layers", "content", "sizes")
    ARRAY_NAMES = ("array_flags", "order_size", "arrays")

    def __init__(self, tile: Tile, with_arrays: bool):
        self.with_arrays = with_arrays
        self.lengths = [max(1, (e.bit_length() + 7) // 8) for e in tile.extent]
        has_lower = any(tile.lower)
        flags = sum((l - 1) << 2 * k for k, l in enumerate(self.lengths))
        self.flags = bytes([flags | 64 * has_lower | 128 * bool(tile.lacking)])
        self.coder = varint(tile.method << 4 | tile.version)
        self.points = varint(tile.points)
        self.lower = b"".join(varint(v) for v in tile.lower) if has_lower else b""
        self.extent = b"".join(e.to_bytes(l, "little") for e, l in zip(tile.extent, self.lengths))
        self.lacking = varint(tile.lacking) if tile.lacking else b""
        pairs = list(zip(tile.representatives, tile.spreads))[:-1]
        self.layers = b"".join(varint(v) for pair in pairs for v in pair)
        self.content = tile.content.to_bytes(checksum_width(12 * tile.points), "little")
        self.chunks: dict[tuple, bytes] = dict(tile.chunks)
        self.array_flags = bytes([tile.order_kind | 4 * tile.values_in_all_layers])
        self.order_known = tile.order_kind
        self.array_contents = [
            c.to_bytes(a.content_width(tile.points), "little")
            for a, c in zip(tile.arrays, tile.array_contents)
        ]
        self.needs_order = list(tile.needs_order)
        self.overrides: dict[str, bytes] = {}

    def _sizes(self, kind: int, number: int = 0) -> list[int]:
        columns = sorted(c for c in self.chunks if c[1:] == (kind, number))
        return [len(self.chunks[c]) for c in columns]

    def _array_fields(self) -> bytes:
        out = b""
        for a, content in enumerate(self.array_contents):
            sizes = self._sizes(2, a)
            if self.order_known == 1:
                sizes[-1] = 2 * sizes[-1] + self.needs_order[a]
            out += content + b"".join(varint(s) for s in sizes)
        return out

    def field(self, name: str) -> bytes:
        if name in self.overrides:
            return self.overrides[name]
        if name == "sizes":
            return b"".join(varint(s) for s in self._sizes(0))
        if name == "order_size":
            return varint(self._sizes(1)[0]) if self.order_known == 1 else b""
        if name == "arrays":
            return self._array_fields()
        return getattr(self, name)

    def record(self) -> bytes:
        names = self.NAMES + (self.ARRAY_NAMES if self.with_arrays else ())
        return b"".join(self.field(n) for n in names)


class MeshDraft:
    """The fields of a Mesh block, each as its bytes."""

    def __init__(self, content: bytes, record: MeshRecord):
        block = MeshBlock(content, record)
        cells = sum(block.counts)
        self.first_tile, self.tiles = varint(block.first_tile), varint(block.tiles)
        self.counts = b"".join(varint(c) for c in block.counts)
        self.content = block.content.to_bytes(checksum_width(16 * cells), "little")
        self.cells = bytes(block.cells)
        widths = [a.content_width(cells) for a in record.arrays]
        self.value_contents = [c.to_bytes(w, "little") for c, w in zip(block.value_contents, widths)]
        self.values = [bytes(v) for v in block.values]

    def bytes(self) -> bytes:
        values = b"".join(c + text(v) for c, v in zip(self.value_contents, self.values))
        return self.first_tile + self.tiles + self.counts + self.content + text(self.cells) + values


class Draft:
    def __init__(self, data: bytes):
        file = File(data)
        head = file.head
        self.signature, self.version = SIGNATURE, bytes([file.major, file.minor])
        self.flags = head.flags
        self.grid = head.grid_bytes
        self.records: list[tuple[int, bytes]] = list(head.records)
        self.record_count: bytes | None = None
        with_arrays = head.has_arrays or head.keeps_order or head.grid.has_low_halves()
        self.tiles = [TileDraft(t, with_arrays) for t in file.tiles]
        self.tile_count: bytes | None = None
        self.head_tail = b""
        self.mesh_blocks = list(file.mesh_contents)
        # Blocks behind the first tile, in front of the Mesh blocks and behind them.
        self.behind_first: list[tuple[int, bytes]] = []
        self.before_mesh: list[tuple[int, bytes]] = []
        self.before_index: list[tuple[int, bytes]] = []
        self.trailing: list[tuple[int, bytes]] = [(END, bytes(8))] if head.trailing else []
        self.index: bytes | None = None
        self.index_offset: bytes | None = None
        self.tail = b""

    def head_content(self) -> bytes:
        out = bytes([self.flags]) + self.grid
        if self.flags & 64:
            out += varint(len(self.records)) if self.record_count is None else self.record_count
            out += b"".join(bytes([tag]) + text(content) for tag, content in self.records)
        return (out if self.flags & 32 else out + self._table()) + self.head_tail

    def _table(self) -> bytes:
        count = varint(len(self.tiles)) if self.tile_count is None else self.tile_count
        return count + b"".join(t.record() for t in self.tiles)

    def bytes(self) -> bytes:
        start = self.signature + self.version
        out = start + block(HEAD, self.head_content(), start)
        meshes = b"".join(block(*b) for b in self.before_mesh)
        meshes += b"".join(block(MESH, m) for m in self.mesh_blocks)
        if not self.flags & 32:
            columns = sorted({c for t in self.tiles for c in t.chunks})
            for column in columns:
                for tile in self.tiles:
                    if column in tile.chunks:
                        out += with_checksum(tile.chunks[column])
            out += meshes + b"".join(block(*b) for b in self.trailing)
            return out + self.tail
        for tile in self.tiles:
            out += block(TILE, tile.record())
            for column in sorted(tile.chunks):
                out += with_checksum(tile.chunks[column])
            if tile is self.tiles[0]:
                out += b"".join(block(*b) for b in self.behind_first)
        out += meshes + b"".join(block(*b) for b in self.before_index)
        offset = len(out)
        out += block(INDEX, self._table() if self.index is None else self.index)
        end = offset.to_bytes(8, "little") if self.index_offset is None else self.index_offset
        return out + block(END, end) + self.tail
