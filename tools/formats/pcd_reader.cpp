#include "formats/pcd_reader.h"

#include <algorithm>
#include <utility>

#include "formats/pcd_body.h"
#include "formats/pcd_header.h"
#include "formats/wording.h"

namespace bspc::formats {

namespace {

class PcdStream : public PointStream {
 public:
  explicit PcdStream(InputBuffer in)
      : in_(std::move(in)), text_(in_), header_(readPcdHeader(text_)) {
    info_.type = header_.positionType;
    for (const PcdArray& array : header_.arrays) info_.arrays.push_back(array.array);
    keepHeader();
    // In text, a digit and a blank a number; compressed, nobody knows.
    std::uint64_t least = header_.pointBytes;
    switch (header_.encoding) {
      case PcdEncoding::Ascii:
        body_ = asciiPcdBody(text_, header_);
        least = 2 * header_.pointNumbers;
        break;
      case PcdEncoding::Binary:
        body_ = binaryPcdBody(in_, header_);
        break;
      case PcdEncoding::BinaryCompressed:
        body_ = compressedPcdBody(in_, header_);
        break;
    }
    reservable_ = in_.reservable(header_.points, static_cast<std::size_t>(least));
  }

  std::size_t read(std::uint8_t* positions, Span<ArrayValues> values, std::size_t count) override {
    const std::uint64_t left = header_.points - done_;
    const auto points = static_cast<std::size_t>(std::min<std::uint64_t>(count, left));
    if (points > 0) body_->readPoints(done_, points, positions, values);
    done_ += points;
    if (points < count && !finished_) {
      body_->requireEnd();
      finished_ = true;
    }
    return points;
  }

 private:
  void keepHeader() {
    auto& entries = info_.metadata.entries;
    if (!header_.viewpoint.empty()) entries.emplace_back("pcd.viewpoint", header_.viewpoint);
    for (const PcdField& field : header_.fields) {
      const bool isUsual = isFloatingPoint(field.type) == (field.name == "rgb");
      if (!isPackedColour(field) || isUsual) continue;
      entries.emplace_back("pcd." + field.name, scalarName(field.type));
    }
    info_.isOrganised = header_.height > 1;
    if (!info_.isOrganised) return;
    entries.emplace_back("pcd.width", std::to_string(header_.width));
    entries.emplace_back("pcd.height", std::to_string(header_.height));
  }

  InputBuffer in_;
  TextScanner text_;
  PcdHeader header_;
  std::unique_ptr<PcdBody> body_;
  std::uint64_t done_ = 0;
  bool finished_ = false;
};

}  // namespace

std::unique_ptr<PointStream> openPcd(InputBuffer in) {
  return std::make_unique<PcdStream>(std::move(in));
}

std::string pcdPlace(const PcdHeader& header, std::uint64_t index) {
  return "point " + grouped(index + 1) + " of " + grouped(header.points);
}

void requirePcdEnd(InputBuffer& in) {
  while (in.ensure(1)) {
    const char* const end = in.data() + in.available();
    const char* const found = std::find_if(in.data(), end, [](char c) { return c != '\0'; });
    in.consume(static_cast<std::size_t>(found - in.data()));
    if (found == end) continue;
    throw FormatError("trailing data after the last point (byte " + grouped(in.offset()) + ")");
  }
}

void failInexactPcd(const PcdHeader& header, std::size_t axis, std::uint64_t index,
                    std::uint64_t byte) {
  throw FormatError("field " + quoted(header.axis(axis).name) + " of " + pcdPlace(header, index) +
                    " is not exact as a float64, the type that x, y and z have in common (byte " +
                    grouped(byte) + ")");
}

}  // namespace bspc::formats
