#include "geometry/predictive/mirror_plane.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace bspc::geometry::predictive {

namespace {

constexpr std::size_t kSamples = 200;
constexpr std::size_t kLeastPoints = 16;
constexpr std::size_t kLeastVotes = 4;
constexpr double kLeastScore = 0.35;

std::uint64_t scrambled(std::uint64_t key) {
  key *= 0x9E3779B97F4A7C15U;
  return key ^ (key >> 29);
}

/// That a sample and some point have their mirror plane at sum / 2, but for a distance beside it.
struct Vote {
  std::uint64_t sum = 0;
  std::uint32_t sample = 0;
  std::uint32_t beside = 0;  ///< square of the distance along the other two axes
};

/// Looks for planes across one axis.
class AxisVoting {
 public:
  AxisVoting(Span<const GridPoint> points, unsigned axis) : points_(points), axis_(axis) {
    const std::size_t stride = std::max<std::size_t>(1, points.size() / kSamples);
    for (std::size_t i = 0; i < points.size(); i += stride) samples_.push_back(points[i]);
    enterSamples();
    collectVotes();
  }

  /// The best plane and how good it is: about the share of points that have a mirrored one.
  std::optional<MirrorPlane> best(double& score) const {
    std::uint64_t middle = 0;
    std::size_t most = 0;
    for (std::size_t i = 0, j = 0; i < votes_.size(); ++i) {
      while (votes_[i].sum - votes_[j].sum > 2) ++j;
      if (i - j + 1 > most) {
        most = i - j + 1;
        middle = (votes_[i].sum + votes_[j].sum) / 2;
      }
    }
    if (most < kLeastVotes) return std::nullopt;
    MirrorPlane plane{axis_, 0};
    score = 0;
    for (std::uint64_t sum = middle < 2 ? 0 : middle - 2; sum <= middle + 2; ++sum) {
      const double s = scoreOf(sum);
      if (s <= score) continue;
      score = s;
      plane.sum = sum;
    }
    return plane;
  }

 private:
  struct Entry {
    std::uint64_t key = 0;
    std::uint32_t sample = 0;
    std::uint32_t beside = 0;
    bool operator<(const Entry& other) const { return key < other.key; }
  };

  static constexpr std::size_t kMaxVotes = std::size_t{1} << 20;
  static constexpr unsigned kFilterBits = 16;

  static std::uint64_t keyOf(std::uint32_t b, std::uint32_t c) {
    return (std::uint64_t{b} << 32) | c;
  }
  static std::size_t filterSlot(std::uint64_t key) {
    return static_cast<std::size_t>(scrambled(key) >> (64 - kFilterBits));
  }

  /// The places beside the axis where a sample's mirror image may stand.
  void enterSamples() {
    const unsigned b = (axis_ + 1) % 3;
    const unsigned c = (axis_ + 2) % 3;
    for (std::uint32_t i = 0; i < samples_.size(); ++i) {
      for (std::uint32_t place = 0; place < 9; ++place) {
        const std::uint32_t db = place / 3 - 1;
        const std::uint32_t dc = place % 3 - 1;
        const std::uint64_t key = keyOf(samples_[i][b] + db, samples_[i][c] + dc);
        entries_.push_back({key, i, db * db + dc * dc});
        filter_[filterSlot(key)] = true;
      }
    }
    std::sort(entries_.begin(), entries_.end());
  }

  void collectVotes() {
    const unsigned b = (axis_ + 1) % 3;
    const unsigned c = (axis_ + 2) % 3;
    for (const GridPoint& p : points_) {
      const std::uint64_t key = keyOf(p[b], p[c]);
      if (!filter_[filterSlot(key)]) continue;
      const auto range = std::equal_range(entries_.begin(), entries_.end(), Entry{key, 0, 0});
      for (auto e = range.first; e != range.second; ++e) {
        const std::uint32_t x = samples_[e->sample][axis_];
        // A point is its own image, and that of its neighbours, in any plane through it.
        if ((x > p[axis_] ? x - p[axis_] : p[axis_] - x) <= 2) continue;
        votes_.push_back({std::uint64_t{x} + p[axis_], e->sample, e->beside});
      }
      if (votes_.size() > kMaxVotes) break;
    }
    std::sort(votes_.begin(), votes_.end(), [](const Vote& l, const Vote& r) {
      return l.sum != r.sum ? l.sum < r.sum : l.sample < r.sample;
    });
  }

  /// Share of the samples that are mirrored to within a step, exact images counting most. Those on
  /// the plane say nothing.
  double scoreOf(std::uint64_t sum) const {
    constexpr double kLoss = 0.08;
    std::vector<double> value(samples_.size(), 0);
    const auto first = std::lower_bound(votes_.begin(), votes_.end(), sum < 1 ? 0 : sum - 1,
                                        [](const Vote& v, std::uint64_t s) { return v.sum < s; });
    for (auto v = first; v != votes_.end() && v->sum <= sum + 1; ++v) {
      const unsigned distance = v->beside + (v->sum == sum ? 0 : 1);
      value[v->sample] = std::max(value[v->sample], 1 - kLoss * distance);
    }
    std::size_t aside = 0;
    for (const GridPoint& p : samples_) {
      const std::uint64_t twice = 2 * std::uint64_t{p[axis_]};
      if ((twice > sum ? twice - sum : sum - twice) > 2) ++aside;
    }
    const double total = std::accumulate(value.begin(), value.end(), 0.0);
    return aside == 0 ? 0 : total / static_cast<double>(aside);
  }

