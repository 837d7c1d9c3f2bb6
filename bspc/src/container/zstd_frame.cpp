#include "container/zstd_frame.h"

#include <zstd.h>

#include <cstdint>

namespace bspc::container {

namespace {

constexpr std::uint64_t kMostWindow = std::uint64_t{1} << kFrameWindowLog;

/// Bytes of the window that a frame says it needs. RFC 8878, section 3.1.1.1: behind four bytes
/// stands a descriptor, and behind that the window, unless the whole content is one segment.
std::uint64_t windowOf(ByteView frame) {
  const bool oneSegment = (frame[4] & 0x20) != 0;
  if (oneSegment) return ZSTD_getFrameContentSize(frame.data(), frame.size());
  const std::uint64_t base = std::uint64_t{1} << (10 + (frame[5] >> 3));
  return base + base / 8 * (frame[5] & 7);
}

}  // namespace

void checkFrame(const ByteReader& in, ByteView frame) {
  constexpr std::uint64_t kMagic = 0xFD2FB528;
  constexpr std::size_t kShortest = 6;
  std::uint64_t magic = 0;
  for (std::size_t i = 0; i < 4 && i < frame.size(); ++i) {
    magic |= std::uint64_t{frame[i]} << (8 * i);
  }
  if (frame.size() < kShortest || magic != kMagic) in.fail("no zstd frame where one is told");
  if (ZSTD_findFrameCompressedSize(frame.data(), frame.size()) != frame.size()) {
    in.fail("a zstd frame is damaged, or not alone where it stands");
  }
  if ((frame[4] & 3) != 0) in.fail("a zstd frame with a dictionary");
  if (windowOf(frame) > kMostWindow) in.fail("a zstd frame needs a window of more than 8 MiB");
}

}  // namespace bspc::container
