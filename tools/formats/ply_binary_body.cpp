#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>

#include "formats/array_tuples.h"
#include "formats/model.h"
#include "formats/ply_body.h"
#include "formats/record_reader.h"
#include "formats/scalar_convert.h"
#include "formats/scalar_visit.h"
#include "formats/wording.h"

namespace bspc::formats {

namespace {

/// Where the numbers are in vertices without lists.
RecordLayout layoutOf(const PlyHeader& header, bool swapped) {
  RecordLayout layout;
  layout.swapped = swapped;
  layout.positionType = header.positionType;
  const std::vector<std::size_t> axes = plyAxes(header);
  std::vector<std::size_t> offsets;
  for (std::size_t p = 0; p < axes.size(); ++p) {
    const PlyProperty& property = header.vertices().properties[p];
    if (axes[p] < 3) layout.xyz[axes[p]] = {layout.bytes, property.type};
    offsets.push_back(layout.bytes);
    layout.bytes += scalarSize(property.type);
  }
  for (const GroupedColumns& group : header.arrays) {
    layout.arrays.emplace_back();
    for (const std::size_t p : group.columns) layout.arrays.back().push_back(offsets[p]);
  }
  return layout;
}

class BinaryBody : public PlyBody {
 public:
  BinaryBody(InputBuffer& in, const PlyHeader& header)
      : in_(in),
        header_(header),
        axes_(plyAxes(header)),
        targets_(targetsOf(header.arrays, axes_.size())),
        swapped_((header.encoding == PlyEncoding::LittleEndian) != hostIsLittleEndian()),
        layout_(layoutOf(header, swapped_)),
        records_(in, layout_) {}

  void skip(const PlyElement& element) override {
    element_ = &element;
    if (element.hasList()) {
      for (std::uint64_t i = 0; i < element.count; ++i) readRecord(i, nullptr, {});
    } else {
      skipRecords();
    }
  }

  void readLists(const PlyElement& element, std::size_t property, Cells& cells) override {
    element_ = &element;
    wanted_ = property;
    cells_ = &cells;
    for (std::uint64_t i = 0; i < element.count; ++i) readRecord(i, nullptr, {});
    cells_ = nullptr;
  }

  void readVertices(std::uint64_t first, std::size_t count, std::uint8_t* positions,
                    Span<ArrayValues> values) override {
    element_ = &header_.vertices();
    if (!element_->hasList()) return readFixed(first, count, positions, values);
    const std::size_t pointBytes = 3 * scalarSize(header_.positionType);
    for (std::size_t i = 0; i < count; ++i) {
      appendTuple(values);
      readRecord(first + i, positions + i * pointBytes, values);
    }
  }

  void requireEnd() override {
    if (in_.ensure(1)) {
      throw FormatError("trailing data after the last element (byte " + grouped(in_.offset()) +
                        ")");
    }
  }

 private:
  void readFixed(std::uint64_t first, std::size_t count, std::uint8_t* positions,
                 Span<ArrayValues> values) {
    const RecordReader::Result result = records_.read(positions, values, count);
    if (result.status == RecordReader::Status::EndOfStream) failShort(first + result.records);
    if (result.status == RecordReader::Status::Inexact) {
      failInexact(element_->properties[header_.xyz[result.axis]], first + result.records,
                  in_.offset() + layout_.xyz[result.axis].offset);
    }
  }

  /// Reads one element with lists in it; the coordinates of a vertex go to `point`, its other
  /// numbers to the last tuples of `values`.
  void readRecord(std::uint64_t index, std::uint8_t* point, Span<ArrayValues> values) {
    const std::size_t size = scalarSize(header_.positionType);
    for (std::size_t p = 0; p < element_->properties.size(); ++p) {
      const PlyProperty& property = element_->properties[p];
      if (property.isList) {
        readList(index, property, cells_ != nullptr && p == wanted_);
        continue;
      }
      const std::size_t bytes = scalarSize(property.type);
      require(bytes, index);
      if (point != nullptr && axes_[p] < 3) {
        const ScalarSource source{in_.data(), property.type, 0, swapped_};
        const ScalarTarget target{point + axes_[p] * size, header_.positionType, 0};
        if (convertScalars(source, target, 1) == 0) failInexact(property, index, in_.offset());
      } else if (!values.empty() && targets_[p].array != ColumnTarget::kNone) {
        const ScalarSource source{in_.data(), property.type, 0, swapped_};
        convertScalars(source, {targets_[p].at(values), property.type, 0}, 1);
      }
      in_.consume(bytes);
    }
  }

