#include "attributes/method_choice.h"

#include <algorithm>
#include <limits>

namespace bspc::attributes {

namespace {

/// The bytes that a candidate is expected to take for all points.
double estimate(const Candidate& candidate, std::size_t points, std::size_t sample) {
  const auto size = static_cast<double>(candidate.write(sample).size());
  const double fixed = std::min(static_cast<double>(candidate.fixedBytes), size);
  const double share = static_cast<double>(points) / static_cast<double>(std::min(sample, points));
  return fixed + (size - fixed) * share;
}

struct Estimated {
  const Candidate* candidate = nullptr;
  double bytes = std::numeric_limits<double>::infinity();
};

double learned(const Estimated& e) { return e.candidate->learning * e.bytes; }

/// The best candidate of each family, best first.
std::vector<Estimated> familyWinners(const std::vector<Candidate>& candidates, std::size_t points,
                                     std::size_t sample) {
  std::vector<Estimated> winners;
  for (const Candidate& candidate : candidates) {
    const Estimated estimated{&candidate, estimate(candidate, points, sample)};
    const auto rival =
        std::find_if(winners.begin(), winners.end(), [&candidate](const Estimated& other) {
          return other.candidate->family == candidate.family;
        });
    if (rival == winners.end()) {
      winners.push_back(estimated);
    } else if (estimated.bytes < rival->bytes) {
      *rival = estimated;
    }
  }
  std::stable_sort(winners.begin(), winners.end(),
                   [](const Estimated& a, const Estimated& b) { return a.bytes < b.bytes; });
  return winners;
}

}  // namespace

Bytes smallestPayload(const std::vector<Candidate>& candidates, std::size_t points,
                      std::size_t sample, bool bestOnly) {
  constexpr double kPromising = 1.15;
  const double allowance = bestOnly ? 1 : kPromising;  // times the best estimate
  constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();
  // A sample that is nearly everything is no saving.
  const bool sampled = candidates.size() > 1 && points > sample + sample / 2;
  Bytes best;
  const auto tryAll = [&best](const Candidate& candidate) {
    Bytes payload = candidate.write(kAll);
    if (best.empty() || payload.size() < best.size()) best = std::move(payload);
  };
  if (!sampled) {
    for (const Candidate& candidate : candidates) tryAll(candidate);
    return best;
  }
  const std::vector<Estimated> winners = familyWinners(candidates, points, sample);
  for (const Estimated& winner : winners) {
    if (learned(winner) <= allowance * winners[0].bytes) tryAll(*winner.candidate);
  }
  return best;
}

}  // namespace bspc::attributes
