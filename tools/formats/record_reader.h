#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "bspc/scalar_type.h"
#include "formats/input_buffer.h"

namespace bspc::formats {

/// Where the coordinates are in binary records of one size, and what they become.
struct RecordLayout {
  struct Coordinate {
    std::size_t offset = 0;
    ScalarType type = ScalarType::Float32;
  };
  /// Bytes of a record; the coordinates lie within them.
  std::size_t bytes = 0;
  std::array<Coordinate, 3> xyz{};
  /// Whether numbers are in the other byte order than this machine's.
  bool swapped = false;
  /// The type of the positions, as commonScalarType() gives it.
  ScalarType positionType = ScalarType::Float32;
};

/// Reads the positions of many binary records.
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
  /// Reads up to `count` records and writes three packed numbers each to `positions`. Fewer end
  /// with another status than Ok; at the end of the stream everything has been consumed.
  Result read(std::uint8_t* positions, std::size_t count);

 private:
  Result readPacked(std::uint8_t* positions, std::size_t count);
  Result readBlock(std::uint8_t* positions, std::size_t count);

  InputBuffer& in_;
  RecordLayout layout_;
  std::size_t pointBytes_;
  /// Whether records are what is wanted, byte for byte.
  bool packed_;
};

}  // namespace bspc::formats
