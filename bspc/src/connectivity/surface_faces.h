#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "bspc/mesh.h"
#include "entropy/symbol_coder.h"

namespace bspc::connectivity {

/// An oriented surface with its vertices numbered in the order in which its coder meets them.
struct SurfaceFaces {
  Cells faces;
  std::uint32_t vertices = 0;
  /// Of each vertex, its number before it was coded. Of an encoder only.
  std::vector<std::uint32_t> given;
};

/// Called with bytes of memory that will be in use; throws to stop.
using MemoryCheck = std::function<void(std::uint64_t bytes)>;

/// Codes faces of which no two have the same directed edge and none has a vertex twice, over points
/// 0 … points − 1, which need not all be used. Nothing is said about where they lie.
SurfaceFaces encodeSurface(entropy::SymbolWriter& coder, const Cells& faces, std::uint32_t points);

/// Any stream is safe. Throws Error(Corrupt), and what `check` throws.
SurfaceFaces decodeSurface(entropy::SymbolReader& coder, std::uint32_t points,
                           const MemoryCheck& check);

}  // namespace bspc::connectivity
