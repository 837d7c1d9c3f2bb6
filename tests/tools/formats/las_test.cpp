#include <cmath>

#include "bspc/grid.h"
#include "tools/formats/format_test_support.h"

namespace bspc::formats {

namespace {

using test::expectInMessage;
using test::failure;
using test::numbers;
using test::Order;
using test::put;
using test::read;

constexpr std::array<std::size_t, 11> kRecordBytes{20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};

/// Writes LAS files; the fields are what a test may want to get wrong.
struct LasFile {
  unsigned minor = 2;
  unsigned format = 0;
  std::size_t recordBytes = 20;
  std::array<double, 3> scale{0.01, 0.01, 0.001};
  std::array<double, 3> offset{500000, 4000000, -10};
  std::vector<std::array<std::int32_t, 3>> points{{1, 2, 3}, {-4, 5, 600000}};
  std::uint64_t claimedPoints = 2;
  /// What stands between header and points, and behind the points.
  std::string records;
  std::uint32_t recordCount = 0;
  std::string tail;
  std::uint32_t extendedRecords = 0;
  /// Whether version 1.4 says the number of points in the old place alone.
  bool oldCount = false;

  std::size_t headerBytes() const { return minor == 4 ? 375 : (minor == 3 ? 235 : 227); }

  template <class T>
  static void set(std::string& bytes, std::size_t at, T value) {
    std::string number;
    put(number, Order::Little, value);
    bytes.replace(at, number.size(), number);
  }

  std::string header() const {
    std::string head(headerBytes(), '\0');
    head.replace(0, 4, "LASF");
    head[24] = 1;
    head[25] = static_cast<char>(minor);
    set(head, 94, static_cast<std::uint16_t>(headerBytes()));
    set(head, 96, static_cast<std::uint32_t>(headerBytes() + records.size()));
    set(head, 100, recordCount);
    head[104] = static_cast<char>(format);
    set(head, 105, static_cast<std::uint16_t>(recordBytes));
    const bool isNew = minor == 4 && !oldCount;
    if (isNew) {
      set(head, 247, claimedPoints);
    } else {
      set(head, 107, static_cast<std::uint32_t>(claimedPoints));
    }
    for (std::size_t k = 0; k < 3; ++k) {
      set(head, 131 + 8 * k, scale[k]);
      set(head, 155 + 8 * k, offset[k]);
    }
    if (minor == 4) set(head, 243, extendedRecords);
    return head;
  }

