#include "attributes/neighbours.h"

#include <algorithm>

#include "attributes/cell_map.h"

namespace bspc::attributes {

RankedPoints rankPoints(Span<const GridPoint> points, std::size_t known) {
  constexpr unsigned kPositionBits = 30;
  const unsigned bits = coordinateBits(points);
  const unsigned cut = bits > kPositionBits ? bits - kPositionBits : 0;
  RankedPoints result;
  result.known = known;
  result.cut = cut;
  result.bits = bits;
  result.curve = mortonOrder(points, bits);
  result.indexOfRank.resize(points.size());
  result.positions.resize(points.size());
  result.rankAlongCurve.resize(points.size());
  std::size_t nextKnown = 0;
  std::size_t nextNew = known;
  for (std::size_t place = 0; place < points.size(); ++place) {
    const std::uint32_t index = result.curve[place].index;
    const std::size_t rank = index < known ? nextKnown++ : nextNew++;
    const GridPoint& p = points[index];
    result.rankAlongCurve[place] = static_cast<std::uint32_t>(rank);
    result.indexOfRank[rank] = index;
    for (unsigned k = 0; k < 3; ++k) {
      result.positions[rank][k] = static_cast<std::int32_t>(p[k] >> cut);
    }
  }
  return result;
}

namespace {

/// A cell and those around it.
struct Surroundings {
  std::array<std::uint32_t, 27> cells{};
  unsigned count = 0;
};

/// The coordinates of a code along one axis, one to either side of it: -1, 0, +1. Those outside
/// the cube of all codes are left out.
struct AxisSteps {
  std::array<std::uint64_t, 3> parts{};
  unsigned count = 0;

  AxisSteps(std::uint64_t code, unsigned axis) {
    const std::uint64_t mask = spreadBits(~std::uint64_t{0}) << axis;
    const std::uint64_t own = code & mask;
    parts[count++] = own;
    if (own != 0) parts[count++] = (own - 1) & mask;
    if (own != mask) parts[count++] = ((own | ~mask) + 1) & mask;
  }
};

Surroundings surround(const CellMap& map, std::size_t cell) {
  const std::uint64_t code = map.code(cell);
  const AxisSteps x(code, 0);
  const AxisSteps y(code, 1);
  const AxisSteps z(code, 2);
  Surroundings result;
  for (unsigned k = 0; k < z.count; ++k) {
    for (unsigned j = 0; j < y.count; ++j) {
      for (unsigned i = 0; i < x.count; ++i) {
        const std::uint32_t found = map.find(x.parts[i] | y.parts[j] | z.parts[k]);
        if (found != CellMap::kNone) result.cells[result.count++] = found;
      }
    }
  }
  return result;
}

/// The nearest of the points that it is shown, in order.
class NearestList {
 public:
  explicit NearestList(unsigned limit) : limit_(limit) {}

  void clear() { count_ = 0; }
  unsigned count() const { return count_; }
  std::uint32_t rank(unsigned i) const { return ranks_[i]; }

  void offer(std::uint64_t distance, std::uint32_t rank) {
    if (count_ == limit_ && !isBefore(distance, rank, limit_ - 1)) return;
    unsigned at = count_ < limit_ ? count_++ : limit_ - 1;
    for (; at > 0 && isBefore(distance, rank, at - 1); --at) {
      distances_[at] = distances_[at - 1];
      ranks_[at] = ranks_[at - 1];
    }
    distances_[at] = distance;
    ranks_[at] = rank;
  }

 private:
  bool isBefore(std::uint64_t distance, std::uint32_t rank, unsigned i) const {
    return distance != distances_[i] ? distance < distances_[i] : rank < ranks_[i];
  }

  unsigned limit_;
  unsigned count_ = 0;
  std::array<std::uint64_t, NeighbourTable::kMaxNeighbours> distances_{};
  std::array<std::uint32_t, NeighbourTable::kMaxNeighbours> ranks_{};
};

constexpr std::size_t kMembersTried = 24;

void gather(const RankedPoints& points, const CellMap& map, const Surroundings& around,
            std::uint32_t rank, NearestList& nearest) {
  nearest.clear();
  for (unsigned i = 0; i < around.count; ++i) {
    const Span<const std::uint32_t> members = map.members(around.cells[i]);
    const std::size_t first = members.size() > kMembersTried ? members.size() - kMembersTried : 0;
    for (std::size_t m = first; m < members.size(); ++m) {
      nearest.offer(points.squaredDistance(rank, members[m]), members[m]);
    }
  }
}

}  // namespace

NeighbourTable::NeighbourTable(const RankedPoints& points, unsigned limit, unsigned mean)
    : known_(points.known), limit_(limit) {
  const std::size_t added = points.size() - points.known;
  ranks_.resize(added * limit);
  counts_.resize(added);
  CellMap map(points.curve, cellShift(points.curve, mean));
  if (known_ > 0) {
    for (std::size_t cell = 0, place = 0; place < points.size(); ++place) {
      while (cell + 1 < map.size() && map.startOf(cell + 1) <= place) ++cell;
      const std::uint32_t rank = points.rankAlongCurve[place];
      if (rank < known_) map.add(cell, rank);
    }
  }
  NearestList nearest(limit);
  Surroundings around;
  std::size_t cell = 0;
  bool isNewCell = true;
  for (std::size_t place = 0; place < points.size(); ++place) {
    while (cell + 1 < map.size() && map.startOf(cell + 1) <= place) {
      ++cell;
      isNewCell = true;
    }
    const std::uint32_t rank = points.rankAlongCurve[place];
    if (rank < known_) continue;
    if (isNewCell) around = surround(map, cell);
    isNewCell = false;
    gather(points, map, around, rank, nearest);
    const std::size_t i = rank - known_;
    unsigned count = nearest.count();
    for (unsigned n = 0; n < count; ++n) ranks_[i * limit + n] = nearest.rank(n);
    // Without neighbours to speak of, those along the curve are better than none.
    constexpr unsigned kEnough = 2;
    for (std::uint32_t back = 1; count < kEnough && back <= kEnough && back <= rank; ++back) {
      const std::uint32_t other = rank - back;
      if (count > 0 && ranks_[i * limit] == other) continue;
      ranks_[i * limit + count++] = other;
    }
    counts_[i] = static_cast<std::uint8_t>(count);
    map.add(cell, rank);
  }
}

}  // namespace bspc::attributes
