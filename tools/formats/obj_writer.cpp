#include "formats/obj_writer.h"

#include "formats/array_columns.h"
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
  explicit ObjWriter(const ModelLayout& layout) {
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

 private:
  std::vector<ArrayColumn> columns_;
};

}  // namespace

std::unique_ptr<PointWriter> objWriter(const ModelLayout& layout) {
  return std::make_unique<ObjWriter>(layout);
}

}  // namespace bspc::formats