  std::string text() const {
    std::string all = header() + records;
    for (const auto& point : points) {
      std::string record;
      for (const std::int32_t x : point) put(record, Order::Little, x);
      record.resize(recordBytes, '\7');
      all += record;
    }
    return all + tail;
  }
};

std::string variableLengthRecord(const std::string& user, std::uint16_t id,
                                 const std::string& payload) {
  std::string record(2, '\0');
  record += user;
  record.resize(18, '\0');
  put(record, Order::Little, id);
  put(record, Order::Little, static_cast<std::uint16_t>(payload.size()));
  record.resize(54, '\0');
  return record + payload;
}

std::string extraAttribute(const std::string& name, char type) {
  std::string attribute(4, '\0');
  attribute[2] = type;
  attribute += name;
  attribute.resize(192, '\0');
  return attribute;
}

bool has(const Model& model, const std::string& content) {
  const auto& all = model.otherContent;
  return std::find(all.begin(), all.end(), content) != all.end();
}

const std::vector<double> kPositions{500000 + 1 * 0.01,  4000000 + 2 * 0.01, -10 + 3 * 0.001,
                                     500000 + -4 * 0.01, 4000000 + 5 * 0.01, -10 + 600000 * 0.001};

TEST(Las, EveryVersionAndPointFormatIsRead) {
  for (const unsigned minor : {0U, 1U, 2U, 3U, 4U}) {
    for (unsigned format = 0; format <= 10; ++format) {
      LasFile file;
      file.minor = minor;
      file.format = format;
      file.recordBytes = kRecordBytes[format];
      const Model model = read(file.text(), Format::Las);
      EXPECT_EQ(model.type, ScalarType::Float64);
      EXPECT_EQ(numbers<double>(model), kPositions) << minor << ' ' << format;
      const bool hasColours =
          format == 2 || format == 3 || format == 5 || format == 7 || format == 8 || format == 10;
      EXPECT_EQ(has(model, "colours (uint16)"), hasColours);
      EXPECT_EQ(has(model, "point attribute \"GPS time\" (float64)"), format != 0 && format != 2);
      EXPECT_EQ(has(model, "point attribute \"near infrared\" (uint16)"),
                format == 8 || format == 10);
      EXPECT_EQ(has(model, "waveforms"), format == 4 || format == 5 || format >= 9);
      EXPECT_TRUE(has(model, "point attribute \"intensity\" (uint16)"));
    }
  }
}

TEST(Las, TheLatticeOfTheHeaderRestoresEveryPosition) {
  std::mt19937_64 random(5);
  for (const double scale : {0.01, 0.001, 1e-7, -0.0003048006096012192, 1.234567e-5}) {
    LasFile file;
    file.scale = {scale, scale, 3 * scale};
    file.offset = {500123.4567891, -4000321.789123456, 12.5};
    file.points.clear();
    for (int i = 0; i < 3000; ++i) {
      std::array<std::int32_t, 3> point{};
      for (std::int32_t& x : point) x = static_cast<std::int32_t>(random() % 2000000) - 1000000;
      file.points.push_back(point);
    }
    file.points.push_back({INT32_MIN, INT32_MIN, INT32_MIN});
    file.points.push_back({INT32_MAX, INT32_MAX, INT32_MAX});
    file.claimedPoints = file.points.size();
    const Model model = read(file.text(), Format::Las);
    GridRequest request;
    request.knownLattice = model.lattice;
    const GridFit fit = fitGrid(model.view(), request);
    EXPECT_TRUE(fit.exact) << scale;
    EXPECT_DOUBLE_EQ(fit.grid.step(0), std::fabs(scale));
    EXPECT_DOUBLE_EQ(fit.grid.step(2), 3 * std::fabs(scale));
  }
}

TEST(Las, CentimetresAreFound) {
  LasFile file;
  file.points.clear();
  for (std::int32_t i = 0; i < 500; ++i) file.points.push_back({i * i, 7 * i + 3, 1000 - i});
  file.claimedPoints = 500;
  file.scale = {0.01, 0.01, 0.01};
  for (const double offset : {0.0, 637000.0, 637123.25}) {
    file.offset = {offset, 2 * offset, 0};
    const Model model = read(file.text(), Format::Las);
    GridRequest request;
    request.knownLattice = model.lattice;
    const GridFit fit = fitGrid(model.view(), request);
    EXPECT_TRUE(fit.exact);
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(fit.grid.step(axis), axis == 1 ? 0.07 : 0.01, axis == 1 ? 0.061 : 1e-12);
    }
  }
}

TEST(Las, RecordsBetweenHeaderAndPointsAreNamed) {
  LasFile file;
  file.records = variableLengthRecord("LASF_Projection", 34735, "keys") +
                 variableLengthRecord("LASF_Projection", 34737, "") +
                 variableLengthRecord("liblas", 2112, "more") + "private";
  file.recordCount = 3;
  const Model model = read(file.text(), Format::Las);
  EXPECT_EQ(numbers<double>(model), kPositions);
  EXPECT_TRUE(has(model, "2 records \"LASF_Projection\""));
  EXPECT_TRUE(has(model, "1 record \"liblas\""));
  EXPECT_TRUE(has(model, "7 bytes in front of the points"));
  // Some writers count more records than there are.
  file.recordCount = 4000000000U;
  EXPECT_EQ(read(file.text(), Format::Las).otherContent, model.otherContent);
}

TEST(Las, TheMarkInFrontOfThePointsOfVersion10IsNoContent) {
  LasFile file;
  file.minor = 0;
  file.records = "\xDD\xCC";
  const Model model = read(file.text(), Format::Las);
  EXPECT_EQ(numbers<double>(model), kPositions);
  EXPECT_FALSE(has(model, "2 bytes in front of the points"));
}

TEST(Las, ExtraBytesOfAPointAreNamed) {
  LasFile file;
  file.recordBytes = 25;
  EXPECT_TRUE(has(read(file.text(), Format::Las), "5 extra bytes a point"));
  file.records = variableLengthRecord(
      "LASF_Spec", 4, extraAttribute("height", 9) + extraAttribute("undocumented", 0));
  file.recordCount = 1;
  const Model model = read(file.text(), Format::Las);
  EXPECT_EQ(numbers<double>(model), kPositions);
  EXPECT_TRUE(has(model, "point attribute \"height\" (float32)"));
  EXPECT_TRUE(has(model, "point attribute \"undocumented\""));
}

TEST(Las, WhatFollowsThePointsIsNamedOrDeclared) {
  LasFile file;
  file.tail = "12345";
  EXPECT_TRUE(has(read(file.text(), Format::Las), "5 bytes after the last point"));
  file.minor = 4;
  file.extendedRecords = 1;
  const Model declared = read(file.text(), Format::Las);
  EXPECT_TRUE(has(declared, "1 extended record"));
  EXPECT_FALSE(has(declared, "5 bytes after the last point"));
  EXPECT_EQ(numbers<double>(declared), kPositions);
}

TEST(Las, ThePointCountOfVersion14MayStandInTheOldPlace) {
  LasFile file;
  file.minor = 4;
  file.oldCount = true;
  EXPECT_EQ(read(file.text(), Format::Las).size(), 2U);
}

TEST(Las, AnEmptyFileHasNoPointsAndNoAttributes) {
  LasFile file;
  file.points.clear();
  file.claimedPoints = 0;
  const Model model = read(file.text(), Format::Las);
  EXPECT_EQ(model.size(), 0U);
  EXPECT_TRUE(model.otherContent.empty());
}

TEST(Las, CompressedPointsAreRefusedByName) {
  for (const unsigned mark : {64U, 128U, 192U}) {
    LasFile file;
    file.format = 3 + mark;
    expectInMessage(failure(file.text(), Format::Las), {"LAZ", "las2las", "pdal", "byte 104"});
  }
}

TEST(Las, ErrorsOfTheHeaderSayWhere) {
  expectInMessage(failure("", Format::Las), {"ends", "header"});
  expectInMessage(failure("ply\nformat ascii 1.0\n", Format::Las), {"LASF", "ply", "byte 0"});
  expectInMessage(failure(LasFile().text().substr(0, 200), Format::Las), {"ends", "byte 200"});
  LasFile file;
  file.minor = 5;
  expectInMessage(failure(file.text(), Format::Las), {"1.5", "byte 24"});
  file = {};
  file.format = 11;
  expectInMessage(failure(file.text(), Format::Las), {"point format 11", "byte 104"});
  file = {};
  file.format = 1;
  expectInMessage(failure(file.text(), Format::Las), {"20 bytes", "28", "byte 105"});
  file = {};
  file.scale[1] = 0;
  expectInMessage(failure(file.text(), Format::Las), {"scale of y", "byte 139"});
  file = {};
  file.offset[2] = std::nan("");
  expectInMessage(failure(file.text(), Format::Las), {"offset of z", "byte 171"});
  std::string text = LasFile().text();
  LasFile::set(text, 96, std::uint32_t{226});
  expectInMessage(failure(text, Format::Las), {"inside the header", "byte 96"});
  LasFile::set(text, 96, std::uint32_t{4000000000U});
  expectInMessage(failure(text, Format::Las), {"before the first point"});
  LasFile::set(text, 94, std::uint16_t{100});
  expectInMessage(failure(text, Format::Las), {"100 bytes", "227", "byte 94"});
}

TEST(Las, AFileThatEndsEarlySaysAtWhichPoint) {
  const std::string text = LasFile().text();
  expectInMessage(failure(text.substr(0, text.size() - 1), Format::Las),
                  {"point 2 of 2", "byte " + std::to_string(text.size() - 1)});
}

TEST(Las, HugeCountsCostNothing) {
  LasFile file;
  file.claimedPoints = UINT32_MAX;
  expectInMessage(failure(file.text(), Format::Las), {"point 3 of 4,294,967,295"});
  file.minor = 4;
  file.claimedPoints = UINT64_MAX;
  expectInMessage(failure(file.text(), Format::Las), {"point 3 of"});
}

TEST(Las, NoMutationHarms) {
  LasFile file;
  file.minor = 4;
  file.format = 7;
  file.recordBytes = 40;
  file.extendedRecords = 1;
  file.records = variableLengthRecord("LASF_Spec", 4, extraAttribute("height", 9)) +
                 variableLengthRecord("liblas", 2112, "more");
  file.recordCount = 2;
  test::expectNoMutationHarms(file.text(), Format::Las, 4000);
  // Hits in the header, where everything is decided, are rare in a long file.
  test::expectNoMutationHarms(LasFile().text(), Format::Las, 4000);
}

}  // namespace

}  // namespace bspc::formats
