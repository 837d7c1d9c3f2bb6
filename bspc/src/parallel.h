#pragma once

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

namespace bspc {

/// The threads that `wish` means: 0 is as many as the machine runs at a time.
inline unsigned threadCount(unsigned wish) {
  return wish != 0 ? wish : std::max(1U, std::thread::hardware_concurrency());
}

/// Produces `count` results on several threads, the calling one among them, and hands them to a
/// consumer in order. Only a few results wait at a time, so memory stays bounded.
template <class Result>
class OrderedParallel {
 public:
  /// Makes result `i`; runs on any thread.
  using Produce = std::function<Result(std::size_t i)>;
  /// Takes result `i`; runs on the calling thread, in order.
  using Consume = std::function<void(std::size_t i, Result result)>;
  /// Runs on the calling thread from time to time; may throw to end everything.
  using Idle = std::function<void()>;

  OrderedParallel(std::size_t count, unsigned threads, Produce produce)
      : count_(count),
        threads_(static_cast<unsigned>(std::min<std::size_t>(std::max(threads, 1U), count))),
        window_(std::size_t{2} * std::max(threads_, 1U)),
        slots_(window_),
        produce_(std::move(produce)) {}
  OrderedParallel(const OrderedParallel&) = delete;
  OrderedParallel& operator=(const OrderedParallel&) = delete;
  ~OrderedParallel() {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      stopped_ = true;
    }
    changed_.notify_all();
    for (std::thread& worker : workers_) worker.join();
  }

  /// Throws what a producer threw for the first result that failed, or what the others threw.
  void run(const Consume& consume, const Idle& idle) {
    startWorkers();
    while (consumed_ < count_) {
      if (std::optional<Slot> slot = takeReady()) {
        if (slot->error) std::rethrow_exception(slot->error);
        consume(consumed_ - 1, std::move(*slot->result));
      } else if (const std::optional<std::size_t> index = claim()) {
        work(*index);
      } else {
        waitForChange();
      }
      if (idle) idle();
    }
  }

 private:
  struct Slot {
    std::optional<Result> result;
    std::exception_ptr error;
    bool ready() const { return result.has_value() || error != nullptr; }
  };

  void startWorkers() {
    for (unsigned t = 1; t < threads_; ++t) {
      try {
        workers_.emplace_back([this] { workUntilDone(); });
      } catch (const std::system_error&) {
        break;  // as many as the system gives; the calling thread works in any case
      }
    }
  }

  void workUntilDone() {
    for (;;) {
      std::size_t index = 0;
      {
        std::unique_lock<std::mutex> lock(mutex_);
        changed_.wait(lock, [this] { return stopped_ || next_ == count_ || claimable(); });
        if (stopped_ || next_ == count_) return;
        index = next_++;
      }
      work(index);
    }
  }

  bool claimable() const { return next_ < count_ && next_ < consumed_ + window_; }

  std::optional<std::size_t> claim() {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!claimable()) return std::nullopt;
    return next_++;
  }

  void work(std::size_t index) {
    Slot slot;
    try {
      slot.result.emplace(produce_(index));
    } catch (...) {
      slot.error = std::current_exception();
    }
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      slots_[index % window_] = std::move(slot);
    }
    changed_.notify_all();
  }

  std::optional<Slot> takeReady() {
    std::optional<Slot> taken;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      Slot& slot = slots_[consumed_ % window_];
      if (!slot.ready()) return std::nullopt;
      taken.emplace(std::move(slot));
      slot = Slot();
      ++consumed_;
    }
    changed_.notify_all();
    return taken;
  }

  void waitForChange() {
    constexpr auto kAtMost = std::chrono::milliseconds(50);
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait_for(lock, kAtMost,
                      [this] { return slots_[consumed_ % window_].ready() || claimable(); });
  }

  const std::size_t count_;
  const unsigned threads_;
  const std::size_t window_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Slot> slots_;  ///< result i waits in slot i % window_
  std::size_t next_ = 0;     ///< the first result that nobody has begun
  std::size_t consumed_ = 0;
  bool stopped_ = false;
  Produce produce_;
  std::vector<std::thread> workers_;
};

}  // namespace bspc
