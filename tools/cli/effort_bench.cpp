#include "cli/effort_bench.h"

#include <algorithm>
#include <memory>

#include "bspc/decoder.h"
#include "bspc/error.h"
#include "cli/interrupts.h"
#include "cli/progress_bar.h"
#include "cli/restored_points.h"

namespace bspc::cli {

namespace {

constexpr std::size_t kLeastRuns = 3;
constexpr std::size_t kMostRuns = 100;
/// Sets that are through sooner are coded again.
constexpr auto kWorthMeasuring = std::chrono::seconds(1);

}  // namespace

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

EffortBench::EffortBench(const PointSetView& points, const EncodeOptions& options,
                         const BenchLimits& limits)
    : points_(points), options_(options), limits_(limits) {}

std::vector<EffortResult> EffortBench::run(const std::vector<unsigned>& efforts) {
  start_ = Clock::now();
  end_ = start_ + std::chrono::duration_cast<Clock::duration>(
                      std::chrono::duration<double>(limits_.seconds));
  std::vector<EffortResult> results(efforts.size());
  for (std::size_t e = 0; e < efforts.size(); ++e) results[e].effort = efforts[e];
  for (bool ran = true; ran;) {
    ran = false;
    for (EffortResult& result : results) {
      if (enough(result) || !fits(result)) continue;
      if (!runOnce(result)) return results;
      ran = true;
    }
  }
  return results;
}

bool EffortBench::enough(const EffortResult& result) const {
  if (limits_.runs != 0) return result.runs() >= limits_.runs;
  if (result.runs() < kLeastRuns) return false;
  return result.runs() >= kMostRuns || Clock::now() - start_ >= kWorthMeasuring;
}

/// Whether another run is likely to end in time; a first one is tried.
bool EffortBench::fits(const EffortResult& result) const {
  if (result.runs() == 0) return !timeIsOver();
  const std::chrono::duration<double> last(result.encodeSeconds.back() +
                                           result.decodeSeconds.back());
  return Clock::now() + last < end_;
}

/// Returns false if it was stopped.
bool EffortBench::runOnce(EffortResult& result) {
  try {
    Bytes bytes;
    const double encoding = encodeOnce(result, bytes);
    const double decoding = decodeOnce(result, bytes);
    result.encodeSeconds.push_back(encoding);
    result.decodeSeconds.push_back(decoding);
    return true;
  } catch (const Error& error) {
    if (error.code() != ErrorCode::Cancelled) throw;
    return false;
  }
}

ProgressCallback EffortBench::stoppable(const ProgressCallback& draw) const {
  return [this, draw](double share) { return draw(share) && !timeIsOver(); };
}

double EffortBench::encodeOnce(EffortResult& result, Bytes& bytes) const {
  ProgressBar bar("effort " + std::to_string(result.effort) + ", encoding", limits_.quiet);
  EncodeOptions options = options_;
  options.effort = result.effort;
  options.progress = stoppable(bar.callback());
  MemorySink sink;
  const Clock::time_point start = Clock::now();
  result.report = encode(points_, sink, options);
  const std::chrono::duration<double> seconds = Clock::now() - start;
  bytes = sink.take();
  return seconds.count();
}

double EffortBench::decodeOnce(const EffortResult& result, const Bytes& bytes) const {
  ProgressBar bar("effort " + std::to_string(result.effort) + ", decoding", limits_.quiet);
  DecodeOptions options;
  options.threads = options_.threads;
  options.progress = stoppable(bar.callback());
  std::uint64_t points = 0;
  const Clock::time_point start = Clock::now();
  Decoder decoder(std::make_shared<MemorySource>(bytes));
  const auto restore = [&](const DecodedPoints& decoded) {
    points += RestoredPoints(decoder.info(), decoded).view().size();
  };
  if (decoder.info().mesh.empty()) {
    decoder.decodeTiles(options, restore);
  } else {
    restore(decoder.decode(options));
  }
  const std::chrono::duration<double> seconds = Clock::now() - start;
  if (points != result.report.points) {
    throw Error(ErrorCode::Corrupt,
                "effort " + std::to_string(result.effort) + " did not give all points back");
  }
  return seconds.count();
}

}  // namespace bspc::cli
