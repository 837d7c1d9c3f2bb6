#pragma once

#include <cstdint>
#include <string>

#include "bspc/io.h"
#include "bspc/span.h"

namespace bspc::container {

/// Types of framed blocks (docs/format.md, "Blocks"). A reader passes over unknown types from
/// kOptionalBlock on, and refuses other unknown ones.
enum class BlockType : std::uint8_t {
  Head = 1,
  Tile = 2,
  Index = 3,
  End = 4,
  Mesh = 5,
};
constexpr unsigned kOptionalBlock = 128;

/// Every End block: type, size, 8 bytes, checksum.
constexpr std::uint64_t kEndContent = 8;
constexpr std::uint64_t kEndBlock = 1 + 1 + kEndContent + 4;

/// Bytes of a framed block with `content` bytes.
std::uint64_t blockSize(std::uint64_t content);

/// A block: type, size as varint, content, checksum of all that together with `before` (bytes of
/// the file in front of the block that its checksum is to cover: the preamble for the head).
Bytes makeBlock(BlockType type, ByteView content, ByteView before = {});

struct Block {
  unsigned type = 0;
  Bytes content;
  std::uint64_t contentOffset = 0;  ///< in the file
  std::uint64_t end = 0;            ///< offset of what follows
};

/// Where a block stands, from its first bytes alone. Throws Error(Truncated) if the file ends
/// inside the block.
struct BlockFrame {
  unsigned type = 0;
  std::uint64_t contentOffset = 0;
  std::uint64_t content = 0;  ///< bytes
  std::uint64_t end = 0;
};
BlockFrame readFrame(ByteSource& source, std::uint64_t offset, const std::string& part);

/// Reads the block at `offset` and checks it; `covered` bytes before it belong to its checksum.
/// Throws Error(Truncated) if the file ends inside it, Error(Corrupt) on a wrong checksum.
Block readBlock(ByteSource& source, std::uint64_t offset, std::uint64_t covered,
                const std::string& part);

/// A chunk: payload and its checksum; sizes and places stand in the tile table.
std::uint64_t chunkSize(std::uint64_t payload);
Bytes makeChunk(Bytes payload);
/// Reads the chunk at `offset` (which the caller knows to lie inside the file) and checks it.
Bytes readChunk(ByteSource& source, std::uint64_t offset, std::uint64_t payload,
                const std::string& part);

}  // namespace bspc::container
