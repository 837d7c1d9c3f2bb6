#pragma once

#include <functional>

namespace bspc {

/// Called from time to time with the share of the work that is done, 0 to 1, never decreasing.
/// Return false to stop: the call under way then throws Error(Cancelled). Decoding calls it at
/// least once in 16,384 points (fast: 65,536), 4,096 cells of a coarse layer, 1,024 vertices of
/// method surface, 4,096 faces, and before each array of a tile; on several threads the others see
/// the wish as often. The order of the points and the values of one array of a tile come without a
/// call.
using ProgressCallback = std::function<bool(double share)>;

}  // namespace bspc
