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

inline float squareBetween(const NearPoints& near, unsigned a, unsigned b) {
  const float dx = near.x[a] - near.x[b];
  const float dy = near.y[a] - near.y[b];
  const float dz = near.z[a] - near.z[b];
  return dx * dx + dy * dy + dz * dz;
}

inline void Candidates::startCell(NearPoints& near, float side, float spacing) {
  middle_ = 0.5F * side;
  reach_ = middle_ + 0.3F * spacing;
  pairSquare_ = static_cast<float>(features_.pairReach) * spacing * spacing;
  minimumSquare_ = 0.09F * spacing * spacing;
  inverseSquare_ = 1 / (spacing * spacing);
  listed_ = 0;
  for (unsigned t = 0; t < near.count; ++t) proposeAround(near, t);
}

inline void Candidates::addPoint(const NearPoints& near) {
  const unsigned t = near.count - 1;
  dropNear(near.x[t], near.y[t], near.z[t]);
  proposeAround(near, t);
}

inline void Candidates::dropNear(float px, float py, float pz) {
  unsigned kept = 0;
  for (unsigned i = 0; i < listed_; i += entropy::kLanes) {
    const Lanes dx = entropy::load(x_ + i) - px;
    const Lanes dy = entropy::load(y_ + i) - py;
    const Lanes dz = entropy::load(z_ + i) - pz;
    std::uint32_t far = entropy::maskBits(dx * dx + dy * dy + dz * dz >= minimumSquare_);
    if (listed_ - i < entropy::kLanes) far &= (1U << (listed_ - i)) - 1;
    if (kept == i && far == 0xFF) {
      kept += entropy::kLanes;
      continue;
    }
    forEachBit(far, [&](unsigned lane) {
      const unsigned j = i + lane;
      x_[kept] = x_[j];
      y_[kept] = y_[j];
      z_[kept] = z_[j];
      weight_[kept] = weight_[j];
      kind_[kept] = kind_[j];
      ++kept;
    });
  }
  listed_ = kept;
}

inline void Candidates::propose(const NearPoints& near, Kind kind, float x, float y, float z,
                                float square) {
  if (listed_ >= kMostInCell) return;
  entropy::IntLanes close = {};
  for (unsigned i = 0; i < entropy::wholeLanes(near.count); i += entropy::kLanes) {
    const Lanes dx = entropy::load(near.x + i) - x;
    const Lanes dy = entropy::load(near.y + i) - y;
    const Lanes dz = entropy::load(near.z + i) - z;
    close |= dx * dx + dy * dy + dz * dz < minimumSquare_;
  }
  if (entropy::maskBits(close) != 0) return;
  x_[listed_] = x;
  y_[listed_] = y;
  z_[listed_] = z;
  const float drop = kind == kExtrapolated ? 20.0F : 1.2F;  // per square spacing
  weight_[listed_] = 1 / (1 + drop * (square * inverseSquare_));
  kind_[listed_] = static_cast<std::uint8_t>(kind);
  ++listed_;
}

/// 2a − b, for a pair whose square length is `square`.
inline void Candidates::extrapolate(const NearPoints& near, const Vector3& a, const Vector3& b,
                                    float square) {
  Vector3 candidate{2 * a[0] - b[0], 2 * a[1] - b[1], 2 * a[2] - b[2]};
  if (features_.has(Features::kChains)) {
    constexpr float kClose = 0.15F;  // to where the row would have begun, of the pair's square
    constexpr float kBend = 0.5F;
    const Vector3 before{2 * b[0] - a[0], 2 * b[1] - a[1], 2 * b[2] - a[2]};
    const NearPoints::Nearest c = near.nearestTo(before[0], before[1], before[2]);
    if (c.square < kClose * square) {
      candidate[0] += kBend * (near.x[c.index] - before[0]);
      candidate[1] += kBend * (near.y[c.index] - before[1]);
      candidate[2] += kBend * (near.z[c.index] - before[2]);
      square = 0.5F * square;  // three that agree are worth more
    }
  }
  propose(near, kExtrapolated, candidate[0], candidate[1], candidate[2], square);
}

