#pragma once

#include <cstdint>

namespace bspc::test {

// The programs that link counted_memory.cpp have an operator new that counts, and that fails when
// it is told to. What C libraries take from malloc() is not counted.

/// Bytes that are allocated now.
std::uint64_t liveBytes();

/// The most bytes that were allocated at a time since it was made, beyond those of that moment.
class PeakOfMemory {
 public:
  PeakOfMemory();
  std::uint64_t bytes() const;

 private:
  std::uint64_t before_;
};

/// While it lives, the allocation of that number (from 1 on) throws std::bad_alloc, and the ones
/// after it too if `allAfter` is set.
class FailingAllocation {
 public:
  explicit FailingAllocation(std::uint64_t number, bool allAfter = false);
  ~FailingAllocation();
  FailingAllocation(const FailingAllocation&) = delete;
  FailingAllocation& operator=(const FailingAllocation&) = delete;

  /// Whether it came to that.
  bool reached() const;
};

}  // namespace bspc::test
