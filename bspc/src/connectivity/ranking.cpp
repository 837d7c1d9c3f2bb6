#include "connectivity/ranking.h"

#include <algorithm>
#include <cmath>

#include "entropy/logistic_math.h"

namespace bspc::connectivity {

namespace {

constexpr unsigned kGatesAtVertex = 16;
constexpr float kFar = 50;  ///< stands for an infinite cotangent

/// min(4, excess) / 2 for valences
float half(std::uint32_t count) { return 0.5F * static_cast<float>(std::min(count, 4U)); }

std::uint32_t difference(std::uint32_t a, std::uint32_t b) { return a > b ? a - b : b - a; }

/// Cosine of the angle between a normal and a vector of length `size`; 1 if it has none.
float cosineTo(const Vector& unit, const Vector& vector, float size) {
  return size > 0 ? dot(unit, vector) / size : 1;
}

}  // namespace

void Ranker::rank(const Gate& gate, const RankingReach& reach, Ranking& ranking) {
  const GateFrame frame(front_, gate);
  ranking.gate = gate;
  ranking.apexCosine = frame.apexCosine;
  ranking.longest = frame.longest;
  gather(gate, frame, reach);
  std::vector<Candidate>& candidates = ranking.candidates;
  candidates.clear();
  for (const std::uint32_t vertex : found_) candidates.push_back(describe(gate, frame, vertex));
  compareCotangents(candidates);
  const unsigned kind = gateKind(gate);
  for (Candidate& c : candidates) c.score = weights_.score(kind, c);
  std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
    return a.score != b.score ? a.score > b.score : a.vertex < b.vertex;
  });
  if (candidates.size() > reach.candidates) candidates.resize(reach.candidates);
  float sum = 0;
  for (Candidate& c : candidates) {
    c.probability = entropy::exp2((c.score - candidates[0].score) * 1.44269504F);
    sum += c.probability;
  }
  for (Candidate& c : candidates) c.probability = c.probability / sum;
}

void Ranker::gather(const Gate& gate, const GateFrame& frame, const RankingReach& reach) {
  found_.clear();
  front_.gates().leaving(gate.edge.to, kGatesAtVertex,
                         [&](std::uint32_t vertex) { consider(gate, vertex); });
  front_.gates().entering(gate.edge.from, kGatesAtVertex,
                          [&](std::uint32_t vertex) { consider(gate, vertex); });
  if (frame.hasFace) nearest(gate, frame.target, reach);
  Position middle{};
  const Position& end = front_.position(gate.edge.to);
  for (std::size_t k = 0; k < 3; ++k) middle[k] = frame.origin[k] + end[k];
  nearest(gate, middle, reach);
}

void Ranker::nearest(const Gate& gate, const Position& place, const RankingReach& reach) {
  front_.index().nearest(place, reach.neighbours, reach.among, neighbours_);
  for (const Neighbour& neighbour : neighbours_) consider(gate, neighbour.vertex);
}

void Ranker::consider(const Gate& gate, std::uint32_t vertex) {
  if (vertex == gate.edge.from || vertex == gate.edge.to || vertex == gate.apex) return;
  if (std::find(found_.begin(), found_.end(), vertex) != found_.end()) return;
  if (front_.valence(vertex) > 0) {
    if (!front_.free(gate.edge.to, vertex)) return;
    if (gate.closing && !front_.free(vertex, gate.edge.from)) return;
  }
  found_.push_back(vertex);
}

Candidate Ranker::describe(const Gate& gate, const GateFrame& frame, std::uint32_t vertex) const {
  Candidate c;
  c.vertex = vertex;
  auto& f = c.feature;
  const Vector a = frame.toVertex(vertex);
  const Vector b{a[0] - frame.edge[0], a[1] - frame.edge[1], a[2] - frame.edge[2]};
  const Vector normal = cross(frame.edge, a);
  const float size = std::sqrt(dot(normal, normal));
  const float toA = std::sqrt(dot(a, a));
  const float toB = std::sqrt(dot(b, b));
  const float ab = dot(a, b);
  c.cotangent = size > 0 ? ab / size : (ab > 0 ? kFar : -kFar);
  const float cosine = toA > 0 && toB > 0 ? ab / (toA * toB) : 1;
  const float foldCosine = frame.hasNormal ? cosineTo(frame.normal, normal, size) : 1;

  bool gluesFirst = false;
  bool gluesSecond = false;
  if (front_.valence(vertex) > 0) {
    gluesFirst = front_.isOpen({gate.edge.to, vertex});
    gluesSecond = gate.closing && front_.isOpen({vertex, gate.edge.from});
    c.kind = gluesFirst && gluesSecond ? 2 : gluesFirst || gluesSecond ? 1 : 3;
  }
  f[kBias] = 1;
  f[kCotangent] = 0.5F * entropy::clamped(c.cotangent, -3, 8);
  f[kCosine] = cosine;
  f[kFold] = 1 - foldCosine;
  f[kFoldSquared] = 0.5F * f[kFold] * f[kFold];
  if (gluesFirst || gluesSecond) {
    // Glued edges first, so that their faces are looked up only where there are any.
    describeFolds(gate, frame, a, normal, c);
  }
  const float perimeter = 1 + toA + toB;
  const float logPerimeter = entropy::naturalLog(perimeter);
  f[kPerimeter] = logPerimeter - 1.0986123F;
  if (frame.hasFace) {
    f[kPerimeterChange] = entropy::magnitude(logPerimeter - frame.logPerimeter);
    const Vector away{a[0] - frame.toTarget[0], a[1] - frame.toTarget[1], a[2] - frame.toTarget[2]};
    const float distance = std::sqrt(dot(away, away));
    f[kParallelogram] = entropy::clamped(2 * distance / perimeter, 0, 4);
    const auto steps = static_cast<float>(1 + static_cast<double>(distance) * frame.length);
    f[kParallelogramLog] = entropy::clamped(entropy::naturalLog(steps) - frame.logLength, -4, 4);
  }
  const bool isLongest = toA <= 1 && toB <= 1;
  f[kAngleChange] = entropy::magnitude(cosine - frame.apexCosine);
  f[kLongestKept] = isLongest == frame.longest ? 1 : 0;
  f[kCoplanarLongest] = isLongest && frame.longest && foldCosine > 0.98F ? 1 : 0;
  f[kCoplanar] = foldCosine > 0.999F ? 1 : 0;
  if (frame.hasNormal) describeGaps(frame, a, b, gluesFirst, gluesSecond, c);
  describeValences(gate, gluesFirst, gluesSecond, c);
  return c;
}

