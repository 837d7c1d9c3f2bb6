#include "formats/off_writer.h"

#include <string>

#include "formats/mesh_lines.h"
#include "formats/point_lines.h"

namespace bspc::formats {

namespace {

class OffWriter : public PointWriter {
 public:
  explicit OffWriter(const ModelLayout& layout) : points_(layout.points), mesh_(layout.mesh) {
    requireNoArrays(layout.arrays, "an OFF file");
    requireFacesOnly(layout.mesh, "an OFF file");
  }

  void begin(OutputBuffer& out) override {
    out.text() += "OFF\n" + std::to_string(points_) + ' ' +
                  std::to_string(mesh_ == nullptr ? 0 : mesh_->faces.size()) + " 0\n";
  }

  void append(OutputBuffer& out, const PointSetView& points) override {
    writePointLines(out, points, {}, {});
  }

  void finish(OutputBuffer& out) override {
    if (mesh_ != nullptr) writeCellLines(out, mesh_->faces, {"", true, 0});
  }

 private:
  std::uint64_t points_;
  const MeshCells* mesh_;
};

}  // namespace

std::unique_ptr<PointWriter> offWriter(const ModelLayout& layout) {
  return std::make_unique<OffWriter>(layout);
}

}  // namespace bspc::formats
