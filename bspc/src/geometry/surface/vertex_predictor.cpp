#include "geometry/surface/vertex_predictor.h"

#include <algorithm>
#include <cmath>

namespace bspc::geometry::surface {

namespace {

std::int64_t rounded(double x) {
  constexpr double kMost = 17179869184;  // 2^34: beyond every grid
  return static_cast<std::int64_t>(std::floor(x > -kMost ? (x < kMost ? x + 0.5 : kMost) : -kMost));
}

Vector3 placeOf(const GridPoint& p) {
  return {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
}

Vector3 middleOf(const GridPoint& extent) {
  return placeOf({extent[0] / 2, extent[1] / 2, extent[2] / 2});
}

}  // namespace

VertexPredictor::VertexPredictor(const VertexRings& rings, const GridPoint& extent)
    : rings_(rings), known_(rings.vertices()), last_(middleOf(extent)) {}

const VertexPrediction& VertexPredictor::predict(std::uint32_t vertex) {
  gather(vertex);
  makeFeatures(vertex);
  makeFrame();
  makeGuesses();
  makeExact();
  return prediction_;
}

void VertexPredictor::gather(std::uint32_t vertex) {
  near_.clear();
  for (const std::uint32_t v : rings_.neighbours(vertex)) {
    if (known_[v].known) near_.push_back(v);
  }
  parallelograms_.clear();
  hasEdge_ = false;
  for (const VertexRings::Side side : rings_.sides(vertex)) {
    if (!known_[side.from].known || !known_[side.to].known) continue;
    const std::uint32_t across = rings_.third(side.to, side.from);
    if (isKnown(across) && across != vertex) {
      const Vector3 edge = at(side.to) - at(side.from);
      parallelograms_.push_back(
          {side.from, side.to, across, dot(edge, edge), at(side.from) + at(side.to) - at(across)});
    } else if (!hasEdge_) {
      hasEdge_ = true;
      edge_ = 0.5 * (at(side.from) + at(side.to));
    }
  }
  const std::size_t count = parallelograms_.size();
  prediction_.situation = count > 0  ? static_cast<unsigned>(std::min<std::size_t>(count, 4)) - 1
                          : hasEdge_ ? 4
                          : !near_.empty() ? 5
                                           : 6;
}

void VertexPredictor::makeFeatures(std::uint32_t vertex) {
  mean_ = last_;
  if (!near_.empty()) {
    Vector3 sum{};
    for (const std::uint32_t v : near_) sum = sum + at(v);
    mean_ = (1 / static_cast<double>(near_.size())) * sum;
  }
  features_ = {};
  normal_ = {};
  if (!parallelograms_.empty()) {
    addParallelograms();
  } else {
    base_ = hasEdge_ ? edge_ : mean_;
  }
  features_[0] = mean_ - base_;
  features_[5] = meanAround(vertex);
  features_[7] = meanStraight(vertex);
}

void VertexPredictor::addParallelograms() {
  Vector3 sum{};
  Vector3 turns{};
  Vector3 errors{};
  Vector3 errorsAcross{};
  Vector3 middles{};
  for (const Parallelogram& p : parallelograms_) {
    const Vector3& a = at(p.a);
    const Vector3& b = at(p.b);
    const Vector3& d = at(p.across);
    sum = sum + p.place;
    middles = middles + (a + b);
    // How far the next two parallelograms beyond this one were off.
    const std::uint32_t besideA = rings_.third(p.across, p.a);
    const std::uint32_t besideB = rings_.third(p.b, p.across);
    if (isKnown(besideA)) turns = turns + (at(besideA) - (d + a - b));
    if (isKnown(besideB)) turns = turns + (at(besideB) - (d + b - a));
    errors = errors + (known_[p.a].error + known_[p.b].error);
    errorsAcross = errorsAcross + known_[p.across].error;
    normal_ = normal_ + cross(d - a, b - a);
  }
  std::stable_sort(
      parallelograms_.begin(), parallelograms_.end(),
      [](const Parallelogram& x, const Parallelogram& y) { return x.length > y.length; });
  const double share = 1 / static_cast<double>(parallelograms_.size());
  base_ = share * sum;
  features_[1] = share * turns;
  features_[2] = share * errors;
  features_[3] = (0.5 * share) * middles - base_;
  features_[4] = parallelograms_[0].place - base_;
  features_[6] = share * errorsAcross;
}

/// The mean place of neighbours of neighbours, from the base.
Vector3 VertexPredictor::meanAround(std::uint32_t vertex) const {
  Vector3 sum{};
  double count = 0;
  for (const std::uint32_t v : near_) {
    const Span<const std::uint32_t> ring = rings_.neighbours(v);
    for (std::size_t i = 0; i < std::min(ring.size(), kMostAround); ++i) {
      if (!known_[ring[i]].known || ring[i] == vertex) continue;
      sum = sum + at(ring[i]);
      count += 1;
    }
  }
  return count > 0 ? (1 / count) * sum - base_ : Vector3{};
}

/// The mean place straight on behind neighbours, from the base.
Vector3 VertexPredictor::meanStraight(std::uint32_t vertex) const {
  Vector3 sum{};
  double count = 0;
  for (const std::uint32_t v : near_) {
    const std::uint32_t other = opposite(vertex, v);
    if (!isKnown(other)) continue;
    sum = sum + (2.0 * at(v) - at(other));
    count += 1;
  }
  return count > 0 ? (1 / count) * sum - base_ : Vector3{};
}

std::uint32_t VertexPredictor::opposite(std::uint32_t vertex, std::uint32_t middle) const {
  std::array<std::uint32_t, kMostAround> around{};
  std::size_t count = 0;
  std::uint32_t v = vertex;
  while (count < kMostAround) {
    around[count++] = v;
    v = rings_.third(middle, v);
    if (v == kNoVertex) return kNoVertex;
    if (v == vertex) return count % 2 == 0 ? around[count / 2] : kNoVertex;
  }
  return kNoVertex;
}

/// Along the normal of the faces across, from the neighbours to the base, and across both.
void VertexPredictor::makeFrame() {
  frame_ = {Vector3{1, 0, 0}, Vector3{0, 1, 0}, Vector3{0, 0, 1}};
  const double length = std::sqrt(dot(normal_, normal_));
  if (!(length > 0)) return;
  const Vector3 n = (1 / length) * normal_;
  const auto inPlane = [&](const Vector3& v) { return v - dot(v, n) * n; };
  Vector3 ahead = inPlane(base_ - mean_);
  double size = std::sqrt(dot(ahead, ahead));
  if (!(size > 1e-9)) {
    ahead = inPlane(std::fabs(n[0]) < 0.7 ? Vector3{1, 0, 0} : Vector3{0, 1, 0});
    size = std::sqrt(dot(ahead, ahead));
  }
  ahead = (1 / size) * ahead;
  frame_ = {n, ahead, cross(n, ahead)};
}

void VertexPredictor::makeGuesses() {
  constexpr double kUsualShare = 0.5;
  constexpr double kLeastVariance = 0.3;
  const unsigned situation = prediction_.situation;
  const std::array<Vector3, kGuesses> places{
      base_, parallelograms_.empty() ? base_ : parallelograms_[0].place, mean_,
      base_ + stencils_[situation].estimate(features_), base_ + features_[1]};
  for (unsigned g = 0; g < kGuesses; ++g) {
    VertexPrediction::Guess& guess = prediction_.guesses[g];
    guess.place = places[g];
    const Scale& scale = scales_[situation][g];
    std::array<double, 3> variance{};
    for (unsigned j = 0; j < 3; ++j) {
      double sum = scale.sum[j] / scale.weight * kUsualShare;
      for (const std::uint32_t v : near_) {
        const double error = dot(known_[v].errors[g], frame_[j]);
        sum += error * error;
      }
      variance[j] = sum / (kUsualShare + static_cast<double>(near_.size())) + kLeastVariance;
    }
    for (unsigned i = 0; i < 3; ++i) {
      for (unsigned j = 0; j < 3; ++j) {
        guess.spread[i][j] = variance[0] * frame_[0][i] * frame_[0][j] +
                             variance[1] * frame_[1][i] * frame_[1][j] +
                             variance[2] * frame_[2][i] * frame_[2][j];
      }
    }
  }
}

void VertexPredictor::makeExact() {
  for (unsigned k = 0; k < 3; ++k) {
    for (unsigned e = 0; e < kExact; ++e) prediction_.exact[e].value[k] = VertexPrediction::kNever;
    for (unsigned e = 0; e < 2 && e < parallelograms_.size(); ++e) {
      prediction_.exact[e].value[k] = rounded(parallelograms_[e].place[k]);
    }
    if (!parallelograms_.empty()) prediction_.exact[2].value[k] = rounded(base_[k]);
    if (!near_.empty()) prediction_.exact[4].value[k] = rounded(at(near_[0])[k]);
    makeShared(k);
    for (unsigned e = 0; e < kExact; ++e) prediction_.exact[e].trust[k] = trustOf(e, k);
  }
}

/// The coordinate that most neighbours have, of equally frequent ones the smallest.
void VertexPredictor::makeShared(unsigned axis) {
  std::vector<double> values;
  values.reserve(near_.size());
  for (const std::uint32_t v : near_) values.push_back(at(v)[axis]);
  std::sort(values.begin(), values.end());
  std::size_t most = 0;
  for (std::size_t i = 0; i < values.size();) {
    std::size_t end = i;
    while (end < values.size() && values[end] == values[i]) ++end;
    if (end - i > most) {
      most = end - i;
      prediction_.exact[VertexPrediction::kShared].value[axis] = rounded(values[i]);
    }
    i = end;
  }
  prediction_.sharing[axis] = static_cast<std::uint8_t>(most < 2 ? 0 : most == 2 ? 1 : 2);
}

/// Whether the value held for none, some or all of the neighbours, and the last two times.
std::uint8_t VertexPredictor::trustOf(unsigned exact, unsigned axis) const {
  std::size_t hits = 0;
  for (const std::uint32_t v : near_) hits += known_[v].hits[exact][axis] ? 1 : 0;
  const unsigned held = near_.empty()         ? 4
                        : hits == 0           ? 0
                        : hits < near_.size() ? 1
                        : near_.size() == 1   ? 2
                                              : 3;
  return static_cast<std::uint8_t>(4 * held + recent_[exact][axis]);
}

void VertexPredictor::learn(std::uint32_t vertex, const GridPoint& place) {
  constexpr double kDecay = 0.95;
  Known& known = known_[vertex];
  known.place = placeOf(place);
  known.known = true;
  const unsigned situation = prediction_.situation;
  const Vector3 target = known.place - base_;
  stencils_[situation].learn(features_, target);
  if (!parallelograms_.empty()) known.error = target;
  for (unsigned g = 0; g < kGuesses; ++g) {
    known.errors[g] = known.place - prediction_.guesses[g].place;
    Scale& scale = scales_[situation][g];
    scale.weight = scale.weight * kDecay + 1;
    for (unsigned j = 0; j < 3; ++j) {
      const double error = dot(known.errors[g], frame_[j]);
      scale.sum[j] = scale.sum[j] * kDecay + error * error;
    }
  }
  for (unsigned e = 0; e < kExact; ++e) {
    for (unsigned k = 0; k < 3; ++k) {
      const bool hit = prediction_.exact[e].value[k] == static_cast<std::int64_t>(place[k]);
      known.hits[e][k] = hit;
      recent_[e][k] = static_cast<std::uint8_t>((recent_[e][k] * 2 + (hit ? 1 : 0)) & 3);
    }
  }
  last_ = known.place;
}

}  // namespace bspc::geometry::surface
