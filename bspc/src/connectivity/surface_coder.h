#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "bspc/error.h"
#include "connectivity/face_front.h"
#include "connectivity/face_size_symbols.h"
#include "connectivity/numbers.h"
#include "connectivity/surface_symbols.h"
#include "entropy/symbol_coder.h"

namespace bspc::connectivity {

/// Open gates: those first at which a vertex has many faces already, since little is left to be
/// said there; of equal ones the oldest.
class FullestFirst {
 public:
  explicit FullestFirst(const FaceFront& front) : front_(front) {}

  void push(Edge edge) { classes_[classOf(edge)].push_back(edge); }
  /// Takes the next open gate out; false if there is none.
  bool pop(Edge& edge) {
    for (unsigned c = kClasses; c-- > 0;) {
      while (!classes_[c].empty()) {
        edge = classes_[c].front();
        classes_[c].pop_front();
        if (!front_.isOpen(edge)) continue;
        const unsigned now = classOf(edge);
        if (now == c) return true;
        classes_[now].push_back(edge);
        c = now;
      }
    }
    return false;
  }

 private:
  static constexpr unsigned kClasses = 8;

  unsigned classOf(Edge edge) const {
    return std::min(std::max(front_.valence(edge.from), front_.valence(edge.to)), kClasses - 1);
  }

  const FaceFront& front_;
  std::array<std::deque<Edge>, kClasses> classes_;
};

/// Codes an oriented surface, and numbers its vertices as they appear, for encoder and decoder
/// alike: nothing is known of where they lie. `Truth` (FaceTruth or UnknownFaces) answers the
/// encoder's questions, with numbers of its own.
template <class Coder, class Truth>
class SurfaceCoder {
 public:
  /// `mostVertices`: how many there can be.
  SurfaceCoder(Coder& coder, FaceFront& front, Truth& truth, std::uint64_t mostVertices)
      : coder_(coder), front_(front), truth_(truth), mostVertices_(mostVertices), queue_(front) {
    if (Coder::kWriting) numberOf_.assign(static_cast<std::size_t>(mostVertices), kNoVertex);
  }

  /// `check(corners)` is called from time to time with how many corners were coded; it may throw to
  /// stop.
  template <class Check>
  void code(std::uint64_t faces, Check check) {
    Edge edge;
    while (front_.faces() < faces) {
      if (queue_.pop(edge)) {
        codeGate(edge, check);
      } else {
        codeFace(codeSeed(), check);
      }
    }
  }

  /// Of each vertex, its number in the truth. Of an encoder only.
  std::vector<std::uint32_t> takeGiven() { return std::move(given_); }

 private:
  enum Deed : std::uint8_t { kNew, kRight, kLeft, kOther, kBorder };
  static constexpr unsigned kCheckEvery = 1024;
  static constexpr std::uint64_t kMostSteps = 1024;

  [[noreturn]] static void corrupt(const std::string& what) {
    throw Error(ErrorCode::Corrupt, "the surface is damaged: " + what);
  }

  std::uint32_t addVertex(std::uint32_t given) {
    if (front_.vertices() >= mostVertices_) corrupt("it has more vertices than there are points");
    const auto number = static_cast<std::uint32_t>(front_.vertices());
    front_.addVertex();
    if (Coder::kWriting) {
      numberOf_[given] = number;
      given_.push_back(given);
    }
    return number;
  }

  /// A vertex of which nothing is known.
  std::uint32_t anyVertex(std::uint32_t number) {
    if (front_.vertices() == 0) corrupt("it begins with a vertex that there is not");
    return coder_.uniform(number, static_cast<std::uint32_t>(front_.vertices() - 1));
  }

  /// The first edge of a face that no gate leads to.
  Edge codeSeed() {
    Edge given;
    if (Coder::kWriting) {
      do {
        given = truth_.edgeOf(seed_++);
      } while (isCoded(given));
    }
    Edge edge;
    edge.from = codeSeedVertex(given.from);
    edge.to = codeSeedVertex(given.to);
    if (!Coder::kWriting && !front_.free(edge.from, edge.to)) corrupt("a face comes twice");
    return edge;
  }

