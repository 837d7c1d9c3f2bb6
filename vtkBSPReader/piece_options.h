#pragma once

#include <cstdint>

#include "bspc/decoder.h"

namespace bspc::vtk {

/// The tiles of piece `piece` of `pieces`: pieces follow each other through the file, have about
/// the same number of points, and together are the whole.
TileRange tilesOfPiece(const FileInfo& info, std::uint64_t piece, std::uint64_t pieces);

/// Options that decode one piece of what `whole` decodes: all pieces have the level of the whole,
/// and share its maxPoints.
DecodeOptions optionsOfPiece(const Decoder& decoder, DecodeOptions whole, std::uint64_t piece,
                             std::uint64_t pieces);

}  // namespace bspc::vtk
