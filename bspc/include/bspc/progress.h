#pragma once

#include <functional>

namespace bspc {

/// Called from time to time with the share of the work that is done, 0 to 1, never decreasing.
/// Return false to stop: the call under way then throws Error(Cancelled).
using ProgressCallback = std::function<bool(double share)>;

}  // namespace bspc