/// What the near point t makes with those before it.
inline void Candidates::proposeAround(const NearPoints& near, unsigned t) {
  const float x = near.x[t];
  const float y = near.y[t];
  const float z = near.z[t];
  const auto groups = entropy::wholeLanes(t + 1);
  const std::uint32_t before = (1U << t) - 1;
  std::uint32_t pairs = 0;
  for (unsigned i = 0; i < groups; i += entropy::kLanes) {
    const Lanes dx = entropy::load(near.x + i) - x;
    const Lanes dy = entropy::load(near.y + i) - y;
    const Lanes dz = entropy::load(near.z + i) - z;
    pairs |= entropy::maskBits(dx * dx + dy * dy + dz * dz < pairSquare_) << i;
  }
  pairs &= before;
  pairs_[t] = pairs;
  forEachBit(pairs, [&](unsigned j) { pairs_[j] |= 1U << t; });

  for (unsigned i = 0; i < groups; i += entropy::kLanes) {
    const std::uint32_t here = (pairs >> i) & 0xFF;
    if (here == 0) continue;
    const Lanes px = entropy::load(near.x + i);
    const Lanes py = entropy::load(near.y + i);
    const Lanes pz = entropy::load(near.z + i);
    forEachBit(here & inCell(2 * x - px, 2 * y - py, 2 * z - pz), [&](unsigned lane) {
      const unsigned j = i + lane;
      extrapolate(near, {x, y, z}, {near.x[j], near.y[j], near.z[j]}, squareBetween(near, t, j));
    });
    forEachBit(here & inCell(2 * px - x, 2 * py - y, 2 * pz - z), [&](unsigned lane) {
      const unsigned j = i + lane;
      extrapolate(near, {near.x[j], near.y[j], near.z[j]}, {x, y, z}, squareBetween(near, t, j));
    });
  }
  if (!features_.has(Features::kParallelograms)) return;
  forEachBit(pairs, [&](unsigned k) {
    const float dx = x - near.x[k];
    const float dy = y - near.y[k];
    const float dz = z - near.z[k];
    const float side = dx * dx + dy * dy + dz * dz;
    // t + j − k for pairs j, k; then j + k − t for pairs of t.
    const std::uint32_t toK = pairs_[k] & before;
    const std::uint32_t toT = pairs & ((1U << k) - 1);
    for (unsigned i = 0; i < groups; i += entropy::kLanes) {
      const std::uint32_t moved = (toK >> i) & 0xFF;
      const std::uint32_t spanned = (toT >> i) & 0xFF;
      if ((moved | spanned) == 0) continue;
      const Lanes px = entropy::load(near.x + i);
      const Lanes py = entropy::load(near.y + i);
      const Lanes pz = entropy::load(near.z + i);
      if (moved != 0) {
        forEachBit(moved & inCell(px + dx, py + dy, pz + dz), [&](unsigned lane) {
          const unsigned j = i + lane;
          propose(near, kParallelogram, near.x[j] + dx, near.y[j] + dy, near.z[j] + dz,
                  side + squareBetween(near, j, k));
        });
      }
      if (spanned != 0) {
        forEachBit(spanned & inCell(px - dx, py - dy, pz - dz), [&](unsigned lane) {
          const unsigned j = i + lane;
          propose(near, kParallelogram, near.x[j] - dx, near.y[j] - dy, near.z[j] - dz,
                  side + squareBetween(near, j, t));
        });
      }
    }
  });
}

inline void Candidates::startBox(const Question& q, float spacing, float error,
                                 const Surface& surface) {
  const float width = 0.6F * error * spacing;
  for (Group& group : group_) {
    group.count = 0;
    if (scales_ == 1) {
      group.kernel[0].inverseWidth = 1 / (0.25F * width + 0.4F);
    } else {
      group.kernel[0].inverseWidth = 1 / (0.12F * width + 0.38F);
      group.kernel[1].inverseWidth = 1 / (width + 0.5F);
    }
  }
  if (scales_ == 2) {
    group_[kProjected].kernel[0].inverseWidth = group_[kProjected].kernel[1].inverseWidth;
  }
  const float margin = 0.3F * spacing;
  const float hx = 0.5F * q.size[0] + margin;
  const float hy = 0.5F * q.size[1] + margin;
  const float hz = 0.5F * q.size[2] + margin;
  const bool separate = features_.has(Features::kSeparateKinds);
  for (unsigned i = 0; i < listed_; i += entropy::kLanes) {
    std::uint32_t inBox =
        entropy::maskBits((entropy::magnitude(entropy::load(x_ + i) - q.centre(0)) <= hx) &
                          (entropy::magnitude(entropy::load(y_ + i) - q.centre(1)) <= hy) &
                          (entropy::magnitude(entropy::load(z_ + i) - q.centre(2)) <= hz));
    if (listed_ - i < entropy::kLanes) inBox &= (1U << (listed_ - i)) - 1;
    forEachBit(inBox, [&](unsigned lane) {
      const unsigned j = i + lane;
      group_[separate ? kind_[j] : unsigned{kExtrapolated}].add(x_[j], y_[j], z_[j], weight_[j]);
    });
  }
  if (features_.has(Features::kProjection) && surface.quadric.valid) {
    project(surface, spacing, group_[kExtrapolated]);
    if (separate) project(surface, spacing, group_[kParallelogram]);
  }
  for (unsigned kind = 0; kind < kKinds; ++kind) spread(q, kind);
}

/// Candidates moved onto the quadric along its normal, if they are near it.
inline void Candidates::project(const Surface& surface, float spacing, Group& from) {
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
    const unsigned lanes = std::min<unsigned>(entropy::kLanes, from.count - i);
    const auto xs = entropy::valuesOf(x);
    const auto ys = entropy::valuesOf(y);
    const auto zs = entropy::valuesOf(z);
    for (unsigned lane = 0; lane < lanes; ++lane) {
      to.add(xs[lane], ys[lane], zs[lane], from.weight[i + lane]);
    }
  }
}

inline void Candidates::spread(const Question& q, unsigned kind) {
  Group& group = group_[kind];
  const auto padded = entropy::wholeLanes(group.count);
  for (unsigned i = group.count; i < padded; ++i) {
    group.place[0][i] = group.place[1][i] = group.place[2][i] = Neighbourhood::kNowhere;
    group.weight[i] = 0;
  }
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
  const auto evidence = entropy::valuesOf(
      entropy::naturalLog((entropy::load(uppers) + 3e-3F) / (entropy::load(lowers) + 3e-3F)));
  answers = 0;
  for (unsigned kind = 0; kind < kKinds; ++kind) {
    for (unsigned s = 0; s < scalesOf(kind); ++s) answer[kind][s].evidence = evidence[answers++];
  }
}

inline void Candidates::take(unsigned axis, bool upper) {
  for (unsigned kind = 0; kind < kKinds; ++kind) {
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
