"""The container of docs/format.md, sections 2 to 6: everything but the payloads."""

from __future__ import annotations

import struct

import zstd
from elementary import BIT, STRING, UINT32, Reader, require, value_size
from grid import Grid
from words import WordType
from xxh3 import checksum, checksum_width

SIGNATURE = bytes.fromhex("8B425350 0D0A1A0A")
HEAD, TILE, INDEX, END, MESH = 1, 2, 3, 4, 5
METHODS = {1: "kd", 2: "fast", 3: "bsp", 4: "octree", 5: "gencode", 6: "predictive", 7: "surface"}


class ArrayDescription:
    def __init__(self, name: bytes = b"", scalar_type: int = UINT32, components: int = 3) -> None:
        self.name = name
        self.scalar_type = scalar_type
        self.components = components
        self.component_names, self.unit, self.semantic, self.tolerance = [], b"", 0, 0.0

    @classmethod
    def read(cls, reader: Reader) -> "ArrayDescription":
        name = reader.text()
        require(name, "an array without a name")
        kind = reader.u8()
        require(kind & 15 <= STRING, "unknown scalar type", "unsupported")
        array = cls(name, kind & 15, reader.varint())
        require(1 <= array.components <= 65536, "wrong number of components")
        if kind & 16:
            array.component_names = [reader.text() for _ in range(array.components)]
        if kind & 32:
            array.unit = reader.text()
        if kind & 64:
            array.semantic = reader.u8()
        if kind & 128:
            array.tolerance = struct.unpack("<d", reader.bytes(8))[0]
            require(0 < array.tolerance < float("inf"), "a tolerance is not positive and finite")
        return array

    def content_width(self, points: int) -> int:
        if self.scalar_type == STRING or points >= 65536:
            return 8
        return checksum_width(points * self.components * value_size(self.scalar_type))


def array_table(reader: Reader) -> list[ArrayDescription]:
    arrays = [ArrayDescription.read(reader) for _ in range(reader.varint())]
    require(len({a.name for a in arrays}) == len(arrays), "two arrays have the same name")
    return arrays


class Metadata:
    def __init__(self, content: bytes = b"\0\0\0\0\0") -> None:
        packed = content[0] if content else 2
        require(packed < 2, "unknown form of metadata")
        self.content = zstd.any_frame(content[1:]) if packed else bytes(content[1:])
        reader = Reader(self.content)
        self.crs, self.unit = reader.text(), reader.text()
        self.entries = [(reader.text(), reader.text()) for _ in range(reader.varint())]
        require(len({k for k, _ in self.entries}) == len(self.entries), "two entries have one key")
        self.field_data = []
        for _ in range(reader.varint()):
            array = ArrayDescription.read(reader)
            count = reader.varint() * array.components
            if array.scalar_type == STRING:
                values = [reader.text() for _ in range(count)]
            else:
                data = reader.bytes(count * value_size(array.scalar_type))
                require(array.scalar_type != BIT or all(v < 2 for v in data), "a bit is neither 0 nor 1")
                values = WordType(array.scalar_type).words_in(data)
            c = array.components
            self.field_data.append((array, [values[i : i + c] for i in range(0, count, c)]))
        require(len({a.name for a, _ in self.field_data}) == len(self.field_data), "two arrays have one name")
        reader.finish()


class MeshRecord:
    def __init__(self, content: bytes) -> None:
        reader = Reader(content)
        self.counts = [reader.varint() for _ in range(3)]
        require(all(c < 1 << 60 for c in self.counts), "too many cells")
        self.blocks = reader.varint()
        require(self.blocks >= 1, "a mesh without blocks")
        self.arrays = array_table(reader)
        reader.finish()


class MeshBlock:
    def __init__(self, content: bytes, record: MeshRecord) -> None:
        reader = Reader(content)
        self.first_tile, self.tiles = reader.varint(), reader.varint()
        self.counts = [reader.varint() for _ in range(3)]
        require(all(c < 1 << 60 for c in self.counts), "too many cells")
        cells = sum(self.counts)
        self.content = reader.unsigned(checksum_width(16 * cells))
        self.cells = reader.bytes(reader.varint())
        self.value_contents, self.values = [], []
        for array in record.arrays:
            self.value_contents.append(reader.unsigned(array.content_width(cells)))
            self.values.append(reader.bytes(reader.varint()))
        reader.finish()


def _chunk_size(reader: Reader) -> int:
    size = reader.varint()
    require(size < (1 << 64) - 1, "a chunk of 2^64 - 1 bytes")
    return size


