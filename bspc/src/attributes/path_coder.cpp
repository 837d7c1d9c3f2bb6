#include "attributes/path_coder.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "attributes/cell_map.h"
#include "attributes/unused_set.h"
#include "bspc/error.h"
#include "entropy/adaptive_bit.h"
#include "entropy/symbol_coder.h"

namespace bspc::attributes {

namespace {

using Position = std::array<std::int64_t, 3>;

/// The points that the path has not reached, in cells.
class UnusedCells {
 public:
  UnusedCells(const RankedPoints& points, unsigned shift)
      : points_(points),
        map_(points.curve, shift),
        cellOf_(points.size()),
        shift_(shift + (points.bits > kMortonBits ? points.bits - kMortonBits : 0) - points.cut),
        last_((std::int64_t{1} << (kMortonBits - shift)) - 1) {
    map_.allowRemoval();
    for (std::size_t rank = 0, cell = 0; rank < points.size(); ++rank) {
      while (cell + 1 < map_.size() && map_.startOf(cell + 1) <= rank) ++cell;
      cellOf_[rank] = static_cast<std::uint32_t>(cell);
      map_.add(cell, static_cast<std::uint32_t>(rank));
    }
  }

  void remove(std::uint32_t rank) { map_.remove(cellOf_[rank], rank); }

  /// Appends the points of the 27 cells around a position, at most 64 of each, with their squared
  /// distances.
  void gather(const Position& centre,
              std::vector<std::pair<std::uint64_t, std::uint32_t>>& found) const {
    constexpr std::size_t kMostOfCell = 64;
    std::array<std::array<std::uint64_t, 3>, 3> parts{};
    std::array<unsigned, 3> counts{};
    for (unsigned k = 0; k < 3; ++k) {
      const std::int64_t cell = centre[k] >> shift_;
      for (std::int64_t c = std::max<std::int64_t>(cell - 1, 0); c <= std::min(cell + 1, last_);
           ++c) {
        parts[k][counts[k]++] = spreadBits(static_cast<std::uint64_t>(c)) << k;
      }
    }
    for (unsigned z = 0; z < counts[2]; ++z) {
      for (unsigned y = 0; y < counts[1]; ++y) {
        for (unsigned x = 0; x < counts[0]; ++x) {
          const std::uint32_t cell = map_.find(parts[0][x] | parts[1][y] | parts[2][z]);
          if (cell == CellMap::kNone) continue;
          const Span<const std::uint32_t> members = map_.members(cell);
          const std::size_t count = std::min(members.size(), kMostOfCell);
          for (std::size_t m = 0; m < count; ++m) {
            found.emplace_back(distance(centre, members[m]), members[m]);
          }
        }
      }
    }
  }

 private:
  std::uint64_t distance(const Position& centre, std::uint32_t rank) const {
    std::uint64_t sum = 0;
    for (unsigned k = 0; k < 3; ++k) {
      const std::int64_t d = points_.positions[rank][k] - centre[k];
      sum += static_cast<std::uint64_t>(d * d);
    }
    return sum;
  }

  const RankedPoints& points_;
  CellMap map_;
  std::vector<std::uint32_t> cellOf_;
  unsigned shift_;     ///< from positions to cells
  std::int64_t last_;  ///< greatest coordinate of a cell
};

template <class Coder>
class PathCoder {
 public:
  PathCoder(Coder& coder, const RankedPoints& points, const PathSettings& settings,
            std::vector<std::uint32_t>& path)
      : coder_(coder),
        points_(points),
        settings_(settings),
        path_(path),
        fine_(points, fineShift(points)),
        coarse_(points, std::min(fineShift(points) + settings.coarser, kMortonBits - 1)),
        unused_(points.size()) {}

  void run(std::size_t limit) {
    const std::size_t end = std::min(limit, points_.size());
    for (std::size_t step = 0; step < end; ++step) {
      if (step == 0 || !codeNear(step)) codeFar(step);
      const std::uint32_t rank = path_[step];
      unused_.take(rank);
      fine_.remove(rank);
      coarse_.remove(rank);
    }
  }

 private:
  static constexpr unsigned kRankBits = 7;
  static constexpr std::size_t kMostRanks = 126;
  static constexpr unsigned kEscapeClass = 15;
  static constexpr unsigned kFarBits = 33;  ///< of offsets among fewer than 2^32 points, folded

  static unsigned fineShift(const RankedPoints& points) {
    constexpr unsigned kMean = 3;
    return cellShift(points.curve, kMean);
  }

  Position expected(std::size_t step) const {
    const auto& last = points_.positions[path_[step - 1]];
    Position result{last[0], last[1], last[2]};
    if (step > 1 && !escaped_) {
      const auto& before = points_.positions[path_[step - 2]];
      for (unsigned k = 0; k < 3; ++k) {
        const std::int64_t moved = std::int64_t{last[k]} - before[k];
        result[k] += (moved * static_cast<std::int64_t>(settings_.momentum)) >> 1;
      }
    }
    return result;
  }

