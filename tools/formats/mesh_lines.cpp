#include "formats/mesh_lines.h"

#include <string>

#include "formats/model.h"
#include "formats/wording.h"

namespace bspc::formats {

void writeCellLines(OutputBuffer& out, const Cells& cells, const CellStyle& style) {
  for (std::size_t i = 0; i < cells.size(); ++i) {
    std::string& text = out.text();
    text += style.keyword;
    if (style.withSize) text += std::to_string(cells[i].size());
    for (const std::uint32_t vertex : cells[i]) {
      text += ' ';
      text += std::to_string(vertex + style.first);
    }
    text += '\n';
    out.advance(i, cells.size());
  }
}

void requireFacesOnly(const MeshCells* mesh, const char* format) {
  if (mesh == nullptr) return;
  const std::size_t others = mesh->lines.size() + mesh->vertices.size();
  if (others == 0) return;
  throw FormatError(std::string(format) + " has no place for " +
                    counted(others, "line or vertex cell", "lines and vertex cells") +
                    "; OBJ has, and --no-faces leaves all cells out");
}

}  // namespace bspc::formats
