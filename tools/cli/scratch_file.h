#pragma once

#include <cstdint>
#include <memory>

#include "bspc/stream_encoder.h"

namespace bspc::cli {

/// A temporary file in the folder that TMPDIR names (or /tmp). It has no name from the moment it is
/// open, so nothing stays behind however the program ends.
class ScratchFile final : public ScratchStorage {
 public:
  /// Throws Error(Io).
  ScratchFile();
  ~ScratchFile() override;
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;

  std::uint64_t size() const override { return size_; }
  void read(std::uint64_t offset, Span<std::uint8_t> into) override;
  void append(ByteView bytes) override;

 private:
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
};

}  // namespace bspc::cli
