#include "attributes/logistic_mixer.h"

#include <cstddef>

namespace bspc::attributes {

namespace {

/// round(2^16 / (1 + exp(−k / 2))) for k = −16 … 16; between them the function is taken as linear.
constexpr std::array<std::uint32_t, 33> kLogistic{
    22,    36,    60,    98,    162,   267,   439,   720,   1179,  1921,  3108,
    4971,  7812,  11955, 17625, 24743, 32768, 40793, 47911, 53581, 57724, 60565,
    62428, 63615, 64357, 64816, 65097, 65269, 65374, 65438, 65476, 65500, 65514};
constexpr int kSegment = 128;  // odds between two entries

}  // namespace

const LogisticTables& LogisticTables::instance() {
  static const LogisticTables tables;
  return tables;
}

LogisticTables::LogisticTables() {
  for (int odds = -kMaxOdds; odds <= kMaxOdds; ++odds) {
    const int from = odds + 16 * kSegment;
    const auto entry = static_cast<std::size_t>(from / kSegment);
    const auto part = static_cast<std::uint32_t>(from % kSegment);
    const std::uint32_t value =
        (kLogistic[entry] * (kSegment - part) + kLogistic[entry + 1] * part + kSegment / 2) /
        kSegment;
    const int place = odds + kMaxOdds;
    squash_[static_cast<std::size_t>(place)] = static_cast<std::uint16_t>(value);
  }
  // The inverse: the least odds whose probability reaches the middle of the twelve-bit step.
  int odds = -kMaxOdds;
  for (std::uint32_t step = 0; step < stretch_.size(); ++step) {
    while (odds < kMaxOdds && probability(odds) < 16 * step + 8) ++odds;
    stretch_[step] = static_cast<std::int16_t>(odds);
  }
}

}  // namespace bspc::attributes
