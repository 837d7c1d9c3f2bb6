#include "geometry/predictive/range_image.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "bspc/error.h"
#include "geometry/predictive/camera_fit.h"
#include "geometry/predictive/range_image_coder.h"
#include "support/point_sets.h"

namespace bspc::geometry::predictive {
namespace {

/// A depth camera; lengths in grid steps.
struct Frame {
  unsigned width = 160;
  unsigned height = 120;
  std::array<double, 2> focal = {140, 140};
  std::array<double, 2> centre = {0, 0};  ///< of the picture's pixels, a fraction of one
  double nearest = 900;
  double depthStep = 13.3;  ///< between depths that the camera tells apart
  unsigned depthAxis = 2;
};

/// What it sees of a tilted wall and a ball, with holes.
std::vector<GridPoint> photograph(const Frame& frame) {
  std::mt19937_64 random(21);
  std::vector<GridPoint> points;
  for (unsigned v = 0; v < frame.height; ++v) {
    for (unsigned u = 0; u < frame.width; ++u) {
      if (random() % 20 == 0) continue;
      const double x = u + frame.centre[0] - frame.width / 2.0;
      const double y = v + frame.centre[1] - frame.height / 2.0;
      double rank = 30 + 0.2 * u + 0.1 * v;
      const double toBall = (x - 20) * (x - 20) + (y + 10) * (y + 10);
      if (toBall < 900) rank = 10 + toBall / 100;
      const double z = frame.nearest + frame.depthStep * std::floor(rank);
      const std::array<double, 3> p = {x / frame.focal[0] * z + 2000, y / frame.focal[1] * z + 2000,
                                       z - frame.nearest + 7};
      GridPoint q = {};
      for (unsigned k = 0; k < 3; ++k) {
        q[(frame.depthAxis + 1 + k) % 3] = static_cast<std::uint32_t>(std::lround(p[k]));
      }
      points.push_back(q);
    }
  }
  std::shuffle(points.begin(), points.end(), random);
  return points;
}

GridPoint extentOf(const std::vector<GridPoint>& points) {
  GridPoint extent = {};
  for (const GridPoint& p : points) {
    for (unsigned k = 0; k < 3; ++k) extent[k] = std::max(extent[k], p[k]);
  }
  return extent;
}

std::vector<Frame> frames() {
  std::vector<Frame> all(3);
  all[0].focal = {151, 138};  // oblong pixels
  all[1].centre = {0.5, 0.31};
  all[1].depthAxis = 0;
  all[2].depthAxis = 1;
  all[2].depthStep = 7;
  return all;
}

TEST(CameraFit, FindsCamerasOfAllKinds) {
  for (const Frame& frame : frames()) {
    const std::vector<GridPoint> points = photograph(frame);
    const GridPoint extent = extentOf(points);
    const auto camera = findCamera(points, extent);
    ASSERT_TRUE(camera);
    EXPECT_EQ(camera->depthAxis, frame.depthAxis);
    for (unsigned k = 0; k < 2; ++k) {
      const double focal = PinholeCamera::kPitchUnit / static_cast<double>(camera->pitch[k]);
      EXPECT_NEAR(focal, frame.focal[k], 0.01 * frame.focal[k]);
    }
    const auto image = arrangeRangeImage(points, extent, *camera);
    ASSERT_TRUE(image);
    EXPECT_LE(image->left.size(), points.size() / 1000);
    std::size_t errors = 0;
    for (const RangePixel& p : image->pixels) errors += p.error != RangePixel().error ? 1 : 0;
    EXPECT_LE(errors, points.size() / 50);
  }
}

TEST(CameraFit, NoneWhereThereIsNoCamera) {
  for (const std::vector<GridPoint>& points :
       {test::scannedSphere(1, 20000, 500), test::randomPoints(2, 20000, {3000, 3000, 99}),
        test::randomPoints(3, 20000, {60, 60, 60})}) {
    EXPECT_FALSE(findCamera(points, extentOf(points)));
  }
  for (const test::NamedPoints& set : test::degenerateSets()) {
    EXPECT_FALSE(findCamera(set.points, extentOf(set.points))) << set.name;
  }
}

/// A frame, the image of it, and the image as a stream.
struct CodedFrame {
  std::vector<GridPoint> points;
  GridPoint extent{};
  RangeImage image;
  Bytes bytes;
};

CodedFrame codeFrame() {
  CodedFrame coded;
  coded.points = photograph({});
  coded.points.push_back(coded.points[0]);  // has no pixel of its own
  coded.extent = extentOf(coded.points);
  const auto camera = findCamera(coded.points, coded.extent);
  if (!camera) return coded;
  const auto image = arrangeRangeImage(coded.points, coded.extent, *camera);
  if (!image) return coded;
  coded.image = *image;
  entropy::SymbolWriter writer;
  RangeImageCoder<entropy::SymbolWriter> encoder;
  RangeImageHead head = image->head;
  encoder.codeHead(writer, head, coded.extent, coded.points.size());
  std::vector<RangePixel> pixels = image->pixels;
  for (std::size_t y = 0; y < head.size[1]; ++y) {
    encoder.codeRow(writer, Span<RangePixel>(pixels).subspan(y * head.size[0], head.size[0]));
  }
  coded.bytes = writer.finish();
  return coded;
}

const CodedFrame& codedFrame() {
  static const CodedFrame coded = codeFrame();
  return coded;
}

/// The points of a stream, pixel by pixel.
std::vector<GridPoint> decodedPoints(const CodedFrame& coded, ByteView bytes) {
  entropy::SymbolReader reader(bytes);
  RangeImageCoder<entropy::SymbolReader> decoder;
  RangeImageHead head;
  decoder.codeHead(reader, head, coded.extent, coded.points.size());
  std::vector<RangePixel> row(head.size[0]);
  std::vector<GridPoint> points;
  for (std::uint32_t y = 0; y < head.size[1]; ++y) {
    decoder.codeRow(reader, row);
    for (std::uint32_t x = 0; x < head.size[0]; ++x) {
      if (row[x].rank == RangePixel::kEmpty) continue;
      points.push_back(decoder.pointOf(head, x, y, row[x], coded.extent));
    }
  }
  reader.finish();
  return points;
}

TEST(RangeImage, EveryPointComesBackOrIsLeft) {
  const CodedFrame& coded = codedFrame();
  ASSERT_FALSE(coded.bytes.empty());
  EXPECT_LT(8 * coded.bytes.size(), 3 * coded.points.size());
  std::vector<GridPoint> back = decodedPoints(coded, coded.bytes);
  EXPECT_GE(coded.image.left.size(), 1U);
  for (const std::uint32_t i : coded.image.left) back.push_back(coded.points[i]);
  EXPECT_EQ(test::sorted(back), test::sorted(coded.points));
}

TEST(RangeImage, IndicesNameThePointsOfPixels) {
  const CodedFrame& coded = codedFrame();
  const std::vector<GridPoint> points = decodedPoints(coded, coded.bytes);
  std::size_t next = 0;
  for (std::size_t i = 0; i < coded.image.pixels.size(); ++i) {
    if (coded.image.pixels[i].rank == RangePixel::kEmpty) continue;
    ASSERT_LT(next, points.size());
    EXPECT_EQ(points[next++], coded.points[coded.image.indices[i]]);
  }
  EXPECT_EQ(next, points.size());
}

TEST(RangeImage, DamagedStreamsGivePointsWithinTheTileOrAnError) {
  const CodedFrame& coded = codedFrame();
  std::mt19937_64 random(9);
  unsigned errors = 0;
  for (int round = 0; round < 60; ++round) {
    Bytes bytes = coded.bytes;
    if (round % 3 == 0) {
      bytes.resize(random() % 300);
      for (std::uint8_t& b : bytes) b = static_cast<std::uint8_t>(random());
    } else {
      const std::size_t reach = round % 3 == 1 ? 64 : bytes.size();
      bytes[random() % reach] ^= static_cast<std::uint8_t>(1U << (random() % 8));
    }
    try {
      for (const GridPoint& p : decodedPoints(coded, bytes)) {
        for (unsigned k = 0; k < 3; ++k) ASSERT_LE(p[k], coded.extent[k]);
      }
    } catch (const Error& e) {
      EXPECT_EQ(e.code(), ErrorCode::Corrupt);
      ++errors;
    }
  }
  EXPECT_GT(errors, 30U);
}

TEST(RangeImage, MostPixelsAnImageMayHaveAreBoundByItsPoints) {
  const CodedFrame& coded = codedFrame();
  RangeImageHead head = coded.image.head;
  head.size = {RangeImageHead::kMaxSize, RangeImageHead::kMaxSize};
  entropy::SymbolWriter writer;
  RangeImageCoder<entropy::SymbolWriter> encoder;
  EXPECT_THROW(encoder.codeHead(writer, head, coded.extent, coded.points.size()), Error);
}

}  // namespace
}  // namespace bspc::geometry::predictive
