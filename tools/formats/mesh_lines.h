#pragma once

#include <cstdint>

#include "bspc/mesh.h"
#include "formats/output_buffer.h"

namespace bspc::formats {

/// How a cell is written as a line of text.
struct CellStyle {
  const char* keyword = "";
  bool withSize = false;    ///< the number of vertices in front of them
  std::uint64_t first = 0;  ///< number of the first vertex
};

/// Writes one line a cell.
void writeCellLines(OutputBuffer& out, const Cells& cells, const CellStyle& style);

/// Throws FormatError if there are cells that are no faces, which `format` has no place for.
void requireFacesOnly(const MeshCells* mesh, const char* format);

}  // namespace bspc::formats
