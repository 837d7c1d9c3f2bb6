#pragma once

#include <cstdint>
#include <vector>

#include "bspc/encoder.h"
#include "bspc/point_set.h"
#include "bspc/span.h"

namespace bspc {

/// How several processes write one file together (of the streaming layout): each codes its own
/// points and writes them at its place; nothing goes between them but short messages.
///
///   1. Everybody: describePart(); send the message to everybody.
///   2. Everybody: agreeOnParts(messages), then encodePart(); send FilePart::summary to one.
///   3. That one: frameParts(summaries); everybody writes FilePart::tiles at FileFrame::offsets of
///      its rank, one writes FileFrame::head at 0 and FileFrame::end at FileFrame::endOffset.
///
/// Messages are for processes of one program run; they are not a format.

/// What the others need to know of a part's points before they are coded: their range, and the
/// lattice that they lie on if options.grid is automatic. A part may be empty.
/// Throws Error as fitGrid() does.
Bytes describePart(const PointSetView& points, const EncodeOptions& options);

/// The options with which each part is to be encoded: one grid for all, which is exact for every
/// part where their lattices can be combined, and what else the encoder would choose for as many
/// points as there are together. `options` must be the same everywhere; so is then the result.
/// GridRequest::Precision restores to float64, since no part knows the rounding of the others.
/// Throws Error: InvalidArgument if parts differ in their scalar type, or for an array of original
/// ids (indices would be those of the parts); OutOfGrid.
EncodeOptions agreeOnParts(const std::vector<Bytes>& descriptions, const EncodeOptions& options);

/// One part of a file.
struct FilePart {
  Bytes tiles;          ///< as they stand in the file
  Bytes summary;        ///< what frameParts() needs of it
  EncodeReport report;  ///< of this part alone
};

/// Codes a part with what agreeOnParts() returned. Throws Error as encode() does.
FilePart encodePart(const PointSetView& points, const EncodeOptions& agreed);

/// What stands around the parts in the file.
struct FileFrame {
  Bytes head;
  std::vector<std::uint64_t> offsets;  ///< where the tiles of each part begin
  Bytes end;
  std::uint64_t endOffset = 0;
  std::uint64_t points = 0;
  std::uint64_t tiles = 0;
};

/// The frame of parts, which stand in the file in the order of their summaries. Throws
/// Error(InvalidArgument) naming a part whose arrays differ from those of the parts before it.
FileFrame frameParts(const std::vector<Bytes>& summaries);

}  // namespace bspc
