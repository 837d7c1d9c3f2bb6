#include "bspc/io.h"

#include <algorithm>
#include <cstring>
#include <string>

#include "bspc/error.h"

namespace bspc {

void MemorySource::read(std::uint64_t offset, Span<std::uint8_t> into) {
  if (offset > bytes_.size() || into.size() > bytes_.size() - offset) {
    throw Error(ErrorCode::Io, "a read past the end of a memory buffer of " +
                                   std::to_string(bytes_.size()) + " bytes");
  }
  if (!into.empty()) {
    std::memcpy(into.data(), bytes_.data() + static_cast<std::size_t>(offset), into.size());
  }
}

void MemorySink::write(ByteView bytes) { bytes_.insert(bytes_.end(), bytes.begin(), bytes.end()); }

StreamSource::StreamSource(std::istream& stream) : stream_(stream) {
  stream_.clear();
  stream_.seekg(0, std::ios::end);
  const auto end = stream_.tellg();
  if (!stream_ || end < 0) throw Error(ErrorCode::Io, "the input cannot be searched for its size");
  size_ = static_cast<std::uint64_t>(end);
}

void StreamSource::read(std::uint64_t offset, Span<std::uint8_t> into) {
  stream_.clear();
  stream_.seekg(static_cast<std::streamoff>(offset));
  stream_.read(reinterpret_cast<char*>(into.data()), static_cast<std::streamsize>(into.size()));
  if (!stream_) {
    throw Error(ErrorCode::Io, "could not read " + std::to_string(into.size()) + " bytes at byte " +
                                   std::to_string(offset));
  }
}

void StreamSink::write(ByteView bytes) {
  stream_.write(reinterpret_cast<const char*>(bytes.data()),
                static_cast<std::streamsize>(bytes.size()));
  if (!stream_) {
    throw Error(ErrorCode::Io,
                "could not write " + std::to_string(bytes.size()) + " bytes; is the disk full?");
  }
}

}  // namespace bspc
