#include "container/byte_reader.h"

#include <limits>

#include "bspc/error.h"

namespace bspc::container {

void ByteReader::fail(const std::string& what) const {
  const std::string place = fileOffset_ == kNoOffset
                                ? std::to_string(at_) + " of it: "
                                : std::to_string(fileOffset_ + at_) + " of the file: ";
  throw Error(ErrorCode::Corrupt, part_ + ", byte " + place + what);
}

unsigned ByteReader::u8() {
  if (remaining() < 1) fail("ends early");
  return bytes_[at_++];
}

std::uint64_t ByteReader::unsignedLittle(unsigned width) {
  if (remaining() < width) fail("ends early");
  std::uint64_t value = 0;
  for (unsigned i = 0; i < width; ++i) value |= std::uint64_t{bytes_[at_ + i]} << (8 * i);
  at_ += width;
  return value;
}

std::uint64_t ByteReader::varint() {
  std::uint64_t value = 0;
  for (unsigned shift = 0; shift < 64; shift += 7) {
    const std::uint64_t byte = u8();
    const std::uint64_t part = byte & 127;
    if (shift == 63 && part > 1) fail("a number has more than 64 bits");
    value |= part << shift;
    if (byte == 0 && shift > 0) fail("a number is not written in its shortest form");
    if (byte < 128) return value;
  }
  fail("a number has more than 64 bits");
}

std::uint32_t ByteReader::varint32() {
  const std::uint64_t value = varint();
  if (value > std::numeric_limits<std::uint32_t>::max()) fail("a number has more than 32 bits");
  return static_cast<std::uint32_t>(value);
}

std::int64_t ByteReader::signedVarint() {
  const std::uint64_t bits = varint();
  const auto half = static_cast<std::int64_t>(bits >> 1);
  return (bits & 1) != 0 ? -half - 1 : half;
}

ByteView ByteReader::bytes(std::uint64_t count) {
  if (remaining() < count) fail("ends early");
  const ByteView view = bytes_.subspan(at_, static_cast<std::size_t>(count));
  at_ += view.size();
  return view;
}

void ByteReader::expectEnd() const {
  if (remaining() != 0) fail(std::to_string(remaining()) + " bytes too many");
}

}  // namespace bspc::container