void Ranker::describeFolds(const Gate& gate, const GateFrame& frame, const Vector& toCandidate,
                           const Vector& normal, Candidate& c) const {
  const float size = std::sqrt(dot(normal, normal));
  float sum = 0;
  unsigned edges = 0;
  const auto foldAt = [&](std::uint32_t from, std::uint32_t to, const Vector& origin,
                          const Vector& along) {
    const std::uint32_t apex = front_.apexOf(to, from);
    if (apex == kNoVertex) return;
    Vector toApex = frame.toVertex(apex);
    for (std::size_t k = 0; k < 3; ++k) toApex[k] -= origin[k];
    const Vector across = cross(toApex, along);
    const float acrossSize = std::sqrt(dot(across, across));
    sum += 1 - (size > 0 && acrossSize > 0 ? dot(across, normal) / (acrossSize * size) : 1.0F);
    ++edges;
  };
  if (front_.isOpen({gate.edge.to, c.vertex})) {
    const Vector along{toCandidate[0] - frame.edge[0], toCandidate[1] - frame.edge[1],
                       toCandidate[2] - frame.edge[2]};
    foldAt(gate.edge.to, c.vertex, frame.edge, along);
  }
  if (gate.closing && front_.isOpen({c.vertex, gate.edge.from})) {
    foldAt(c.vertex, gate.edge.from, Vector{}, {-toCandidate[0], -toCandidate[1], -toCandidate[2]});
  }
  if (edges == 0) return;
  c.feature[kGlueFold] = sum / static_cast<float>(edges);
  c.feature[kGlueFoldSquared] = 0.5F * c.feature[kGlueFold] * c.feature[kGlueFold];
}

void Ranker::describeGaps(const GateFrame& frame, const Vector& toCandidate, const Vector& fromEnd,
                          bool gluesFirst, bool gluesSecond, Candidate& c) const {
  auto& f = c.feature;
  const auto compare = [&](float turn, float gap, std::uint32_t vertex, bool glues) {
    if (vertex == kNoVertex) return;
    if (c.vertex == vertex) {
      if (glues) f[kGapClosed] += 1 - std::min(gap, 2.0F);
      return;
    }
    const float room = gap - turn;
    if (room < 0) {
      f[kOverlap] += 1;
    } else if (room < 0.5F) {
      f[kSliver] += (0.5F - room) * 2;
    }
  };
  compare(GateFrame::turn(-dot(fromEnd, frame.edge), dot(fromEnd, frame.inward)), frame.leavingTurn,
          frame.leavingVertex, gluesFirst);
  compare(GateFrame::turn(dot(toCandidate, frame.edge), dot(toCandidate, frame.inward)),
          frame.enteringTurn, frame.enteringVertex, gluesSecond);
}

void Ranker::describeValences(const Gate& gate, bool gluesFirst, bool gluesSecond,
                              Candidate& c) const {
  auto& f = c.feature;
  const std::uint32_t usual = front_.triangles() ? 6 : 4;
  const auto atEnd = [&](std::uint32_t vertex, bool glued) {
    const std::uint32_t valence = front_.valence(vertex) + 1;
    if (glued && front_.gates().count(vertex) == 2) {
      f[kClosedValence] += half(difference(valence, usual));
    } else if (valence >= usual) {
      f[kValenceExcess] += half(valence + 1 - usual);
    }
  };
  atEnd(gate.edge.to, gluesFirst);
  atEnd(gate.edge.from, gluesSecond);
  const std::uint32_t valence = front_.valence(c.vertex) + 1;
  if (c.kind == 2 && front_.gates().count(c.vertex) == 2) {
    f[kClosedValence] += half(difference(valence, usual));
  } else if (valence >= usual) {
    f[kApexExcess] = half(valence + 1 - usual);
  }
}

void Ranker::compareCotangents(std::vector<Candidate>& candidates) {
  byCotangent_.clear();
  for (std::uint32_t i = 0; i < candidates.size(); ++i) byCotangent_.push_back(i);
  std::sort(byCotangent_.begin(), byCotangent_.end(), [&](std::uint32_t i, std::uint32_t j) {
    const Candidate& a = candidates[i];
    const Candidate& b = candidates[j];
    return a.cotangent != b.cotangent ? a.cotangent < b.cotangent : a.vertex < b.vertex;
  });
  unsigned rank = 0;
  for (const std::uint32_t i : byCotangent_) {
    Candidate& c = candidates[i];
    c.feature[kRank] = half(rank);
    c.feature[kBest] = rank == 0 ? 1 : 0;
    c.feature[kMargin] = 0.5F * std::min(3.0F, c.cotangent - candidates[byCotangent_[0]].cotangent);
    if (c.feature[kFold] < 1.2F && c.feature[kOverlap] < 0.5F) ++rank;
  }
}

}  // namespace bspc::connectivity
