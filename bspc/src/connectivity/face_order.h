#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "bspc/error.h"
#include "bspc/mesh.h"
#include "connectivity/half_edge_map.h"
#include "connectivity/numbers.h"
#include "entropy/adaptive_bit.h"
#include "entropy/adaptive_symbols.h"

namespace bspc::connectivity {

/// Codes the order in which faces came in, and the vertex that each began with, for faces that both
/// sides know. The next face is looked for among the neighbours of the last two, and behind the
/// last one in the order of the faces' smallest vertices.
template <class Coder>
class FaceOrder {
 public:
  FaceOrder(Coder& coder, const Cells& faces)
      : coder_(coder),
        faces_(faces),
        sorted_(faces.size()),
        placeOf_(faces.size()),
        nextFree_(faces.size() + 1) {
    std::iota(sorted_.begin(), sorted_.end(), 0U);
    std::iota(nextFree_.begin(), nextFree_.end(), 0U);
    for (std::uint32_t i = 0; i < faces.size(); ++i) {
      smallest_.push_back(smallestOf(faces[i]));
      const Span<const std::uint32_t> face = faces[i];
      for (std::size_t j = 0; j < face.size(); ++j) {
        edges_.put(face[j], face[j + 1 < face.size() ? j + 1 : 0], i);
      }
    }
    std::sort(sorted_.begin(), sorted_.end(), [&](std::uint32_t a, std::uint32_t b) {
      return keyOf(a) != keyOf(b) ? keyOf(a) < keyOf(b) : a < b;
    });
    for (std::uint32_t i = 0; i < sorted_.size(); ++i) placeOf_[sorted_[i]] = i;
  }

  /// `order`: which of the faces come, one after the other; `starts`: of each of them, which of its
  /// corners comes first. A decoder fills both. `check()` may throw to stop.
  template <class Check>
  void code(std::vector<std::uint32_t>& order, std::vector<std::uint32_t>& starts, Check check) {
    for (std::size_t t = 0; t < faces_.size(); ++t) {
      if (t % kCheckEvery == 0) check();
      const std::uint32_t face = codeFace(Coder::kWriting ? order[t] : 0);
      const std::uint32_t start = codeStart(face, Coder::kWriting ? starts[t] : 0);
      nextFree_[placeOf_[face]] = placeOf_[face] + 1;
      before_ = last_;
      last_ = face;
      if (Coder::kWriting) continue;
      order.push_back(face);
      starts.push_back(start);
    }
  }

 private:
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;
  static constexpr std::size_t kCheckEvery = 4096;
  static constexpr std::size_t kEdges = 4;  ///< of a face that are looked across
  static constexpr std::size_t kCandidates = 1 + 2 * kEdges;

  static std::uint32_t smallestOf(Span<const std::uint32_t> face) {
    std::uint32_t at = 0;
    for (std::uint32_t j = 1; j < face.size(); ++j) {
      if (face[j] < face[at]) at = j;
    }
    return at;
  }
  std::uint32_t keyOf(std::uint32_t face) const {
    return faces_[face].empty() ? 0 : faces_[face][smallest_[face]];
  }

  bool isUsed(std::uint32_t face) const { return nextFree_[placeOf_[face]] != placeOf_[face]; }

  /// The first place from `place` on whose face has not come yet; faces_.size() if there is none.
  std::uint32_t freeFrom(std::uint32_t place) {
    std::uint32_t end = place;
    while (nextFree_[end] != end) end = nextFree_[end];
    while (nextFree_[place] != place) place = std::exchange(nextFree_[place], end);
    return end;
  }

  std::uint32_t codeFace(std::uint32_t value) {
    std::array<std::uint32_t, kCandidates> tried{};
    std::size_t count = 0;
    std::uint32_t found = kNone;
    const auto tryFace = [&](std::uint32_t face, std::size_t sort) {
      if (found != kNone || face == kNone || isUsed(face)) return;
      if (std::find(tried.begin(), tried.begin() + count, face) != tried.begin() + count) return;
      tried[count++] = face;
      if (coder_.bit(isIt_[sort][history_ & 3U], face == value)) {
        found = face;
        history_ = history_ << 1 | (sort == 0 ? 0U : 1U);
      }
    };
    std::uint32_t expected = freeFrom(last_ == kNone ? 0 : placeOf_[last_]);
    if (expected == faces_.size()) expected = freeFrom(0);
    tryFace(sorted_[expected], 0);
    tryNeighbours(last_, 1, tryFace);
    tryNeighbours(before_, 1 + kEdges, tryFace);
    if (found != kNone) return found;
    const auto from = static_cast<std::int64_t>(expected);
    const std::int64_t place =
        from + jump_.codeSigned(coder_, static_cast<std::int64_t>(placeOf_[value]) - from);
    if (place < 0 || place >= static_cast<std::int64_t>(faces_.size()) ||
        isUsed(sorted_[static_cast<std::size_t>(place)])) {
      throw Error(ErrorCode::Corrupt, "the order of the faces is damaged");
    }
    return sorted_[static_cast<std::size_t>(place)];
  }

  template <class Try>
  void tryNeighbours(std::uint32_t of, std::size_t sort, Try tryFace) const {
    if (of == kNone) return;
    const Span<const std::uint32_t> face = faces_[of];
    for (std::size_t j = 0; j < std::min(face.size(), kEdges); ++j) {
      const std::size_t at = (smallest_[of] + j) % face.size();
      tryFace(edges_.find(face[(at + 1) % face.size()], face[at]), sort + j);
    }
  }

  /// The first corner, counted from that of the smallest vertex.
  std::uint32_t codeStart(std::uint32_t face, std::uint32_t value) {
    const auto size = static_cast<std::uint32_t>(faces_[face].size());
    if (size < 2) return 0;
    const std::uint32_t turn = (value + size - smallest_[face]) % size;
    std::uint32_t coded = 0;
    if (size == 3) {
      coded = coder_.symbol(triangleStart_[lastStart_], turn);
      lastStart_ = coded;
    } else {
      coded = coder_.uniform(turn, size - 1);
    }
    return (coded + smallest_[face]) % size;
  }

  Coder& coder_;
  const Cells& faces_;
  std::vector<std::uint32_t> smallest_;  ///< corner of each face's smallest vertex
  std::vector<std::uint32_t> sorted_;    ///< faces by their smallest vertices
  std::vector<std::uint32_t> placeOf_;   ///< of each face in sorted_
  std::vector<std::uint32_t> nextFree_;  ///< a place whose face has come leads to later ones
  HalfEdgeMap edges_;
  std::uint32_t last_ = kNone;
  std::uint32_t before_ = kNone;
  unsigned history_ = 0;  ///< whether the last faces were the expected ones, newest lowest
  std::array<std::array<entropy::AdaptiveBit, 4>, kCandidates> isIt_;
  AdaptiveNumber jump_;
  std::array<entropy::AdaptiveSymbols<3>, 3> triangleStart_;
  unsigned lastStart_ = 0;
};

}  // namespace bspc::connectivity
