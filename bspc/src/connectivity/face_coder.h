#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "bspc/error.h"
#include "connectivity/advancing_front.h"
#include "connectivity/candidate_weights.h"
#include "connectivity/face_size_symbols.h"
#include "connectivity/gate_queue.h"
#include "connectivity/gate_symbols.h"
#include "connectivity/ranking.h"
#include "entropy/symbol_coder.h"

namespace bspc::connectivity {

/// What the stream says about how its faces are coded.
struct FaceCoding {
  RankingReach reach;
  bool surestFirst = true;  ///< else the newest gate is next
  bool flips = false;  ///< some faces were turned around to be consistent with their neighbours
};

/// Codes faces by an advancing front over known vertices, for encoder and decoder alike: each next
/// vertex is one of the front's candidates, whose ranking the geometry gives. `Truth` (FaceTruth or
/// UnknownFaces) answers the encoder's questions.
template <class Coder, class Truth>
class FaceCoder {
 public:
  FaceCoder(Coder& coder, AdvancingFront& front, const FaceCoding& coding, Truth& truth)
      : coder_(coder),
        front_(front),
        coding_(coding),
        truth_(truth),
        ranker_(front, weights_),
        remembered_(kRemembered) {}

  /// `check()` is called from time to time; it may throw to stop.
  template <class Check>
  void code(std::uint64_t faces, Check check) {
    for (std::uint32_t seed = 0; front_.faces() < faces; ++seed) {
      if (seed >= front_.vertices()) {
        if (Coder::kWriting) return;  // what was not reached has to be told in another way
        corrupt("a mesh has fewer faces than it says");
      }
      if (front_.valence(seed) > 0) continue;
      if (!coder_.bit(isSeed_, Coder::kWriting && truth_.usesVertex(seed))) {
        front_.dismiss(seed);
        continue;
      }
      codeFirstFace(seed);
      Ranking* ranking = nullptr;
      while (front_.faces() < faces && (ranking = nextGate()) != nullptr) {
        codeGate(*ranking);
        if (front_.allCorners().size() >= checked_ + kCheckEvery) {
          checked_ = front_.allCorners().size();
          check();
        }
      }
    }
  }

  /// Of each face, whether it was turned around; empty if the coding says none was.
  const std::vector<std::uint8_t>& flipped() const { return flipped_; }

 private:
  static constexpr std::size_t kSeedNeighbours = 24;
  static constexpr std::size_t kRemembered = 4;
  static constexpr std::size_t kCheckEvery = 1024;
  static constexpr RankingReach kEscapeReach{64, 300, VertexIndex::Among::All};
  static constexpr std::size_t kEscapeClasses = 32;

  [[noreturn]] static void corrupt(const std::string& what) {
    throw Error(ErrorCode::Corrupt, "the faces are damaged: " + what);
  }

  std::uint32_t anyVertex(std::uint32_t value) {
    return coder_.uniform(value, static_cast<std::uint32_t>(front_.vertices() - 1));
  }

  void codeFirstFace(std::uint32_t seed) {
    Position place = front_.position(seed);
    for (double& x : place) x *= 2;
    front_.index().nearest(place, kSeedNeighbours + 1, VertexIndex::Among::Awake, neighbours_);
    std::uint32_t second = Coder::kWriting ? truth_.neighbour(seed, neighbours_) : 0;
    std::size_t rank = 0;
    bool found = false;
    for (const Neighbour& n : neighbours_) {
      if (n.vertex == seed || rank == kSeedNeighbours) continue;
      found = coder_.bit(seedRank_[rank++], n.vertex == second);
      if (found) {
        second = n.vertex;
        break;
      }
    }
    if (!found) second = anyVertex(second);
    forget();
    codeFace(remembered(front_.gateAt({seed, second})));
  }

  /// The ranking of the gate that is to be coded next; nullptr if none is open.
  Ranking* nextGate() {
    Edge edge;
    unsigned priority = 0;
    while (queue_.pop(edge, priority)) {
      if (!front_.isOpen(edge)) continue;
      Ranking& ranking = remembered(front_.gateAt(edge));
      if (coding_.surestFirst) {
        const unsigned now = GateQueue::classOf(ranking);
        if (now > priority) {
          queue_.push(now, edge);
          continue;
        }
      }
      return &ranking;
    }
    return nullptr;
  }

  void codeGate(Ranking& ranking) {
    const Edge edge = ranking.gate.edge;
    const bool border = Coder::kWriting && !truth_.hasFaceAt(edge);
    if (symbols_.border(coder_, front_, ranking, border)) {
      front_.markBorder(edge);
      forget();
    } else {
      codeFace(ranking);
    }
  }

