#include "formats/off_writer.h"

#include <string>

#include "formats/point_lines.h"

namespace bspc::formats {

namespace {

class OffWriter : public PointWriter {
 public:
  explicit OffWriter(const ModelLayout& layout) : points_(layout.points) {
    requireNoArrays(layout.arrays, "an OFF file");
  }

  void begin(OutputBuffer& out) override {
    out.text() += "OFF\n" + std::to_string(points_) + " 0 0\n";
  }

  void append(OutputBuffer& out, const PointSetView& points) override {
    writePointLines(out, points, {}, {});
  }

 private:
  std::uint64_t points_;
};

}  // namespace

std::unique_ptr<PointWriter> offWriter(const ModelLayout& layout) {
  return std::make_unique<OffWriter>(layout);
}

}  // namespace bspc::formats
