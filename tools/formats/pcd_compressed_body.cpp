#include <lzf.h>

#include <algorithm>
#include <vector>

#include "formats/array_tuples.h"
#include "formats/little_endian.h"
#include "formats/model.h"
#include "formats/pcd_body.h"
#include "formats/scalar_convert.h"
#include "formats/wording.h"

namespace bspc::formats {

namespace {

/// Three bytes of LZF data make at most 264.
constexpr std::uint64_t kGreatestExpansion = 88;

class CompressedBody : public PcdBody {
 public:
  CompressedBody(InputBuffer& in, const PcdHeader& header) : in_(in), header_(header) {}

  void readPoints(std::uint64_t first, std::size_t count, std::uint8_t* positions,
                  Span<ArrayValues> values) override {
    uncompress();
    const std::size_t size = scalarSize(header_.positionType);
    for (std::size_t k = 0; k < 3; ++k) {
      const PcdField& field = header_.axis(k);
      const std::size_t bytes = scalarSize(field.type);
      const std::uint64_t at = field.byteOffset * header_.points + first * bytes;
      const ScalarSource source{fields_.data() + at, field.type, bytes, !hostIsLittleEndian()};
      const ScalarTarget target{positions + k * size, header_.positionType, 3 * size};
      const std::size_t exact = convertScalars(source, target, count);
      if (exact < count) failInexactPcd(header_, k, first + exact, start_);
    }
    for (std::size_t a = 0; a < values.size(); ++a) {
      appendArray(first, count, header_.arrays[a], values[a]);
    }
  }

  void requireEnd() override {
    uncompress();
    requirePcdEnd(in_);
  }

 private:
  void appendArray(std::uint64_t first, std::size_t count, const PcdArray& array,
                   ArrayValues& values) const {
    const std::size_t size = scalarSize(values.type);
    std::uint8_t* const tuples = appendTuples(values, count);
    for (std::size_t k = 0; k < array.offsets.size(); ++k) {
      const PcdField& field = header_.fields[array.fields[k]];
      const std::size_t stride = static_cast<std::size_t>(field.count) * scalarSize(field.type);
      const std::uint64_t at = field.byteOffset * header_.points + first * stride;
      const ScalarSource source{fields_.data() + at + array.offsets[k], values.type, stride,
                                !hostIsLittleEndian()};
      convertScalars(source, {tuples + k * size, values.type, array.offsets.size() * size}, count);
    }
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw FormatError(what + " (byte " + grouped(start_) + ")");
  }

  void uncompress() {
    if (done_) return;
    done_ = true;
    start_ = in_.offset();
    if (!in_.ensure(8)) {
      // Nothing need follow the header of no points.
      if (header_.points == 0 && in_.available() == 0) return;
      fail("the file ends before the sizes of the compressed points");
    }
    const std::uint32_t packed = loadUInt32(in_.data());
    const std::uint32_t size = loadUInt32(in_.data() + 4);
    if (size / header_.pointBytes != header_.points || size % header_.pointBytes != 0) {
      fail("the compressed points are said to have " + grouped(size) + " bytes uncompressed; " +
           counted(header_.points, "point", "points") + " of " + grouped(header_.pointBytes) +
           " bytes were expected");
    }
    in_.consume(8);
    const std::vector<std::uint8_t> data = compressedData(packed);
    if (size == 0) return;
    if (size / kGreatestExpansion > packed) failDamaged();
    fields_.resize(size);
    const unsigned got = lzf_decompress(data.data(), packed, fields_.data(), size);
    if (got != size) failDamaged();
  }

  /// Memory grows as the bytes arrive, whatever their number is said to be.
  std::vector<std::uint8_t> compressedData(std::size_t bytes) {
    constexpr std::size_t kPiece = std::size_t{1} << 20;
    std::vector<std::uint8_t> data;
    while (data.size() < bytes) {
      const std::size_t size = data.size();
      data.resize(std::min(bytes, size + kPiece));
      const std::size_t got = in_.read(data.data() + size, data.size() - size);
      if (size + got == data.size()) continue;
      throw FormatError("the file ends inside the compressed points, after " + grouped(size + got) +
                        " of " + grouped(bytes) + " bytes (byte " + grouped(in_.offset()) + ")");
    }
    return data;
  }

  [[noreturn]] void failDamaged() const {
    fail("the compressed points are damaged: their LZF data do not give " +
         counted(header_.points, "point", "points"));
  }

  InputBuffer& in_;
  const PcdHeader& header_;
  bool done_ = false;
  /// Where the sizes stand.
  std::uint64_t start_ = 0;
  /// Every field of all points, one field after the other.
  std::vector<std::uint8_t> fields_;
};

}  // namespace

std::unique_ptr<PcdBody> compressedPcdBody(InputBuffer& in, const PcdHeader& header) {
  return std::make_unique<CompressedBody>(in, header);
}

}  // namespace bspc::formats
