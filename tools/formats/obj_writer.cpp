#include "formats/obj_writer.h"

#include "formats/array_columns.h"
#include "formats/mesh_lines.h"
#include "formats/point_lines.h"

namespace bspc::formats {

namespace {

/// Whether these are the colours that may follow the coordinates of a vertex.
bool areColours(const std::vector<ArrayDescription>& arrays) {
  return arrays.size() == 1 && arrays[0].semantic == Semantic::Colours &&
         isFloatingPoint(arrays[0].type) &&
         (arrays[0].components == 3 || arrays[0].components == 4);
}

class ObjWriter : public PointWriter {
 public:
  explicit ObjWriter(const ModelLayout& layout) : mesh_(layout.mesh) {
    if (!areColours(layout.arrays)) {
      requireNoArrays(layout.arrays, "an OBJ file");
    } else {
      columns_ = columnsOf(layout.arrays);
    }
  }

  void begin(OutputBuffer& out) override { out.text() += "# written by bspc\n"; }

  void append(OutputBuffer& out, const PointSetView& points) override {
    writePointLines(out, points, columns_, {"v ", ' ', false});
  }

  void finish(OutputBuffer& out) override {
    if (mesh_ == nullptr) return;
    writeCellLines(out, mesh_->vertices, {"p", false, 1});
    writeCellLines(out, mesh_->lines, {"l", false, 1});
    writeCellLines(out, mesh_->faces, {"f", false, 1});
  }

 private:
  std::vector<ArrayColumn> columns_;
  const MeshCells* mesh_;
};

}  // namespace

std::unique_ptr<PointWriter> objWriter(const ModelLayout& layout) {
  return std::make_unique<ObjWriter>(layout);
}

}  // namespace bspc::formats
