#include <utility>
#include <vector>

#include "formats/model.h"
#include "formats/pcd_body.h"
#include "formats/record_reader.h"
#include "formats/scalar_convert.h"
#include "formats/wording.h"

namespace bspc::formats {

namespace {

RecordLayout layoutOf(const PcdHeader& header) {
  RecordLayout layout;
  layout.bytes = static_cast<std::size_t>(header.pointBytes);
  for (std::size_t k = 0; k < 3; ++k) {
    const PcdField& field = header.axis(k);
    layout.xyz[k] = {static_cast<std::size_t>(field.byteOffset), field.type};
  }
  for (const PcdArray& array : header.arrays) {
    std::vector<std::size_t> offsets;
    for (std::size_t k = 0; k < array.offsets.size(); ++k) {
      const std::uint64_t field = header.fields[array.fields[k]].byteOffset;
      offsets.push_back(static_cast<std::size_t>(field) + array.offsets[k]);
    }
    layout.arrays.push_back(std::move(offsets));
  }
  layout.swapped = !hostIsLittleEndian();
  layout.positionType = header.positionType;
  return layout;
}

class BinaryBody : public PcdBody {
 public:
  BinaryBody(InputBuffer& in, const PcdHeader& header)
      : in_(in), header_(header), records_(in, layoutOf(header)) {}

  void readPoints(std::uint64_t first, std::size_t count, std::uint8_t* positions,
                  Span<ArrayValues> values) override {
    const RecordReader::Result result = records_.read(positions, values, count);
    const std::uint64_t next = first + result.records;
    if (result.status == RecordReader::Status::EndOfStream) {
      throw FormatError("the file ends inside " + pcdPlace(header_, next) + " (byte " +
                        grouped(in_.offset()) + ")");
    }
    if (result.status == RecordReader::Status::Inexact) {
      failInexactPcd(header_, result.axis, next,
                     in_.offset() + header_.axis(result.axis).byteOffset);
    }
  }

  void requireEnd() override { requirePcdEnd(in_); }

 private:
  InputBuffer& in_;
  const PcdHeader& header_;
  RecordReader records_;
};

}  // namespace

std::unique_ptr<PcdBody> binaryPcdBody(InputBuffer& in, const PcdHeader& header) {
  return std::make_unique<BinaryBody>(in, header);
}

}  // namespace bspc::formats