  /// Codes the face at the gate, which was ranked as if it were a triangle.
  void codeFace(Ranking& ranking) {
    const Gate gate = ranking.gate;
    if (Coder::kWriting) truth_.take(gate.edge);
    std::uint64_t size = 3;
    const std::uint32_t across = front_.faceAt(gate.edge.to, gate.edge.from);
    if (!front_.triangles()) {
      size = sizes_.code(coder_, truth_.face().size(),
                         across == kNoVertex ? 0 : front_.corners(across));
    }
    if (size < 3 || size > front_.vertices()) corrupt("a face has an impossible number of corners");
    face_ = {gate.edge.from, gate.edge.to};
    for (std::uint64_t i = 2; i < size; ++i) codeCorner(ranking, gate, i + 1 == size);
    if (coding_.flips) {
      const unsigned context = across == kNoVertex ? 2 : flipped_[across];
      flipped_.push_back(coder_.bit(flip_[context], Coder::kWriting && truth_.flipped()) ? 1 : 0);
    }
    if (!Coder::kWriting && !front_.fits(face_)) corrupt("an edge has two faces on the same side");
    front_.add(face_, opened_);
    forget();
    for (const Edge edge : opened_) {
      queue_.push(coding_.surestFirst ? GateQueue::classOf(remembered(front_.gateAt(edge))) : 0,
                  edge);
    }
  }

  void codeCorner(Ranking& first, const Gate& gate, bool last) {
    const std::uint32_t value = Coder::kWriting ? truth_.face()[face_.size()] : 0;
    if (face_.size() == 2 && last) {
      face_.push_back(codeVertex(first, value));
      return;
    }
    Gate next = gate;
    next.closing = last;
    if (face_.size() > 2) {
      next.edge.to = face_.back();
      next.apex = face_[face_.size() - 2];
      next.diagonal = true;
      next.straight = false;
    }
    ranker_.rank(next, coding_.reach, corner_);
    face_.push_back(codeVertex(corner_, value));
  }

  std::uint32_t codeVertex(const Ranking& ranking, std::uint32_t value) {
    const std::vector<Candidate>& candidates = ranking.candidates;
    std::size_t at = 0;
    if (Coder::kWriting) {
      while (at < candidates.size() && candidates[at].vertex != value) ++at;
    }
    at = symbols_.candidate(coder_, front_, ranking, at);
    if (at == candidates.size()) return codeEscape(ranking, value);
    const std::uint32_t vertex = candidates[at].vertex;
    weights_.learn(gateKind(ranking.gate), candidates, at);
    return vertex;
  }

  /// A vertex that is not among the candidates: one of a wider search, or else any.
  std::uint32_t codeEscape(const Ranking& ranking, std::uint32_t value) {
    ranker_.rank(ranking.gate, kEscapeReach, wide_);
    std::size_t place = 0;
    for (const Candidate& c : wide_.candidates) {
      bool refused = false;
      for (const Candidate& other : ranking.candidates) refused |= other.vertex == c.vertex;
      if (refused) continue;
      const std::size_t placeClass =
          std::min(place < 8 ? place : 8 + place / 8, kEscapeClasses - 1);
      if (coder_.bit(escape_[c.kind][placeClass], c.vertex == value)) return c.vertex;
      ++place;
    }
    return anyVertex(value);
  }

  /// The ranking of a gate, made anew unless nothing has changed since it was made last.
  Ranking& remembered(const Gate& gate) {
    for (std::size_t i = 0; i < inUse_; ++i) {
      const Edge edge = remembered_[i].gate.edge;
      if (edge.from == gate.edge.from && edge.to == gate.edge.to) return remembered_[i];
    }
    if (inUse_ == kRemembered) inUse_ = 0;
    Ranking& ranking = remembered_[inUse_++];
    ranker_.rank(gate, coding_.reach, ranking);
    return ranking;
  }
  void forget() { inUse_ = 0; }

  Coder& coder_;
  AdvancingFront& front_;
  FaceCoding coding_;
  Truth& truth_;
  CandidateWeights weights_;
  Ranker ranker_;
  GateQueue queue_;
  GateSymbols symbols_;
  FaceSizeSymbols sizes_;
  entropy::AdaptiveBit isSeed_;
  std::array<entropy::AdaptiveBit, kSeedNeighbours> seedRank_;
  std::array<entropy::AdaptiveBit, 3> flip_;
  std::array<std::array<entropy::AdaptiveBit, kEscapeClasses>, kKinds> escape_;
  std::vector<std::uint8_t> flipped_;
  std::vector<Ranking> remembered_;  ///< the first inUse_ of them
  std::size_t inUse_ = 0;
  std::size_t checked_ = 0;  ///< corners when check() was called last
  Ranking corner_;
  Ranking wide_;
  std::vector<Neighbour> neighbours_;
  std::vector<std::uint32_t> face_;
  std::vector<Edge> opened_;
};

}  // namespace bspc::connectivity