class Tile:
    """A tile record, and then the payloads of its chunks."""

    def __init__(self, reader: Reader, head: "Head") -> None:
        start = reader.position
        flags = reader.u8()
        coder = reader.varint()
        require(coder < 1 << 32, "a coder is above 32 bits")
        self.method, self.version = coder >> 4, coder & 15
        self.points = reader.varint()
        require(self.points >= 1, "a tile without points")
        self.lower = [reader.varint() for _ in range(3)] if flags & 64 else [0, 0, 0]
        require(not flags & 64 or any(self.lower), "a lower corner that need not be told")
        self.extent = []
        for k in range(3):
            width = (flags >> 2 * k & 3) + 1
            self.extent.append(reader.unsigned(width))
            require(width == 1 or self.extent[k] >> 8 * (width - 1), "an extent is longer than it must be")
        self.upper = [self.lower[k] + self.extent[k] for k in range(3)]
        require(all(u < 1 << 32 for u in self.upper), "a box is beyond the grid")
        head.grid.check_box(self.lower, self.upper)
        self.lacking = reader.varint() if flags & 128 else 0
        require(not flags & 128 or 1 <= self.lacking < head.layers, "wrong number of lacking layers")
        self.layers = head.layers - self.lacking
        self._read_layers(reader)
        self.content = reader.unsigned(checksum_width(12 * self.points))
        self.geometry_sizes = [_chunk_size(reader) for _ in range(self.layers)]
        self.order_kind, self.order_size, self.values_in_all_layers = 0, 0, False
        self.array_contents, self.array_sizes, self.needs_order = [], [], []
        self.arrays = ([ArrayDescription()] if head.grid.has_low_halves() else []) + head.arrays
        if head.has_arrays or head.keeps_order or head.grid.has_low_halves():
            self._read_arrays(reader, head)
        self.record = bytes(reader.data[start : reader.position])

    def _read_layers(self, reader: Reader) -> None:
        self.representatives, self.spreads = [], []
        for _ in range(self.layers - 1):
            self.representatives.append(reader.varint())
            self.spreads.append(reader.varint())
        counts = [1, *self.representatives, self.points]
        require(counts == sorted(counts), "numbers of representatives fall")
        require(all(s < 1 << 32 for s in self.spreads), "a spread is too large")
        self.representatives.append(self.points)
        self.spreads.append(0)

    def _read_arrays(self, reader: Reader, head: "Head") -> None:
        flags = reader.u8()
        require(flags < 8 and flags & 3 != 3, "reserved flags of arrays")
        self.order_kind = flags & 3
        require(self.order_kind or not head.keeps_order, "a kept order is not known")
        self.values_in_all_layers = bool(flags & 4)
        if self.order_kind == 1:
            self.order_size = _chunk_size(reader)
        for array in self.arrays:
            self.array_contents.append(reader.unsigned(array.content_width(self.points)))
            sizes = [_chunk_size(reader) for _ in range(self.layers if self.values_in_all_layers else 1)]
            needs = False
            if self.order_kind == 1:
                needs = bool(sizes[-1] & 1)
                sizes[-1] >>= 1
            self.array_sizes.append(sizes)
            self.needs_order.append(needs)

    def chunk_sizes(self, layers: int) -> list[tuple[tuple[int, int, int], int]]:
        """(column, kind, size) of all chunks in the order of the columns of `layers` layers."""
        chunks = []
        for own, layer in enumerate(range(self.lacking, layers)):
            chunks.append(((layer, 0, 0), self.geometry_sizes[own]))
            if layer == layers - 1 and self.order_kind == 1:
                chunks.append(((layer, 1, 0), self.order_size))
            for a, sizes in enumerate(self.array_sizes):
                if self.values_in_all_layers:
                    chunks.append(((layer, 2, a), sizes[own]))
                elif layer == layers - 1:
                    chunks.append(((layer, 2, a), sizes[0]))
        return chunks


class Head:
    def __init__(self, content: bytes) -> None:
        reader = Reader(content)
        self.flags = flags = reader.u8()
        self.layers = (flags & 31) + 1
        self.streaming = bool(flags & 32)
        self.trailing = bool(flags & 128)
        require(not (self.streaming and self.trailing), "trailing blocks of a streaming file")
        start = reader.position
        self.grid = Grid(reader)
        self.grid_bytes = bytes(reader.data[start : reader.position])
        self.records: list[tuple[int, bytes]] = []
        self.arrays, self.has_arrays, self.keeps_order = [], False, False
        self.mesh, self.metadata, self.has_metadata = None, Metadata(), False
        if flags & 64:
            self._read_records(reader)
        self.tiles = None if self.streaming else [Tile(reader, self) for _ in range(reader.varint())]
        reader.finish()

    def _read_records(self, reader: Reader) -> None:
        count = reader.varint()
        require(count >= 1, "no records")
        last = -1
        for _ in range(count):
            tag = reader.u8()
            content = reader.bytes(reader.varint())
            self.records.append((tag, bytes(content)))
            require(tag > last, "records are not in order")
            last = tag
            if tag == 1:
                table = Reader(content)
                self.arrays, self.has_arrays = array_table(table), True
                table.finish()
            elif tag == 2:
                require(not content, "a record goes on after its end")
                self.keeps_order = True
            elif tag == 3:
                self.mesh = MeshRecord(content)
            elif tag == 128:
                self.metadata, self.has_metadata = Metadata(content), True
            else:
                require(tag >= 128, "unknown record", "unsupported")


def _require_optional(kind: int) -> None:
    require(not HEAD <= kind <= MESH, "a block out of place")
    require(kind >= 128, "a block of unknown type", "unsupported")


