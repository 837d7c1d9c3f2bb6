#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "entropy/adaptive_bit.h"
#include "entropy/adaptive_symbols.h"
#include "geometry/partition/partition_cell.h"

namespace bspc::geometry {

/// Octree occupancy, [1] of the paper (Botsch, Wiratanaya, Kobbelt 2002): whether each child of a
/// cell holds points, a bit a child, learned in the context of the bits before it.
class OctreeSymbols {
 public:
  /// All sides of a cell that are as long as the longest are halved at once.
  static constexpr bool kAllAxes = true;
  static constexpr Occupancy kRoot = Occupancy::Some;

  /// Fills the children's occupancy from that of `wanted`, the encoder's alone.
  template <class Coder>
  void code(Coder& coder, PartitionCell& cell, unsigned /*open*/, PartitionCell* children,
            unsigned count) {
    unsigned pattern = 1;
    unsigned occupied = 0;
    for (unsigned i = 0; i < count; ++i) {
      bool some = children[i].count > 0;
      // The last child cannot be empty if all others are.
      if (i + 1 == count && occupied == 0) {
        some = true;
      } else {
        some = coder.bit(models_[cell.history][count - 1][pattern], some);
      }
      pattern = (pattern << 1) | (some ? 1U : 0U);
      occupied += some ? 1U : 0U;
      children[i].occupancy = some ? Occupancy::Some : Occupancy::None;
    }
    const unsigned only = occupied == 1 && count > 1 ? cell.history + 1U : 0U;
    const auto history =
        static_cast<std::uint8_t>(count == 1 ? cell.history : std::min(only, kHistories - 1));
    for (unsigned i = 0; i < count; ++i) children[i].history = history;
  }

 private:
  static constexpr unsigned kHistories = 4;  ///< ancestors in a row with one child, up to 3
  std::array<std::array<std::array<entropy::AdaptiveBit, 256>, 8>, kHistories> models_{};
};

/// A kd-tree with the symbols 0, 1, + for the halves of a cell, [7] of the paper (Lewiner,
/// Craizer, Lopes, Pesco, Velho, Medeiros 2006, GEncode).
class GenCodeSymbols {
 public:
  static constexpr bool kAllAxes = false;
  static constexpr Occupancy kRoot = Occupancy::Many;

  template <class Coder>
  void code(Coder& coder, PartitionCell& cell, unsigned open, PartitionCell* children,
            unsigned count) {
    if (count == 1) {
      children[0].occupancy = Occupancy::Many;
      children[0].history = cell.history;
      return;
    }
    const auto classOf = [](const PartitionCell& c) {
      return static_cast<unsigned>(std::min<std::uint64_t>(c.count, 2));
    };
    unsigned wanted = 0;
    while (Coder::kWriting && (kPairs[wanted][0] != classOf(children[0]) ||
                               kPairs[wanted][1] != classOf(children[1]))) {
      ++wanted;
    }
    const unsigned openClass = std::min(open - 1, kOpenClasses - 1);
    const unsigned pair = coder.symbol(models_[openClass][cell.history], wanted);
    constexpr std::array<Occupancy, 3> kClasses{Occupancy::None, Occupancy::One, Occupancy::Many};
    const unsigned oneSided = pair < 2 ? 1U : 0U;
    for (unsigned i = 0; i < 2; ++i) {
      children[i].occupancy = kClasses[kPairs[pair][i]];
      children[i].history =
          static_cast<std::uint8_t>(((unsigned{cell.history} << 1) | oneSided) & (kHistories - 1));
    }
  }

 private:
  /// Two points or more in two halves: 0 +, + 0, 1 1, 1 +, + 1, + +.
  static constexpr std::array<std::array<std::uint8_t, 2>, 6> kPairs{
      {{0, 2}, {2, 0}, {1, 1}, {1, 2}, {2, 1}, {2, 2}}};
  static constexpr unsigned kHistories = 8;
  static constexpr unsigned kOpenClasses = 4;
  std::array<std::array<entropy::AdaptiveSymbols<6>, kHistories>, kOpenClasses> models_;
};

}  // namespace bspc::geometry
