#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "bspc/error.h"
#include "geometry/predictive/mirror_coder.h"
#include "geometry/predictive/mirror_plane.h"
#include "support/point_sets.h"

namespace bspc::geometry::predictive {
namespace {

struct MirroredSet {
  std::vector<GridPoint> points;
  MirrorPlane plane;
};

/// Random points and their images across `axis`, of which some are a step off and some missing.
MirroredSet mirroredSet(unsigned axis, std::uint64_t sum) {
  std::mt19937_64 random(11 + axis);
  MirroredSet set{{}, {axis, sum}};
  for (int i = 0; i < 800; ++i) {
    GridPoint p = {};
    for (std::uint32_t& x : p) x = static_cast<std::uint32_t>(random() % 3000) + 100;
    p[axis] = static_cast<std::uint32_t>(random() % (sum / 2));
    set.points.push_back(p);
    if (random() % 10 == 0) continue;
    GridPoint q = p;
    q[axis] = static_cast<std::uint32_t>(sum - p[axis]);
    if (random() % 8 == 0) q[(axis + random() % 3) % 3] += random() % 2 == 0 ? 1U : ~0U;
    set.points.push_back(q);
    if (random() % 50 == 0) set.points.insert(set.points.end(), {p, q});  // duplicates
  }
  std::shuffle(set.points.begin(), set.points.end(), random);
  return set;
}

TEST(MirrorPlane, IsFoundAcrossEachAxis) {
  for (unsigned axis = 0; axis < 3; ++axis) {
    const MirroredSet set = mirroredSet(axis, 4001 + axis);
    const auto plane = findMirrorPlane(set.points);
    ASSERT_TRUE(plane) << axis;
    EXPECT_EQ(plane->axis, axis);
    EXPECT_EQ(plane->sum, set.plane.sum);
  }
}

TEST(MirrorPlane, NoneWhereThereIsNoSymmetry) {
  EXPECT_FALSE(findMirrorPlane(test::randomPoints(1, 3000, {4000, 4000, 4000})));
  EXPECT_FALSE(findMirrorPlane(test::scannedSphere(2, 5000, 4000)));
  EXPECT_FALSE(findMirrorPlane({}));
}

TEST(MirrorPlane, TakesDegenerateSets) {
  for (const test::NamedPoints& set : test::degenerateSets()) findMirrorPlane(set.points);
}

struct Halves {
  std::vector<GridPoint> originals;
  std::vector<GridPoint> others;
};

Halves halvesOf(const MirroredSet& set) {
  Halves halves;
  for (const GridPoint& p : set.points) {
    (set.plane.isOriginal(p) ? halves.originals : halves.others).push_back(p);
  }
  return halves;
}

TEST(MirrorMatches, EveryOtherPointIsACopyOrLeftOnce) {
  const Halves halves = halvesOf(mirroredSet(1, 4002));
  const MirrorPlane plane{1, 4002};
  const MirrorMatches matches = matchMirrored(plane, halves.originals, halves.others);
  std::vector<bool> used(halves.others.size());
  std::size_t copies = 0;
  for (std::size_t i = 0; i < halves.originals.size(); ++i) {
    if (!matches.offsets[i]) continue;
    const std::uint32_t copy = matches.copies[i];
    ASSERT_LT(copy, used.size());
    EXPECT_FALSE(used[copy]);
    used[copy] = true;
    ++copies;
    const GridPoint& p = halves.originals[i];
    const GridPoint& q = halves.others[copy];
    const auto offset = [&matches, i](std::size_t k) {
      return std::int64_t{(*matches.offsets[i])[k]};
    };
    EXPECT_EQ(std::int64_t{q[1]}, static_cast<std::int64_t>(plane.sum) - p[1] + offset(0));
    EXPECT_EQ(std::int64_t{q[2]}, p[2] + offset(1));
    EXPECT_EQ(std::int64_t{q[0]}, p[0] + offset(2));
  }
  for (const std::uint32_t i : matches.unmatched) {
    EXPECT_FALSE(used[i]);
    used[i] = true;
  }
  EXPECT_EQ(copies + matches.unmatched.size(), halves.others.size());
  EXPECT_LT(matches.unmatched.size(), halves.others.size() / 50);
}

TEST(MirrorCoder, CopiesComeBack) {
  const Halves halves = halvesOf(mirroredSet(2, 4003));
  const MirrorPlane plane{2, 4003};
  const GridPoint extent = {4200, 4200, 4200};
  const MirrorMatches matches = matchMirrored(plane, halves.originals, halves.others);
  const PhaseHistograms phases = {PhaseHistogram(), PhaseHistogram(123456789), PhaseHistogram()};
  entropy::SymbolWriter writer;
  MirrorCoder<entropy::SymbolWriter> encoder(plane, extent);
  for (std::size_t i = 0; i < halves.originals.size(); ++i) {
    encoder.code(writer, halves.originals[i], matches.offsets[i], phases);
  }
  const Bytes bytes = writer.finish();
  // Nearly all have a copy, and seven of eight an exact one.
  EXPECT_LT(8 * bytes.size(), 2 * halves.originals.size());
  entropy::SymbolReader reader(bytes);
  MirrorCoder<entropy::SymbolReader> decoder(plane, extent);
  for (std::size_t i = 0; i < halves.originals.size(); ++i) {
    const auto copy = decoder.code(reader, halves.originals[i], std::nullopt, phases);
    ASSERT_EQ(copy.has_value(), matches.offsets[i].has_value()) << i;
    if (copy) {
      EXPECT_EQ(*copy, halves.others[matches.copies[i]]) << i;
    }
  }
  reader.finish();
}

TEST(MirrorCoder, GarbageGivesPointsWithinTheTileOrAnError) {
  std::mt19937_64 random(5);
  const GridPoint extent = {10, 20, 30};
  const PhaseHistograms phases;
  unsigned errors = 0;
  for (int round = 0; round < 100; ++round) {
    Bytes bytes(64);
    for (std::uint8_t& b : bytes) b = static_cast<std::uint8_t>(random());
    entropy::SymbolReader reader(bytes);
    MirrorCoder<entropy::SymbolReader> decoder({0, random() % 21}, extent);
    try {
      for (int i = 0; i < 200; ++i) {
        const auto copy = decoder.code(reader, {0, 20, 30}, std::nullopt, phases);
        for (unsigned k = 0; copy && k < 3; ++k) ASSERT_LE((*copy)[k], extent[k]);
      }
    } catch (const Error& e) {
      EXPECT_EQ(e.code(), ErrorCode::Corrupt);
      ++errors;
    }
  }
  EXPECT_GT(errors, 0U);
}

}  // namespace
}  // namespace bspc::geometry::predictive
