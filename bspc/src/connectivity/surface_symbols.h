#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "connectivity/face_front.h"
#include "entropy/logistic_mixer.h"

namespace bspc::connectivity {

/// What is known where the next vertex of a face is asked for, behind `from` → `to`, when nothing
/// is known of places: numbers of faces, each capped, and what was done before.
struct CornerContext {
  static constexpr unsigned kMostFaces = 9;
  static constexpr unsigned kNobody = 10;  ///< in place of a number of faces: no such vertex
  static constexpr unsigned kNoFace = 15;

  unsigned from = 0;          ///< faces at `from`
  unsigned to = 0;            ///< faces at `to`
  unsigned right = kNobody;   /// faces at the other end of the newest gate that leaves `to`
  unsigned left = kNobody;    /// faces at the other end of the newest gate that enters `from`
  unsigned apex = kNobody;    /// faces at the vertex before the edge in the face across
  unsigned border = 0;        ///< 1: a border stands at `from`; 2: at `to`
  unsigned gates = 0;         ///< open gates at both ends
  unsigned across = kNoFace;  ///< how the face across was made, and which of its edges this is
  unsigned last = 0;          ///< what was done last
  unsigned before = 0;        ///< and before that
  bool closing = true;        ///< the vertex asked for is the face's last one
};

/// What is asked, in this order; each only if the one before did not settle the matter.
enum class CornerQuestion : std::uint8_t { Border, New, Right, Left };

/// Codes the answers for a surface whose vertices have no places yet.
class SurfaceSymbols {
 public:
  SurfaceSymbols()
      : mixer_({kSlots * 10, kSlots * 100, kSlots * 25}, {kSlots}, kInputs, kWeight, kRate,
               kCounterAge),
        counters_(std::size_t{kContexts} << kTableBits) {}

  template <class Coder>
  bool code(Coder& coder, CornerQuestion question, const CornerContext& c, bool bit) {
    const unsigned slot = static_cast<unsigned>(question) + (c.closing ? 0 : 4);
    const unsigned ends = c.from * 11 + c.to;
    const unsigned sides = c.right * 11 + c.left;
    const std::array<std::uint64_t, kContexts> contexts{
        ends + 1000 * c.border,
        ends * 121 + sides,
        (c.to * 11 + c.right) * 4 + c.border,
        (c.from * 11 + c.left) * 4 + c.border,
        (ends * 16 + c.across) * 5 + c.last,
        (ends * 5 + c.last) * 5 + c.before,
        (ends * 11 + c.apex) * 25 + c.gates,
        (ends * 11 + c.right) * 25 + c.gates,
        (ends * 11 + c.left) * 25 + c.gates,
        std::uint64_t{ends * 121 + sides} * 16 + c.across,
    };
    evidence_.clear();
    for (unsigned k = 0; k < kContexts; ++k) {
      const std::uint64_t hash = (contexts[k] * kSlots + slot) * 0x9E3779B97F4A7C15ULL;
      evidence_.add(counters_[(std::size_t{k} << kTableBits) + (hash >> (64 - kTableBits))]);
    }
    evidence_.add(kBias);
    return mixer_.code(
        coder, bit, evidence_,
        {slot * 10 + c.from, (slot * 10 + c.from) * 10 + c.to, slot * 25 + c.last * 5 + c.before},
        {slot});
  }

 private:
  static constexpr unsigned kSlots = 8;
  static constexpr unsigned kContexts = 10;
  static constexpr unsigned kTableBits = 16;
  static constexpr unsigned kInputs = 16;
  static constexpr float kWeight = 0.2F;
  static constexpr float kBias = 0.3F;
  static constexpr unsigned kCounterAge = 250;
  static constexpr entropy::MixingRate kRate{0.02F, 60, 0.003F};

  entropy::LayeredMixer<3> mixer_;
  entropy::Evidence evidence_;
  std::vector<entropy::Counter> counters_;
};

}  // namespace bspc::connectivity
