// Polyhedra and their cuts: what no rounding may break.

#include "geometry/bsp/polyhedron.h"

#include <gtest/gtest.h>

#include <memory>
#include <random>

namespace bspc::geometry {
namespace {

GridBox boxUpTo(std::uint32_t last) {
  GridBox box;
  box.upper = {last, last, last};
  return box;
}

CutPlane randomPlane(std::mt19937_64& random, std::uint32_t side) {
  CutPlane plane;
  std::int64_t sum = 0;
  for (std::int32_t& n : plane.normal) {
    n = static_cast<std::int32_t>(random() % 8193) - 4096;
    sum += n * static_cast<std::int64_t>(random() % (std::uint64_t{2} * side));
  }
  plane.offset = sum;
  return plane;
}

TEST(Polyhedron, ABoxHasItsVolume) {
  Polyhedron box;
  box.setBox({9, 19, 29});
  const std::int64_t cube = kOneStep * kOneStep * kOneStep;
  EXPECT_EQ(box.volumeShift(), 0U);
  EXPECT_EQ(box.volume(0), std::int64_t{6} * 10 * 20 * 30 * cube);
  EXPECT_TRUE(box.isBox());
}

TEST(Polyhedron, CutsShareTheVolumeOut) {
  std::mt19937_64 random(31);
  unsigned cuts = 0;
  for (unsigned trial = 0; trial < 2000; ++trial) {
    Polyhedron cell;
    cell.setBox({63, 63, 63});
    for (unsigned depth = 0; depth < 12; ++depth) {
      const CutPlane plane = randomPlane(random, 64);
      const PolyhedronCut cut(cell, plane, false);
      if (!cut.hasFront() || !cut.hasBack()) continue;
      ASSERT_TRUE(cut.fits());
      const auto front = std::make_unique<Polyhedron>();
      const auto back = std::make_unique<Polyhedron>();
      cut.build(true, *front);
      cut.build(false, *back);
      const std::int64_t whole = cell.volume(0);
      // New vertices move by half a unit; a cell's surface is below 6 · (2^14)² units.
      EXPECT_NEAR(static_cast<double>(front->volume(0) + back->volume(0)),
                  static_cast<double>(whole), 6.0 * 6 * (1U << 28));
      ++cuts;
      std::vector<std::uint8_t> bytes;
      (random() % 2 == 0 ? front : back)->pack(bytes);
      cell.unpack(bytes);
    }
  }
  EXPECT_GT(cuts, 3000U);
}

TEST(Polyhedron, TheGridBoxHoldsThePointsThatThePlanesLeaveIn) {
  constexpr std::uint32_t kSide = 24;
  std::mt19937_64 random(32);
  for (unsigned trial = 0; trial < 200; ++trial) {
    Polyhedron cell;
    cell.setBox({kSide - 1, kSide - 1, kSide - 1});
    for (unsigned depth = 0; depth < 8; ++depth) {
      const CutPlane plane = randomPlane(random, kSide);
      const PolyhedronCut cut(cell, plane, false);
      if (!cut.hasFront() || !cut.hasBack() || !cut.fits()) continue;
      const auto part = std::make_unique<Polyhedron>();
      cut.build(random() % 2 == 0, *part);
      cell = *part;
      const GridBox box = cell.gridBox(boxUpTo(kSide - 1), kOneStep / 4);
      for (std::uint32_t i = 0; i < kSide * kSide * kSide; ++i) {
        const GridPoint p{i % kSide, i / kSide % kSide, i / (kSide * kSide)};
        EXPECT_TRUE(!cell.contains(p) || box.contains(p));
      }
    }
  }
}

TEST(Polyhedron, AnAxisPlaneCutsExactly) {
  Polyhedron cell;
  cell.setBox({99, 99, 99});
  const CutPlane plane = CutPlane::across(1, 37);
  EXPECT_TRUE(plane.inFront({0, 37, 0}));
  EXPECT_FALSE(plane.inFront({0, 36, 0}));
  const PolyhedronCut cut(cell, plane, true);
  Polyhedron part;
  cut.build(false, part);
  const GridBox box = part.gridBox(boxUpTo(99), 0);
  EXPECT_EQ(box.upper, (GridPoint{99, 36, 99}));
  EXPECT_TRUE(part.isBox());
}

TEST(IntegerArithmetic, RoundsAsItSays) {
  EXPECT_EQ(floorDivide(-7, 2), -4);
  EXPECT_EQ(roundDivide(-7, 2), -3);
  EXPECT_EQ(roundDivide(7, 2), 4);
  EXPECT_EQ(integerRoot(0), 0);
  EXPECT_EQ(integerRoot(24), 4);
  EXPECT_EQ(integerRoot(25), 5);
  EXPECT_EQ(integerRoot((std::int64_t{1} << 60) - 1), (std::int64_t{1} << 30) - 1);
  EXPECT_EQ(integerRoot(-3), 0);
}

}  // namespace
}  // namespace bspc::geometry
