#include "container/packed_bytes.h"

#include <zstd.h>

#include <algorithm>
#include <memory>
#include <new>
#include <string>

#include "bspc/error.h"
#include "container/zstd_frame.h"

namespace bspc::container {

namespace {

enum Packing : unsigned { kPlain = 0, kZstd = 1 };

using Stream = std::unique_ptr<ZSTD_DStream, decltype(&ZSTD_freeDStream)>;

[[noreturn]] void failLimit(std::uint64_t maxBytes) {
  throw Error(ErrorCode::LimitExceeded,
              "what a file says beside its points takes more than the limit of " +
                  std::to_string(maxBytes) +
                  " bytes; raise the limit of memory if the file is to be trusted");
}

Bytes unpack(ByteReader& in, std::uint64_t maxBytes) {
  const ByteView packed = in.bytes(in.remaining());
  checkFrame(in, packed);
  const Stream stream(ZSTD_createDStream(), &ZSTD_freeDStream);
  if (!stream) throw std::bad_alloc();
  Bytes bytes;
  Bytes piece(std::size_t{1} << 16);
  ZSTD_inBuffer input{packed.data(), packed.size(), 0};
  for (;;) {
    ZSTD_outBuffer output{piece.data(), piece.size(), 0};
    const std::size_t left = ZSTD_decompressStream(stream.get(), &output, &input);
    if (ZSTD_isError(left) != 0) in.fail("damaged compressed bytes");
    if (output.pos > maxBytes || bytes.size() > maxBytes - output.pos) failLimit(maxBytes);
    bytes.insert(bytes.end(), piece.begin(),
                 piece.begin() + static_cast<std::ptrdiff_t>(output.pos));
    if (left == 0) break;
    if (input.pos == input.size && output.pos < output.size) in.fail("compressed bytes end early");
  }
  return bytes;
}

}  // namespace

void writePacked(ByteWriter& out, ByteView bytes, int level) {
  Bytes packed(ZSTD_compressBound(bytes.size()));
  const std::size_t size =
      ZSTD_compress(packed.data(), packed.size(), bytes.data(), bytes.size(), level);
  if (ZSTD_isError(size) == 0 && size < bytes.size()) {
    out.u8(kZstd);
    out.bytes(ByteView(packed.data(), size));
    return;
  }
  out.u8(kPlain);
  out.bytes(bytes);
}

Bytes readPacked(ByteReader& in, std::uint64_t maxBytes) {
  const unsigned packing = in.u8();
  if (packing == kZstd) return unpack(in, maxBytes);
  if (packing != kPlain) in.fail("bytes are packed in an unknown way");
  const ByteView bytes = in.bytes(in.remaining());
  return {bytes.begin(), bytes.end()};
}

}  // namespace bspc::container
