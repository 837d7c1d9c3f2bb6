#include <gtest/gtest.h>

#include <cstdint>
#include <limits>

#include "bspc/error.h"
#include "container/byte_reader.h"
#include "container/byte_writer.h"

namespace bspc::container {
namespace {

TEST(ElementaryTypes, VarintsComeBack) {
  constexpr std::uint64_t kTop = std::numeric_limits<std::uint64_t>::max();
  for (const std::uint64_t v : {std::uint64_t{0}, std::uint64_t{127}, std::uint64_t{128},
                                std::uint64_t{16383}, std::uint64_t{16384}, kTop - 1, kTop}) {
    ByteWriter out;
    out.varint(v);
    EXPECT_EQ(out.size(), varintSize(v));
    ByteReader in(out.data(), "test", 0);
    EXPECT_EQ(in.varint(), v);
    EXPECT_NO_THROW(in.expectEnd());
  }
}

TEST(ElementaryTypes, SignedVarintsComeBack) {
  for (const std::int64_t v :
       {std::int64_t{0}, std::int64_t{-1}, std::int64_t{1}, std::int64_t{-64}, std::int64_t{64},
        std::numeric_limits<std::int64_t>::min(), std::numeric_limits<std::int64_t>::max()}) {
    ByteWriter out;
    out.signedVarint(v);
    ByteReader in(out.data(), "test", 0);
    EXPECT_EQ(in.signedVarint(), v);
  }
}

void expectCorrupt(const Bytes& bytes) {
  ByteReader in(bytes, "test", 0);
  try {
    in.varint();
    ADD_FAILURE() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::Corrupt);
  }
}

TEST(ElementaryTypes, ImproperVarintsAreRefused) {
  expectCorrupt({});                                                     // nothing
  expectCorrupt({0x80});                                                 // cut short
  expectCorrupt({0x80, 0x00});                                           // too long a form
  expectCorrupt({255, 255, 255, 255, 255, 255, 255, 255, 255, 2});       // 65 bits
  expectCorrupt({255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 1});  // 71 bits
}

TEST(ElementaryTypes, MessagesNameThePartAndTheOffsetInTheFile) {
  const Bytes bytes{1, 2};
  ByteReader in(bytes, "the head", 100);
  in.u8();
  try {
    in.unsignedLittle(4);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()), "the head, byte 101 of the file: ends early");
  }
}

}  // namespace
}  // namespace bspc::container
