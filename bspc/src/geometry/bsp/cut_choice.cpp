#include "geometry/bsp/cut_choice.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <vector>

namespace bspc::geometry {

namespace {

Eigen::Vector3d asEigen(const GridPoint& p) {
  return {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
}

Eigen::Vector3d asEigen(const IntegerVector& v) {
  return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}

Eigen::Vector3d principalDirection(Span<const GridPoint> points) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const GridPoint& p : points) mean += asEigen(p);
  mean /= static_cast<double>(points.size());
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const GridPoint& p : points) {
    const Eigen::Vector3d d = asEigen(p) - mean;
    covariance += d * d.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
  return solver.eigenvectors().col(2);  // eigenvalues rise
}

}  // namespace

WantedDirection wantedDirection(Span<const GridPoint> points, const LocalFrame& frame) {
  Eigen::Vector3d normal = principalDirection(points);
  constexpr double kToUnit = 1.0 / static_cast<double>(kUnit);
  if (normal.dot(asEigen(frame.u)) < 0) normal = -normal;
  const double cosPhi = std::min(1.0, normal.dot(asEigen(frame.u)) * kToUnit);
  WantedDirection wanted;
  wanted.sinPhi = std::min(kMaxSinPhi, std::sqrt(1 - cosPhi * cosPhi));
  if (normal.dot(asEigen(frame.w)) < 0) wanted.sinPhi = -wanted.sinPhi;
  wanted.cosPsi = normal.dot(asEigen(frame.v)) * kToUnit;
  return wanted;
}

double wantedAlpha(Span<const GridPoint> points, const LocalFrame& frame,
                   const IntegerVector& normal) {
  std::vector<std::int64_t> along;
  along.reserve(points.size());
  for (const GridPoint& p : points) {
    along.push_back(dot(normal, {2 * std::int64_t{p[0]} + 1, 2 * std::int64_t{p[1]} + 1,
                                 2 * std::int64_t{p[2]} + 1}));
  }
  const auto middle = along.begin() + static_cast<std::ptrdiff_t>(along.size() / 2);
  std::nth_element(along.begin(), middle, along.end());
  const double half = static_cast<double>(kOneStep) / 2;
  const double median = static_cast<double>(*middle) * half;
  const auto start = static_cast<double>(dot(normal, frame.start));
  const auto diagonal = static_cast<double>(dot(normal, frame.diagonal));
  if (diagonal == 0) return 0.5;
  return std::clamp((median - start) / diagonal, 0.5 - kAlphaReach, 0.5 + kAlphaReach);
}

}  // namespace bspc::geometry
