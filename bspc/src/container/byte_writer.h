#pragma once

#include <cstddef>
#include <cstdint>

#include "bspc/span.h"

namespace bspc::container {

/// Appends the format's elementary types to a byte string (docs/format.md, "Elementary types").
class ByteWriter {
 public:
  void u8(unsigned value) { bytes_.push_back(static_cast<std::uint8_t>(value)); }
  /// Little-endian, `width` ≤ 8 bytes.
  void unsignedLittle(std::uint64_t value, unsigned width);
  /// Seven bits a byte, lowest first, the top bit set on all but the last.
  void varint(std::uint64_t value);
  /// Zigzag: 0, −1, 1, −2, … as a varint.
  void signedVarint(std::int64_t value);
  void bytes(ByteView view);
  /// Makes room for so many bytes more.
  void reserve(std::size_t more) { bytes_.reserve(bytes_.size() + more); }

  std::size_t size() const { return bytes_.size(); }
  const Bytes& data() const { return bytes_; }
  Bytes take() { return std::move(bytes_); }

 private:
  Bytes bytes_;
};

/// Bytes that ByteWriter::varint() takes for `value`.
std::size_t varintSize(std::uint64_t value);

}  // namespace bspc::container
