#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "bspc/span.h"
#include "container/block.h"
#include "container/file_head.h"

namespace bspc::fuzz {

/// A framed block that stands behind the chunks.
struct FramedBlock {
  unsigned type = 0;
  Bytes content;
};

/// A .bspc file as its parts, right or not, that it can be put together from again.
struct FileModel {
  unsigned versionMinor = 0;
  container::FileHead head;  ///< has the tiles in both layouts
  /// Payloads by tile and by column of the layout; those of columns without chunk do not count.
  std::vector<std::vector<Bytes>> chunks;
  std::vector<FramedBlock> blocks;

  /// Gives every table as many entries as the head says.
  void normalise();
};

/// Takes a file apart whatever its checksums; empty if its head cannot be understood.
std::optional<FileModel> takeApart(ByteView file);

/// A part of a file: a block that gets a frame, a payload that gets a checksum, or bytes as they
/// are.
struct Piece {
  enum class Kind { Raw, Block, Chunk, EndBlock };
  Kind kind = Kind::Raw;
  unsigned type = 0;  ///< of a block
  Bytes content;      ///< of an end block: none, it gets the place of the index
};

std::vector<Piece> piecesOf(FileModel model);
/// The bytes of a file with all checksums right.
Bytes putTogether(const std::vector<Piece>& pieces);

/// The same file with the checksums of the decoded points and cells right, and the numbers of
/// cells, where they can be decoded.
Bytes withRightContents(ByteView file);

}  // namespace bspc::fuzz
