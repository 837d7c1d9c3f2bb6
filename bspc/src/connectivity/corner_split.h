#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "connectivity/advancing_front.h"
#include "connectivity/welding.h"
#include "entropy/adaptive_bit.h"

namespace bspc::connectivity {

/// Codes which member of a welded vertex each corner of the faces is. Along most edges both faces
/// have the same ones; along a seam they have not, and a soup has a new one at every corner.
template <class Coder>
class CornerSplit {
 public:
  /// `mayRenumber`: the encoder may number the members of a vertex as they are first used.
  CornerSplit(Coder& coder, const Welding& welding, bool mayRenumber)
      : coder_(coder),
        welding_(welding),
        mayRenumber_(mayRenumber),
        used_(welding.vertices(), 0),
        number_(mayRenumber ? welding.points() : 0, kNoNumber),
        taken_(mayRenumber ? 0 : welding.points(), 0) {}

  /// The points of all corners of the front's faces, face by face; an encoder gives them.
  /// `check()` may throw to stop.
  template <class Check>
  void codeFront(const AdvancingFront& front, std::vector<std::uint32_t>& points, Check check) {
    if (!Coder::kWriting) points.assign(front.allCorners().size(), 0);
    for (std::uint32_t face = 0; face < front.faces(); ++face) {
      if (face % kCheckEvery == 0) check();
      codeFace(front, face, points);
    }
  }

  /// The point of a corner of a face that is not the front's.
  std::uint32_t codeAlone(std::uint32_t vertex, std::uint32_t point) {
    const Span<const std::uint32_t> members = welding_.members(vertex);
    return members.size() == 1 ? members[0] : codeNew(vertex, point);
  }

  /// After an encoder has coded everything: order[j] is the point that is to be number j.
  std::vector<std::uint32_t> renumbering() {
    std::vector<std::uint32_t> order(welding_.points());
    for (std::uint32_t vertex = 0; vertex < welding_.vertices(); ++vertex) {
      const Span<const std::uint32_t> members = welding_.members(vertex);
      for (const std::uint32_t point : members) {
        if (number_[point] == kNoNumber) number_[point] = used_[vertex]++;
        order[members[number_[point]]] = point;
      }
    }
    return order;
  }

 private:
  static constexpr std::uint32_t kNoNumber = 0xFFFFFFFF;
  static constexpr std::uint32_t kCheckEvery = 4096;
  enum Edge : unsigned { kUnknown, kSame, kDifferent, kStates };

  void codeFace(const AdvancingFront& front, std::uint32_t face,
                std::vector<std::uint32_t>& points) {
    const std::uint32_t start = front.faceStart(face);
    const std::uint32_t end = front.faceStart(face + 1);
    const Span<const std::uint32_t> corners = front.allCorners();
    Edge edge = kUnknown;
    for (std::uint32_t corner = start; corner < end; ++corner) {
      const std::uint32_t vertex = corners[corner];
      const std::uint32_t before = corners[corner > start ? corner - 1 : end - 1];
      const std::uint32_t after = corners[corner + 1 < end ? corner + 1 : start];
      const std::uint32_t across = front.cornerAt(after, vertex);
      const std::uint32_t left = earlier(front.cornerAt(vertex, before), start, points);
      const std::uint32_t right =
          earlier(across == kNoVertex ? across : front.cornerAfter(across), start, points);
      const std::uint32_t point =
          welding_.members(vertex).size() == 1
              ? welding_.members(vertex)[0]
              : codeBeside(vertex, left, right, edge, Coder::kWriting ? points[corner] : 0);
      points[corner] = point;
      edge = right == kNoVertex || welding_.members(vertex).size() == 1 ? kUnknown
             : right == point                                           ? kSame
                                                                        : kDifferent;
    }
  }

  /// The point of a corner, if its face was coded before the one that starts at `start`.
  static std::uint32_t earlier(std::uint32_t corner, std::uint32_t start,
                               const std::vector<std::uint32_t>& points) {
    return corner < start ? points[corner] : kNoVertex;
  }

  /// `left`, `right`: the points that neighbours have at this vertex; `edge`: whether the left one
  /// has the same point at the other end of the common edge.
  std::uint32_t codeBeside(std::uint32_t vertex, std::uint32_t left, std::uint32_t right, Edge edge,
                           std::uint32_t point) {
    const unsigned agree = left == kNoVertex || right == kNoVertex ? 0 : left == right ? 1 : 2;
    if (left != kNoVertex && coder_.bit(isLeft_[edge][agree], point == left)) return left;
    if (right != kNoVertex && right != left && coder_.bit(isRight_[edge][agree], point == right)) {
      return right;
    }
    return codeNew(vertex, point);
  }

  /// The next member that no corner has had, or else any.
  std::uint32_t codeNew(std::uint32_t vertex, std::uint32_t point) {
    const Span<const std::uint32_t> members = welding_.members(vertex);
    if (Coder::kWriting && mayRenumber_) return codeRenumbered(members, vertex, point);
    std::uint32_t& next = used_[vertex];
    while (next < members.size() && taken_[members[next]] != 0) ++next;
    if (next < members.size() && coder_.bit(isNew_, point == members[next])) {
      point = members[next];
    } else {
      point = members[coder_.uniform(welding_.memberOf(point),
                                     static_cast<std::uint32_t>(members.size() - 1))];
    }
    taken_[point] = 1;
    return point;
  }

  std::uint32_t codeRenumbered(Span<const std::uint32_t> members, std::uint32_t vertex,
                               std::uint32_t point) {
    std::uint32_t& next = used_[vertex];
    const bool fresh = number_[point] == kNoNumber;
    if (next < members.size()) coder_.bit(isNew_, fresh);
    if (fresh) {
      number_[point] = next++;
    } else {
      coder_.uniform(number_[point], static_cast<std::uint32_t>(members.size() - 1));
    }
    return point;
  }

  Coder& coder_;
  const Welding& welding_;
  bool mayRenumber_;
  std::vector<std::uint32_t> used_;    ///< of each vertex, so many members were met at least
  std::vector<std::uint32_t> number_;  ///< encoder that renumbers: of each point
  std::vector<std::uint8_t> taken_;
  std::array<std::array<entropy::AdaptiveBit, 3>, kStates> isLeft_;
  std::array<std::array<entropy::AdaptiveBit, 3>, kStates> isRight_;
  entropy::AdaptiveBit isNew_;
};

}  // namespace bspc::connectivity
