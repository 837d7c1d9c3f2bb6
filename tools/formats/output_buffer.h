#pragma once

#include <cstddef>
#include <cstdint>
#include <ostream>
#include <string>

#include "bspc/progress.h"

namespace bspc::formats {

/// Collects output and hands it to a stream in large blocks. Throws FormatError if the stream
/// fails and Error(Cancelled) once `progress` asks to stop; finish() must be called for the last
/// block to be written.
class OutputBuffer {
 public:
  explicit OutputBuffer(std::ostream& out, ProgressCallback progress = {})
      : out_(out), progress_(std::move(progress)), start_(out.tellp()) {}

  /// Where to append; call advance() now and then.
  std::string& text() { return text_; }
  /// Hands a full block on; `done` of `all` items have been written.
  void advance(std::uint64_t done, std::uint64_t all) {
    if (text_.size() < kBlock) return;
    flush();
    report(done, all);
  }
  /// Writes bytes that need no copy, block by block.
  void write(const void* data, std::uint64_t size);
  /// Replaces the first bytes of all that was written, if the stream can go back. Only for streams
  /// that hold nothing else: where they append, the bytes would land at the end.
  void overwriteStart(const std::string& bytes);
  void finish();

 private:
  static constexpr std::size_t kBlock = std::size_t{1} << 18;

  void flush();
  void report(std::uint64_t done, std::uint64_t all);
  void requireGood();

  std::ostream& out_;
  ProgressCallback progress_;
  std::string text_;
  std::ostream::pos_type start_;
};

}  // namespace bspc::formats
