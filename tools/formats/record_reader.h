#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "bspc/arrays.h"
#include "bspc/scalar_type.h"
#include "bspc/span.h"
#include "formats/input_buffer.h"

namespace bspc::formats {

/// Where the numbers of a point are in binary records of one size, and what they become.
struct RecordLayout {
  struct Coordinate {
    std::size_t offset = 0;
    ScalarType type = ScalarType::Float32;
  };
  /// Bytes of a record; all numbers lie within them.
  std::size_t bytes = 0;
  std::array<Coordinate, 3> xyz{};
  /// For each array where the numbers of a tuple are; they keep their type.
  std::vector<std::vector<std::size_t>> arrays;
  /// Whether numbers are in the other byte order than this machine's.
  bool swapped = false;
  /// The type of the positions, as commonScalarType() gives it.
  ScalarType positionType = ScalarType::Float32;
};

/// Reads the positions and arrays of many binary records.
class RecordReader {
 public:
  RecordReader(InputBuffer& in, const RecordLayout& layout);

  enum class Status : std::uint8_t { Ok, EndOfStream, Inexact };
  struct Result {
    std::size_t records = 0;
    Status status = Status::Ok;
    /// The coordinate of the next record that positionType does not hold; only if Inexact. The
    /// input is left in front of that record.
    std::size_t axis = 0;
  };
  /// Reads up to `count` records, writes three packed numbers each to `positions` and appends their
  /// tuples to `values`, which has the arrays of the layout or none. Fewer end with another status
  /// than Ok; at the end of the stream everything has been consumed.
  Result read(std::uint8_t* positions, Span<ArrayValues> values, std::size_t count);

 private:
  Result readPacked(std::uint8_t* positions, std::size_t count);
  Result readBlock(std::uint8_t* positions, Span<ArrayValues> values, std::size_t count);
  void appendArrays(Span<ArrayValues> values, std::size_t count) const;

  InputBuffer& in_;
  RecordLayout layout_;
  std::size_t pointBytes_;
  /// Whether records are what is wanted, byte for byte.
  bool packed_;
};

}  // namespace bspc::formats
