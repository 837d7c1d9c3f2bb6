#include "bspc/stream_encoder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <limits>

#include "bspc/error.h"
#include "codec/codec_support.h"
#include "support/array_sets.h"
#include "support/point_sets.h"

namespace bspc {
namespace {

template <class T>
class VectorReader final : public PointReader {
 public:
  VectorReader(ScalarType type, std::vector<T> xyz, std::vector<ArrayValues> values = {})
      : values_(std::move(values)), type_(type), xyz_(std::move(xyz)) {
    for (const ArrayValues& array : values_) descriptions_.push_back(array);
  }
  ScalarType type() const override { return type_; }
  const std::vector<ArrayDescription>& arrays() const override { return descriptions_; }
  std::size_t read(std::uint8_t* xyz, Span<ArrayValues> values, std::size_t count) override {
    // Pieces of odd sizes, as a pipe gives them.
    count = std::min({count, std::size_t{10007}, (xyz_.size() - at_) / 3});
    if (count > 0) std::memcpy(xyz, xyz_.data() + at_, 3 * count * sizeof(T));
    for (std::size_t i = at_ / 3; i < at_ / 3 + count; ++i) {
      for (std::size_t a = 0; a < values.size(); ++a) {
        if (values_[a].type == ScalarType::String) {
          values[a].strings.push_back(values_[a].strings[i]);
        } else {
          const std::string tuple = test::tupleOf(values_[a], i);
          values[a].values.insert(values[a].values.end(), tuple.begin(), tuple.end());
        }
      }
    }
    at_ += 3 * count;
    return count;
  }

 private:
  std::vector<ArrayValues> values_;
  std::vector<ArrayDescription> descriptions_;
  ScalarType type_;
  std::vector<T> xyz_;
  std::size_t at_ = 0;
};

class MemoryScratch final : public ScratchStorage {
 public:
  explicit MemoryScratch(std::size_t& used) : used_(used) {}
  std::uint64_t size() const override { return bytes_.size(); }
  void read(std::uint64_t offset, Span<std::uint8_t> into) override {
    MemorySource(bytes_).read(offset, into);
  }
  void append(ByteView bytes) override {
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
    used_ += bytes.size();
  }

 private:
  std::size_t& used_;
  Bytes bytes_;
};

/// Enough for a set of the least memory not to fit.
constexpr std::size_t kMany = 400000;

class Streaming : public testing::Test {
 protected:
  StreamOptions options() {
    StreamOptions options;
    options.memoryBytes = 1;
    options.encoding.method = Method::Kd;
    options.encoding.tilePoints = 20000;
    options.scratch = [this] { return std::make_unique<MemoryScratch>(scratchBytes_); };
    return options;
  }
  template <class T>
  Bytes encodedStream(ScalarType type, const std::vector<T>& xyz, const StreamOptions& options,
                      const std::vector<ArrayValues>& values = {}) {
    VectorReader<T> reader(type, xyz, values);
    MemorySink sink;
    report_ = encodeStream(reader, sink, options);
    return sink.take();
  }
  template <class T>
  static std::vector<std::array<T, 3>> sortedPoints(const std::vector<T>& xyz) {
    std::vector<std::array<T, 3>> points(xyz.size() / 3);
    std::memcpy(points.data(), xyz.data(), xyz.size() * sizeof(T));
    std::sort(points.begin(), points.end());
    return points;
  }
  template <class T>
  static std::vector<T> decodedNumbers(const Bytes& file) {
    Decoder decoder = test::open(file);
    const DecodedPoints decoded = decoder.decode();
    std::vector<T> xyz(3 * decoded.points.size());
    restorePositions(decoder.info().grid, Span<const GridPoint>(decoded.points), xyz.data());
    return xyz;
  }
  static std::vector<double> centimetres(std::size_t count) {
    std::vector<double> xyz;
    for (const GridPoint& p : test::scannedSphere(21, count, 60000)) {
      for (const std::uint32_t v : p) xyz.push_back((v + 50000000.0) / 100);
    }
    return xyz;
  }

