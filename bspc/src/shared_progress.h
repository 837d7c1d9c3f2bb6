#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <thread>

#include "bspc/error.h"
#include "geometry/geometry_method.h"
#include "progress_scale.h"

namespace bspc {

/// Adds up what several threads have done. The caller's callback runs on the caller's thread only,
/// which may be the one that draws windows; the others learn from here that they are to stop.
class SharedProgress {
 public:
  /// To be made on the caller's thread; `scale` must outlive it.
  SharedProgress(ProgressScale& scale, std::uint64_t total)
      : scale_(scale),
        total_(static_cast<double>(total > 0 ? total : 1)),
        owner_(std::this_thread::get_id()) {}

  /// The progress of one piece of work, for the thread that does it.
  geometry::PointProgress piece() {
    return [this, most = std::uint64_t{0}](std::uint64_t done) mutable {
      const std::uint64_t before = most;
      most = std::max(most, done);
      add(most - before);  // of nothing too: it learns that it is to stop
    };
  }
  void add(std::uint64_t points) {
    done_ += points;
    if (std::this_thread::get_id() == owner_) {
      report();
    } else if (stopped_) {
      throw Error(ErrorCode::Cancelled, "stopped as asked");
    }
  }
  /// On the caller's thread only. Throws Error(Cancelled).
  void report() {
    try {
      if (stopped_) throw Error(ErrorCode::Cancelled, "stopped as asked");
      scale_.report(static_cast<double>(done_) / total_);
    } catch (...) {
      stopped_ = true;
      throw;
    }
  }

 private:
  ProgressScale& scale_;
  double total_;
  std::thread::id owner_;
  std::atomic<std::uint64_t> done_{0};
  std::atomic<bool> stopped_{false};
};

}  // namespace bspc
