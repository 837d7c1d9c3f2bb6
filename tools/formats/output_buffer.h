#pragma once

#include <cstddef>
#include <cstdint>
#include <ostream>
#include <string>

namespace bspc::formats {

/// Collects output and hands it to a stream in large blocks. Throws FormatError if the stream
/// fails; finish() must be called for the last block to be written.
class OutputBuffer {
 public:
  explicit OutputBuffer(std::ostream& out) : out_(out) {}

  /// Where to append; call flushIfFull() now and then.
  std::string& text() { return text_; }
  void flushIfFull() {
    if (text_.size() >= kBlock) flush();
  }
  /// Writes bytes that need no copy.
  void write(const void* data, std::uint64_t size);
  void finish();

 private:
  static constexpr std::size_t kBlock = std::size_t{1} << 18;

  void flush();
  void requireGood();

  std::ostream& out_;
  std::string text_;
};

}  // namespace bspc::formats
