#include <lzma.h>
#include <zstd.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <stdexcept>

#include "codec.h"

namespace bspc::bench {

namespace {

/// Sorted, as differences whose sign is in the lowest bit, all first bytes first.
Bytes inPlanes(const Coordinates& xyz) {
  const std::vector<std::array<std::int32_t, 3>> points = sortedPoints(xyz);
  const std::size_t plane = xyz.size();
  Bytes bytes(plane * sizeof(std::uint32_t));
  std::array<std::int32_t, 3> last{};
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int64_t d = std::int64_t{points[i][k]} - last[k];
      const auto folded = static_cast<std::uint32_t>(d >= 0 ? 2 * d : -2 * d - 1);
      for (std::size_t b = 0; b < sizeof(folded); ++b) {
        bytes[b * plane + k * points.size() + i] = static_cast<std::uint8_t>(folded >> (8 * b));
      }
    }
    last = points[i];
  }
  return bytes;
}

Coordinates fromPlanes(const Bytes& bytes) {
  const std::size_t plane = bytes.size() / sizeof(std::uint32_t);
  const std::size_t count = plane / 3;
  Coordinates xyz(plane);
  std::array<std::int64_t, 3> last{};
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      std::uint32_t folded = 0;
      for (std::size_t b = 0; b < sizeof(folded); ++b) {
        folded |= std::uint32_t{bytes[b * plane + k * count + i]} << (8 * b);
      }
      const std::int64_t half = folded >> 1U;
      last[k] += (folded & 1U) == 0 ? half : -half - 1;
      xyz[3 * i + k] = static_cast<std::int32_t>(last[k]);
    }
  }
  return xyz;
}

/// The size of what is packed stands in front of it.
constexpr std::size_t kSizeBytes = 8;

std::uint64_t unpackedSize(const Bytes& bytes) {
  std::uint64_t size = 0;
  if (bytes.size() < kSizeBytes) throw std::runtime_error("the packed bytes are too few");
  std::memcpy(&size, bytes.data(), kSizeBytes);
  return size;
}

void checkZstd(std::size_t result) {
  if (ZSTD_isError(result) != 0) {
    throw std::runtime_error(std::string("zstd: ") + ZSTD_getErrorName(result));
  }
}

Bytes zstdPack(const Bytes& bytes, int level, unsigned threads) {
  const std::unique_ptr<ZSTD_CCtx, std::size_t (*)(ZSTD_CCtx*)> context(ZSTD_createCCtx(),
                                                                        ZSTD_freeCCtx);
  checkZstd(ZSTD_CCtx_setParameter(context.get(), ZSTD_c_compressionLevel, level));
  if (threads > 1) {
    checkZstd(ZSTD_CCtx_setParameter(context.get(), ZSTD_c_nbWorkers, static_cast<int>(threads)));
  }
  Bytes packed(kSizeBytes + ZSTD_compressBound(bytes.size()));
  const std::uint64_t size = bytes.size();
  std::memcpy(packed.data(), &size, kSizeBytes);
  const std::size_t used = ZSTD_compress2(context.get(), packed.data() + kSizeBytes,
                                          packed.size() - kSizeBytes, bytes.data(), bytes.size());
  checkZstd(used);
  packed.resize(kSizeBytes + used);
  return packed;
}

Bytes zstdUnpack(const Bytes& packed) {
  Bytes bytes(unpackedSize(packed));
  checkZstd(ZSTD_decompress(bytes.data(), bytes.size(), packed.data() + kSizeBytes,
                            packed.size() - kSizeBytes));
  return bytes;
}

/// Everything through an open coder, from memory to memory.
std::size_t runLzma(lzma_stream& stream, const std::uint8_t* in, std::size_t inSize,
                    std::uint8_t* out, std::size_t outSize) {
  stream.next_in = in;
  stream.avail_in = inSize;
  stream.next_out = out;
  stream.avail_out = outSize;
  const lzma_ret result = lzma_code(&stream, LZMA_FINISH);
  lzma_end(&stream);
  if (result != LZMA_STREAM_END) throw std::runtime_error("xz: the coder failed");
  return outSize - stream.avail_out;
}

Bytes xzPack(const Bytes& bytes, std::uint32_t preset, unsigned threads) {
  lzma_stream stream = LZMA_STREAM_INIT;
  lzma_mt settings{};
  settings.threads = std::max(1U, threads);
  settings.preset = preset;
  settings.check = LZMA_CHECK_CRC64;
  const lzma_ret ready = threads > 1 ? lzma_stream_encoder_mt(&stream, &settings)
                                     : lzma_easy_encoder(&stream, preset, LZMA_CHECK_CRC64);
  if (ready != LZMA_OK) throw std::runtime_error("xz: the coder does not start");
  constexpr std::size_t kSlack = std::size_t{1} << 16;
  Bytes packed(kSizeBytes + kSlack + lzma_stream_buffer_bound(bytes.size()));
  const std::uint64_t size = bytes.size();
  std::memcpy(packed.data(), &size, kSizeBytes);
  packed.resize(kSizeBytes + runLzma(stream, bytes.data(), bytes.size(), packed.data() + kSizeBytes,
                                     packed.size() - kSizeBytes));
  return packed;
}

Bytes xzUnpack(const Bytes& packed) {
  lzma_stream stream = LZMA_STREAM_INIT;
  if (lzma_stream_decoder(&stream, UINT64_MAX, 0) != LZMA_OK) {
    throw std::runtime_error("xz: the decoder does not start");
  }
  Bytes bytes(unpackedSize(packed));
  runLzma(stream, packed.data() + kSizeBytes, packed.size() - kSizeBytes, bytes.data(),
          bytes.size());
  return bytes;
}

Codec zstdCodec(int level) {
  return {"zstd -" + std::to_string(level) + ", sorted", true,
          [level](const Coordinates& xyz, unsigned threads) {
            return zstdPack(inPlanes(xyz), level, threads);
          },
          [](const Bytes& bytes, unsigned /*threads*/) { return fromPlanes(zstdUnpack(bytes)); }};
}

Codec xzCodec(const char* name, std::uint32_t preset) {
  return {std::string(name) + ", sorted", true,
          [preset](const Coordinates& xyz, unsigned threads) {
            return xzPack(inPlanes(xyz), preset, threads);
          },
          [](const Bytes& bytes, unsigned /*threads*/) { return fromPlanes(xzUnpack(bytes)); }};
}

}  // namespace

std::vector<Codec> generalCodecs() {
  constexpr int kQuick = 3;
  constexpr int kSmall = 19;
  constexpr std::uint32_t kDefault = 6;
  constexpr std::uint32_t kMost = 9;
  return {zstdCodec(kQuick), zstdCodec(kSmall), xzCodec("xz -6", kDefault),
          xzCodec("xz -9e", kMost | LZMA_PRESET_EXTREME)};
}

}  // namespace bspc::bench
