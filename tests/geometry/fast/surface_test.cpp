#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "geometry/fast/surface_fit.h"

namespace bspc::geometry::fast {
namespace {

TEST(Footprint, IsTheMiddleAndTheBitsOfTheHalfSides) {
  const std::uint32_t u[] = {10, 30, 20};
  const std::uint32_t v[] = {5, 5, 5};
  const Footprint f = Footprint::of(u, v, 3);
  EXPECT_EQ(f.centre[0], 20U);
  EXPECT_EQ(f.centre[1], 5U);
  EXPECT_EQ(f.halfBits[0], 4);
  EXPECT_EQ(f.halfBits[1], 0);
  EXPECT_EQ(f.normal(0, 30), 10 * 256);
  EXPECT_EQ(f.normal(0, 10), -10 * 256);
}

TEST(Surface, WorkedValues) {
  Surface s;
  s.precision = 3;  // whole steps
  s.height = 100;
  const std::int32_t x[] = {0, 4096, -4096, 2048};
  const std::int32_t y[] = {0, 0, 4096, -2048};
  std::uint32_t heights[4];
  s.mode = SurfaceMode::Constant;
  evaluate(s, x, y, 4, heights);
  EXPECT_EQ(heights[2], 100U);
  s.mode = SurfaceMode::Plane;
  s.slope[0] = 5;  // half the rise to the edge
  s.slope[1] = -2;
  evaluate(s, x, y, 4, heights);
  EXPECT_EQ(heights[0], 100U);
  EXPECT_EQ(heights[1], 110U);
  EXPECT_EQ(heights[2], 86U);
  EXPECT_EQ(heights[3], 107U);
  s.mode = SurfaceMode::Quadric;
  s.bend[0] = 1;  // a quarter of the coefficient of X²
  s.bend[2] = 2;
  evaluate(s, x, y, 4, heights);
  EXPECT_EQ(heights[1], 114U);
  EXPECT_EQ(heights[2], 98U);
  EXPECT_EQ(heights[3], 110U);
}

TEST(Surface, ResidualsAreExpectedToGoOn) {
  EXPECT_EQ(filtered(0, 0), 0U);
  EXPECT_EQ(filtered(128, 0), 45U);
  EXPECT_EQ(filtered(0, 128), 26U);
  EXPECT_EQ(filtered(0U - 128U, 0), 0U - 45U);
}

TEST(SurfaceHistory, CarriesAPlaneToTheNextFootprint) {
  Footprint here;
  here.centre[0] = 1000;
  here.centre[1] = 1000;
  here.halfBits[0] = here.halfBits[1] = 6;
  SurfaceHistory history(0, 0, 50);
  EXPECT_EQ(history.expected(here, 3).height, 50);
  Surface plane;
  plane.mode = SurfaceMode::Plane;
  plane.precision = 3;
  plane.height = 200;
  plane.slope[0] = 16;  // rises by 32 over 64 steps
  history.remember(here, plane);
  Footprint next = here;
  next.centre[0] = 1100;
  const Surface expected = history.expected(next, 3);
  EXPECT_EQ(expected.height, 250);
  EXPECT_EQ(expected.slope[0], 16);
  next.halfBits[0] = 7;
  EXPECT_EQ(history.expected(next, 3).slope[0], 32);
  EXPECT_EQ(history.expected(next, 4).slope[0], 16);
  history.passThrough(1000, 1000, 70);
  EXPECT_EQ(history.expected(next, 3).height, 120);
}

TEST(SurfaceHistory, HoldsExtremesWithinItsLimit) {
  SurfaceHistory history(0, 0, 0);
  Footprint f;
  f.halfBits[0] = f.halfBits[1] = 22;
  Surface s;
  s.precision = 30;
  s.height = INT64_MIN;
  s.slope[0] = INT64_MAX;
  s.slope[1] = INT64_MIN;
  history.remember(f, s);
  f.centre[0] = (1U << 22) - 1;
  for (const int precision : {2, 10, 30}) {
    const Surface e = history.expected(f, precision);
    for (const std::int64_t v : {e.height, e.slope[0], e.slope[1]}) {
      EXPECT_LE(std::llabs(v), std::int64_t{1} << 30);
    }
  }
}

TEST(SurfaceFit, FindsAQuadricAndLeavesLittle) {
  std::mt19937_64 random(1);
  Chunk chunk{};
  chunk.count = kChunkPoints;
  for (std::size_t i = 0; i < chunk.count; ++i) {
    chunk.u[i] = static_cast<std::uint32_t>(random() % 1000);
    chunk.v[i] = static_cast<std::uint32_t>(random() % 1000);
    const double x = chunk.u[i] - 500.0;
    const double y = chunk.v[i] - 500.0;
    chunk.w[i] = static_cast<std::uint32_t>(std::lround(3000 + x / 2 - y / 3 + x * x / 300));
  }
  fitSurface(chunk, SurfaceHistory(512, 512, 2048), 2048, {});
  setResiduals(chunk, 2048);
  EXPECT_EQ(chunk.surface.mode, SurfaceMode::Quadric);
  for (std::size_t i = 0; i < chunk.count; ++i) EXPECT_LE(chunk.residuals[i], 16U);
  FitOptions planesOnly;
  planesOnly.quadrics = false;
  fitSurface(chunk, SurfaceHistory(512, 512, 2048), 2048, planesOnly);
  EXPECT_NE(chunk.surface.mode, SurfaceMode::Quadric);
}

}  // namespace
}  // namespace bspc::geometry::fast