  /// Codes the next point by its rank among those near the expected position; false for a point
  /// that is not among them.
  bool codeNear(std::size_t step) {
    constexpr std::size_t kEnough = 4;
    const Position centre = expected(step);
    near_.clear();
    fine_.gather(centre, near_);
    if (near_.size() < kEnough) {
      near_.clear();
      coarse_.gather(centre, near_);
    }
    escaped_ = true;
    if (near_.empty()) return false;
    const std::size_t ranks = std::min(near_.size(), kMostRanks);
    std::uint64_t symbol = 0;
    if (Coder::kWriting) symbol = symbolOf(path_[step], ranks);
    const unsigned context = lastClass_ * 16 + classBefore_;
    symbol = codeNumber(rankLengths_[context], rankBits_, symbol, kRankBits);
    classBefore_ = lastClass_;
    lastClass_ = kEscapeClass;
    if (symbol == 0) return false;
    if (symbol > ranks) {
      throw Error(ErrorCode::Corrupt, "a path goes to the near point " + std::to_string(symbol) +
                                          " of " + std::to_string(ranks) + ": the file is damaged");
    }
    const std::size_t rank = symbol - 1;
    if (!Coder::kWriting) {
      const auto at = near_.begin() + static_cast<std::ptrdiff_t>(rank);
      std::nth_element(near_.begin(), at, near_.end());
      path_[step] = at->second;
    }
    lastClass_ = rank > 0 ? entropy::bitLength(rank) + 1 : 0;
    escaped_ = false;
    return true;
  }

  /// 1 + the rank of a point by distance; 0 if it is not near or too far down.
  std::uint64_t symbolOf(std::uint32_t point, std::size_t ranks) const {
    const auto at = std::find_if(near_.begin(), near_.end(),
                                 [point](const auto& c) { return c.second == point; });
    if (at == near_.end()) return 0;
    const auto before =
        std::count_if(near_.begin(), near_.end(), [at](const auto& c) { return c < *at; });
    return static_cast<std::size_t>(before) < ranks ? static_cast<std::uint64_t>(before) + 1 : 0;
  }

  /// Codes the next point by how many unused ones lie between it and the last along the curve.
  void codeFar(std::size_t step) {
    escaped_ = true;
    const auto from =
        static_cast<std::int64_t>(step > 0 ? unused_.rank(path_[step - 1]) : std::size_t{0});
    std::uint64_t folded = 0;
    if (Coder::kWriting) {
      const std::int64_t offset = static_cast<std::int64_t>(unused_.rank(path_[step])) - from;
      folded = offset < 0 ? 2 * static_cast<std::uint64_t>(-offset) - 1
                          : 2 * static_cast<std::uint64_t>(offset);
    }
    folded = codeNumber(farLengths_, farBits_, folded, kFarBits);
    if (Coder::kWriting) return;
    const auto half = static_cast<std::int64_t>(folded / 2);
    const std::int64_t rank = from + ((folded & 1) != 0 ? -half - 1 : half);
    if (rank < 0 || rank >= static_cast<std::int64_t>(unused_.size())) {
      throw Error(ErrorCode::Corrupt, "a path leaves the points: the file is damaged");
    }
    path_[step] = static_cast<std::uint32_t>(unused_.select(static_cast<std::size_t>(rank)));
  }

  template <std::size_t Nodes>
  using Bits = std::array<entropy::AdaptiveBit, Nodes>;
  using Mantissas = std::array<Bits<32>, kFarBits + 1>;

  /// A number of at most `most` bits: its length through a binary tree, four bits as learned, the
  /// rest raw.
  template <std::size_t Nodes>
  std::uint64_t codeNumber(Bits<Nodes>& lengths, Mantissas& mantissas, std::uint64_t number,
                           unsigned most) {
    constexpr unsigned kModelled = 4;
    const unsigned length = codeLength(lengths, entropy::bitLength(number), most);
    if (length == 0) return 0;
    const unsigned below = length - 1;
    const unsigned modelled = std::min(below, kModelled);
    unsigned node = 1;
    for (unsigned i = 1; i <= modelled; ++i) {
      const bool bit = ((number >> (below - i)) & 1) != 0;
      node = 2 * node + (coder_.bit(mantissas[length][node], bit) ? 1U : 0U);
    }
    const unsigned raw = below - modelled;
    if (raw == 0) return node;
    const std::uint64_t mask = (std::uint64_t{1} << raw) - 1;
    return (std::uint64_t{node} << raw) | coder_.wide(number & mask, raw);
  }

  template <std::size_t Nodes>
  unsigned codeLength(Bits<Nodes>& models, unsigned length, unsigned most) {
    unsigned node = 1;
    for (unsigned half = Nodes / 2; half > 0; half /= 2) {
      node = 2 * node + (coder_.bit(models[node], (length & half) != 0) ? 1U : 0U);
    }
    const unsigned coded = node - static_cast<unsigned>(Nodes);
    if (coded > most) {
      throw Error(ErrorCode::Corrupt,
                  "a step of a path has " + std::to_string(coded) + " bits: the file is damaged");
    }
    return coded;
  }

  Coder& coder_;
  const RankedPoints& points_;
  const PathSettings& settings_;
  std::vector<std::uint32_t>& path_;
  UnusedCells fine_;
  UnusedCells coarse_;
  UnusedSet unused_;
  bool escaped_ = false;  ///< the last point was not near the one before
  unsigned lastClass_ = 0;
  unsigned classBefore_ = 0;
  std::array<Bits<8>, 256> rankLengths_{};
  Mantissas rankBits_{};
  Bits<64> farLengths_{};
  Mantissas farBits_{};
  std::vector<std::pair<std::uint64_t, std::uint32_t>> near_;
};

}  // namespace

Bytes writePath(const RankedPoints& points, const PathSettings& settings,
                std::vector<std::uint32_t>& path, std::size_t limit) {
  entropy::SymbolWriter writer;
  PathCoder<entropy::SymbolWriter>(writer, points, settings, path).run(limit);
  return writer.finish();
}

std::vector<std::uint32_t> readPath(ByteView stream, const RankedPoints& points,
                                    const PathSettings& settings) {
  std::vector<std::uint32_t> path(points.size());
  entropy::SymbolReader reader(stream);
  PathCoder<entropy::SymbolReader>(reader, points, settings, path).run(points.size());
  reader.finish();
  return path;
}

}  // namespace bspc::attributes