  std::size_t scratchBytes_ = 0;
  EncodeReport report_;
};

TEST_F(Streaming, ALargeSetComesBackExactly) {
  const std::vector<double> xyz = centimetres(kMany);
  const Bytes file = encodedStream(ScalarType::Float64, xyz, options());
  EXPECT_GT(scratchBytes_, xyz.size() * sizeof(double));
  EXPECT_TRUE(report_.exact);
  EXPECT_EQ(report_.points, kMany);
  EXPECT_EQ(report_.fileBytes, file.size());
  EXPECT_TRUE(test::open(file).info().streaming);
  EXPECT_EQ(test::open(file).info().tiles.size(), report_.tiles);
  EXPECT_EQ(sortedPoints(decodedNumbers<double>(file)), sortedPoints(xyz));
}

/// Bytes of a point's coordinates with those of its tuples, point by point.
std::vector<std::string> rowsOf(const std::vector<double>& xyz,
                                const std::vector<ArrayValues>& arrays) {
  std::vector<std::string> rows;
  for (std::size_t i = 0; i < xyz.size() / 3; ++i) {
    std::string row(reinterpret_cast<const char*>(&xyz[3 * i]), 3 * sizeof(double));
    for (const ArrayValues& array : arrays) row += test::tupleOf(array, i);
    rows.push_back(std::move(row));
  }
  return rows;
}

std::vector<std::string> decodedRows(const Bytes& file) {
  Decoder decoder = test::open(file);
  const DecodedPoints decoded = decoder.decode();
  std::vector<double> xyz(3 * decoded.points.size());
  restorePositions(decoder.info().grid, decoded, xyz.data());
  return rowsOf(xyz, decoded.arrays);
}

std::vector<ArrayValues> someArrays(std::size_t count) {
  return {test::randomArray("colour", ScalarType::UInt8, 3, count, 1),
          test::randomArray("time", ScalarType::Float64, 1, count, 2),
          test::randomArray("edge", ScalarType::Bit, 1, count, 3)};
}

TEST_F(Streaming, ArraysComeBackWithTheirPoints) {
  const std::vector<double> xyz = centimetres(kMany);
  const std::vector<ArrayValues> arrays = someArrays(kMany);
  StreamOptions wishes = options();
  wishes.encoding.method = Method::Fast;
  const Bytes file = encodedStream(ScalarType::Float64, xyz, wishes, arrays);
  EXPECT_GE(scratchBytes_, kMany * (24 + 12 + 2 * 12));
  std::vector<std::string> expected = rowsOf(xyz, arrays);
  std::vector<std::string> decoded = decodedRows(file);
  std::sort(expected.begin(), expected.end());
  std::sort(decoded.begin(), decoded.end());
  EXPECT_TRUE(decoded == expected);
  ASSERT_EQ(report_.arrays.size(), 3U);
  EXPECT_EQ(report_.arrays[1].name, "time");
  EXPECT_GT(report_.arrays[1].bytes, kMany);
}

TEST_F(Streaming, TheOrderIsKeptWithIdsAndExactFloats) {
  std::vector<double> xyz = centimetres(kMany);
  for (std::size_t i = 0; i < xyz.size(); i += 7) xyz[i] = -xyz[i] / 3;
  xyz[5] = -0.0;
  xyz[3000] = std::numeric_limits<double>::quiet_NaN();
  std::vector<ArrayValues> arrays = someArrays(kMany);
  StreamOptions wishes = options();
  wishes.encoding.method = Method::Fast;
  wishes.encoding.keepOrder = true;
  wishes.encoding.originalIds = true;
  wishes.encoding.grid = GridRequest::exactFloats();
  wishes.encoding.grid.dropNonFinite = true;
  wishes.encoding.metadata.crs = "EPSG:25832";
  const Bytes file = encodedStream(ScalarType::Float64, xyz, wishes, arrays);
  EXPECT_EQ(report_.grid.form, Grid::Form::FloatBits);
  EXPECT_EQ(report_.dropped, 1U);
  EXPECT_EQ(test::open(file).info().metadata.crs, "EPSG:25832");
  ArrayValues ids;
  ids.type = ScalarType::UInt64;
  for (std::uint64_t i = 0; i < kMany; ++i) {
    for (unsigned b = 0; b < 8; ++b) ids.values.push_back(static_cast<std::uint8_t>(i >> (8 * b)));
  }
  arrays.push_back(ids);
  std::vector<std::string> expected = rowsOf(xyz, arrays);
  expected.erase(expected.begin() + 1000);
  EXPECT_TRUE(decodedRows(file) == expected);
}

TEST_F(Streaming, StringsNeedASetThatFitsIntoMemory) {
  const std::vector<double> few = centimetres(500);
  std::vector<ArrayValues> arrays{test::randomArray("s", ScalarType::String, 1, 500, 4)};
  std::vector<std::string> expected = rowsOf(few, arrays);
  std::vector<std::string> decoded =
      decodedRows(encodedStream(ScalarType::Float64, few, options(), arrays));
  std::sort(expected.begin(), expected.end());
  std::sort(decoded.begin(), decoded.end());
  EXPECT_EQ(decoded, expected);
  arrays = {test::randomArray("s", ScalarType::String, 1, kMany, 4)};
  try {
    encodedStream(ScalarType::Float64, centimetres(kMany), options(), arrays);
    FAIL() << "strings were streamed";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::Unsupported);
    EXPECT_NE(std::string(error.what()).find("\"s\""), std::string::npos);
  }
}

TEST_F(Streaming, TheGridIsThatOfTheSetInMemory) {
  const std::vector<double> xyz = centimetres(kMany);
  for (const GridRequest& request :
       {GridRequest::automatic(), GridRequest::withBits(14), GridRequest::withPrecision(0.25)}) {
    StreamOptions wishes = options();
    wishes.encoding.grid = request;
    encodedStream(ScalarType::Float64, xyz, wishes);
    EncodeReport report;
    test::encoded(PointSetView(xyz.data(), kMany), wishes.encoding, &report);
    EXPECT_TRUE(report_.grid.sameLattice(report.grid));
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(report_.grid.axes[k].base, report.grid.axes[k].base);
      EXPECT_EQ(report_.maxError[k], report.maxError[k]);
    }
  }
}