  bool isCoded(Edge given) const {
    const std::uint32_t from = numberOf_[given.from];
    const std::uint32_t to = numberOf_[given.to];
    return from != kNoVertex && to != kNoVertex && !front_.free(from, to);
  }

  std::uint32_t codeSeedVertex(std::uint32_t given) {
    const std::uint32_t number = Coder::kWriting ? numberOf_[given] : 0;
    return coder_.bit(newSeed_, number == kNoVertex) ? addVertex(given) : anyVertex(number);
  }

  template <class Check>
  void codeGate(Edge edge, Check check) {
    const bool border = Coder::kWriting && !truth_.hasFaceAt({given_[edge.from], given_[edge.to]});
    if (symbols_.code(coder_, CornerQuestion::Border, contextOf(edge, front_.triangles(), true),
                      border)) {
      front_.close(edge);
      remember(kBorder);
    } else {
      codeFace(edge, check);
    }
  }

  template <class Check>
  void codeFace(Edge edge, Check check) {
    if (Coder::kWriting) truth_.take({given_[edge.from], given_[edge.to]});
    std::uint64_t size = 3;
    if (!front_.triangles()) {
      const std::uint32_t across = front_.faceAt(edge.to, edge.from);
      size = sizes_.code(coder_, truth_.face().size(),
                         across == kNoVertex ? 0 : front_.corners(across));
    }
    if (size < 3 || size > mostVertices_) corrupt("a face has an impossible number of corners");
    face_ = {edge.from, edge.to};
    Deed deed = kNew;
    for (std::uint64_t i = 2; i < size; ++i) {
      const std::uint32_t given = Coder::kWriting ? truth_.face()[face_.size()] : 0;
      face_.push_back(codeCorner({edge.from, face_.back()}, i + 1 == size, given, deed));
      if (++corners_ % kCheckEvery == 0) check(corners_);
    }
    if (!Coder::kWriting && !front_.fits(face_)) corrupt("an edge has two faces on the same side");
    front_.place(face_, opened_);
    deeds_.push_back(deed);
    for (const Edge opened : opened_) queue_.push(opened);
    remember(deed);
  }

  /// The vertex behind the edge in the face at hand.
  std::uint32_t codeCorner(Edge edge, bool closing, std::uint32_t given, Deed& deed) {
    const CornerContext context = contextOf(edge, closing, face_.size() == 2);
    const std::uint32_t number = Coder::kWriting ? numberOf_[given] : 0;
    const auto ask = [&](CornerQuestion question, Deed answer, bool bit) {
      if (!symbols_.code(coder_, question, context, bit)) return false;
      deed = answer;
      return true;
    };
    if (ask(CornerQuestion::New, kNew, number == kNoVertex)) return addVertex(given);
    const std::uint32_t right = rightOf(edge, closing);
    const std::uint32_t left = leftOf(edge, closing);
    if (right != kNoVertex && ask(CornerQuestion::Right, kRight, number == right)) return right;
    if (left != kNoVertex && left != right && ask(CornerQuestion::Left, kLeft, number == left)) {
      return left;
    }
    deed = kOther;
    return codeOther(edge, number);
  }

  /// The vertex that closes a further edge, if it is to be: the other end of the newest gate that
  /// leaves `to`, or of the newest that enters `from`.
  std::uint32_t rightOf(Edge edge, bool closing) const {
    const std::uint32_t vertex = ahead(edge.to);
    return vertex == kNoVertex || (closing && !front_.free(vertex, edge.from)) ? kNoVertex : vertex;
  }
  std::uint32_t leftOf(Edge edge, bool closing) const {
    const std::uint32_t vertex = closing ? behind(edge.from) : kNoVertex;
    return vertex == kNoVertex || !front_.free(edge.to, vertex) ? kNoVertex : vertex;
  }
  std::uint32_t ahead(std::uint32_t vertex) const {
    std::uint32_t next = kNoVertex;
    front_.gates().leaving(vertex, 1, [&](std::uint32_t other) { next = other; });
    return next;
  }
  std::uint32_t behind(std::uint32_t vertex) const {
    std::uint32_t next = kNoVertex;
    front_.gates().entering(vertex, 1, [&](std::uint32_t other) { next = other; });
    return next;
  }

