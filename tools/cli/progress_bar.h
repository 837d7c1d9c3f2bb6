#pragma once

#include <chrono>
#include <string>

#include "bspc/progress.h"

namespace bspc::cli {

/// A bar on standard error while it is a terminal and the work takes longer than a moment.
class ProgressBar {
 public:
  ProgressBar(std::string label, bool quiet);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// For the library; stops the work after an interrupt. The bar must outlive it.
  ProgressCallback callback();
  /// Takes the bar from the terminal.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;

  void draw(double share);

  std::string label_;
  bool visible_;
  bool drawn_ = false;
  Clock::time_point next_;
};

}  // namespace bspc::cli
