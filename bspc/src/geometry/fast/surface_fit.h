#pragma once

#include "geometry/fast/chunk_coder.h"

namespace bspc::geometry::fast {

/// What the encoder tries; the decoder does not depend on it.
struct FitOptions {
  bool quadrics = true;
};

/// Chooses mode, class and surface of a chunk whose u, v, w are set, and sets its residuals.
/// Returns an estimate of the bits that its heights take.
float fitSurface(Chunk& chunk, const SurfaceHistory& history, std::uint32_t lastHeight,
                 const FitOptions& options);

/// Class of gaps; also returns an estimate of their bits.
float chooseGapClass(Chunk& chunk);

/// Sets the residuals of the chunk's surface.
void setResiduals(Chunk& chunk, std::uint32_t lastHeight);

}  // namespace bspc::geometry::fast
