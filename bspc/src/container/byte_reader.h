#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "bspc/span.h"

namespace bspc::container {

/// Reads the format's elementary types; every step is checked against the end of the bytes.
/// Throws Error(Corrupt) that names the part of the file and the offset.
class ByteReader {
 public:
  /// For bytes whose place in the file is not known: errors tell the place among them.
  static constexpr std::uint64_t kNoOffset = ~std::uint64_t{0};

  /// `part` names what is read, e.g. "the head"; `fileOffset` is where the bytes stand in the file.
  ByteReader(ByteView bytes, std::string part, std::uint64_t fileOffset)
      : bytes_(bytes), part_(std::move(part)), fileOffset_(fileOffset) {}

  unsigned u8();
  std::uint64_t unsignedLittle(unsigned width);
  std::uint64_t varint();
  /// A varint of at most 32 bits.
  std::uint32_t varint32();
  std::int64_t signedVarint();
  ByteView bytes(std::uint64_t count);

  std::size_t position() const { return at_; }
  std::size_t remaining() const { return bytes_.size() - at_; }
  void expectEnd() const;
  /// Throws Error(Corrupt) with the part, the offset and `what`.
  [[noreturn]] void fail(const std::string& what) const;

 private:
  ByteView bytes_;
  std::string part_;
  std::uint64_t fileOffset_;
  std::size_t at_ = 0;
};

}  // namespace bspc::container
