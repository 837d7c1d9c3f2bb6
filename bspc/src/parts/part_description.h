#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "bspc/encoder.h"
#include "bspc/grid.h"
#include "grid/coordinates.h"

namespace bspc::parts {

/// What a part says of its points to the others.
struct PartDescription {
  std::uint64_t points = 0;  ///< that are finite; if there are none, nothing else counts
  ScalarType type = ScalarType::Float32;
  lattice::Ranges ranges{};
  std::optional<Grid> lattice;  ///< that every point lies on

  Bytes write() const;
  /// Throws Error(Corrupt).
  static PartDescription read(ByteView message);
};

/// A lattice that holds the points of both, their types and bases aside; nothing where one would
/// have steps that no grid can have. `a` and `b` are exact for some points each.
std::optional<Grid> commonLattice(const Grid& a, const Grid& b);

/// The grid of all parts together, its bases placed.
Grid agreedGrid(const std::vector<PartDescription>& parts, const GridRequest& request);

}  // namespace bspc::parts
