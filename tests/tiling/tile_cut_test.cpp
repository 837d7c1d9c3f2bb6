#include "tiling/tile_cut.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>

#include "support/point_sets.h"
#include "tiling/cell_code.h"

namespace bspc::tiling {
namespace {

/// Checks that every point is in one tile, none is too large or empty, and input order is kept.
void expectProper(const std::vector<GridPoint>& points, std::size_t most, const TileCut& cut) {
  ASSERT_EQ(cut.firsts.back(), points.size());
  for (std::size_t t = 0; t < cut.tiles(); ++t) {
    EXPECT_LT(cut.firsts[t], cut.firsts[t + 1]);
    EXPECT_LE(cut.firsts[t + 1] - cut.firsts[t], most);
  }
  if (cut.tiles() == 1) return;
  std::vector<std::uint32_t> all = cut.order;
  for (std::size_t t = 0; t < cut.tiles(); ++t) {
    EXPECT_TRUE(std::is_sorted(all.begin() + static_cast<std::ptrdiff_t>(cut.firsts[t]),
                               all.begin() + static_cast<std::ptrdiff_t>(cut.firsts[t + 1])));
  }
  std::sort(all.begin(), all.end());
  std::vector<std::uint32_t> expected(points.size());
  std::iota(expected.begin(), expected.end(), 0U);
  EXPECT_EQ(all, expected);
}

TEST(TileCut, CoversEverySet) {
  for (const test::NamedPoints& set : test::degenerateSets()) {
    for (const std::size_t most : {std::size_t{1}, std::size_t{7}, std::size_t{100}}) {
      SCOPED_TRACE(set.name + ", " + std::to_string(most));
      expectProper(set.points, most, cutTiles(set.points, most));
    }
  }
}

TEST(TileCut, TilesAreWellFilledAndLieApart) {
  const std::vector<GridPoint> points = test::scannedSphere(3, 100000, 1U << 20);
  constexpr std::size_t kMost = 4096;
  const TileCut cut = cutTiles(points, kMost);
  expectProper(points, kMost, cut);
  EXPECT_LT(cut.tiles(), 2 * (points.size() / kMost) + 8);
  // A point of space is in few boxes.
  std::size_t inside = 0;
  for (std::size_t t = 0; t < cut.tiles(); ++t) {
    GridPoint lower = points[cut.order[cut.firsts[t]]];
    GridPoint upper = lower;
    for (std::size_t i = cut.firsts[t]; i < cut.firsts[t + 1]; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        lower[k] = std::min(lower[k], points[cut.order[i]][k]);
        upper[k] = std::max(upper[k], points[cut.order[i]][k]);
      }
    }
    for (std::size_t i = 0; i < points.size(); i += 100) {
      bool in = true;
      for (std::size_t k = 0; k < 3; ++k) {
        in = in && lower[k] <= points[i][k] && points[i][k] <= upper[k];
      }
      inside += in ? 1 : 0;
    }
  }
  EXPECT_LT(inside, 2 * points.size() / 100);
}

TEST(TileCut, AnEmptySetHasNoTile) { EXPECT_EQ(cutTiles({}, 10).tiles(), 0U); }

TEST(CellCode, NumbersHalvesFromTheFirstCutDown) {
  DyadicBox box;
  box.lower = {100, 0, 0};
  box.bits = {3, 2, 0};  // halved along x, x (x before y at equal length), y, x, y
  const CellCode code(box, 3);
  EXPECT_EQ(code({100, 0, 0}), 0U);
  EXPECT_EQ(code({104, 0, 0}), 4U);
  EXPECT_EQ(code({102, 1, 0}), 2U);
  EXPECT_EQ(code({107, 3, 0}), 7U);
  const DyadicBox cell = code.cell(7);
  EXPECT_EQ(cell.lower, (GridPoint{106, 2, 0}));
  EXPECT_EQ(cell.bits, (std::array<unsigned, 3>{1, 1, 0}));
}

TEST(CellCode, CellsHoldTheirPoints) {
  const GridPoint top{0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF};
  const DyadicBox box = dyadicBox({0, 0, 0}, top);
  const CellCode code(box, 15);
  for (const GridPoint& p : test::randomPoints(1, 1000, top)) {
    const DyadicBox cell = code.cell(code(p));
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_GE(p[k], cell.lower[k]);
      EXPECT_LT(p[k] - cell.lower[k], std::uint64_t{1} << cell.bits[k]);
    }
  }
}

}  // namespace
}  // namespace bspc::tiling
