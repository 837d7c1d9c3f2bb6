#pragma once

#include <cstddef>
#include <cstdint>
#include <istream>
#include <vector>

#include "bspc/progress.h"

namespace bspc::formats {

/// Reads a stream in large blocks and shows them as contiguous memory, which grows only as bytes
/// arrive. The stream need not be seekable. Throws FormatError if the stream fails,
/// Error(Cancelled) once `progress` asks to stop.
class InputBuffer {
 public:
  explicit InputBuffer(std::istream& in, ProgressCallback progress = {});

  const char* data() const { return buffer_.data() + begin_; }
  std::size_t available() const { return end_ - begin_; }
  /// Bytes consumed since the start.
  std::uint64_t offset() const { return offset_; }

  /// Reads more behind what is available; false at the end of the stream. Moves data().
  bool fill();
  /// Whether `count` bytes are available, after reading as much as that takes.
  bool ensure(std::size_t count) {
    while (available() < count) {
      if (!fill()) return false;
    }
    return true;
  }
  /// The caller keeps `count` within available().
  void consume(std::size_t count) {
    begin_ += count;
    offset_ += count;
  }

  /// Copies up to `count` bytes to `to`; fewer only at the end of the stream.
  std::size_t read(std::uint8_t* to, std::size_t count);
  /// Passes over up to `count` bytes; fewer only at the end of the stream.
  std::uint64_t skip(std::uint64_t count);

  /// Whether the stream can go back, as files can and pipes cannot.
  bool canSeek() const { return canSeek_; }
  /// Goes back to the byte of this offset. Throws FormatError if the stream cannot.
  void seek(std::uint64_t offset);

  /// How many items of at least `bytes` each there is memory to be set aside for, if a header
  /// claims `claimed` of them: never more than the stream can hold, 0 if that is not known.
  std::size_t reservable(std::uint64_t claimed, std::size_t bytes) const;

 private:
  std::size_t readStream(char* to, std::size_t count);
  void report();

  std::istream& in_;
  ProgressCallback progress_;
  std::vector<char> buffer_;
  std::size_t begin_ = 0;
  std::size_t end_ = 0;
  std::uint64_t offset_ = 0;
  /// From the start to the end; 0 if that is not known.
  std::uint64_t streamBytes_ = 0;
  bool canSeek_ = false;
  std::istream::pos_type start_ = 0;
};

}  // namespace bspc::formats
