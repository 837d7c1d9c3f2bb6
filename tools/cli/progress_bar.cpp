#include "cli/progress_bar.h"

#include <unistd.h>

#include <array>
#include <cstdio>
#include <iostream>

#include "cli/interrupts.h"

namespace bspc::cli {

namespace {

constexpr auto kPatience = std::chrono::milliseconds(500);
constexpr auto kRefresh = std::chrono::milliseconds(100);

}  // namespace

ProgressBar::ProgressBar(std::string label, bool quiet)
    : label_(std::move(label)),
      visible_(!quiet && ::isatty(STDERR_FILENO) != 0),
      next_(Clock::now() + kPatience) {}

ProgressBar::~ProgressBar() { clear(); }

void ProgressBar::clear() {
  if (drawn_) std::cerr << "\r\033[K" << std::flush;
  drawn_ = false;
}

ProgressCallback ProgressBar::callback() {
  return [this](double share) {
    if (visible_ && Clock::now() >= next_) draw(share);
    return !interrupted();
  };
}

void ProgressBar::draw(double share) {
  constexpr std::size_t kWidth = 40;
  const auto full = static_cast<std::size_t>(share * kWidth);
  std::array<char, 16> percent{};
  std::snprintf(percent.data(), percent.size(), "%3.0f %%", 100 * share);
  std::cerr << '\r' << label_ << " [" << std::string(full, '#')
            << std::string(kWidth - (full < kWidth ? full : kWidth), ' ') << "] " << percent.data()
            << std::flush;
  drawn_ = true;
  next_ = Clock::now() + kRefresh;
}

}  // namespace bspc::cli
