#include "attributes/byte_planes.h"

#include <zstd.h>

#include <algorithm>
#include <new>
#include <string>

#include "container/zstd_frame.h"

namespace bspc::attributes {

namespace {

/// A row's first number: how it is stored, or the size of its zstd frame (which is never so small).
enum RowKind : std::uint8_t { kEqualBytes = 0, kPlainBytes = 1, kLeastFrame = 2 };

}  // namespace

void PlaneWriter::Free::operator()(ZSTD_CCtx_s* context) const { ZSTD_freeCCtx(context); }
void PlaneReader::Free::operator()(ZSTD_DCtx_s* context) const { ZSTD_freeDCtx(context); }

PlaneWriter::PlaneWriter(int level) : level_(level), context_(ZSTD_createCCtx()) {
  if (!context_) throw std::bad_alloc();
}

void PlaneWriter::write(ByteView row, container::ByteWriter& out) {
  if (!row.empty() && std::all_of(row.begin(), row.end(),
                                  [first = row[0]](std::uint8_t b) { return b == first; })) {
    out.varint(kEqualBytes);
    out.u8(row[0]);
    return;
  }
  packed_.resize(ZSTD_compressBound(row.size()));
  const std::size_t size = ZSTD_compressCCtx(context_.get(), packed_.data(), packed_.size(),
                                             row.data(), row.size(), level_);
  if (ZSTD_isError(size) != 0 || size >= row.size() || size < kLeastFrame) {
    out.varint(kPlainBytes);
    out.bytes(row);
    return;
  }
  out.varint(size);
  out.bytes({packed_.data(), size});
}

PlaneReader::PlaneReader() : context_(ZSTD_createDCtx()) {
  if (!context_) throw std::bad_alloc();
}

void PlaneReader::read(container::ByteReader& in, Span<std::uint8_t> row) {
  const std::uint64_t kind = in.varint();
  if (kind == kEqualBytes) {
    std::fill(row.begin(), row.end(), static_cast<std::uint8_t>(in.u8()));
    return;
  }
  if (kind == kPlainBytes) {
    const ByteView plain = in.bytes(row.size());
    std::copy(plain.begin(), plain.end(), row.begin());
    return;
  }
  const ByteView frame = in.bytes(kind);
  container::checkFrame(in, frame);
  const std::size_t size =
      ZSTD_decompressDCtx(context_.get(), row.data(), row.size(), frame.data(), frame.size());
  if (ZSTD_isError(size) != 0) {
    in.fail(std::string("a zstd frame is damaged (") + ZSTD_getErrorName(size) + ")");
  }
  if (size != row.size()) {
    in.fail("a zstd frame gives " + std::to_string(size) + " bytes instead of " +
            std::to_string(row.size()));
  }
}

Bytes PlaneReader::readClaimed(container::ByteReader& in, std::uint64_t size,
                               MemoryBudget& budget) {
  const std::uint64_t kind = in.varint();
  if (kind == kEqualBytes) {
    budget.take(size);
    return Bytes(static_cast<std::size_t>(size), static_cast<std::uint8_t>(in.u8()));
  }
  if (kind == kPlainBytes) {
    const ByteView plain = in.bytes(size);
    budget.take(size);
    return Bytes(plain.begin(), plain.end());
  }
  const ByteView frame = in.bytes(kind);
  container::checkFrame(in, frame);
  ZSTD_DCtx_reset(context_.get(), ZSTD_reset_session_and_parameters);
  ZSTD_DCtx_setParameter(context_.get(), ZSTD_d_windowLogMax, container::kFrameWindowLog);
  constexpr std::uint64_t kStep = 65536;
  Bytes result;
  ZSTD_inBuffer input{frame.data(), frame.size(), 0};
  std::size_t filled = 0;
  for (std::size_t left = 1; left != 0;) {
    if (filled == result.size()) {
      const std::uint64_t more = std::min<std::uint64_t>(
          std::max<std::uint64_t>(result.size(), kStep), size - result.size());
      // One byte beyond the claim would show that the frame holds more.
      if (more == 0) in.fail("a zstd frame gives more than " + std::to_string(size) + " bytes");
      budget.take(result.size() + more);
      result.resize(result.size() + static_cast<std::size_t>(more));
    }
    ZSTD_outBuffer output{result.data(), result.size(), filled};
    left = ZSTD_decompressStream(context_.get(), &output, &input);
    if (ZSTD_isError(left) != 0) {
      in.fail(std::string("a zstd frame is damaged (") + ZSTD_getErrorName(left) + ")");
    }
    if (output.pos == filled && input.pos == input.size && left != 0) {
      in.fail("a zstd frame ends early");
    }
    filled = output.pos;
  }
  if (filled != size || input.pos != input.size) {
    in.fail("a zstd frame does not give " + std::to_string(size) + " bytes");
  }
  return result;
}

}  // namespace bspc::attributes
