#include "container/block.h"

#include <algorithm>
#include <array>

#include "bspc/error.h"
#include "container/byte_reader.h"
#include "container/byte_writer.h"
#include "container/checksum.h"

namespace bspc::container {

namespace {

/// Type byte and the longest varint.
constexpr std::uint64_t kMaxFrame = 1 + 10;

[[noreturn]] void failTruncated(const std::string& part, std::uint64_t fileSize) {
  throw Error(ErrorCode::Truncated,
              "the file ends early, at byte " + std::to_string(fileSize) + ", inside " + part);
}

[[noreturn]] void failChecksum(const std::string& part, std::uint64_t offset) {
  throw Error(ErrorCode::Corrupt, part + " at byte " + std::to_string(offset) +
                                      " is damaged (wrong checksum); get the file again");
}

void append(Bytes& to, ByteView from) { to.insert(to.end(), from.begin(), from.end()); }

std::uint64_t storedChecksum(const std::uint8_t* p, unsigned width) {
  std::uint64_t value = 0;
  for (unsigned i = 0; i < width; ++i) value |= std::uint64_t{p[i]} << (8 * i);
  return value;
}

}  // namespace

std::uint64_t blockSize(std::uint64_t content) {
  return 1 + varintSize(content) + content + checksumWidth(content);
}

Bytes makeBlock(BlockType type, ByteView content, ByteView before) {
  ByteWriter frame;
  frame.u8(static_cast<unsigned>(type));
  frame.varint(content.size());
  frame.bytes(content);
  Bytes covered(before.begin(), before.end());
  append(covered, frame.data());
  const unsigned width = checksumWidth(content.size());
  frame.unsignedLittle(checksum(covered, width), width);
  return frame.take();
}

BlockFrame readFrame(ByteSource& source, std::uint64_t offset, const std::string& part) {
  const std::uint64_t size = source.size();
  if (offset >= size) failTruncated(part, size);
  Bytes bytes(static_cast<std::size_t>(std::min(kMaxFrame, size - offset)));
  source.read(offset, bytes);
  ByteReader in(bytes, part, offset);
  BlockFrame frame;
  frame.type = in.u8();
  try {
    frame.content = in.varint();
  } catch (const Error&) {
    if (bytes.size() < kMaxFrame) failTruncated(part, size);
    throw;
  }
  frame.contentOffset = offset + in.position();
  const unsigned width = checksumWidth(frame.content);
  if (frame.content > size - frame.contentOffset ||
      size - frame.contentOffset - frame.content < width) {
    failTruncated(part, size);
  }
  frame.end = frame.contentOffset + frame.content + width;
  return frame;
}

Block readBlock(ByteSource& source, std::uint64_t offset, std::uint64_t covered,
                const std::string& part) {
  const BlockFrame frame = readFrame(source, offset, part);
  const unsigned width = checksumWidth(frame.content);
  Block block;
  block.type = frame.type;
  block.contentOffset = frame.contentOffset;
  block.end = frame.end;
  Bytes whole(static_cast<std::size_t>(block.end - offset + covered));
  source.read(offset - covered, whole);
  const std::size_t hashed = whole.size() - width;
  if (checksum(ByteView(whole.data(), hashed), width) !=
      storedChecksum(whole.data() + hashed, width)) {
    failChecksum(part, offset);
  }
  const auto first = whole.begin() + static_cast<std::ptrdiff_t>(hashed - frame.content);
  block.content.assign(first, first + static_cast<std::ptrdiff_t>(frame.content));
  return block;
}

std::uint64_t chunkSize(std::uint64_t payload) { return payload + checksumWidth(payload); }

Bytes makeChunk(Bytes payload) {
  const unsigned width = checksumWidth(payload.size());
  ByteWriter sum;
  sum.unsignedLittle(checksum(payload, width), width);
  append(payload, sum.data());
  return payload;
}

Bytes readChunk(ByteSource& source, std::uint64_t offset, std::uint64_t payload,
                const std::string& part) {
  const unsigned width = checksumWidth(payload);
  Bytes chunk(static_cast<std::size_t>(payload + width));
  source.read(offset, chunk);
  const auto size = static_cast<std::size_t>(payload);
  if (checksum(ByteView(chunk.data(), size), width) != storedChecksum(chunk.data() + size, width)) {
    failChecksum(part, offset);
  }
  chunk.resize(size);
  return chunk;
}

}  // namespace bspc::container
