#pragma once

#include <cstdint>
#include <istream>
#include <ostream>

#include "bspc/span.h"

namespace bspc {

/// Random access to the bytes of a file. Implementations throw Error(Io) on failure.
class ByteSource {
 public:
  virtual ~ByteSource() = default;
  virtual std::uint64_t size() const = 0;
  /// Fills `into` from `offset` on. The caller keeps offset + into.size() within size().
  virtual void read(std::uint64_t offset, Span<std::uint8_t> into) = 0;
};

/// Where an encoder writes, front to back. Implementations throw Error(Io) on failure.
class ByteSink {
 public:
  virtual ~ByteSink() = default;
  virtual void write(ByteView bytes) = 0;
};

/// Reads from memory that the caller keeps alive.
class MemorySource final : public ByteSource {
 public:
  explicit MemorySource(ByteView bytes) : bytes_(bytes) {}
  std::uint64_t size() const override { return bytes_.size(); }
  void read(std::uint64_t offset, Span<std::uint8_t> into) override;

 private:
  ByteView bytes_;
};

/// Collects what is written.
class MemorySink final : public ByteSink {
 public:
  void write(ByteView bytes) override;
  const Bytes& bytes() const { return bytes_; }
  Bytes take() { return std::move(bytes_); }

 private:
  Bytes bytes_;
};

/// Reads from a seekable stream that the caller keeps alive (opened in binary mode).
class StreamSource final : public ByteSource {
 public:
  explicit StreamSource(std::istream& stream);
  std::uint64_t size() const override { return size_; }
  void read(std::uint64_t offset, Span<std::uint8_t> into) override;

 private:
  std::istream& stream_;
  std::uint64_t size_ = 0;
};

/// Writes to a stream that the caller keeps alive (opened in binary mode); need not be seekable.
class StreamSink final : public ByteSink {
 public:
  explicit StreamSink(std::ostream& stream) : stream_(stream) {}
  void write(ByteView bytes) override;

 private:
  std::ostream& stream_;
};

}  // namespace bspc
