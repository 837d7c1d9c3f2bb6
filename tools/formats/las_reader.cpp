#include "formats/las_reader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "formats/las_header.h"
#include "formats/position_text.h"
#include "formats/record_reader.h"
#include "formats/scalar_convert.h"
#include "formats/wording.h"

namespace bspc::formats {

namespace {

RecordLayout layoutOf(const LasHeader& header) {
  RecordLayout layout;
  layout.bytes = header.recordBytes;
  for (std::size_t k = 0; k < 3; ++k) layout.xyz[k] = {4 * k, ScalarType::Int32};
  layout.swapped = !hostIsLittleEndian();
  layout.positionType = ScalarType::Int32;
  return layout;
}

Grid latticeOf(const LasHeader& header) {
  Grid grid;
  grid.form = Grid::Form::Affine;
  grid.scalarType = ScalarType::Float64;
  for (std::size_t k = 0; k < 3; ++k) {
    grid.axes[k].origin = header.offset[k];
    // −X steps of −scale are the same numbers.
    grid.axes[k].step = std::fabs(header.scale[k]);
  }
  return grid;
}

class LasStream : public PointStream {
 public:
  explicit LasStream(InputBuffer in)
      : in_(std::move(in)), header_(readLasHeader(in_)), records_(in_, layoutOf(header_)) {
    info_.type = ScalarType::Float64;
    info_.otherContent = header_.otherContent;
    info_.lattice = latticeOf(header_);
    reservable_ = in_.reservable(header_.points, header_.recordBytes);
  }

  std::size_t read(std::uint8_t* positions, std::size_t count) override {
    const std::uint64_t left = header_.points - done_;
    const auto points = static_cast<std::size_t>(std::min<std::uint64_t>(count, left));
    for (std::size_t first = 0; first < points; first += kBlock) {
      readBlock(positions + first * sizeof(Position), std::min(kBlock, points - first));
    }
    if (points < count) finish();
    return points;
  }

 private:
  using Position = std::array<double, 3>;
  static constexpr std::size_t kBlock = 4096;

  void readBlock(std::uint8_t* positions, std::size_t count) {
    auto* bytes = reinterpret_cast<std::uint8_t*>(whole_.data());
    const std::size_t got = records_.read(bytes, count).records;
    if (got < count) {
      throw FormatError("the file ends inside point " + grouped(done_ + got + 1) + " of " +
                        grouped(header_.points) + " (byte " + grouped(in_.offset()) + ")");
    }
    for (std::size_t i = 0; i < count; ++i) {
      Position position{};
      for (std::size_t k = 0; k < 3; ++k) {
        position[k] = whole_[3 * i + k] * header_.scale[k] + header_.offset[k];
      }
      storePosition(positions, i, position);
    }
    done_ += count;
  }

  /// Extended records follow the points, and waveforms; other bytes are not to be passed over
  /// without a word.
  void finish() {
    if (finished_) return;
    const std::uint64_t rest = in_.skip(UINT64_MAX);
    if (rest > 0 && header_.extendedRecords == 0 && !header_.hasWaveforms) {
      info_.otherContent.push_back(counted(rest, "byte", "bytes") + " after the last point");
    }
    finished_ = true;
  }

  InputBuffer in_;
  LasHeader header_;
  RecordReader records_;
  std::vector<std::int32_t> whole_ = std::vector<std::int32_t>(3 * kBlock);
  std::uint64_t done_ = 0;
  bool finished_ = false;
};

}  // namespace

std::unique_ptr<PointStream> openLas(InputBuffer in) {
  return std::make_unique<LasStream>(std::move(in));
}

}  // namespace bspc::formats
