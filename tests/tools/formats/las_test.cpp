#include <cmath>

#include "bspc/grid.h"
#include "formats/las_records.h"
#include "tools/formats/format_test_support.h"

namespace bspc::formats {

namespace {

using test::contentOf;
using test::expectInMessage;
using test::failure;
using test::numbers;
using test::Order;
using test::put;
using test::read;
using test::valuesOf;
using test::viewOf;
using test::written;

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

std::string extraAttribute(const std::string& name, char type, char options = 0) {
  std::string attribute(4, '\0');
  attribute[2] = type;
  attribute[3] = options;
  attribute += name;
  attribute.resize(192, '\0');
  return attribute;
}

bool has(const Model& model, const std::string& content) {
  const std::vector<std::string> all = contentOf(model);
  return std::find(all.begin(), all.end(), content) != all.end();
}

bool hasArray(const Model& model, const std::string& name) {
  return std::any_of(model.arrays.begin(), model.arrays.end(),
                     [&](const ArrayDescription& array) { return array.name == name; });
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
      EXPECT_EQ(hasArray(model, "RGB"), hasColours);
      EXPECT_EQ(hasArray(model, "GpsTime"), format != 0 && format != 2);
      EXPECT_EQ(hasArray(model, "Infrared"), format == 8 || format == 10);
      EXPECT_EQ(hasArray(model, "WavePacketOffset"), format == 4 || format == 5 || format >= 9);
      EXPECT_EQ(hasArray(model, format < 6 ? "ScanAngleRank" : "ScanAngle"), true);
      EXPECT_EQ(valuesOf<std::uint16_t>(model, "Intensity"),
                (std::vector<std::uint16_t>{0x0707, 0x0707}));
      EXPECT_TRUE(model.otherContent.empty());
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

Bytes fieldBytes(const Model& model, const std::string& name) {
  for (const ArrayValues& array : model.metadata.fieldData) {
    if (array.name == name) return array.values;
  }
  return {};
}

std::string textOf(const Bytes& bytes) { return {bytes.begin(), bytes.end()}; }

TEST(Las, RecordsBetweenHeaderAndPointsAreMetadata) {
  LasFile file;
  file.records = variableLengthRecord("LASF_Projection", 34736, "keys") +
                 variableLengthRecord("LASF_Projection", 34737, "") +
                 variableLengthRecord("lib:las", 2112, "more") + "private";
  file.recordCount = 3;
  const Model model = read(file.text(), Format::Las);
  EXPECT_EQ(numbers<double>(model), kPositions);
  EXPECT_TRUE(model.otherContent.empty());
  EXPECT_EQ(metadataEntry(model.metadata, "las.vlr.1"), "LASF_Projection:34736:");
  EXPECT_EQ(textOf(fieldBytes(model, "las.vlr.1")), "keys");
  EXPECT_EQ(textOf(fieldBytes(model, "las.vlr.3")), "more");
  EXPECT_EQ(textOf(fieldBytes(model, "las.gap")), "private");
  const std::string back = test::writtenAgain(model, Format::Las);
  EXPECT_EQ(back.substr(227, file.records.size()), file.records);
  // Some writers count more records than there are.
  file.recordCount = 4000000000U;
  EXPECT_EQ(read(file.text(), Format::Las).metadata.entries, model.metadata.entries);
}

TEST(Las, WellKnownTextIsTheCoordinateSystem) {
  const std::string wkt = "PROJCS[\"somewhere\",UNIT[\"metre\",1]]";
  LasFile file;
  file.records = variableLengthRecord("LASF_Projection", 2112, wkt + '\0');
  file.recordCount = 1;
  const Model model = read(file.text(), Format::Las);
  EXPECT_EQ(model.metadata.crs, wkt);
  EXPECT_TRUE(model.metadata.fieldData.empty());
  EXPECT_EQ(test::writtenAgain(model, Format::Las).substr(227, file.records.size()), file.records);
}

TEST(Las, GeoTiffKeysTellTheCodeOfTheCoordinateSystemAndItsUnit) {
  const auto model = [](std::initializer_list<std::uint16_t> keys) {
    std::string payload;
    for (const std::uint16_t key : keys) put(payload, Order::Little, key);
    LasFile file;
    file.records = variableLengthRecord("LASF_Projection", 34735, payload);
    file.recordCount = 1;
    return read(file.text(), Format::Las);
  };
  const Model projected = model({1, 1, 0, 3, 1024, 0, 1, 1, 3072, 0, 1, 32610, 3076, 0, 1, 9001});
  EXPECT_EQ(projected.metadata.crs, "EPSG:32610");
  EXPECT_EQ(projected.metadata.lengthUnit, "m");
  EXPECT_EQ(model({1, 1, 0, 2, 1024, 0, 1, 2, 2048, 0, 1, 4326}).metadata.crs, "EPSG:4326");
  EXPECT_EQ(model({1, 1, 0, 1, 3072, 0, 1, 32767}).metadata.crs, "");
  EXPECT_EQ(model({1, 1, 0, 9, 3072}).metadata.crs, "");
}

TEST(Las, TheMarkInFrontOfThePointsOfVersion10IsNoContent) {
  LasFile file;
  file.minor = 0;
  file.records = "\xDD\xCC";
  const Model model = read(file.text(), Format::Las);
  EXPECT_EQ(numbers<double>(model), kPositions);
  EXPECT_TRUE(model.metadata.fieldData.empty());
}

TEST(Las, ExtraBytesOfAPointAreArrays) {
  LasFile file;
  file.recordBytes = 35;
  EXPECT_EQ(valuesOf<std::uint8_t>(read(file.text(), Format::Las), "ExtraBytes"),
            (std::vector<std::uint8_t>(30, 7)));
  // float32, three int16, two bytes of no known type, and a name that is one of the format's.
  file.records =
      variableLengthRecord("LASF_Spec", 4,
                           extraAttribute("height", 9) + extraAttribute("offset", 24) +
                               extraAttribute("raw", 0, 2) + extraAttribute("Intensity", 1));
  file.recordCount = 1;
  const Model model = read(file.text(), Format::Las);
  EXPECT_EQ(numbers<double>(model), kPositions);
  std::vector<std::string> arrays = test::arraysOf(model);
  arrays.erase(arrays.begin(), arrays.begin() + 12);
  EXPECT_EQ(arrays, (std::vector<std::string>{"height 1 x float32", "Intensity_2 1 x uint8",
                                              "offset 3 x int16", "raw 2 x uint8",
                                              "ExtraBytes 2 x uint8"}));
  EXPECT_EQ(valuesOf<std::int16_t>(model, "offset"), (std::vector<std::int16_t>(6, 0x0707)));
  const Model back = read(test::writtenAgain(model, Format::Las), Format::Las);
  std::vector<std::string> restored = test::arraysOf(back);
  std::vector<std::string> wanted = test::arraysOf(model);
  std::sort(restored.begin(), restored.end());
  std::sort(wanted.begin(), wanted.end());
  EXPECT_EQ(restored, wanted);
  for (const ArrayValues& array : model.values) {
    EXPECT_EQ(test::arrayOf(back, array.name).values, array.values) << array.name;
  }
}

/// A file with every bit of its points drawn at random.
std::string randomFile(unsigned minor, unsigned format) {
  LasFile file;
  file.minor = minor;
  file.format = format;
  file.recordBytes = kRecordBytes[format];
  file.points.assign(200, {});
  file.claimedPoints = file.points.size();
  std::string text = file.text();
  std::mt19937_64 random(format);
  for (std::size_t i = 0; i < file.points.size(); ++i) {
    const std::size_t start = text.size() - (i + 1) * file.recordBytes;
    for (std::size_t b = 0; b < file.recordBytes; ++b)
      text[start + b] = static_cast<char>(random());
  }
  return text;
}

TEST(Las, EveryBitOfEveryPointFormatComesBack) {
  for (unsigned format = 0; format <= 10; ++format) {
    const unsigned minor = format < 4 ? 2 : (format < 6 ? 3 : 4);
    const std::string text = randomFile(minor, format);
    const Model model = read(text, Format::Las);
    const std::string back = test::writtenAgain(model, Format::Las);
    ASSERT_EQ(back.size(), text.size());
    const std::size_t header = minor == 4 ? 375 : (minor == 3 ? 235 : 227);
    EXPECT_TRUE(back.substr(header) == text.substr(header)) << format;
    EXPECT_EQ(back.substr(94, 17), text.substr(94, 17)) << format;
    EXPECT_EQ(back.substr(131, 48), text.substr(131, 48)) << format;
  }
}

TEST(Las, BitsAreArraysOfTheirOwn) {
  LasFile file;
  file.points.resize(1);
  file.claimedPoints = 1;
  std::string text = file.text();
  text[227 + 14] = static_cast<char>(0b10101011);
  text[227 + 15] = static_cast<char>(0b10100110);
  const Model model = read(text, Format::Las);
  const auto value = [&](const char* name) { return +valuesOf<std::uint8_t>(model, name).at(0); };
  EXPECT_EQ(value("ReturnNumber"), 3);
  EXPECT_EQ(value("NumberOfReturns"), 5);
  EXPECT_EQ(value("ScanDirectionFlag"), 0);
  EXPECT_EQ(value("EdgeOfFlightLine"), 1);
  EXPECT_EQ(value("Classification"), 6);
  EXPECT_EQ(value("Synthetic"), 1);
  EXPECT_EQ(value("KeyPoint"), 0);
  EXPECT_EQ(value("Withheld"), 1);
}

TEST(Las, TheWrittenHeaderSumsUpThePoints) {
  LasFile file;
  file.points = {{100, 200, 300}, {-100, 500, 0}, {7, 7, 7}};
  file.claimedPoints = 3;
  std::string text = file.text();
  for (std::size_t i = 0; i < 3; ++i) text[227 + 20 * i + 14] = static_cast<char>(i < 2 ? 1 : 2);
  const std::string back = test::writtenAgain(read(text, Format::Las), Format::Las);
  const auto number = [&](std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t k = 4; k-- > 0;) value = value << 8 | static_cast<unsigned char>(back[at + k]);
    return value;
  };
  EXPECT_EQ(number(107), 3U);
  EXPECT_EQ(number(111), 2U);
  EXPECT_EQ(number(115), 1U);
  std::string range;
  put(range, Order::Little, 500000 + 100 * 0.01);
  put(range, Order::Little, 500000 + -100 * 0.01);
  EXPECT_EQ(back.substr(179, 16), range);
}

TEST(Las, ModelsOfOtherFormatsBecomeLas14) {
  const std::vector<double> xyz{0.25, -1.5, 1000, 7, 8.125, 9};
  const std::vector<std::uint8_t> rgb{1, 2, 255, 4, 5, 6};
  const std::vector<std::uint8_t> classes{200, 3};
  const std::vector<float> normals{0, 0, 1, 1, 0, 0};
  const std::vector<double> times{0.1, 0.2};
  PointSetView view(xyz.data(), 2);
  ArrayView colours = viewOf("Colours", ScalarType::UInt8, rgb, 3);
  colours.semantic = Semantic::Colours;
  view.addArray(colours);
  view.addArray(viewOf("Classification", ScalarType::UInt8, classes));
  ArrayView directions = viewOf("Normals", ScalarType::Float32, normals, 3);
  directions.semantic = Semantic::Normals;
  view.addArray(directions);
  view.addArray(viewOf("time", ScalarType::Float64, times));
  const std::string text = written(view, Format::Las);
  EXPECT_EQ(text[25], 4);
  EXPECT_EQ(text[104], 7);
  const Model back = read(text, Format::Las);
  for (std::size_t i = 0; i < xyz.size(); ++i) EXPECT_NEAR(numbers<double>(back)[i], xyz[i], 1e-6);
  EXPECT_EQ(valuesOf<std::uint16_t>(back, "RGB"),
            (std::vector<std::uint16_t>{256, 512, 65280, 1024, 1280, 1536}));
  EXPECT_EQ(valuesOf<std::uint8_t>(back, "Classification"), classes);
  EXPECT_EQ(valuesOf<float>(back, "Normals"), normals);
  EXPECT_EQ(test::arrayOf(back, "Normals").semantic, Semantic::Normals);
  EXPECT_EQ(valuesOf<double>(back, "time"), times);
}

TEST(Las, ValuesThatAFieldCannotHoldAreRefused) {
  const std::vector<double> xyz{0, 0, 0};
  const std::vector<std::uint8_t> returns{16};
  PointSetView view(xyz.data(), 1);
  view.addArray(viewOf("ReturnNumber", ScalarType::UInt8, returns));
  try {
    written(view, Format::Las);
    FAIL() << "not refused";
  } catch (const FormatError& error) {
    expectInMessage(error.what(), {"\"ReturnNumber\" of point 0 is 16", "at most 15"});
  }
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

TEST(Las, AnEmptyFileIsRead) {
  LasFile file;
  file.points.clear();
  file.claimedPoints = 0;
  const Model model = read(file.text(), Format::Las);
  EXPECT_EQ(model.size(), 0U);
  EXPECT_TRUE(model.otherContent.empty());
  EXPECT_EQ(read(test::writtenAgain(model, Format::Las), Format::Las).size(), 0U);
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
  test::expectNoMutationHarms(file.text(), Format::Las, 4000, 400);
  // Hits in the header, where everything is decided, are rare in a long file.
  test::expectNoMutationHarms(LasFile().text(), Format::Las, 4000, 400);
}

}  // namespace

}  // namespace bspc::formats
