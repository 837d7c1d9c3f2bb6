#include <algorithm>
#include <cstring>
#include <string>

#include "formats/model.h"
#include "formats/ply_body.h"
#include "formats/scalar_convert.h"
#include "formats/scalar_visit.h"
#include "formats/wording.h"

namespace bspc::formats {

namespace {

class BinaryBody {
 public:
  BinaryBody(InputBuffer& in, const PlyHeader& header, std::vector<std::uint8_t>& positions)
      : in_(in),
        header_(header),
        positions_(positions),
        axes_(plyAxes(header)),
        swapped_((header.encoding == PlyEncoding::LittleEndian) != hostIsLittleEndian()) {}

  void read() {
    for (std::size_t e = 0; e < header_.elements.size(); ++e) {
      element_ = &header_.elements[e];
      if (e == header_.vertexElement) {
        readVertices();
      } else if (element_->hasList()) {
        for (std::uint64_t i = 0; i < element_->count; ++i) readRecord(i, nullptr);
      } else {
        skipRecords();
      }
    }
    if (in_.ensure(1)) {
      throw FormatError("trailing data after the last element (byte " + grouped(in_.offset()) +
                        ")");
    }
  }

 private:
  void readVertices() {
    const std::size_t pointBytes = 3 * scalarSize(header_.positionType);
    if (element_->hasList()) {
      std::array<std::uint8_t, 24> point{};
      for (std::uint64_t i = 0; i < element_->count; ++i) {
        readRecord(i, point.data());
        positions_.insert(positions_.end(), point.data(), point.data() + pointBytes);
      }
    } else if (isPackedPositions()) {
      readPacked(pointBytes);
    } else {
      readFixed(pointBytes);
    }
  }

  /// Whether the records are what the model wants, byte for byte.
  bool isPackedPositions() const {
    const auto& properties = element_->properties;
    return !swapped_ && properties.size() == 3 &&
           header_.xyz == std::array<std::size_t, 3>{0, 1, 2} &&
           std::all_of(properties.begin(), properties.end(),
                       [&](const PlyProperty& p) { return p.type == header_.positionType; });
  }

  void readPacked(std::size_t pointBytes) {
    constexpr std::size_t kBlockBytes = std::size_t{1} << 20;
    const std::size_t block = kBlockBytes / pointBytes;
    for (std::uint64_t done = 0; done < element_->count;) {
      const auto count =
          static_cast<std::size_t>(std::min<std::uint64_t>(block, element_->count - done));
      // A header can claim any number of vertices: memory grows as their bytes arrive.
      const std::size_t size = positions_.size();
      positions_.resize(size + count * pointBytes);
      const std::size_t got = in_.read(positions_.data() + size, count * pointBytes);
      if (got < count * pointBytes) failShort(done + got / pointBytes);
      done += count;
    }
  }

  void readFixed(std::size_t pointBytes) {
    const auto recordBytes = static_cast<std::size_t>(element_->fixedBytes());
    const std::size_t block = std::max<std::size_t>((std::size_t{1} << 17) / recordBytes, 1);
    for (std::uint64_t done = 0; done < element_->count;) {
      const auto count =
          static_cast<std::size_t>(std::min<std::uint64_t>(block, element_->count - done));
      if (!in_.ensure(count * recordBytes)) {
        const std::uint64_t whole = in_.available() / recordBytes;
        in_.consume(in_.available());
        failShort(done + whole);
      }
      const std::size_t size = positions_.size();
      positions_.resize(size + count * pointBytes);
      convertBlock(done, count, recordBytes, positions_.data() + size);
      in_.consume(count * recordBytes);
      done += count;
    }
  }

  void convertBlock(std::uint64_t first, std::size_t count, std::size_t recordBytes,
                    std::uint8_t* to) const {
    const std::size_t size = scalarSize(header_.positionType);
    std::size_t offset = 0;
    for (std::size_t p = 0; p < element_->properties.size(); ++p) {
      const PlyProperty& property = element_->properties[p];
      if (axes_[p] < 3) {
        const ScalarSource source{in_.data() + offset, property.type, recordBytes, swapped_};
        const ScalarTarget target{to + axes_[p] * size, header_.positionType, 3 * size};
        const std::size_t exact = convertScalars(source, target, count);
        if (exact < count) {
          failInexact(property, first + exact, in_.offset() + exact * recordBytes + offset);
        }
      }
      offset += scalarSize(property.type);
    }
  }

  /// Reads one element with lists in it; the coordinates of a vertex go to `point`.
  void readRecord(std::uint64_t index, std::uint8_t* point) {
    const std::size_t size = scalarSize(header_.positionType);
    for (std::size_t p = 0; p < element_->properties.size(); ++p) {
      const PlyProperty& property = element_->properties[p];
      if (property.isList) {
        skipList(index, property);
        continue;
      }
      const std::size_t bytes = scalarSize(property.type);
      require(bytes, index);
      if (point != nullptr && axes_[p] < 3) {
        const ScalarSource source{in_.data(), property.type, 0, swapped_};
        const ScalarTarget target{point + axes_[p] * size, header_.positionType, 0};
        if (convertScalars(source, target, 1) == 0) failInexact(property, index, in_.offset());
      }
      in_.consume(bytes);
    }
  }

  void skipList(std::uint64_t index, const PlyProperty& property) {
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
    // Beyond 2^60 items no file is long enough, and their bytes could not be counted.
    if (count > (std::uint64_t{1} << 60) || in_.skip(count * itemBytes) < count * itemBytes) {
      in_.skip(UINT64_MAX);
      failShort(index);
    }
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
  std::vector<std::uint8_t>& positions_;
  std::vector<std::size_t> axes_;
  bool swapped_;
  const PlyElement* element_ = nullptr;
};

}  // namespace

void readBinaryPlyBody(InputBuffer& in, const PlyHeader& header,
                       std::vector<std::uint8_t>& positions) {
  BinaryBody(in, header, positions).read();
}

std::string plyPlace(const PlyElement& element, std::uint64_t index) {
  const bool plain = element.name == "vertex" || element.name == "face" || element.name == "edge";
  return (plain ? element.name : "element " + quoted(element.name)) + " " + grouped(index + 1) +
         " of " + grouped(element.count);
}

std::vector<std::size_t> plyAxes(const PlyHeader& header) {
  std::vector<std::size_t> axes(header.vertices().properties.size(), 3);
  for (std::size_t k = 0; k < 3; ++k) axes[header.xyz[k]] = k;
  return axes;
}

}  // namespace bspc::formats
