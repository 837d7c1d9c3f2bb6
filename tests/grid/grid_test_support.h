#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "bspc/error.h"
#include "bspc/grid.h"

namespace bspc::test {

template <class T>
PointSetView viewOf(const std::vector<T>& xyz, ScalarType type) {
  return {xyz.data(), type, xyz.size() / 3, 0};
}
inline PointSetView viewOf(const std::vector<float>& xyz) {
  return viewOf(xyz, ScalarType::Float32);
}
inline PointSetView viewOf(const std::vector<double>& xyz) {
  return viewOf(xyz, ScalarType::Float64);
}
inline PointSetView viewOf(const std::vector<std::int32_t>& xyz) {
  return viewOf(xyz, ScalarType::Int32);
}

template <class T>
std::vector<T> restore(const GridFit& fit) {
  std::vector<T> xyz(3 * fit.points.size());
  restorePositions<T>(fit.grid, fit.points, xyz.data());
  return xyz;
}

/// Checks what the fit claims against the data: the reported errors, exactness, and that restored
/// coordinates are finite.
inline void expectHonest(const PointSetView& points, const GridFit& fit) {
  fit.grid.validate();
  ASSERT_EQ(fit.points.size() + fit.dropped, points.size());
  std::array<double, 3> error{};
  for (std::size_t j = 0; j < fit.points.size(); ++j) {
    const auto given = points.position(fit.sourceIndex.empty() ? j : fit.sourceIndex[j]);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double restored =
          restoredCoordinate(fit.grid, static_cast<int>(axis), fit.points[j][axis]);
      ASSERT_TRUE(std::isfinite(restored));
      ASSERT_FALSE(restored == 0 && std::signbit(restored));
      error[axis] = std::max(error[axis], std::fabs(restored - given[axis]));
    }
  }
  EXPECT_EQ(fit.maxError, error);
  EXPECT_EQ(fit.exact, error == (std::array<double, 3>{}));
}

/// Indices start at zero along every axis.
inline void expectBasesAtMinimum(const GridFit& fit) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::uint32_t least = UINT32_MAX;
    for (const GridPoint& p : fit.points) least = std::min(least, p[axis]);
    EXPECT_EQ(least, 0U) << "axis " << axis;
  }
}

inline std::uint32_t largestIndex(const GridFit& fit) {
  std::uint32_t largest = 0;
  for (const GridPoint& p : fit.points) {
    for (const std::uint32_t i : p) largest = std::max(largest, i);
  }
  return largest;
}

template <class T>
GridFit fitted(const std::vector<T>& xyz, const GridRequest& request = {}) {
  GridFit fit = fitGrid(viewOf(xyz), request);
  expectHonest(viewOf(xyz), fit);
  return fit;
}

inline void expectRatio(const GridFit& fit, std::int64_t p, std::int64_t q) {
  ASSERT_EQ(fit.grid.form, Grid::Form::Rational);
  for (const Grid::Axis& axis : fit.grid.axes) {
    EXPECT_EQ(axis.numerator, p);
    EXPECT_EQ(axis.denominator, q);
  }
}

template <class Call>
std::string messageOf(ErrorCode code, Call call) {
  try {
    call();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), code) << error.what();
    return error.what();
  }
  ADD_FAILURE() << "no error";
  return {};
}

/// `count` points whose coordinates value(k) come from random multiples k in low … high.
template <class T, class Value>
std::vector<T> randomOn(std::size_t count, std::int64_t low, std::int64_t high, Value value,
                        std::uint64_t seed = 1) {
  std::mt19937_64 random(seed);
  std::uniform_int_distribution<std::int64_t> multiple(low, high);
  std::vector<T> xyz(3 * count);
  for (T& x : xyz) x = static_cast<T>(value(static_cast<double>(multiple(random))));
  return xyz;
}

template <class T>
std::vector<T> randomReals(std::size_t count, double low, double high, std::uint64_t seed = 1) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> real(low, high);
  std::vector<T> xyz(3 * count);
  for (T& x : xyz) x = static_cast<T>(real(random));
  return xyz;
}

}  // namespace bspc::test
