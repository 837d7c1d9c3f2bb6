#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "bspc/encoder.h"
#include "bspc/point_set.h"

namespace bspc::cli {

/// What coding at one effort gives and costs, from memory to memory.
struct EffortResult {
  unsigned effort = 0;
  EncodeReport report;  ///< of the last run
  /// One of each for every run that was finished.
  std::vector<double> encodeSeconds;
  std::vector<double> decodeSeconds;

  std::size_t runs() const { return decodeSeconds.size(); }
};

/// Of at least one value.
double median(std::vector<double> values);

struct BenchLimits {
  /// Runs of each effort; 0: at least 3, and more of small sets, which are through in no time.
  unsigned runs = 0;
  /// The run that is under way after so many seconds is stopped, and no other begins.
  double seconds = 0;
  bool quiet = false;
};

/// Codes points at several efforts that take turns, so that a busy spell of the machine meets all
/// of them, and decodes what came of it; every checksum is checked. Ends early, with the runs that
/// are finished, after an interrupt and when the time is over.
class EffortBench {
 public:
  /// The points must outlive this. `options` are those of every run, but for effort and progress.
  EffortBench(const PointSetView& points, const EncodeOptions& options, const BenchLimits& limits);

  /// One result for each of the efforts, which ascend; those without a run at the end.
  std::vector<EffortResult> run(const std::vector<unsigned>& efforts);

 private:
  using Clock = std::chrono::steady_clock;

  bool timeIsOver() const { return Clock::now() >= end_; }
  bool enough(const EffortResult& result) const;
  bool fits(const EffortResult& result) const;
  bool runOnce(EffortResult& result);
  double encodeOnce(EffortResult& result, Bytes& bytes) const;
  double decodeOnce(const EffortResult& result, const Bytes& bytes) const;
  ProgressCallback stoppable(const ProgressCallback& draw) const;

  const PointSetView& points_;
  EncodeOptions options_;
  BenchLimits limits_;
  Clock::time_point start_;
  Clock::time_point end_;
};

}  // namespace bspc::cli
