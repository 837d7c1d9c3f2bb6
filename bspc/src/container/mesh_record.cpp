#include "container/mesh_record.h"

#include <algorithm>

#include "bspc/error.h"
#include "container/array_table.h"
#include "container/checksum.h"

namespace bspc::container {

namespace {

/// No mesh has as many cells of a sort.
constexpr std::uint64_t kTooManyCells = std::uint64_t{1} << 60;

void writeCounts(ByteWriter& out, const CellCounts& counts) {
  out.varint(counts.vertices);
  out.varint(counts.lines);
  out.varint(counts.faces);
}

CellCounts readCounts(ByteReader& in) {
  CellCounts counts;
  counts.vertices = in.varint();
  counts.lines = in.varint();
  counts.faces = in.varint();
  if (std::max({counts.vertices, counts.lines, counts.faces}) >= kTooManyCells) {
    in.fail("an impossible number of cells");
  }
  return counts;
}

attributes::ArrayShape shapeOf(const ArrayDescription& array) {
  return {array.type, array.components, array.semantic};
}

Bytes readBytes(ByteReader& in) {
  const ByteView view = in.bytes(in.varint());
  return {view.begin(), view.end()};
}

void writeBytes(ByteWriter& out, const Bytes& bytes) {
  out.varint(bytes.size());
  out.bytes(bytes);
}

}  // namespace

std::uint64_t CellCounts::total() const { return vertices + lines + faces; }

void CellCounts::add(const CellCounts& more) {
  vertices += more.vertices;
  lines += more.lines;
  faces += more.faces;
}

void writeMeshRecord(ByteWriter& out, const MeshRecord& mesh) {
  writeCounts(out, mesh.counts);
  out.varint(mesh.blocks);
  writeArrayTable(out, mesh.arrays);
}

MeshRecord readMeshRecord(ByteReader& in, const DecodeLimits& limits) {
  MeshRecord mesh;
  mesh.counts = readCounts(in);
  mesh.blocks = in.varint();
  if (mesh.blocks == 0) in.fail("a mesh without blocks");
  // Each block stands for a tile at least.
  if (mesh.blocks > limits.tiles) {
    throw Error(ErrorCode::LimitExceeded, "the file has " + std::to_string(mesh.blocks) +
                                              " blocks of cells, more than the limit of " +
                                              std::to_string(limits.tiles) +
                                              " tiles; raise it if the file is to be trusted");
  }
  mesh.arrays = readArrayTable(in, limits);
  return mesh;
}

Bytes writeMeshBlock(const MeshBlock& block, const std::vector<ArrayDescription>& arrays) {
  ByteWriter out;
  out.varint(block.firstTile);
  out.varint(block.tiles);
  writeCounts(out, block.counts);
  out.unsignedLittle(block.contentChecksum, cellsChecksumWidth(block.counts.total()));
  writeBytes(out, block.cells);
  for (std::size_t a = 0; a < arrays.size(); ++a) {
    out.unsignedLittle(block.arrays[a].contentChecksum,
                       valuesChecksumWidth(shapeOf(arrays[a]), block.counts.total()));
    writeBytes(out, block.arrays[a].payload);
  }
  return out.take();
}

MeshBlock readMeshBlock(ByteReader& in, const std::vector<ArrayDescription>& arrays) {
  MeshBlock block;
  block.firstTile = in.varint();
  block.tiles = in.varint();
  block.counts = readCounts(in);
  block.contentChecksum = in.unsignedLittle(cellsChecksumWidth(block.counts.total()));
  block.cells = readBytes(in);
  for (const ArrayDescription& array : arrays) {
    MeshBlock::Array& read = block.arrays.emplace_back();
    read.contentChecksum =
        in.unsignedLittle(valuesChecksumWidth(shapeOf(array), block.counts.total()));
    read.payload = readBytes(in);
  }
  in.expectEnd();
  return block;
}

}  // namespace bspc::container
