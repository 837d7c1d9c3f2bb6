#include "faults/counted_memory.h"

#include <malloc.h>

#include <atomic>
#include <cstdlib>
#include <limits>
#include <new>

namespace {

constexpr std::uint64_t kNever = std::numeric_limits<std::uint64_t>::max();

std::atomic<std::uint64_t> live{0};
std::atomic<std::uint64_t> peak{0};
std::atomic<std::uint64_t> allocations{0};
std::atomic<std::uint64_t> failFirst{kNever};
std::atomic<std::uint64_t> failLast{kNever};

void* counted(void* memory) {
  if (memory == nullptr) throw std::bad_alloc();
  const std::uint64_t size = malloc_usable_size(memory);
  const std::uint64_t now = live.fetch_add(size) + size;
  std::uint64_t before = peak.load();
  while (before < now && !peak.compare_exchange_weak(before, now)) {
  }
  return memory;
}

void failIfTold() {
  const std::uint64_t number = ++allocations;
  if (number >= failFirst.load() && number <= failLast.load()) throw std::bad_alloc();
}

void release(void* memory) noexcept {
  if (memory == nullptr) return;
  live.fetch_sub(malloc_usable_size(memory));
  std::free(memory);
}

}  // namespace

void* operator new(std::size_t size) {
  failIfTold();
  return counted(std::malloc(size > 0 ? size : 1));
}
void* operator new[](std::size_t size) { return operator new(size); }
void* operator new(std::size_t size, std::align_val_t alignment) {
  failIfTold();
  const auto step = static_cast<std::size_t>(alignment);
  return counted(std::aligned_alloc(step, (size + step - 1) / step * step));
}
void* operator new[](std::size_t size, std::align_val_t alignment) {
  return operator new(size, alignment);
}
// Those of sanitizers do not go through the ones above.
void* operator new(std::size_t size, const std::nothrow_t& /*tag*/) noexcept {
  try {
    return operator new(size);
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}
void* operator new[](std::size_t size, const std::nothrow_t& tag) noexcept {
  return operator new(size, tag);
}
void operator delete(void* memory, const std::nothrow_t& /*tag*/) noexcept { release(memory); }
void operator delete[](void* memory, const std::nothrow_t& /*tag*/) noexcept { release(memory); }
void operator delete(void* memory) noexcept { release(memory); }
void operator delete[](void* memory) noexcept { release(memory); }
void operator delete(void* memory, std::size_t /*size*/) noexcept { release(memory); }
void operator delete[](void* memory, std::size_t /*size*/) noexcept { release(memory); }
void operator delete(void* memory, std::align_val_t /*step*/) noexcept { release(memory); }
void operator delete[](void* memory, std::align_val_t /*step*/) noexcept { release(memory); }
void operator delete(void* memory, std::size_t /*size*/, std::align_val_t /*step*/) noexcept {
  release(memory);
}
void operator delete[](void* memory, std::size_t /*size*/, std::align_val_t /*step*/) noexcept {
  release(memory);
}

namespace bspc::test {

std::uint64_t liveBytes() { return live.load(); }

PeakOfMemory::PeakOfMemory() : before_(live.load()) { peak.store(before_); }

std::uint64_t PeakOfMemory::bytes() const { return peak.load() - before_; }

FailingAllocation::FailingAllocation(std::uint64_t number, bool allAfter) {
  allocations.store(0);
  failLast.store(allAfter ? kNever - 1 : number);
  failFirst.store(number);
}

FailingAllocation::~FailingAllocation() {
  failFirst.store(kNever);
  failLast.store(kNever);
}

bool FailingAllocation::reached() const { return allocations.load() >= failFirst.load(); }

}  // namespace bspc::test