TEST_F(Streaming, TheFileDoesNotDependOnTheThreads) {
  const std::vector<double> xyz = centimetres(kMany);
  StreamOptions one = options();
  one.encoding.threads = 1;
  StreamOptions three = options();
  three.encoding.threads = 3;
  EXPECT_EQ(encodedStream(ScalarType::Float64, xyz, one),
            encodedStream(ScalarType::Float64, xyz, three));
}

TEST_F(Streaming, EqualPointsThatFillMoreThanMemoryComeBack) {
  std::vector<float> xyz(3 * kMany, 2.5F);
  xyz[0] = 7;
  const Bytes file = encodedStream(ScalarType::Float32, xyz, options());
  EXPECT_GT(scratchBytes_, 0U);
  EXPECT_EQ(sortedPoints(decodedNumbers<float>(file)), sortedPoints(xyz));
}

TEST_F(Streaming, ASmallSetIsCodedAsInMemory) {
  const std::vector<double> xyz = centimetres(3000);
  const Bytes file = encodedStream(ScalarType::Float64, xyz, options());
  EXPECT_EQ(scratchBytes_, 0U);
  EXPECT_EQ(file, test::encoded(PointSetView(xyz.data(), 3000), options().encoding));
  EXPECT_EQ(test::open(encodedStream(ScalarType::Float64, std::vector<double>(), options()))
                .info()
                .points,
            0U);
}

TEST_F(Streaming, PointsThatAreNotFiniteAreNamedOrDropped) {
  constexpr std::ptrdiff_t kBroken = 390001;
  std::vector<double> xyz = centimetres(kMany);
  xyz[std::size_t{3} * kBroken + 1] = std::numeric_limits<double>::quiet_NaN();
  try {
    encodedStream(ScalarType::Float64, xyz, options());
    FAIL() << "was accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::NonFinite);
    EXPECT_NE(std::string(error.what()).find("point 390001"), std::string::npos) << error.what();
  }
  StreamOptions wishes = options();
  wishes.encoding.grid.dropNonFinite = true;
  const Bytes file = encodedStream(ScalarType::Float64, xyz, wishes);
  EXPECT_EQ(report_.dropped, 1U);
  xyz.erase(xyz.begin() + 3 * kBroken, xyz.begin() + 3 * (kBroken + 1));
  EXPECT_EQ(sortedPoints(decodedNumbers<double>(file)), sortedPoints(xyz));
}

/// Room for so many bytes, and then none.
class FullScratch final : public ScratchStorage {
 public:
  FullScratch(std::uint64_t room, bool readable) : room_(room), readable_(readable) {}
  std::uint64_t size() const override { return bytes_.size(); }
  void read(std::uint64_t offset, Span<std::uint8_t> into) override {
    if (!readable_) throw Error(ErrorCode::Io, "cannot be read");
    MemorySource(bytes_).read(offset, into);
  }
  void append(ByteView bytes) override {
    if (bytes_.size() + bytes.size() > room_) throw Error(ErrorCode::Io, "is full");
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
  }

 private:
  std::uint64_t room_;
  bool readable_;
  Bytes bytes_;
};

TEST_F(Streaming, ScratchThatIsFullOrCannotBeReadIsAnError) {
  const std::vector<float> xyz(3 * kMany, 1.0F);
  StreamOptions failing = options();
  for (const std::uint64_t room : {std::uint64_t{0}, std::uint64_t{3} << 20, ~std::uint64_t{0}}) {
    failing.scratch = [room] { return std::make_unique<FullScratch>(room, false); };
    try {
      encodedStream(ScalarType::Float32, xyz, failing);
      FAIL() << room;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::Io);
    }
  }
}

TEST_F(Streaming, WhatIsNotPossibleIsRefused) {
  const std::vector<double> xyz = centimetres(kMany);
  StreamOptions wishes = options();
  wishes.scratch = nullptr;
  EXPECT_THROW(encodedStream(ScalarType::Float64, xyz, wishes), Error);
  wishes = options();
  wishes.encoding.wantOrder = true;
  EXPECT_THROW(encodedStream(ScalarType::Float64, xyz, wishes), Error);
}

TEST_F(Streaming, ProgressGrowsAndStops) {
  const std::vector<double> xyz = centimetres(kMany);
  StreamOptions wishes = options();
  double last = 0;
  wishes.encoding.progress = [&last](double share) {
    EXPECT_GE(share, last);
    last = share;
    return true;
  };
  encodedStream(ScalarType::Float64, xyz, wishes);
  EXPECT_EQ(last, 1);
  for (const double until : {0.0, 0.3, 0.5, 0.8}) {
    wishes.encoding.progress = [until](double share) { return share < until; };
    try {
      encodedStream(ScalarType::Float64, xyz, wishes);
      FAIL() << "did not stop";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::Cancelled);
    }
  }
}

}  // namespace
}  // namespace bspc
