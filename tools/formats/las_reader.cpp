#include "formats/las_reader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "formats/array_columns.h"
#include "formats/las_header.h"
#include "formats/las_point.h"
#include "formats/position_text.h"
#include "formats/record_reader.h"
#include "formats/scalar_convert.h"
#include "formats/wording.h"

namespace bspc::formats {

namespace {

/// An array of the file, and how its bits come out of their byte.
struct LasArray {
  ArrayDescription array;
  std::vector<std::size_t> offsets;  ///< of the components in a record
  unsigned shift = 0;
  unsigned mask = 0;  ///< 0: whole numbers
};

std::vector<std::size_t> consecutive(std::size_t offset, const ArrayDescription& array) {
  std::vector<std::size_t> offsets;
  for (std::size_t k = 0; k < array.components; ++k) {
    offsets.push_back(offset + k * scalarSize(array.type));
  }
  return offsets;
}

/// Single numbers among the extra bytes may be components of one array.
void appendExtras(std::vector<LasArray>& arrays, const LasHeader& header) {
  const std::size_t start = lasRecordBytes(header.pointFormat);
  std::set<std::string> taken;
  for (const LasArray& array : arrays) taken.insert(array.array.name);
  std::vector<Column> columns;
  std::vector<std::size_t> offsets;
  std::vector<LasArray> others;
  for (LasExtraField& extra :
       lasExtraFields(header.extraDescriptions, header.recordBytes - start)) {
    if (extra.array.name.empty()) extra.array.name = kLasExtraBytes;
    extra.array.name = uniqueName(extra.array.name, taken);
    taken.insert(extra.array.name);
    if (extra.isScalar) {
      columns.push_back({extra.array.name, extra.array.type});
      offsets.push_back(start + extra.offset);
    } else {
      others.push_back({extra.array, consecutive(start + extra.offset, extra.array)});
    }
  }
  for (const GroupedColumns& group : groupColumns(columns)) {
    LasArray array{group.array, {}};
    const bool isGroup = group.columns.size() > 1;
    if (isGroup) array.array.name = uniqueName(array.array.name, taken);
    taken.insert(array.array.name);
    for (const std::size_t column : group.columns) array.offsets.push_back(offsets[column]);
    arrays.push_back(std::move(array));
  }
  arrays.insert(arrays.end(), others.begin(), others.end());
}

std::vector<LasArray> arraysOf(const LasHeader& header) {
  std::vector<LasArray> arrays;
  for (LasField& field : lasFields(header.pointFormat)) {
    const unsigned mask = field.bits > 0 ? field.mask() : 0;
    std::vector<std::size_t> offsets = consecutive(field.offset, field.array);
    arrays.push_back({std::move(field.array), std::move(offsets), field.shift, mask});
  }
  appendExtras(arrays, header);
  return arrays;
}

RecordLayout layoutOf(const LasHeader& header, const std::vector<LasArray>& arrays) {
  RecordLayout layout;
  layout.bytes = header.recordBytes;
  for (std::size_t k = 0; k < 3; ++k) layout.xyz[k] = {4 * k, ScalarType::Int32};
  for (const LasArray& array : arrays) layout.arrays.push_back(array.offsets);
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
      : in_(std::move(in)),
        header_(readLasHeader(in_)),
        arrays_(arraysOf(header_)),
        records_(in_, layoutOf(header_, arrays_)) {
    info_.type = ScalarType::Float64;
    for (const LasArray& array : arrays_) info_.arrays.push_back(array.array);
    info_.metadata = header_.metadata;
    info_.otherContent = header_.otherContent;
    info_.lattice = latticeOf(header_);
    reservable_ = in_.reservable(header_.points, header_.recordBytes);
  }

  std::size_t read(std::uint8_t* positions, Span<ArrayValues> values, std::size_t count) override {
    const std::uint64_t left = header_.points - done_;
    const auto points = static_cast<std::size_t>(std::min<std::uint64_t>(count, left));
    for (std::size_t first = 0; first < points; first += kBlock) {
      readBlock(positions + first * sizeof(Position), values, std::min(kBlock, points - first));
    }
    if (points < count) finish();
    return points;
  }

 private:
  using Position = std::array<double, 3>;
  static constexpr std::size_t kBlock = 4096;

  void readBlock(std::uint8_t* positions, Span<ArrayValues> values, std::size_t count) {
    auto* bytes = reinterpret_cast<std::uint8_t*>(whole_.data());
    const std::size_t got = records_.read(bytes, values, count).records;
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
    for (std::size_t a = 0; a < values.size(); ++a) takeBits(arrays_[a], values[a], count);
    done_ += count;
  }

  /// Makes the bits of an array of the last `count` bytes of it.
  static void takeBits(const LasArray& array, ArrayValues& values, std::size_t count) {
    if (array.mask == 0) return;
    for (auto byte = values.values.end() - static_cast<std::ptrdiff_t>(count);
         byte != values.values.end(); ++byte) {
      *byte = static_cast<std::uint8_t>((*byte >> array.shift) & array.mask);
    }
  }

  /// Extended records follow the points, and waveforms; other bytes are not to be passed over
  /// without a word.
  void finish() {
    if (finished_) return;
    const std::uint64_t rest = in_.skip(UINT64_MAX);
    if (rest > 0 && header_.extendedRecords == 0 && !header_.hasWaveforms) {
      info_.otherContent.push_back(
          {counted(rest, "byte", "bytes") + " after the last point", OtherContent::Kind::Rest});
    }
    finished_ = true;
  }

  InputBuffer in_;
  LasHeader header_;
  std::vector<LasArray> arrays_;
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
