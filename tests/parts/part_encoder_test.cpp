#include "bspc/part_encoder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "bspc/error.h"
#include "codec/codec_support.h"
#include "support/point_sets.h"

namespace bspc {
namespace {

using Coordinates = std::vector<double>;

/// A scanned surface in units of `step`, around x = `shift`.
Coordinates scan(std::uint64_t seed, std::size_t count, double shift, double unitsPerStep) {
  Coordinates xyz;
  for (const GridPoint& p : test::scannedSphere(seed, count, 4095)) {
    for (std::size_t k = 0; k < 3; ++k) {
      // Divided, so that the numbers are those that parsing decimals gives.
      xyz.push_back((p[k] + (k == 0 ? shift : 0)) / unitsPerStep);
    }
  }
  return xyz;
}

PointSetView viewOf(const Coordinates& xyz) { return PointSetView(xyz.data(), xyz.size() / 3); }

struct WrittenTogether {
  Bytes file;
  std::vector<EncodeReport> reports;
  FileFrame frame;
};

/// What several processes would write.
WrittenTogether writeTogether(const std::vector<PointSetView>& views,
                              const EncodeOptions& options = {}) {
  std::vector<Bytes> descriptions;
  descriptions.reserve(views.size());
  for (const PointSetView& view : views) descriptions.push_back(describePart(view, options));
  const EncodeOptions agreed = agreeOnParts(descriptions, options);
  std::vector<FilePart> parts;
  std::vector<Bytes> summaries;
  for (const PointSetView& view : views) {
    parts.push_back(encodePart(view, agreed));
    summaries.push_back(parts.back().summary);
  }
  WrittenTogether written;
  written.frame = frameParts(summaries);
  written.file.resize(static_cast<std::size_t>(written.frame.endOffset));
  const auto put = [&written](const Bytes& bytes, std::uint64_t offset) {
    written.file.resize(std::max<std::size_t>(written.file.size(), offset + bytes.size()));
    std::copy(bytes.begin(), bytes.end(),
              written.file.begin() + static_cast<std::ptrdiff_t>(offset));
  };
  put(written.frame.head, 0);
  put(written.frame.end, written.frame.endOffset);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    put(parts[i].tiles, written.frame.offsets[i]);
    written.reports.push_back(parts[i].report);
  }
  return written;
}

std::vector<std::array<double, 3>> sortedPoints(const Coordinates& xyz) {
  std::vector<std::array<double, 3>> points;
  for (std::size_t i = 0; i + 2 < xyz.size(); i += 3) {
    points.push_back({xyz[i], xyz[i + 1], xyz[i + 2]});
  }
  std::sort(points.begin(), points.end());
  return points;
}

Coordinates decodedCoordinates(const Bytes& file) {
  Decoder decoder = test::open(file);
  const DecodedPoints decoded = decoder.decode();
  Coordinates xyz(3 * decoded.points.size());
  restorePositions(decoder.info().grid, Span<const GridPoint>(decoded.points), xyz.data());
  return xyz;
}

Coordinates together(const std::vector<Coordinates>& parts) {
  Coordinates all;
  for (const Coordinates& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

TEST(PartEncoder, PartsOnDifferentLatticesAreExactTogether) {
  // Steps of 0.05, of 0.02 and of 0.01, below and above zero.
  const std::vector<Coordinates> parts{scan(1, 3000, 0, 20), scan(2, 2000, -9000, 50),
                                       scan(3, 500, 100, 100)};
  const WrittenTogether written =
      writeTogether({viewOf(parts[0]), viewOf(parts[1]), viewOf(parts[2])});
  EXPECT_EQ(written.frame.points, 5500U);
  for (const EncodeReport& report : written.reports) EXPECT_TRUE(report.exact);
  EXPECT_EQ(sortedPoints(decodedCoordinates(written.file)), sortedPoints(together(parts)));
}

TEST(PartEncoder, EmptyPartsAddNothing) {
  const Coordinates points = scan(4, 1000, 0, 100);
  const PointSetView none(points.data(), 0);
  const WrittenTogether written = writeTogether({none, viewOf(points), none});
  EXPECT_EQ(sortedPoints(decodedCoordinates(written.file)), sortedPoints(points));
  EXPECT_EQ(test::open(writeTogether({none, none}).file).info().points, 0U);
}

TEST(PartEncoder, BitsCountOverTheExtentOfAllParts) {
  const std::vector<Coordinates> parts{scan(5, 1000, 0, 7.3), scan(6, 1000, 50000, 7.3)};
  EncodeOptions options;
  options.grid = GridRequest::withBits(10);
  const WrittenTogether written = writeTogether({viewOf(parts[0]), viewOf(parts[1])}, options);
  const FileInfo info = test::open(written.file).info();
  EXPECT_EQ(info.upper[0], 1023U);
}

TEST(PartEncoder, PrecisionIsKept) {
  const std::vector<Coordinates> parts{scan(7, 1000, 0, 7.3), scan(8, 1000, 5e7, 7.3)};
  EncodeOptions options;
  options.grid = GridRequest::withPrecision(0.01);
  const WrittenTogether written = writeTogether({viewOf(parts[0]), viewOf(parts[1])}, options);
  for (const EncodeReport& report : written.reports) {
    for (const double error : report.maxError) EXPECT_LE(error, 0.005 * (1 + 1e-6));
  }
}

TEST(PartEncoder, PartsOnNoLatticeKeepTheFloatSpacingOfTheWhole) {
  std::vector<float> first;
  std::vector<float> second;
  for (std::size_t i = 0; i < 900; ++i) {
    first.push_back(1.0F / static_cast<float>(i + 3));
    second.push_back(100.0F / static_cast<float>(i + 3));
  }
  const WrittenTogether written =
      writeTogether({PointSetView(first.data(), 300), PointSetView(second.data(), 300)});
  const FileInfo info = test::open(written.file).info();
  EXPECT_EQ(info.points, 600U);
  EXPECT_EQ(info.grid.scalarType, ScalarType::Float32);
  for (const EncodeReport& report : written.reports) {
    for (const double error : report.maxError) EXPECT_LE(error, 4e-6);
  }
}

TEST(PartEncoder, ArraysStayWithTheirPoints) {
  const std::vector<Coordinates> parts{scan(9, 700, 0, 100), scan(10, 800, 5000, 100)};
  std::vector<PointSetView> views;
  for (const Coordinates& part : parts) {
    PointSetView view = viewOf(part);
    ArrayView array;
    array.name = "twice";
    array.type = ScalarType::Float64;
    array.components = 3;
    array.tuples = view.size();
    array.data = part.data();  // the positions once more, so that each tuple tells its point
    view.addArray(array);
    views.push_back(view);
  }
  const Bytes file = writeTogether(views).file;
  Decoder decoder = test::open(file);
  const DecodedPoints decoded = decoder.decode();
  ASSERT_EQ(decoded.arrays.size(), 1U);
  const auto* values = reinterpret_cast<const double*>(decoded.arrays[0].values.data());
  const Coordinates xyz = decodedCoordinates(file);
  EXPECT_EQ(Coordinates(values, values + xyz.size()), xyz);
}

TEST(PartEncoder, ATileKnowsItsLayersWhateverItsPartHas) {
  const std::vector<Coordinates> parts{scan(11, 6000, 0, 100), scan(12, 5, 900, 100)};
  EncodeOptions options;
  options.method = Method::Kd;
  const Bytes file = writeTogether({viewOf(parts[0]), viewOf(parts[1])}, options).file;
  Decoder decoder = test::open(file);
  ASSERT_GT(decoder.info().layers.size(), 1U);
  DecodeOptions coarse;
  coarse.level = 0;
  EXPECT_LT(decoder.decode(coarse).points.size(), 6005U);
  EXPECT_EQ(sortedPoints(decodedCoordinates(file)), sortedPoints(together(parts)));
}

ErrorCode codeOf(const std::vector<PointSetView>& views, const EncodeOptions& options = {}) {
  try {
    writeTogether(views, options);
  } catch (const Error& error) {
    return error.code();
  }
  return ErrorCode{};
}

TEST(PartEncoder, PartsThatDoNotFitTogetherAreRefused) {
  const Coordinates points = scan(13, 100, 0, 100);
  const std::vector<float> floats(points.begin(), points.end());
  EXPECT_EQ(codeOf({viewOf(points), PointSetView(floats.data(), 100)}), ErrorCode::InvalidArgument);
  PointSetView named = viewOf(points);
  ArrayView array;
  array.name = "a";
  array.type = ScalarType::UInt8;
  array.tuples = named.size();
  array.data = points.data();
  named.addArray(array);
  EXPECT_EQ(codeOf({viewOf(points), named}), ErrorCode::InvalidArgument);
  EncodeOptions ids;
  ids.originalIds = true;
  EXPECT_EQ(codeOf({viewOf(points)}, ids), ErrorCode::InvalidArgument);
}

TEST(PartEncoder, DamagedMessagesAreRefused) {
  const Coordinates points = scan(14, 100, 0, 100);
  const Bytes good = describePart(viewOf(points), {});
  for (std::size_t size = 1; size < good.size(); ++size) {
    const Bytes cut(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_THROW(agreeOnParts({cut}, {}), Error);
  }
}

}  // namespace
}  // namespace bspc
