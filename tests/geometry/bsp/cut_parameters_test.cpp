// The paper's formulas against values worked out by hand.

#include "geometry/bsp/cut_parameters.h"

#include <gtest/gtest.h>

#include <cmath>

#include "geometry/bsp/cut_choice.h"

namespace bspc::geometry {
namespace {

Polyhedron boxOf(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  Polyhedron box;
  box.setBox({x - 1, y - 1, z - 1});
  return box;
}

TEST(BitAllocation, IsTheLogarithmOfThePointsMinusAConstant) {
  const BspParameters paper;
  const auto expect = [&paper](std::uint64_t points, unsigned level, CutBits wanted) {
    const CutBits bits = paper.bits(points, level);
    EXPECT_EQ(bits.phi, wanted.phi) << points << " at level " << level;
    EXPECT_EQ(bits.psi, wanted.psi) << points << " at level " << level;
    EXPECT_EQ(bits.alpha, wanted.alpha) << points << " at level " << level;
  };
  // 2,832 points: the logarithm is 11.47, so 11 − 3, 11 − 5, 11 − 7.
  expect(2832, 0, {8, 6, 4});
  expect(34834, 9, {12, 10, 8});
  expect(256, 3, {5, 3, 1});
  expect(255, 3, {4, 2, 0});
  expect(16, 3, {1, 0, 0});
  expect(15, 3, {0, 0, 0});
  expect(1, 0, {0, 0, 0});
  expect(34834, 10, {0, 0, 0});  // lmax = 10
  expect(std::uint64_t{1} << 31, 0, {16, 16, 16});
}

TEST(InverseQuadraticMap, IsFinerNearTheMiddle) {
  // Two bits: t in four bins with middles ±¼, ±¾; x = ± t² = ±1/16, ±9/16, in units of 2^-14.
  EXPECT_EQ(InverseQuadratic::value(0, 2), -9216);
  EXPECT_EQ(InverseQuadratic::value(1, 2), -1024);
  EXPECT_EQ(InverseQuadratic::value(2, 2), 1024);
  EXPECT_EQ(InverseQuadratic::value(3, 2), 9216);
  // √0.09 = 0.3 lies in the third bin [0, ½), √0.36 = 0.6 in the fourth.
  EXPECT_EQ(InverseQuadratic::bin(0.09, 2), 2U);
  EXPECT_EQ(InverseQuadratic::bin(0.36, 2), 3U);
  EXPECT_EQ(InverseQuadratic::bin(-0.09, 2), 1U);
  EXPECT_EQ(InverseQuadratic::bin(1, 2), 3U);
  EXPECT_EQ(InverseQuadratic::bin(-1, 2), 0U);
  for (unsigned bits = 1; bits <= InverseQuadratic::kMaxBits; ++bits) {
    const std::uint32_t bins = 1U << bits;
    for (std::uint32_t bin = 0; bin < bins; bin += 1 + bins / 97) {
      const std::int64_t x = InverseQuadratic::value(bin, bits);
      EXPECT_EQ(x, -InverseQuadratic::value(bins - 1 - bin, bits));
      if (bits > 7) continue;  // beyond, several bins share a value of 14 bits
      EXPECT_EQ(InverseQuadratic::bin(static_cast<double>(x) / kUnit, bits), bin);
    }
  }
}

TEST(LocalFrame, HasTheBiggestDiagonalsForAxes) {
  // A box of 4 × 2 × 1: u = (4, 2, 1) / √21.
  const LocalFrame frame = LocalFrame::of(boxOf(4, 2, 1), true);
  EXPECT_EQ(frame.start.x, 0);
  EXPECT_EQ(frame.diagonal.x, 4 * kOneStep);
  EXPECT_EQ(frame.diagonal.y, 2 * kOneStep);
  EXPECT_EQ(frame.diagonal.z, 1 * kOneStep);
  const double length = std::sqrt(21.0);
  EXPECT_NEAR(static_cast<double>(frame.u.x), 4 / length * kUnit, 16);
  EXPECT_NEAR(static_cast<double>(frame.u.y), 2 / length * kUnit, 16);
  EXPECT_NEAR(static_cast<double>(frame.u.z), 1 / length * kUnit, 16);
  // Of the other diagonals, (−4, 2, 1) keeps most beside u: e − u (e·u) with e·u = −11 / √21 is
  // (−4 + 44/21, 2 + 22/21, 1 + 11/21) = (−40, 64, 32) / 21; its direction is (−5, 8, 4) / √105.
  // So far from u does no other pair of vertices lie, the same up to sign aside.
  const double across = std::sqrt(105.0);
  const double sign = frame.v.y < 0 ? -1 : 1;
  EXPECT_NEAR(sign * static_cast<double>(frame.v.x), -5 / across * kUnit, 16);
  EXPECT_NEAR(sign * static_cast<double>(frame.v.y), 8 / across * kUnit, 16);
  EXPECT_NEAR(sign * static_cast<double>(frame.v.z), 4 / across * kUnit, 16);
  // w = u × v.
  EXPECT_NEAR(static_cast<double>(dot(frame.w, frame.u)) / kUnit, 0, 32);
  EXPECT_NEAR(static_cast<double>(dot(frame.w, frame.v)) / kUnit, 0, 32);
  EXPECT_NEAR(std::sqrt(static_cast<double>(dot(frame.w, frame.w))), kUnit, 32);
}

TEST(PlaneNormal, HasTheCosinesAsked) {
  const LocalFrame frame = LocalFrame::of(boxOf(7, 5, 4), true);
  // sin φ = ½: cos φ = √¾. cos ψ = 0.3, so along w √(¼ − 0.09) = 0.4.
  const auto part = [&frame](std::int64_t sinPhi, const IntegerVector& axis) {
    const IntegerVector n = planeNormal(frame, sinPhi, kUnit * 3 / 10);
    return static_cast<double>(dot(n, axis)) / (static_cast<double>(kUnit) * kUnit);
  };
  EXPECT_NEAR(part(kUnit / 2, frame.u), std::sqrt(0.75), 0.002);
  EXPECT_NEAR(part(kUnit / 2, frame.v), 0.3, 0.002);
  EXPECT_NEAR(part(kUnit / 2, frame.w), 0.4, 0.002);
  EXPECT_NEAR(part(-kUnit / 2, frame.w), -0.4, 0.002);  // the sign of sin φ is that of n · w
}

TEST(Clamps, BoundTheDirectionAndTheShift) {
  // Points along z in a box that is longest in x: φ is far beyond 30 degrees.
  const LocalFrame frame = LocalFrame::of(boxOf(1000, 10, 100), true);
  std::vector<GridPoint> points;
  for (std::uint32_t i = 0; i < 100; ++i) points.push_back({5, 5, i});
  const WantedDirection wanted =
      wantedDirection(Span<const GridPoint>(points.data(), points.size()), frame);
  EXPECT_DOUBLE_EQ(std::abs(wanted.sinPhi), 0.5);
  // All of them lie near the lower end of the diagonal, or near its upper end.
  const Span<const GridPoint> all(points.data(), points.size());
  EXPECT_DOUBLE_EQ(wantedAlpha(all, frame, frame.u), 0.2);
  for (GridPoint& p : points) p = {995, 5, 95};
  EXPECT_DOUBLE_EQ(wantedAlpha(all, frame, frame.u), 0.8);
  for (GridPoint& p : points) p = {399, 3, 39};
  EXPECT_NEAR(wantedAlpha(all, frame, frame.u), 0.4, 0.001);
}

TEST(PlaneAt, MeetsTheDiagonalWhereItShould) {
  // A cube of 8: PQ = (8, 8, 8); a plane across it at its middle has x + y + z = 12.
  const Polyhedron cube = boxOf(8, 8, 8);
  const LocalFrame frame = LocalFrame::of(cube, false);
  const CutPlane middle = planeAt(frame, frame.u, kUnit / 2);
  EXPECT_TRUE(middle.inFront({4, 4, 4}));   // 13.5
  EXPECT_TRUE(middle.inFront({4, 4, 3}));   // 12.5
  EXPECT_FALSE(middle.inFront({4, 3, 3}));  // 11.5
  const CutPlane quarter = planeAt(frame, frame.u, kUnit / 4);
  EXPECT_TRUE(quarter.inFront({2, 2, 1}));   // 6.5
  EXPECT_FALSE(quarter.inFront({2, 1, 1}));  // 5.5
}

}  // namespace
}  // namespace bspc::geometry
