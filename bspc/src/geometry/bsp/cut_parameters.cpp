#include "geometry/bsp/cut_parameters.h"

#include <algorithm>
#include <cmath>

namespace bspc::geometry {

CutBits BspParameters::bits(std::uint64_t points, unsigned level) const {
  if (level >= levelMax || points == 0) return {};
  const unsigned log = entropy::bitLength(points) - 1;
  const auto above = [log](unsigned k) {
    return log > k ? std::min(log - k, InverseQuadratic::kMaxBits) : 0U;
  };
  return {above(phiK), above(psiK), above(alphaK)};
}

std::uint32_t InverseQuadratic::bin(double x, unsigned bits) {
  const double t = x < 0 ? -std::sqrt(-x) : std::sqrt(x);
  const double bins = std::ldexp(1.0, static_cast<int>(bits));
  return static_cast<std::uint32_t>(std::clamp(std::floor((t + 1) / 2 * bins), 0.0, bins - 1));
}

std::int64_t InverseQuadratic::value(std::uint32_t bin, unsigned bits) {
  // t = odd / 2^bits.
  const std::int64_t odd = 2 * std::int64_t{bin} + 1 - (std::int64_t{1} << bits);
  const std::int64_t square = (odd * odd * kUnit) >> (2 * bits);
  return odd < 0 ? -square : square;
}

IntegerVector planeNormal(const LocalFrame& frame, std::int64_t sinPhi, std::int64_t cosPsi) {
  const std::int64_t cosPhi = integerRoot(kUnit * kUnit - sinPhi * sinPhi);
  std::int64_t alongW = integerRoot(sinPhi * sinPhi - cosPsi * cosPsi);
  if (sinPhi < 0) alongW = -alongW;
  const auto sum = [&](std::int64_t u, std::int64_t v, std::int64_t w) {
    return floorShift(u * cosPhi + v * cosPsi + w * alongW, kUnitBits);
  };
  return {sum(frame.u.x, frame.v.x, frame.w.x), sum(frame.u.y, frame.v.y, frame.w.y),
          sum(frame.u.z, frame.v.z, frame.w.z)};
}

CutPlane planeAt(const LocalFrame& frame, const IntegerVector& normal, std::int64_t alpha) {
  // Planes have normals of 12 bits, so that tests of points are quick and their faces small.
  constexpr unsigned kShorter = 2;
  const auto shortened = [](std::int64_t c) { return floorShift(c + 2, kShorter); };
  const IntegerVector n{shortened(normal.x), shortened(normal.y), shortened(normal.z)};
  const IntegerVector& d = frame.diagonal;
  const IntegerVector at{frame.start.x + floorShift(d.x * alpha, kUnitBits),
                         frame.start.y + floorShift(d.y * alpha, kUnitBits),
                         frame.start.z + floorShift(d.z * alpha, kUnitBits)};
  CutPlane plane;
  plane.normal = {static_cast<std::int32_t>(n.x), static_cast<std::int32_t>(n.y),
                  static_cast<std::int32_t>(n.z)};
  plane.offset = roundDivide(2 * dot(n, at), kOneStep);
  return plane;
}

}  // namespace bspc::geometry