  Span<const GridPoint> points_;
  unsigned axis_;
  std::vector<GridPoint> samples_;
  std::vector<Entry> entries_;
  std::vector<bool> filter_ = std::vector<bool>(std::size_t{1} << kFilterBits);
  std::vector<Vote> votes_;
};

/// Finds points by their place; each can be taken once.
class PointPool {
 public:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  explicit PointPool(Span<const GridPoint> points) : points_(points), next_(points.size(), kNone) {
    std::size_t size = 16;
    while (size < 2 * points.size()) size *= 2;
    slots_.assign(size, kNone);
    taken_.assign(size, false);
    for (std::size_t i = points.size(); i-- > 0;) {
      const std::size_t s = slotOf(points[i]);
      next_[i] = slots_[s];
      slots_[s] = static_cast<std::uint32_t>(i);
    }
  }

  bool has(const GridPoint& p) const { return slots_[slotOf(p)] != kNone; }

  /// A point at that place that was not taken before, or kNone.
  std::uint32_t take(const GridPoint& p) {
    const std::size_t s = slotOf(p);
    const std::uint32_t i = slots_[s];
    if (i == kNone || taken_[s]) return kNone;
    if (next_[i] == kNone) {
      taken_[s] = true;  // the slot stays, as others may lie behind it
    } else {
      slots_[s] = next_[i];
    }
    return i;
  }

  /// Calls `use` with the index of each point that nobody took.
  template <class Use>
  void forEachLeft(Use use) const {
    for (std::size_t s = 0; s < slots_.size(); ++s) {
      if (taken_[s]) continue;
      for (std::uint32_t i = slots_[s]; i != kNone; i = next_[i]) use(i);
    }
  }

 private:
  std::size_t slotOf(const GridPoint& p) const {
    std::size_t s = scrambled(((std::uint64_t{p[0]} << 32) | p[1]) ^ (scrambled(p[2]) << 7)) &
                    (slots_.size() - 1);
    while (slots_[s] != kNone && points_[slots_[s]] != p) s = (s + 1) & (slots_.size() - 1);
    return s;
  }

  Span<const GridPoint> points_;
  std::vector<std::uint32_t> slots_;  ///< first point of a place
  std::vector<bool> taken_;           ///< all points of the place
  std::vector<std::uint32_t> next_;   ///< another point of the same place
};

constexpr unsigned kOffsets = 27;

MirrorOffset offsetOf(unsigned index) {
  return {static_cast<std::int8_t>(static_cast<int>(index % 3) - 1),
          static_cast<std::int8_t>(static_cast<int>(index / 3 % 3) - 1),
          static_cast<std::int8_t>(static_cast<int>(index / 9) - 1)};
}

/// The place of a copy; none if it would lie off the grid.
std::optional<GridPoint> imageOf(const MirrorPlane& plane, GridPoint p,
                                 const MirrorOffset& offset) {
  const std::array<unsigned, 3> axes = plane.axes();
  for (unsigned k = 0; k < 3; ++k) {
    const auto x = static_cast<std::int64_t>(p[axes[k]]);
    const std::int64_t image = (k == 0 ? static_cast<std::int64_t>(plane.sum) - x : x) + offset[k];
    if (image < 0 || image > std::numeric_limits<std::uint32_t>::max()) return std::nullopt;
    p[axes[k]] = static_cast<std::uint32_t>(image);
  }
  return p;
}

/// The offsets, those that occur most often first.
std::array<unsigned, kOffsets> offsetsByFrequency(const MirrorPlane& plane,
                                                  Span<const GridPoint> originals,
                                                  const PointPool& pool) {
  constexpr std::size_t kSample = 4000;
  std::array<std::size_t, kOffsets> found{};
  const std::size_t stride = std::max<std::size_t>(1, originals.size() / kSample);
  for (std::size_t i = 0; i < originals.size(); i += stride) {
    for (unsigned d = 0; d < kOffsets; ++d) {
      const auto image = imageOf(plane, originals[i], offsetOf(d));
      if (image && pool.has(*image)) ++found[d];
    }
  }
  std::array<unsigned, kOffsets> order{};
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(),
                   [&](unsigned l, unsigned r) { return found[l] > found[r]; });
  return order;
}

}  // namespace

std::optional<MirrorPlane> findMirrorPlane(Span<const GridPoint> points) {
  if (points.size() < kLeastPoints) return std::nullopt;
  std::optional<MirrorPlane> best;
  double bestScore = kLeastScore;
  for (unsigned axis = 0; axis < 3; ++axis) {
    double score = 0;
    const std::optional<MirrorPlane> plane = AxisVoting(points, axis).best(score);
    if (!plane || score <= bestScore) continue;
    best = plane;
    bestScore = score;
  }
  return best;
}

MirrorMatches matchMirrored(const MirrorPlane& plane, Span<const GridPoint> originals,
                            Span<const GridPoint> others) {
  MirrorMatches matches;
  matches.offsets.resize(originals.size());
  matches.copies.resize(originals.size(), PointPool::kNone);
  PointPool pool(others);
  for (const unsigned d : offsetsByFrequency(plane, originals, pool)) {
    const MirrorOffset offset = offsetOf(d);
    for (std::size_t i = 0; i < originals.size(); ++i) {
      if (matches.offsets[i]) continue;
      const auto image = imageOf(plane, originals[i], offset);
      if (!image) continue;
      const std::uint32_t copy = pool.take(*image);
      if (copy == PointPool::kNone) continue;
      matches.offsets[i] = offset;
      matches.copies[i] = copy;
    }
  }
  pool.forEachLeft([&](std::uint32_t i) { matches.unmatched.push_back(i); });
  std::sort(matches.unmatched.begin(), matches.unmatched.end());
  return matches;
}

}  // namespace bspc::geometry::predictive
