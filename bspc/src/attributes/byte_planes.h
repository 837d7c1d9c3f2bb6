#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "attributes/memory_budget.h"
#include "bspc/span.h"
#include "container/byte_reader.h"
#include "container/byte_writer.h"

struct ZSTD_CCtx_s;
struct ZSTD_DCtx_s;

namespace bspc::attributes {

/// Writes rows of bytes, each packed by zstd where that helps.
class PlaneWriter {
 public:
  /// `level` is zstd's.
  explicit PlaneWriter(int level);

  /// Appends a row; its size is not written.
  void write(ByteView row, container::ByteWriter& out);

 private:
  struct Free {
    void operator()(ZSTD_CCtx_s* context) const;
  };
  int level_;
  std::unique_ptr<ZSTD_CCtx_s, Free> context_;
  Bytes packed_;
};

/// Reads what PlaneWriter wrote. Throws Error(Corrupt) on anything else.
class PlaneReader {
 public:
  PlaneReader();

  /// Fills `row`, which has the size of the row that was written.
  void read(container::ByteReader& in, Span<std::uint8_t> row);

  /// Reads a row whose size nothing but the payload vouches for: memory grows as it is unpacked.
  Bytes readClaimed(container::ByteReader& in, std::uint64_t size, MemoryBudget& budget);

 private:
  struct Free {
    void operator()(ZSTD_DCtx_s* context) const;
  };
  std::unique_ptr<ZSTD_DCtx_s, Free> context_;
};

}  // namespace bspc::attributes
