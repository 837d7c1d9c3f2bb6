#pragma once

#include <algorithm>

#include "bspc/error.h"
#include "bspc/progress.h"

namespace bspc {

/// A part of a longer piece of work: maps its own share 0 … 1 to [from, to] of the whole, never
/// goes back, and turns a wish to stop into Error(Cancelled).
class ProgressScale {
 public:
  ProgressScale(ProgressCallback callback, double from, double to)
      : callback_(std::move(callback)), from_(from), to_(to) {}

  void report(double share) {
    if (!callback_) return;
    last_ = std::max(last_, from_ + (to_ - from_) * std::min(std::max(share, 0.0), 1.0));
    if (!callback_(last_)) throw Error(ErrorCode::Cancelled, "stopped as asked");
  }

 private:
  ProgressCallback callback_;
  double from_;
  double to_;
  double last_ = 0;
};

}  // namespace bspc
