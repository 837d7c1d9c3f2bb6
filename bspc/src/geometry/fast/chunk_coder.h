#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "bspc/error.h"
#include "geometry/fast/cell.h"
#include "geometry/fast/chunk_streams.h"
#include "geometry/fast/surface_model.h"

namespace bspc::geometry::fast {

/// Up to kChunkPoints consecutive points of a slab, in local coordinates.
struct Chunk {
  template <class T>
  using PerPoint = std::array<T, kChunkPoints>;

  std::size_t count = 0;
  unsigned gapClass = 0;
  PerPoint<std::uint64_t> gaps;  ///< between codes along the curve
  PerPoint<std::uint32_t> u;
  PerPoint<std::uint32_t> v;
  PerPoint<std::uint32_t> w;
  Footprint footprint;  ///< not of Delta chunks
  PerPoint<std::int32_t> x;
  PerPoint<std::int32_t> y;  ///< normalised u, v; only of Plane and Quadric chunks
  unsigned residualClass = 0;
  Surface surface;
  PerPoint<std::uint32_t> residuals;  ///< zigzag
  PerPoint<std::uint32_t> cutOff;     ///< low bits of u, v, w below the frame's levels
};

/// The bitstream of chunks, for encoder (Io = ChunkWriter) and decoder (Io = ChunkReader) alike:
/// the reader fills in what the writer finds in the chunk.
template <class Io>
class ChunkCoder {
 public:
  explicit ChunkCoder(Io& io) : io_(io) {}

  void codeGaps(Chunk& chunk) {
    chunk.gapClass = codeClass(kGapClass, chunk.gapClass, gapClass_, kGapClasses);
    io_.gapValues(chunk.gapClass, chunk.gaps.data(), chunk.count);
  }

  /// Mode, surface and residuals; (u, v) of the chunk must be known.
  void codeHeights(Chunk& chunk, const SurfaceHistory& history) {
    codeSurface(chunk, history);
    io_.residualValues(chunk.residualClass, chunk.residuals.data(), chunk.count);
  }

  void codeCutOff(Chunk& chunk, unsigned width) {
    if (width == 0) return;
    for (std::size_t i = 0; i < chunk.count; ++i) {
      chunk.cutOff[i] = static_cast<std::uint32_t>(io_.rawField(chunk.cutOff[i], width));
    }
  }

 private:
  unsigned codeClass(Field field, unsigned cls, unsigned& last, const ValueClasses& classes) {
    const std::int64_t change =
        unzigzag(io_.field(field, zigzag(static_cast<std::int64_t>(cls) - last)));
    const std::int64_t now = std::int64_t{last} + change;
    if (now < 0 || now > classes.last()) {
      throw Error(ErrorCode::Corrupt, "a chunk of points has values of an impossible class");
    }
    last = static_cast<unsigned>(now);
    return last;
  }

  std::int64_t codeDifference(Field field, std::int64_t value, std::int64_t expected) {
    return expected + unzigzag(io_.field(field, zigzag(value - expected)));
  }

  void codeSurface(Chunk& chunk, const SurfaceHistory& history) {
    Surface& s = chunk.surface;
    const std::uint64_t mode = io_.field(kMode, static_cast<std::uint64_t>(s.mode));
    if (mode > 3) throw Error(ErrorCode::Corrupt, "a chunk of points has an unknown mode");
    s.mode = static_cast<SurfaceMode>(mode);
    chunk.residualClass =
        codeClass(kResidualClass, chunk.residualClass, residualClass_, kResidualClasses);
    if (s.mode == SurfaceMode::Delta) return;
    if (!Io::kWriting) {
      chunk.footprint = Footprint::of(chunk.u.data(), chunk.v.data(), chunk.count);
    }
    s.precision = precisionOf(chunk.residualClass);
    const Surface expected = history.expected(chunk.footprint, s.precision);
    const bool constant = s.mode == SurfaceMode::Constant;
    s.height = codeDifference(constant ? kConstantHeight : kHeight, s.height, expected.height);
    for (unsigned k = 0; k < 2; ++k) {
      s.slope[k] =
          constant ? 0
                   : codeDifference(static_cast<Field>(kSlopeU + k), s.slope[k], expected.slope[k]);
    }
    for (unsigned k = 0; k < 3; ++k) {
      s.bend[k] = s.mode == SurfaceMode::Quadric
                      ? codeDifference(static_cast<Field>(kBendUU + k), s.bend[k], 0)
                      : 0;
    }
  }

  Io& io_;
  unsigned gapClass_ = 20;
  unsigned residualClass_ = 8;
};

}  // namespace bspc::geometry::fast
