#include "container/byte_writer.h"

namespace bspc::container {

void ByteWriter::unsignedLittle(std::uint64_t value, unsigned width) {
  for (unsigned i = 0; i < width; ++i) u8(static_cast<unsigned>((value >> (8 * i)) & 255));
}

void ByteWriter::varint(std::uint64_t value) {
  while (value >= 128) {
    u8(static_cast<unsigned>(value & 127) | 128U);
    value >>= 7;
  }
  u8(static_cast<unsigned>(value));
}

void ByteWriter::signedVarint(std::int64_t value) {
  const auto bits = static_cast<std::uint64_t>(value);
  varint((bits << 1) ^ (value < 0 ? ~std::uint64_t{0} : 0));
}

void ByteWriter::bytes(ByteView view) { bytes_.insert(bytes_.end(), view.begin(), view.end()); }

std::size_t varintSize(std::uint64_t value) {
  std::size_t size = 1;
  while (value >= 128) {
    value >>= 7;
    ++size;
  }
  return size;
}

}  // namespace bspc::container
