#include "geometry/predictive/axis_residuals.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "geometry/predictive/candidates_body.h"
#include "geometry/predictive/surface_fit.h"

namespace bspc::geometry::predictive {
namespace {

constexpr float kSide = 16;
constexpr float kSpacing = 4;

/// What is expected in a box of a cell of side 16 around which some points are known.
class AxisResidualsTest : public testing::Test {
 protected:
  AxisResidualsTest() {
    near_.clear();
    box_.size = {kSide, kSide, kSide};
  }

  void know(const Vector3& place) { near_.add(place[0], place[1], place[2], 1, 1, known_++); }

  void fitSurface() {
    near_.pad();
    surface_.fit(near_, {kSide / 2, kSide / 2, kSide / 2}, kSpacing, 1.1F, true);
  }

  void start() {
    near_.pad();
    NearPoints points;
    points.gather(near_, kSide / 2, kSide / 2, kSide / 2, 8);
    candidates_->startCell(points, kSide, kSpacing);
    candidates_->startResiduals(box_, kSpacing, 0.1F);
    residuals_.start(box_, surface_);
  }

  AxisResiduals::Expected expected(unsigned rank, float surfaceError = 1) {
    return residuals_.expected(rank, surface_, *candidates_, surfaceError);
  }

  static Features features() {
    Features f;
    f.flags = Features::kQuadric | Features::kParallelograms | Features::kResiduals;
    f.pairReach = 8;
    return f;
  }

  Neighbourhood near_;
  std::uint32_t known_ = 0;
  Surface surface_;
  Question box_;
  std::unique_ptr<Candidates> candidates_ = std::make_unique<Candidates>(features());
  AxisResiduals residuals_;
};

TEST_F(AxisResidualsTest, WithoutCandidatesAreAnywhereInTheBox) {
  start();
  for (unsigned rank = 0; rank < 3; ++rank) {
    EXPECT_EQ(residuals_.axis(rank), rank);
    const AxisResiduals::Expected e = expected(rank);
    EXPECT_EQ(e.kind, rank);
    EXPECT_FLOAT_EQ(e.place, kSide / 2);
    EXPECT_GT(e.scale, kSide / 4);
  }
}

TEST_F(AxisResidualsTest, FollowARowOfPoints) {
  know({-6, 8, 8});
  know({-2, 8, 8});
  box_.size = {4, 4, 4};
  box_.lower = {0, 6, 6};
  start();
  const AxisResiduals::Expected e = expected(0);
  EXPECT_NEAR(e.place, 2, 0.1);
  EXPECT_LT(e.scale, 0.7);
}

TEST_F(AxisResidualsTest, ThatLieOnOneAxisTellWhichCandidateCounts) {
  know({-2, 8, 2});
  know({2, 8, 2});  // on to 6, 8, 2
  know({18, 8, 14});
  know({14, 8, 14});  // on to 10, 8, 14
  start();
  EXPECT_NEAR(expected(0).place, 8, 1);
  EXPECT_NEAR(expected(2).place, 8, 1);
  residuals_.found(0, 6);
  candidates_->weighAt(0, 6);
  EXPECT_NEAR(expected(2).place, 2, 0.5);
  candidates_->startResiduals(box_, kSpacing, 0.1F);
  candidates_->weighAt(0, 10);
  EXPECT_NEAR(expected(2).place, 14, 0.5);
}

TEST_F(AxisResidualsTest, AcrossASureSurfaceLieOnIt) {
  for (float x = -8; x <= 24; x += 8) {
    for (float z = -8; z <= 24; z += 8) know({x, 3, z});
  }
  fitSurface();
  start();
  EXPECT_EQ(residuals_.axis(2), 1U) << "y is the axis across the surface";
  EXPECT_EQ(expected(0).kind, unsigned{AxisResiduals::kFirstAxis});
  const AxisResiduals::Expected sure = expected(2, 0.01F);
  EXPECT_EQ(sure.kind, unsigned{AxisResiduals::kSurface});
  EXPECT_NEAR(sure.place, 3, 0.2);
  EXPECT_NEAR(sure.scale, 0.01 * kSpacing + 0.3, 0.05);
  EXPECT_EQ(expected(2, 100).kind, unsigned{AxisResiduals::kLastAxis});
}

}  // namespace
}  // namespace bspc::geometry::predictive
