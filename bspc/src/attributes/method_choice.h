#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "bspc/span.h"

namespace bspc::attributes {

/// A way to code an array.
struct Candidate {
  /// Codes the first `limit` new points, or all if they are fewer.
  std::function<Bytes(std::size_t limit)> write;
  /// Bytes of the payload that do not grow with the points.
  std::size_t fixedBytes = 0;
  /// Methods that learn much look worse on a sample than they are: by this factor.
  double learning = 1;
  /// Ways of one family differ little: only the best of a family on the sample is tried on all
  /// points.
  unsigned family = 0;
};

/// The smallest payload of the promising candidates: each codes a sample, then those that did best
/// code all `points`; if `bestOnly`, the best one and those that may only have to learn more.
Bytes smallestPayload(const std::vector<Candidate>& candidates, std::size_t points,
                      std::size_t sample, bool bestOnly);

}  // namespace bspc::attributes
