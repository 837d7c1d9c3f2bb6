#pragma once

#include "geometry/predictive/candidates.h"

// Bodies of candidates.h. They are inline so that each build of the coder has its own.

namespace bspc::geometry::predictive {
inline namespace BSPC_LANE_SET {

/// Calls `visit` with the number of every bit that is set.
template <class Visit>
inline void forEachBit(std::uint32_t bits, Visit visit) {
  for (; bits != 0; bits &= bits - 1) visit(static_cast<unsigned>(__builtin_ctz(bits)));
}

/// Bits of the lanes from `i` on that are among the first `count`.
constexpr std::uint32_t lanesBefore(unsigned count, unsigned i) {
  return count - i < entropy::kLanes ? (1U << (count - i)) - 1 : 0xFF;
}

inline void Candidates::startCell(NearPoints& near, float side, float spacing) {
  middle_ = 0.5F * side;
  reach_ = middle_ + 0.3F * spacing;
  innerReach_ = middle_ + 0.8F * spacing;  // 0.77, and what rounding may take
  pairSquare_ = static_cast<float>(features_.pairReach) * spacing * spacing;
  minimumSquare_ = 0.22F * spacing * spacing;
  inverseSquare_ = 1 / (spacing * spacing);
  for (List& list : list_) list.count = 0;
  inners_ = 0;
  for (unsigned t = 0; t < near.count; ++t) addInner(near, t);
  for (unsigned t = 0; t < near.count; ++t) proposeAround(near, t);
}

inline void Candidates::addPoint(const NearPoints& near) {
  const unsigned t = near.count - 1;
  dropNear(near.x[t], near.y[t], near.z[t]);
  addInner(near, t);
  proposeAround(near, t);
}

inline void Candidates::addInner(const NearPoints& near, unsigned t) {
  inner_[inners_] = {near.x[t], near.y[t], near.z[t]};
  const bool isInner = entropy::magnitude(near.x[t] - middle_) <= innerReach_ &&
                       entropy::magnitude(near.y[t] - middle_) <= innerReach_ &&
                       entropy::magnitude(near.z[t] - middle_) <= innerReach_;
  inners_ += isInner ? 1 : 0;
}

inline void Candidates::dropNear(float px, float py, float pz) {
  for (List& list : list_) {
    unsigned kept = 0;
    for (unsigned i = 0; i < list.count; i += entropy::kLanes) {
      const Lanes x = entropy::load(list.x + i);
      const Lanes y = entropy::load(list.y + i);
      const Lanes z = entropy::load(list.z + i);
      const Lanes weight = entropy::load(list.weight + i);
      const Lanes dx = x - px;
      const Lanes dy = y - py;
      const Lanes dz = z - pz;
      const entropy::Packing far(entropy::maskBits(dx * dx + dy * dy + dz * dz >= minimumSquare_) &
                                 lanesBefore(list.count, i));
      far.store(list.x + kept, x);
      far.store(list.y + kept, y);
      far.store(list.z + kept, z);
      far.store(list.weight + kept, weight);
      kept += far.count();
    }
    list.count = kept;
  }
}

/// What the near point t makes with those before it.
inline void Candidates::proposeAround(const NearPoints& near, unsigned t) {
  std::uint32_t pairs = 0;
  for (unsigned i = 0; i < entropy::wholeLanes(t + 1); i += entropy::kLanes) {
    const Lanes dx = entropy::load(near.x + i) - near.x[t];
    const Lanes dy = entropy::load(near.y + i) - near.y[t];
    const Lanes dz = entropy::load(near.z + i) - near.z[t];
    pairs |= entropy::maskBits(dx * dx + dy * dy + dz * dz < pairSquare_) << i;
  }
  pairs &= (1U << t) - 1;
  pairs_[t] = pairs;
  forEachBit(pairs, [&](unsigned j) { pairs_[j] |= 1U << t; });
  extrapolate(near, t, pairs);
  listProposed(kExtrapolated);
  if (!features_.has(Features::kParallelograms)) return;
  span(near, t, pairs);
  listProposed(kParallelogram);
}

/// 2a − b for a pair of t, both ways.
inline void Candidates::extrapolate(const NearPoints& near, unsigned t, std::uint32_t pairs) {
  const bool chains = features_.has(Features::kChains);
  proposed_.count = before_.count = 0;
  for (unsigned i = 0; i < entropy::wholeLanes(t + 1); i += entropy::kLanes) {
    const std::uint32_t here = (pairs >> i) & 0xFF;
    if (here == 0) continue;
    const Lanes x = entropy::load(near.x + i);
    const Lanes y = entropy::load(near.y + i);
    const Lanes z = entropy::load(near.z + i);
    const Lanes dx = near.x[t] - x;
    const Lanes dy = near.y[t] - y;
    const Lanes dz = near.z[t] - z;
    const Lanes square = dx * dx + dy * dy + dz * dz;
    const Lanes onX = 2 * near.x[t] - x;
    const Lanes onY = 2 * near.y[t] - y;
    const Lanes onZ = 2 * near.z[t] - z;
    const Lanes backX = 2 * x - near.x[t];
    const Lanes backY = 2 * y - near.y[t];
    const Lanes backZ = 2 * z - near.z[t];
    const std::uint32_t on = here & inCell(onX, onY, onZ);
    const std::uint32_t back = here & inCell(backX, backY, backZ);
    proposed_.add(on, onX, onY, onZ, square);
    proposed_.add(back, backX, backY, backZ, square);
    if (!chains) continue;
    before_.add(on, backX, backY, backZ, square);
    before_.add(back, onX, onY, onZ, square);
  }
  if (chains) bend(near);
}

/// Rows of three that bend go on as they bend, half as much; three that agree are worth more.
inline void Candidates::bend(const NearPoints& near) {
  constexpr float kClose = 0.15F;  // to where the row would have begun, of the pair's square
  constexpr float kBend = 0.5F;
  for (unsigned i = 0; i < proposed_.count; ++i) {
    const NearPoints::Nearest c = near.nearestTo(before_.x[i], before_.y[i], before_.z[i]);
    if (c.square >= kClose * proposed_.square[i]) continue;
    proposed_.x[i] += kBend * (near.x[c.index] - before_.x[i]);
    proposed_.y[i] += kBend * (near.y[c.index] - before_.y[i]);
    proposed_.z[i] += kBend * (near.z[c.index] - before_.z[i]);
    proposed_.square[i] *= 0.5F;
  }
}

/// t + j − k for pairs j, k; then j + k − t for pairs of t.
inline void Candidates::span(const NearPoints& near, unsigned t, std::uint32_t pairs) {
  const float x = near.x[t];
  const float y = near.y[t];
  const float z = near.z[t];
  const std::uint32_t before = (1U << t) - 1;
  proposed_.count = 0;
  forEachBit(pairs, [&](unsigned k) {
    const float dx = x - near.x[k];
    const float dy = y - near.y[k];
    const float dz = z - near.z[k];
    const float side = dx * dx + dy * dy + dz * dz;
    const std::uint32_t toK = pairs_[k] & before;
    const std::uint32_t toT = pairs & ((1U << k) - 1);
    for (unsigned i = 0; i < entropy::wholeLanes(t + 1); i += entropy::kLanes) {
      const std::uint32_t moved = (toK >> i) & 0xFF;
      const std::uint32_t spanned = (toT >> i) & 0xFF;
      if ((moved | spanned) == 0) continue;
      const Lanes px = entropy::load(near.x + i);
      const Lanes py = entropy::load(near.y + i);
      const Lanes pz = entropy::load(near.z + i);
      const auto squareTo = [&](unsigned other) {
        const Lanes ex = px - near.x[other];
        const Lanes ey = py - near.y[other];
        const Lanes ez = pz - near.z[other];
        return side + (ex * ex + ey * ey + ez * ez);
      };
      const Lanes onX = px + dx;
      const Lanes onY = py + dy;
      const Lanes onZ = pz + dz;
      proposed_.add(moved & inCell(onX, onY, onZ), onX, onY, onZ, squareTo(k));
      if (spanned == 0) continue;
      const Lanes backX = px - dx;
      const Lanes backY = py - dy;
      const Lanes backZ = pz - dz;
      proposed_.add(spanned & inCell(backX, backY, backZ), backX, backY, backZ, squareTo(t));
    }
  });
}

/// Those of the proposed places that are not close to a known point.
inline void Candidates::listProposed(Kind kind) {
  const float drop = kind == kExtrapolated ? 8.0F : 1.8F;  // per square spacing
  List& list = listOf(kind);
  unsigned room = kMostInCell;
  for (const List& other : list_) room -= other.count;
  for (unsigned i = 0; i < proposed_.count; i += entropy::kLanes) {
    const Lanes x = entropy::load(proposed_.x + i);
    const Lanes y = entropy::load(proposed_.y + i);
    const Lanes z = entropy::load(proposed_.z + i);
    entropy::IntLanes close = {};
    for (unsigned j = 0; j < inners_; ++j) {
      const Lanes dx = x - inner_[j][0];
      const Lanes dy = y - inner_[j][1];
      const Lanes dz = z - inner_[j][2];
      close |= dx * dx + dy * dy + dz * dz < minimumSquare_;
    }
    const Lanes weight =
        1.0F / (1.0F + drop * (entropy::load(proposed_.square + i) * inverseSquare_));
    const entropy::Packing far(~entropy::maskBits(close) & lanesBefore(proposed_.count, i));
    far.store(list.x + list.count, x);
    far.store(list.y + list.count, y);
    far.store(list.z + list.count, z);
    far.store(list.weight + list.count, weight);
    const unsigned more = std::min(far.count(), room);
    list.count += more;
    room -= more;
  }
}

inline void Candidates::startBox(const Question& q, float spacing, float error,
                                 const Surface& surface) {
  const float width = 0.6F * error * spacing;
  for (Group& group : group_) {
    group.count = 0;
    if (scales_ == 1) {
      group.kernel[0].inverseWidth = 1 / (0.25F * width + 0.4F);
    } else {
      group.kernel[0].inverseWidth = 1 / (0.12F * width + 0.5F);
      group.kernel[1].inverseWidth = 1 / (width + 0.5F);
    }
  }
  if (scales_ == 2) {
    group_[kProjected].kernel[0].inverseWidth = group_[kProjected].kernel[1].inverseWidth;
  }
  halvings_ = 0;
  for (const Kind kind : {kExtrapolated, kParallelogram}) {
    if (!speaks(kind)) continue;
    choose(q, 0.3F * spacing, list_[kind], group_[kind]);
    if (features_.has(Features::kProjection) && surface.quadric.valid) {
      project(surface, spacing, group_[kind]);
    }
  }
  for (unsigned kind = 0; kind < kKinds; ++kind) {
    if (speaks(kind)) spread(q, kind);
  }
}

/// Those in or near the question's box.
inline void Candidates::choose(const Question& q, float margin, const List& from, Group& to) {
  const float hx = 0.5F * q.size[0] + margin;
  const float hy = 0.5F * q.size[1] + margin;
  const float hz = 0.5F * q.size[2] + margin;
  for (unsigned i = 0; i < from.count; i += entropy::kLanes) {
    const Lanes x = entropy::load(from.x + i);
    const Lanes y = entropy::load(from.y + i);
    const Lanes z = entropy::load(from.z + i);
    const entropy::Packing inBox(entropy::maskBits((entropy::magnitude(x - q.centre(0)) <= hx) &
                                                   (entropy::magnitude(y - q.centre(1)) <= hy) &
                                                   (entropy::magnitude(z - q.centre(2)) <= hz)) &
                                 lanesBefore(from.count, i));
    inBox.store(to.place[0] + to.count, x);
    inBox.store(to.place[1] + to.count, y);
    inBox.store(to.place[2] + to.count, z);
    inBox.store(to.weight + to.count, entropy::load(from.weight + i));
    to.grow(inBox.count());
  }
}

/// Candidates moved onto the quadric along its normal, if they are near it.
inline void Candidates::project(const Surface& surface, float spacing, const Group& from) {
  const Quadric& s = surface.quadric;
  Group& to = group_[kProjected];
  for (unsigned i = 0; i < from.count; i += entropy::kLanes) {
    Lanes x = entropy::load(from.place[0] + i);
    Lanes y = entropy::load(from.place[1] + i);
    Lanes z = entropy::load(from.place[2] + i);
    const Lanes px = (x - s.centre[0]) * s.inverseSpacing;
    const Lanes py = (y - s.centre[1]) * s.inverseSpacing;
    const Lanes pz = (z - s.centre[2]) * s.inverseSpacing;
    const Lanes a = s.u[0] * px + s.u[1] * py + s.u[2] * pz;
    const Lanes b = s.v[0] * px + s.v[1] * py + s.v[2] * pz;
    const Lanes c = s.normal[0] * px + s.normal[1] * py + s.normal[2] * pz;
    Lanes height = c - (s.term[0] + a * (s.term[1] + s.term[3] * a + s.term[4] * b) +
                        b * (s.term[2] + s.term[5] * b));
    height = entropy::only((height > -0.5F) & (height < 0.5F), height) * spacing;
    x -= height * s.normal[0];
    y -= height * s.normal[1];
    z -= height * s.normal[2];
    entropy::store(to.place[0] + to.count, x);
    entropy::store(to.place[1] + to.count, y);
    entropy::store(to.place[2] + to.count, z);
    entropy::store(to.weight + to.count, entropy::load(from.weight + i));
    to.grow(std::min<unsigned>(entropy::kLanes, from.count - i));
  }
}

inline void Candidates::padGroup(Group& group) {
  for (unsigned i = group.count; i < entropy::wholeLanes(group.count); ++i) {
    group.place[0][i] = group.place[1][i] = group.place[2][i] = Neighbourhood::kNowhere;
    group.weight[i] = 0;
  }
}

inline void Candidates::spread(const Question& q, unsigned kind) {
  Group& group = group_[kind];
  padGroup(group);
  const auto padded = entropy::wholeLanes(group.count);
  for (unsigned s = 0; s < scalesOf(kind); ++s) {
    Kernel& kernel = group.kernel[s];
    for (unsigned k = 0; k < 3; ++k) {
      const float low = q.lower[k];
      const float high = low + q.size[k];
      for (unsigned i = 0; i < padded; i += entropy::kLanes) {
        const Lanes place = entropy::load(group.place[k] + i);
        const Lanes atLow = entropy::bell((low - place) * kernel.inverseWidth);
        const Lanes atHigh = entropy::bell((high - place) * kernel.inverseWidth);
        entropy::store(kernel.low[k] + i, atLow);
        entropy::store(kernel.high[k] + i, atHigh);
        entropy::store(kernel.mass[k] + i, atHigh - atLow + 1e-7F);
      }
    }
  }
}

inline void Candidates::ask(const Question& q) {
  const unsigned k = q.axis;
  const unsigned k1 = k == 0 ? 1 : 0;
  const unsigned k2 = k == 2 ? 1 : 2;
  static_assert(std::size_t{kKinds} * kScales <= entropy::kLanes,
                "there is a lane for each answer");
  alignas(32) float uppers[entropy::kLanes] = {};
  alignas(32) float lowers[entropy::kLanes] = {};
  unsigned answers = 0;
  for (unsigned kind = 0; kind < kKinds; ++kind) {
    if (!speaks(kind)) continue;
    Group& group = group_[kind];
    for (unsigned s = 0; s < scalesOf(kind); ++s) {
      Kernel& kernel = group.kernel[s];
      Lanes lower = {};
      Lanes upper = {};
      for (unsigned i = 0; i < group.count; i += entropy::kLanes) {
        const Lanes at =
            entropy::bell((q.middle - entropy::load(group.place[k] + i)) * kernel.inverseWidth);
        entropy::store(kernel.at + i, at);
        const Lanes across = entropy::load(kernel.mass[k1] + i) *
                             entropy::load(kernel.mass[k2] + i) * entropy::load(group.weight + i);
        lower += across * (at - entropy::load(kernel.low[k] + i));
        upper += across * (entropy::load(kernel.high[k] + i) - at);
      }
      Answer& a = answer[kind][s];
      a.lower = entropy::sum(lower);
      a.upper = entropy::sum(upper);
      uppers[answers] = a.upper;
      lowers[answers++] = a.lower;
    }
  }
  if (answers == 1) {
    Answer& only = answer[kExtrapolated][0];
    only.evidence = entropy::naturalLog((only.upper + 3e-3F) / (only.lower + 3e-3F));
    return;
  }
  const auto evidence = entropy::valuesOf(
      entropy::naturalLog((entropy::load(uppers) + 3e-3F) / (entropy::load(lowers) + 3e-3F)));
  answers = 0;
  for (unsigned kind = 0; kind < kKinds; ++kind) {
    if (!speaks(kind)) continue;
    for (unsigned s = 0; s < scalesOf(kind); ++s) answer[kind][s].evidence = evidence[answers++];
  }
}

inline void Candidates::take(unsigned axis, bool upper) {
  for (unsigned kind = 0; kind < kKinds; ++kind) {
    if (!speaks(kind)) continue;
    Group& group = group_[kind];
    for (unsigned s = 0; s < scalesOf(kind); ++s) {
      Kernel& kernel = group.kernel[s];
      for (unsigned i = 0; i < group.count; i += entropy::kLanes) {
        const Lanes at = entropy::load(kernel.at + i);
        entropy::store((upper ? kernel.low[axis] : kernel.high[axis]) + i, at);
        const Lanes mass = upper ? entropy::load(kernel.high[axis] + i) - at
                                 : at - entropy::load(kernel.low[axis] + i);
        entropy::store(kernel.mass[axis] + i, mass + 1e-7F);
      }
    }
  }
  if (++halvings_ % kPackingPace != 0) return;
  for (unsigned kind = 0; kind < kKinds; ++kind) {
    if (group_[kind].count > kWorthPacking) packGroup(kind);
  }
}

/// Forgets candidates with less than a quarter of the mean mass in the box, if a quarter of them
/// has so little.
inline void Candidates::packGroup(unsigned kind) {
  Group& group = group_[kind];
  const Kernel& widest = group.kernel[scalesOf(kind) - 1];
  alignas(32) float masses[kMostInBox];
  Lanes total = {};
  for (unsigned i = 0; i < group.count; i += entropy::kLanes) {
    const Lanes mass = entropy::load(group.weight + i) * entropy::load(widest.mass[0] + i) *
                       entropy::load(widest.mass[1] + i) * entropy::load(widest.mass[2] + i);
    entropy::store(masses + i, mass);
    total += mass;
  }
  const float least = entropy::sum(total) / (4 * static_cast<float>(group.count));
  const auto packingAt = [&](unsigned i) {
    return entropy::Packing(entropy::maskBits(entropy::load(masses + i) >= least) &
                            lanesBefore(group.count, i));
  };
  unsigned kept = 0;
  for (unsigned i = 0; i < group.count; i += entropy::kLanes) kept += packingAt(i).count();
  if (4 * kept > 3 * group.count) return;
  kept = 0;
  for (unsigned i = 0; i < group.count; i += entropy::kLanes) {
    const entropy::Packing packing = packingAt(i);
    const auto keep = [&](float* values) {
      packing.store(values + kept, entropy::load(values + i));
    };
    keep(group.weight);
    for (unsigned k = 0; k < 3; ++k) {
      keep(group.place[k]);
      for (unsigned s = 0; s < scalesOf(kind); ++s) {
        keep(group.kernel[s].low[k]);
        keep(group.kernel[s].high[k]);
        keep(group.kernel[s].mass[k]);
      }
    }
    kept += packing.count();
  }
  group.count = kept;
  padGroup(group);
}

inline void Candidates::startResiduals(const Question& q, float spacing, float error) {
  for (Group& each : group_) each.count = 0;
  Group& group = group_[kExtrapolated];
  for (const List& list : list_) choose(q, 0.15F * spacing, list, group);
  padGroup(group);
  const float inverseWidth = 1 / (0.25F * (0.6F * error * spacing) + 0.4F);
  group.kernel[0].inverseWidth = inverseWidth;
  for (unsigned i = 0; i < group.count; i += entropy::kLanes) {
    Lanes mass = entropy::load(group.weight + i);
    for (unsigned k = 0; k < 3; ++k) {
      const Lanes place = entropy::load(group.place[k] + i);
      const float low = q.lower[k];
      const float high = low + q.size[k];
      const Lanes atLow = entropy::bell((low - place) * inverseWidth);
      const Lanes atHigh = entropy::bell((high - place) * inverseWidth);
      mass = mass * (atHigh - atLow + 1e-7F);
    }
    entropy::store(boxMass_ + i, mass);
  }
}

inline Candidates::Moments Candidates::momentsAlong(unsigned axis, float from) const {
  constexpr float kNone = 2e-3F;  // the mass of a place that no candidate foretells
  const Group& group = group_[kExtrapolated];
  Lanes mass = {};
  Lanes first = {};
  Lanes second = {};
  for (unsigned i = 0; i < group.count; i += entropy::kLanes) {
    const Lanes weight = entropy::load(boxMass_ + i);
    const Lanes place = entropy::load(group.place[axis] + i) - from;
    const Lanes weighted = weight * place;
    mass += weight;
    first += weighted;
    second += weighted * place;
  }
  const float inverse = 1 / (entropy::sum(mass) + kNone);
  Moments m;
  m.mean = entropy::sum(first) * inverse;
  m.variance = entropy::sum(second) * inverse - m.mean * m.mean;
  m.unexplained = kNone * inverse;
  return m;
}

inline void Candidates::weighAt(unsigned axis, float place) {
  const Group& group = group_[kExtrapolated];
  const float scale = 0.5F * group.kernel[0].inverseWidth;
  for (unsigned i = 0; i < group.count; i += entropy::kLanes) {
    const Lanes t = (entropy::load(group.place[axis] + i) - place) * scale;
    const Lanes away = 1.0F + t * t;
    entropy::store(boxMass_ + i, entropy::load(boxMass_ + i) / (away * away));
  }
}

inline float Candidates::nearestSquare(float px, float py, float pz, float most) const {
  const Group& group = group_[group_[kProjected].count > 0       ? kProjected
                              : group_[kParallelogram].count > 0 ? kParallelogram
                                                                 : kExtrapolated];
  Lanes best = entropy::Lanes(most);
  for (unsigned i = 0; i < group.count; i += entropy::kLanes) {
    const Lanes dx = entropy::load(group.place[0] + i) - px;
    const Lanes dy = entropy::load(group.place[1] + i) - py;
    const Lanes dz = entropy::load(group.place[2] + i) - pz;
    best = entropy::smaller(best, dx * dx + dy * dy + dz * dz);
  }
  return entropy::least(best);
}

}  // namespace BSPC_LANE_SET
}  // namespace bspc::geometry::predictive
