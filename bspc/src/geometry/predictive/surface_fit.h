#pragma once

#include <cmath>

#include "geometry/predictive/surface.h"

// Bodies of surface.h. They are inline so that each build of the coder has its own.

namespace bspc::geometry::predictive {
inline namespace BSPC_LANE_SET {

/// Symmetric 3 × 3 matrix: xx, xy, xz, yy, yz, zz.
using Symmetric3 = std::array<float, 6>;

inline Symmetric3 adjugate(const Symmetric3& m) {
  return {m[3] * m[5] - m[4] * m[4], m[2] * m[4] - m[1] * m[5], m[1] * m[4] - m[2] * m[3],
          m[0] * m[5] - m[2] * m[2], m[1] * m[2] - m[0] * m[4], m[0] * m[3] - m[1] * m[1]};
}

inline Symmetric3 squared(const Symmetric3& m) {
  return {m[0] * m[0] + m[1] * m[1] + m[2] * m[2], m[0] * m[1] + m[1] * m[3] + m[2] * m[4],
          m[0] * m[2] + m[1] * m[4] + m[2] * m[5], m[1] * m[1] + m[3] * m[3] + m[4] * m[4],
          m[1] * m[2] + m[3] * m[4] + m[4] * m[5], m[2] * m[2] + m[4] * m[4] + m[5] * m[5]};
}

/// Direction of the least variance: the largest column of a power of the inverse covariance.
inline Vector3 leastDirection(const Symmetric3& covariance, float trace) {
  const float ridge = trace * 1e-3F;
  Symmetric3 m = covariance;
  m[0] += ridge;
  m[3] += ridge;
  m[5] += ridge;
  m = adjugate(m);
  for (unsigned i = 0; i < 3; ++i) {
    const float scale = 1 / (m[0] + m[3] + m[5] + 1e-30F);
    for (float& entry : m) entry *= scale;
    m = squared(m);
  }
  if (m[0] >= m[3] && m[0] >= m[5]) return {m[0], m[1], m[2]};
  if (m[3] >= m[5]) return {m[1], m[3], m[4]};
  return {m[2], m[4], m[5]};
}

inline Spread Plane::spreadIn(const Question& q) const {
  if (!valid) return {};
  const float along = normal[q.axis];
  if (along * along < 1e-4F) return {};
  float distance = 0;
  float spread = variance;
  for (unsigned k = 0; k < 3; ++k) {
    distance += normal[k] * (q.centre(k) - through[k]);
    if (k != q.axis) spread += normal[k] * normal[k] * q.size[k] * q.size[k] * (1 / 12.0F);
  }
  return {-distance / along, entropy::magnitude(along) / std::sqrt(spread), 0.5F * q.size[q.axis]};
}

inline Quadric::Value Quadric::at(float x, float y, float z) const {
  const Vector3 place{(x - centre[0]) * inverseSpacing, (y - centre[1]) * inverseSpacing,
                      (z - centre[2]) * inverseSpacing};
  const float a = dot(u, place);
  const float b = dot(v, place);
  Value value;
  value.height = dot(normal, place) - (term[0] + a * (term[1] + term[3] * a + term[4] * b) +
                                       b * (term[2] + term[5] * b));
  const float slopeU = term[1] + 2 * term[3] * a + term[4] * b;
  const float slopeV = term[2] + term[4] * a + 2 * term[5] * b;
  for (unsigned k = 0; k < 3; ++k) {
    value.gradient[k] = normal[k] - slopeU * u[k] - slopeV * v[k];
  }
  return value;
}

inline std::array<Spread, 2> Quadric::spreadsIn(const Question& q, float error,
                                                float narrowError) const {
  if (!valid) return {};
  const Value middle = at(q.centre(0), q.centre(1), q.centre(2));
  const float along = middle.gradient[q.axis];
  const float steepness = entropy::magnitude(along);
  if (!(steepness >= 0.02F)) return {};
  const unsigned k1 = q.axis == 0 ? 1 : 0;
  const unsigned k2 = q.axis == 2 ? 1 : 2;
  const float across1 = middle.gradient[k1] * q.size[k1] * inverseSpacing;
  const float across2 = middle.gradient[k2] * q.size[k2] * inverseSpacing;
  const float tilt = (across1 * across1 + across2 * across2) * (1 / 12.0F);
  const Spread wide{-middle.height / along, steepness / std::sqrt(error * error + tilt),
                    0.5F * q.size[q.axis] * inverseSpacing};
  Spread narrow = wide;
  narrow.inverseScale = steepness / std::sqrt(narrowError * narrowError + tilt);
  return {wide, narrow};
}

inline void Surface::fit(const Neighbourhood& near, const Vector3& centre, float spacing,
                         float reach, bool wantQuadric) {
  plane.valid = quadric.valid = false;
  if (near.count < 3) return;
  Scaled scaled;
  scaled.groups = entropy::wholeLanes(near.count) / unsigned{entropy::kLanes};
  const float unit = 1 / spacing;
  for (unsigned g = 0; g < scaled.groups; ++g) {
    const unsigned i = g * entropy::kLanes;
    scaled.x[g] = (entropy::load(near.x + i) - centre[0]) * unit;
    scaled.y[g] = (entropy::load(near.y + i) - centre[1]) * unit;
    scaled.z[g] = (entropy::load(near.z + i) - centre[2]) * unit;
    scaled.size[g] = entropy::load(near.size + i) * unit;
    scaled.present[g] = entropy::load(near.weight + i);
  }
  fitPlane(scaled, centre, spacing, reach);
  if (wantQuadric && plane.valid && near.count >= 5) fitQuadric(scaled, centre, spacing);
}

inline void Surface::fitPlane(const Scaled& near, const Vector3& centre, float spacing,
                              float reach) {
  using entropy::Lanes;
  Lanes s[11] = {};
  const float unit = 1 / spacing;
  const float reach2 = reach * reach;
  for (unsigned g = 0; g < near.groups; ++g) {
    const Lanes x = near.x[g];
    const Lanes y = near.y[g];
    const Lanes z = near.z[g];
    const Lanes extra = near.size[g] - unit;
    const Lanes extra2 = extra * extra;
    const Lanes weight = entropy::only(
        near.present[g] > 0.0F, 1.0F / ((x * x + y * y + z * z + reach2) * (reach2 + extra2)));
    const Lanes wx = weight * x;
    const Lanes wy = weight * y;
    const Lanes wz = weight * z;
    s[0] += weight;
    s[1] += wx;
    s[2] += wy;
    s[3] += wz;
    s[4] += wx * x;
    s[5] += wx * y;
    s[6] += wx * z;
    s[7] += wy * y;
    s[8] += wy * z;
    s[9] += wz * z;
    s[10] += weight * extra2;
  }
  const float scale = 1 / (entropy::sum(s[0]) + 1e-20F);
  const Vector3 mean{entropy::sum(s[1]) * scale, entropy::sum(s[2]) * scale,
                     entropy::sum(s[3]) * scale};
  const Symmetric3 c{entropy::sum(s[4]) * scale - mean[0] * mean[0],
                     entropy::sum(s[5]) * scale - mean[0] * mean[1],
                     entropy::sum(s[6]) * scale - mean[0] * mean[2],
                     entropy::sum(s[7]) * scale - mean[1] * mean[1],
                     entropy::sum(s[8]) * scale - mean[1] * mean[2],
                     entropy::sum(s[9]) * scale - mean[2] * mean[2]};
  const float blur = entropy::sum(s[10]) * scale * (1 / 12.0F);
  const float trace = c[0] + c[3] + c[5];
  const Vector3 direction = leastDirection(c, trace > 1e-6F ? trace : 1e-6F);
  const float length2 = dot(direction, direction);
  if (!(length2 > 1e-20F)) return;
  const float inverseLength = 1 / std::sqrt(length2);
  for (unsigned k = 0; k < 3; ++k) {
    plane.normal[k] = direction[k] * inverseLength;
    plane.through[k] = mean[k] * spacing + centre[k];
  }
  const Vector3& n = plane.normal;
  const float across = n[0] * (c[0] * n[0] + 2 * c[1] * n[1] + 2 * c[2] * n[2]) +
                       n[1] * (c[3] * n[1] + 2 * c[4] * n[2]) + n[2] * c[5] * n[2];
  plane.variance = ((across > 0 ? across : 0) + 0.02F * blur) * spacing * spacing + 0.08F;
  plane.valid = true;
}

/// Solves the 6 normal equations by Cholesky. `a`: the lower triangle by rows, then the right side.
inline std::array<float, 6> solveNormalEquations(const std::array<float, 27>& a) {
  std::array<float, 21> l{};
  std::array<float, 6> inverse{};
  const auto at = [](unsigned row, unsigned column) { return row * (row + 1) / 2 + column; };
  for (unsigned p = 0; p < 6; ++p) {
    for (unsigned q = 0; q <= p; ++q) {
      float s = a[at(p, q)];
      for (unsigned k = 0; k < q; ++k) s -= l[at(p, k)] * l[at(q, k)];
      if (p == q) {
        if (!(s > 1e-6F)) s = 1e-6F;
        inverse[p] = 1 / std::sqrt(s);
      } else {
        l[at(p, q)] = s * inverse[q];
      }
    }
  }
  std::array<float, 6> y{};
  for (unsigned p = 0; p < 6; ++p) {
    float s = a[21 + p];
    for (unsigned k = 0; k < p; ++k) s -= l[at(p, k)] * y[k];
    y[p] = s * inverse[p];
  }
  for (unsigned p = 6; p-- > 0;) {
    float s = y[p];
    for (unsigned k = p + 1; k < 6; ++k) s -= l[at(k, p)] * y[k];
    y[p] = s * inverse[p];
  }
  return y;
}

inline void Surface::fitQuadric(const Scaled& near, const Vector3& centre, float spacing) {
  using entropy::Lanes;
  const Vector3& n = plane.normal;
  Vector3 least{};
  const Vector3 size{entropy::magnitude(n[0]), entropy::magnitude(n[1]), entropy::magnitude(n[2])};
  least[size[0] < size[1] ? (size[0] < size[2] ? 0 : 2) : (size[1] < size[2] ? 1 : 2)] = 1;
  Vector3 u = cross(n, least);
  const float scale = 1 / std::sqrt(dot(u, u));
  for (float& k : u) k *= scale;
  const Vector3 v = cross(n, u);

  Lanes s[27] = {};
  for (unsigned g = 0; g < near.groups; ++g) {
    const Lanes x = near.x[g];
    const Lanes y = near.y[g];
    const Lanes z = near.z[g];
    const Lanes distance = x * x + y * y + z * z + 0.4F;
    const Lanes weight = entropy::only(
        near.present[g] > 0.0F,
        1.0F / (distance * distance * (0.0003F + near.size[g] * near.size[g] * (1 / 12.0F))));
    const Lanes a = u[0] * x + u[1] * y + u[2] * z;
    const Lanes b = v[0] * x + v[1] * y + v[2] * z;
    const Lanes height = n[0] * x + n[1] * y + n[2] * z;
    const Lanes term[6] = {entropy::Lanes(1), a, b, a * a, a * b, b * b};
    unsigned t = 0;
    for (unsigned p = 0; p < 6; ++p) {
      const Lanes weighted = weight * term[p];
      s[21 + p] += weighted * height;
      for (unsigned q = 0; q <= p; ++q) s[t++] += weighted * term[q];
    }
  }
  std::array<float, 27> equations{};
  for (unsigned i = 0; i < 27; ++i) equations[i] = entropy::sum(s[i]);
  constexpr std::array<float, 6> kRidge{0.004F, 0.024F, 0.024F, 0.24F, 0.24F, 0.24F};
  for (unsigned p = 0; p < 6; ++p) equations[p * (p + 1) / 2 + p] += kRidge[p];
  quadric.term = solveNormalEquations(equations);
  quadric.u = u;
  quadric.v = v;
  quadric.normal = n;
  quadric.centre = centre;
  quadric.inverseSpacing = 1 / spacing;
  quadric.valid = true;
}

}  // namespace BSPC_LANE_SET
}  // namespace bspc::geometry::predictive
