#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "bspc/arrays.h"
#include "bspc/span.h"
#include "formats/input_buffer.h"
#include "formats/pcd_header.h"
#include "formats/text_scanner.h"

namespace bspc::formats {

/// Reads what follows a PCD header. Throws FormatError.
class PcdBody {
 public:
  PcdBody() = default;
  virtual ~PcdBody() = default;
  PcdBody(const PcdBody&) = delete;
  PcdBody& operator=(const PcdBody&) = delete;

  /// Reads `count` points of which the first is number `first`, counted from 0. Writes three
  /// numbers each of the type header.positionType to `positions` and appends their tuples to
  /// `values`, which has an array for each of header.arrays or none.
  virtual void readPoints(std::uint64_t first, std::size_t count, std::uint8_t* positions,
                          Span<ArrayValues> values) = 0;
  /// Throws if anything follows.
  virtual void requireEnd() = 0;
};

/// Input and header must outlive the body.
std::unique_ptr<PcdBody> asciiPcdBody(TextScanner& text, const PcdHeader& header);
std::unique_ptr<PcdBody> binaryPcdBody(InputBuffer& in, const PcdHeader& header);
/// Holds all points as they are uncompressed, since each of their fields is stored in one piece.
std::unique_ptr<PcdBody> compressedPcdBody(InputBuffer& in, const PcdHeader& header);

/// "point 41,230 of 50,000"; `index` counts from 0.
std::string pcdPlace(const PcdHeader& header, std::uint64_t index);

/// Reads to the end of a binary file. Throws if there is more than zeros, up to which writers that
/// map files into memory fill the last page.
void requirePcdEnd(InputBuffer& in);

/// Throws the error for a coordinate that has no exact float64, which stands at `byte`.
[[noreturn]] void failInexactPcd(const PcdHeader& header, std::size_t axis, std::uint64_t index,
                                 std::uint64_t byte);

}  // namespace bspc::formats