class File:
    """A whole file: its head, its tiles with the payloads of their chunks, its mesh blocks."""

    def __init__(self, data: bytes) -> None:
        self.reader = Reader(data, short="truncated")
        require(data and SIGNATURE.startswith(bytes(data[:8])), "no signature", "not bspc")
        self.reader.bytes(8)
        self.major, self.minor = self.reader.u8(), self.reader.u8()
        require(self.major == 1, "unknown major version", "unsupported")
        kind, content = self._block(covered_before=10)
        require(kind == HEAD, "no head")
        self.head = Head(content)
        self.mesh_blocks, self.mesh_contents = [], []
        if self.head.streaming:
            self._read_streaming()
        else:
            self._read_progressive()
        require(self.reader.left() == 0, "the file goes on after its end")
        self._check_mesh()

    def _block(self, covered_before: int = 0) -> tuple[int, bytes]:
        start = self.reader.position
        kind = self.reader.u8()
        size = self.reader.varint()
        content = self.reader.bytes(size)
        covered = self.reader.data[start - covered_before : self.reader.position]
        width = checksum_width(size)
        require(checksum(covered, size) == self.reader.unsigned(width), "a block is damaged")
        return kind, content

    def _chunk(self, size: int) -> bytes:
        payload = self.reader.bytes(size)
        require(checksum(payload) == self.reader.unsigned(checksum_width(size)), "a chunk is damaged")
        return payload

    def _read_progressive(self) -> None:
        self.tiles = self.head.tiles
        columns = {}
        for t, tile in enumerate(self.tiles):
            tile.chunks = {}
            for column, size in tile.chunk_sizes(self.head.layers):
                columns.setdefault(column, []).append((t, size))
        sizes = [size for column in columns.values() for _, size in column]
        promised = sum(s + checksum_width(s) for s in sizes)
        require(promised <= self.reader.left(), "the file ends early", "truncated")
        start = self.reader.position
        self.reader.position += promised
        for _ in range(self.head.mesh.blocks if self.head.mesh else 0):
            kind, content = self._block()
            require(kind == MESH, "a mesh block is missing")
            self._add_mesh(content)
        if self.head.trailing:
            self._read_trailing({END})
        end, self.reader.position = self.reader.position, start
        for column in sorted(columns):
            for t, size in columns[column]:
                self.tiles[t].chunks[column] = self._chunk(size)
        self.reader.position = end

    def _read_trailing(self, last: set[int]) -> tuple[int, bytes]:
        """Optional blocks up to one of a type in `last`, which is returned."""
        while True:
            start = self.reader.position
            kind, content = self._block()
            if kind == END and END in last:
                require(len(content) == 8 and not any(content), "a wrong end block")
                return start, content
            if kind in last:
                return start, content
            _require_optional(kind)

    def _require_end_block(self) -> None:
        """Without one, a streaming file counts as one that ends early."""
        end = Reader(self.reader.data, max(len(self.reader.data) - 14, 0), short="truncated")
        start = end.bytes(10)
        require(start[:2] == bytes([END, 8]), "no end block", "truncated")
        require(checksum(start) == end.unsigned(4), "no end block", "truncated")

    def _read_streaming(self) -> None:
        self._require_end_block()
        self.reader.short = "corrupt"  # the file is whole
        self.tiles = []
        index, optional = None, False
        while index is None:
            start = self.reader.position
            kind, content = self._block()
            require(kind not in (TILE, MESH) or not optional, "a block behind optional ones")
            if kind == TILE:
                require(not self.mesh_blocks, "a tile behind the mesh")
                record = Reader(content)
                tile = Tile(record, self.head)
                record.finish()
                tile.chunks = {c: self._chunk(s) for c, s in tile.chunk_sizes(self.head.layers)}
                self.tiles.append(tile)
            elif kind == MESH and self.head.mesh:
                self._add_mesh(content)
            elif kind == INDEX:
                index = start
                table = Reader(content)
                records = [Tile(table, self.head).record for _ in range(table.varint())]
                table.finish()
                require(records == [t.record for t in self.tiles], "index and tiles differ")
            else:
                _require_optional(kind)
                optional = True
        kind, content = self._block()
        require(kind == END and len(content) == 8, "no end block")
        require(int.from_bytes(content, "little") == index, "the end block names another index")

    def _add_mesh(self, content: bytes) -> None:
        self.mesh_blocks.append(MeshBlock(content, self.head.mesh))
        self.mesh_contents.append(bytes(content))

    def _check_mesh(self) -> None:
        record = self.head.mesh
        if record is None:
            return
        require(len(self.mesh_blocks) == record.blocks, "wrong number of mesh blocks")
        sums, next_tile = [0, 0, 0], 0
        for block in self.mesh_blocks:
            require(block.first_tile >= next_tile, "mesh blocks overlap")
            next_tile = block.first_tile + block.tiles
            require(next_tile <= len(self.tiles), "a mesh block names tiles that are not there")
            sums = [a + b for a, b in zip(sums, block.counts)]
        require(sums == record.counts, "mesh blocks do not add up")