  void readList(std::uint64_t index, const PlyProperty& property, bool wanted) {
    const std::size_t countBytes = scalarSize(property.countType);
    require(countBytes, index);
    const std::uint64_t count = visitScalar(property.countType, [&](auto zero) {
      auto value = zero;
      convertScalars({in_.data(), property.countType, 0, swapped_}, {&value, property.countType, 0},
                     1);
      if (value < zero) {
        throw FormatError("property " + quoted(property.name) + " of " +
                          plyPlace(*element_, index) + " has a negative number of items (byte " +
                          grouped(in_.offset()) + ")");
      }
      return static_cast<std::uint64_t>(value);
    });
    in_.consume(countBytes);
    const std::uint64_t itemBytes = scalarSize(property.type);
    if (wanted) return readCell(index, property, count);
    // Beyond 2^60 items no file is long enough, and their bytes could not be counted.
    if (count > (std::uint64_t{1} << 60) || in_.skip(count * itemBytes) < count * itemBytes) {
      in_.skip(UINT64_MAX);
      failShort(index);
    }
  }

  void readCell(std::uint64_t index, const PlyProperty& property, std::uint64_t count) {
    const std::size_t bytes = scalarSize(property.type);
    cell_.clear();
    for (std::uint64_t i = 0; i < count; ++i) {
      require(bytes, index);
      double number = 0;
      const ScalarSource source{in_.data(), property.type, 0, swapped_};
      const bool exact = convertScalars(source, {&number, ScalarType::Float64, 0}, 1) == 1;
      cell_.push_back(plyVertex(header_, exact ? number : -1, *element_, index));
      in_.consume(bytes);
    }
    cells_->add(cell_);
  }

  void skipRecords() {
    const std::uint64_t bytes = element_->fixedBytes();
    if (bytes == 0 || element_->count == 0) return;
    const std::uint64_t all =
        UINT64_MAX / bytes < element_->count ? UINT64_MAX : bytes * element_->count;
    const std::uint64_t skipped = in_.skip(all);
    if (skipped < all) failShort(skipped / bytes);
  }

  void require(std::size_t bytes, std::uint64_t index) {
    if (in_.available() >= bytes || in_.ensure(bytes)) return;
    in_.consume(in_.available());
    failShort(index);
  }

  /// Everything up to the end of the file has been consumed.
  [[noreturn]] void failShort(std::uint64_t index) const {
    throw FormatError("the file ends inside " + plyPlace(*element_, index) + " (byte " +
                      grouped(in_.offset()) + ")");
  }

  [[noreturn]] void failInexact(const PlyProperty& property, std::uint64_t index,
                                std::uint64_t byte) const {
    throw FormatError("property " + quoted(property.name) + " of " + plyPlace(*element_, index) +
                      " is not exact as a float64, the type that x, y and z have in common (byte " +
                      grouped(byte) + ")");
  }

  InputBuffer& in_;
  const PlyHeader& header_;
  std::vector<std::size_t> axes_;
  std::vector<ColumnTarget> targets_;
  bool swapped_;
  RecordLayout layout_;
  RecordReader records_;
  const PlyElement* element_ = nullptr;
  Cells* cells_ = nullptr;  ///< where the lists of property wanted_ go
  std::size_t wanted_ = 0;
  std::vector<std::uint32_t> cell_;
};

}  // namespace

std::unique_ptr<PlyBody> binaryPlyBody(InputBuffer& in, const PlyHeader& header) {
  return std::make_unique<BinaryBody>(in, header);
}

std::string plyPlace(const PlyElement& element, std::uint64_t index) {
  const bool plain = element.name == "vertex" || element.name == "face" || element.name == "edge";
  return (plain ? element.name : "element " + quoted(element.name)) + " " + grouped(index + 1) +
         " of " + grouped(element.count);
}

std::uint32_t plyVertex(const PlyHeader& header, double number, const PlyElement& element,
                        std::uint64_t index) {
  if (number >= 0 && number < static_cast<double>(header.vertices().count) &&
      number == std::floor(number) && number < 4294967279.0) {
    return static_cast<std::uint32_t>(number);
  }
  throw FormatError(plyPlace(element, index) + " has a vertex that is none of the " +
                    grouped(header.vertices().count) + " that there are, counted from 0");
}

std::vector<std::size_t> plyAxes(const PlyHeader& header) {
  std::vector<std::size_t> axes(header.vertices().properties.size(), 3);
  for (std::size_t k = 0; k < 3; ++k) axes[header.xyz[k]] = k;
  return axes;
}

}  // namespace bspc::formats