  CornerContext contextOf(Edge edge, bool closing, bool first) const {
    const auto facesAt = [&](std::uint32_t vertex) {
      return vertex == kNoVertex ? CornerContext::kNobody
                                 : std::min(front_.valence(vertex), CornerContext::kMostFaces);
    };
    const auto bordered = [&](std::uint32_t vertex) {
      return front_.borderBeginsAt(vertex) || front_.borderEndsAt(vertex);
    };
    const auto gatesAt = [&](std::uint32_t vertex) {
      return std::min(front_.gates().count(vertex), 4U);
    };
    CornerContext context;
    context.from = facesAt(edge.from);
    context.to = facesAt(edge.to);
    context.right = facesAt(rightOf(edge, closing));
    context.left = facesAt(leftOf(edge, closing));
    context.border = (bordered(edge.from) ? 1U : 0U) + (bordered(edge.to) ? 2U : 0U);
    context.gates = gatesAt(edge.from) * 5 + gatesAt(edge.to);
    context.last = last_;
    context.before = before_;
    context.closing = closing;
    const std::uint32_t corner = first ? front_.cornerAt(edge.to, edge.from) : kNoVertex;
    if (corner == kNoVertex) return context;
    const std::uint32_t across = front_.faceOf(corner);
    context.apex = facesAt(front_.apexOf(edge.to, edge.from));
    context.across = deeds_[across] * 3U + std::min(corner - front_.faceStart(across), 2U);
    return context;
  }

  /// A vertex that neither is new nor closes another edge: some gates away, or else any.
  std::uint32_t codeOther(Edge edge, std::uint32_t number) {
    unsigned way = kAnywhere;
    std::uint64_t steps = 0;
    if (Coder::kWriting) way = findOther(edge, number, steps);
    way = coder_.symbol(way_, way);
    if (way == kAnywhere) return anyVertex(number);
    steps = steps_[way].code(coder_, steps);
    if (steps > kMostSteps) corrupt("a face reaches too far");
    std::uint32_t vertex = way == kAhead ? edge.to : edge.from;
    for (std::uint64_t i = 0; i <= steps && vertex != kNoVertex; ++i) {
      vertex = way == kAhead ? ahead(vertex) : behind(vertex);
    }
    if (vertex == kNoVertex) corrupt("a face reaches beyond the surface");
    return vertex;
  }

  unsigned findOther(Edge edge, std::uint32_t number, std::uint64_t& steps) const {
    std::uint32_t right = ahead(edge.to);
    std::uint32_t left = behind(edge.from);
    for (steps = 0; steps <= kMostSteps && (right != kNoVertex || left != kNoVertex); ++steps) {
      if (right == number) return kAhead;
      if (left == number) return kBehind;
      if (right != kNoVertex) right = ahead(right);
      if (left != kNoVertex) left = behind(left);
    }
    return kAnywhere;
  }

  void remember(Deed deed) {
    before_ = last_;
    last_ = deed;
  }

  static constexpr unsigned kAhead = 0;
  static constexpr unsigned kBehind = 1;
  static constexpr unsigned kAnywhere = 2;

  Coder& coder_;
  FaceFront& front_;
  Truth& truth_;
  std::uint64_t mostVertices_;
  FullestFirst queue_;
  SurfaceSymbols symbols_;
  FaceSizeSymbols sizes_;
  entropy::AdaptiveBit newSeed_;
  entropy::AdaptiveSymbols<3> way_;
  std::array<AdaptiveNumber, 2> steps_;
  std::size_t seed_ = 0;
  std::uint64_t corners_ = 0;
  unsigned last_ = kNew;
  unsigned before_ = kNew;
  std::vector<std::uint8_t> deeds_;  ///< how the last corner of each face was found
  std::vector<std::uint32_t> face_;
  std::vector<Edge> opened_;
  std::vector<std::uint32_t> numberOf_;  ///< of each vertex of the truth
  std::vector<std::uint32_t> given_;
};

}  // namespace bspc::connectivity
