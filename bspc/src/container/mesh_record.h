#pragma once

#include <cstdint>
#include <vector>

#include "bspc/arrays.h"
#include "bspc/limits.h"
#include "container/byte_reader.h"
#include "container/byte_writer.h"

namespace bspc::container {

/// How many cells of each sort.
struct CellCounts {
  std::uint64_t vertices = 0;
  std::uint64_t lines = 0;
  std::uint64_t faces = 0;

  /// Throws Error(Corrupt) if the numbers are beyond reason.
  std::uint64_t total() const;
  void add(const CellCounts& more);
};

/// What the head says of the mesh (docs/format.md, "Mesh").
struct MeshRecord {
  CellCounts counts;
  std::uint64_t blocks = 0;              ///< Mesh blocks that follow the tiles; 0: there is no mesh
  std::vector<ArrayDescription> arrays;  ///< of the cells
};

void writeMeshRecord(ByteWriter& out, const MeshRecord& mesh);
MeshRecord readMeshRecord(ByteReader& in, const DecodeLimits& limits);

/// The content of a Mesh block: the cells over the points of consecutive tiles.
struct MeshBlock {
  std::uint64_t firstTile = 0;
  std::uint64_t tiles = 0;
  CellCounts counts;
  std::uint64_t contentChecksum = 0;  ///< of the cells that are decoded
  Bytes cells;                        ///< payload of connectivity
  struct Array {
    std::uint64_t contentChecksum = 0;  ///< of the values that are decoded
    Bytes payload;
  };
  std::vector<Array> arrays;  ///< in the order of the record
};

/// `arrays`: those of the record.
Bytes writeMeshBlock(const MeshBlock& block, const std::vector<ArrayDescription>& arrays);
MeshBlock readMeshBlock(ByteReader& in, const std::vector<ArrayDescription>& arrays);

}  // namespace bspc::container
