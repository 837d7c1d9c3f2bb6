#include <lzf.h>

#include <cmath>

#include "formats/las_records.h"
#include "tools/formats/format_test_support.h"

namespace bspc::formats {

namespace {

using test::expectInMessage;
using test::failure;
using test::numbers;
using test::Order;
using test::put;
using test::read;
using test::valuesOf;
using test::viewOf;
using test::written;

std::string header(const std::string& fields, const std::string& size, const std::string& data,
                   const std::string& extent = "WIDTH 2\nHEIGHT 1\n") {
  return "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS " + fields +
         "\nTYPE F F F\nSIZE " + size + "\n" + extent + "VIEWPOINT 0 0 0 1 0 0 0\nDATA " + data +
         "\n";
}

const std::string kXyz = "x y z";
const std::string kFloats = "4 4 4";
const std::vector<float> kTwo{0.1F, 2, -3, 4, 5e-7F, 6};

std::string bytesOf(const std::vector<float>& values) {
  std::string bytes;
  for (const float value : values) put(bytes, Order::Little, value);
  return bytes;
}

/// The sizes and the LZF data of a compressed file.
std::string compressed(const std::string& plain) {
  // Room for data that LZF makes longer.
  std::string packed(2 * plain.size() + 64, '\0');
  const unsigned size = lzf_compress(plain.data(), static_cast<unsigned>(plain.size()),
                                     packed.data(), static_cast<unsigned>(packed.size()));
  EXPECT_NE(size, 0U);
  packed.resize(size);
  std::string sizes;
  put(sizes, Order::Little, size);
  put(sizes, Order::Little, static_cast<std::uint32_t>(plain.size()));
  return sizes + packed;
}

/// Field after field, as compressed files have them.
std::string byField(const std::vector<float>& values) {
  std::vector<float> turned;
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t i = k; i < values.size(); i += 3) turned.push_back(values[i]);
  }
  return bytesOf(turned);
}

TEST(Pcd, EveryEncodingIsRead) {
  const std::string ascii = header(kXyz, kFloats, "ascii") + "0.1 2 -3\n\n4 5e-7 6\n";
  const std::string binary = header(kXyz, kFloats, "binary") + bytesOf(kTwo);
  const std::string packed = header(kXyz, kFloats, "binary_compressed") + compressed(byField(kTwo));
  for (const std::string& text : {ascii, binary, packed}) {
    const Model model = read(text, Format::Pcd);
    EXPECT_EQ(model.type, ScalarType::Float32);
    EXPECT_EQ(numbers<float>(model), kTwo);
    EXPECT_TRUE(model.otherContent.empty());
  }
}

/// One point with y as `type`, x and z as int8 in front and behind, and fields that do not count.
template <class T>
void expectTypeIsRead(const std::string& letter, ScalarType expected, T y, double shown) {
  const std::string head = "VERSION .7\nFIELDS n x _ y z\nSIZE 2 1 1 " + std::to_string(sizeof(T)) +
                           " 1\nTYPE U I U " + letter +
                           " I\nCOUNT 3 1 5 1 1\nWIDTH 1\nHEIGHT 1\nPOINTS 1\nDATA ";
  std::string body(6, '\7');
  put(body, Order::Little, std::int8_t{-2});
  body += std::string(5, '\7');
  put(body, Order::Little, y);
  put(body, Order::Little, std::int8_t{3});
  std::ostringstream ascii;
  ascii.precision(20);
  ascii << "7 7 7 -2 0 0 0 0 0 " << +y << " 3\n";
  // A single point is stored field after field in any case.
  const std::vector<std::pair<std::string, std::string>> bodies{
      {"binary", body}, {"binary_compressed", compressed(body)}, {"ascii", ascii.str()}};
  for (const auto& [data, content] : bodies) {
    std::string text = head;
    text += data + "\n";
    text += content;
    const Model model = read(text, Format::Pcd);
    EXPECT_EQ(model.type, expected);
    const std::array<double, 3> position = model.view().position(0);
    EXPECT_EQ(position, (std::array<double, 3>{-2, shown, 3}));
    EXPECT_TRUE(model.otherContent.empty());
    EXPECT_EQ(test::arraysOf(model), (std::vector<std::string>{"n 3 x uint16"}));
    const std::uint16_t seven = data == "ascii" ? 7 : 0x0707;
    EXPECT_EQ(valuesOf<std::uint16_t>(model, "n"), (std::vector<std::uint16_t>(3, seven)));
  }
}

TEST(Pcd, FieldsOfEveryTypeAreRead) {
  expectTypeIsRead("F", ScalarType::Float32, 0.5F, 0.5);
  expectTypeIsRead("F", ScalarType::Float64, 0.1, 0.1);
  expectTypeIsRead("I", ScalarType::Int8, std::int8_t{-128}, -128);
  expectTypeIsRead("U", ScalarType::Int16, std::uint8_t{200}, 200);
  expectTypeIsRead("I", ScalarType::Int16, std::int16_t{-300}, -300);
  expectTypeIsRead("U", ScalarType::Int32, std::uint16_t{65535}, 65535);
  expectTypeIsRead("I", ScalarType::Int32, std::int32_t{-70000}, -70000);
  expectTypeIsRead("U", ScalarType::Int64, std::uint32_t{4000000000U}, 4e9);
  expectTypeIsRead("I", ScalarType::Int64, std::int64_t{-5000000000}, -5e9);
}

TEST(Pcd, IntegersThatNoDoubleHoldsAreRefusedByPoint) {
  const std::string head =
      "FIELDS x y z\nSIZE 8 4 4\nTYPE U F F\nWIDTH 2\nHEIGHT 1\nPOINTS 2\nDATA ";
  std::string body;
  std::string fields;
  for (const std::uint64_t x : {std::uint64_t{1}, (std::uint64_t{1} << 53) + 1}) {
    put(body, Order::Little, x);
    put(fields, Order::Little, x);
    body += std::string(8, '\0');
  }
  fields += std::string(16, '\0');
  const std::string byte = std::to_string(head.size() + 7 + 16);
  expectInMessage(failure(head + "binary\n" + body, Format::Pcd), {"point 2 of 2", "byte " + byte});
  expectInMessage(failure(head + "binary_compressed\n" + compressed(fields), Format::Pcd),
                  {"\"x\" of point 2 of 2"});
  expectInMessage(failure(head + "ascii\n1 0 0\n9007199254740993 0 0\n", Format::Pcd),
                  {"line 9, column 1", "point 2 of 2"});
}

TEST(Pcd, OrganisedCloudsKeepTheirEmptyPlaces) {
  const std::string head = "FIELDS x y z rgb\nSIZE 4 4 4 4\nTYPE F F F U\nWIDTH 2\nHEIGHT 2\n";
  const Model model = read(head + "VIEWPOINT 0 0 1 1 0 0 0\nPOINTS 4\nDATA ascii\n1 2 3 4\n" +
                               "nan nan nan 0\n-nan NaN nan 0\n5 6 7 8\n",
                           Format::Pcd);
  const std::vector<float> values = numbers<float>(model);
  ASSERT_EQ(values.size(), 12U);
  EXPECT_TRUE(std::isnan(values[3]) && std::isnan(values[7]));
  EXPECT_EQ(values[11], 7);
  EXPECT_TRUE(model.otherContent.empty());
  EXPECT_TRUE(model.isOrganised);
  EXPECT_EQ(metadataEntry(model.metadata, "pcd.width"), "2");
  EXPECT_EQ(metadataEntry(model.metadata, "pcd.height"), "2");
  EXPECT_EQ(metadataEntry(model.metadata, "pcd.viewpoint"), "0 0 1 1 0 0 0");
}

std::string scanHeader(const std::string& data) {
  return "FIELDS x y z normal_x rgb normal_y label normal_z rgba\nSIZE 4 4 4 4 4 4 1 4 4\n"
         "TYPE F F F F F F I F U\nCOUNT 1 1 1 1 1 1 1 1 1\nWIDTH 1\nHEIGHT 2\n"
         "VIEWPOINT 0 0 1 1 0 0 0\nPOINTS 2\nDATA " +
         data + "\n";
}

float floatOf(std::uint32_t bits) {
  float value = 0;
  std::memcpy(&value, &bits, sizeof(value));
  return value;
}

TEST(Pcd, PackedColoursAndNormalsAreArraysInEveryEncoding) {
  std::string binary;
  std::string fields;
  const std::array<float, 6> positions{1, 2, 3, 4, 5, 6};
  const std::uint32_t colour = 0x00102030;
  for (std::size_t i = 0; i < 2; ++i) {
    for (std::size_t k = 0; k < 3; ++k) put(binary, Order::Little, positions[3 * i + k]);
    put(binary, Order::Little, 0.5F);
    put(binary, Order::Little, colour);
    put(binary, Order::Little, -0.0F);
    put(binary, Order::Little, std::int8_t{-3});
    put(binary, Order::Little, 1.0F);
    put(binary, Order::Little, std::uint32_t{0xFF405060});
  }
  std::size_t at = 0;
  for (const std::size_t bytes : {4U, 4U, 4U, 4U, 4U, 4U, 1U, 4U, 4U}) {
    for (std::size_t i = 0; i < 2; ++i) fields += binary.substr(at + 33 * i, bytes);
    at += bytes;
  }
  std::ostringstream ascii;
  ascii.precision(9);
  for (std::size_t i = 0; i < 2; ++i) {
    for (std::size_t k = 0; k < 3; ++k) ascii << positions[3 * i + k] << ' ';
    ascii << "0.5 " << floatOf(colour) << " -0 -3 1 " << 0xFF405060U << '\n';
  }
  std::vector<Model> models;
  models.push_back(read(scanHeader("binary") + binary, Format::Pcd));
  models.push_back(read(scanHeader("binary_compressed") + compressed(fields), Format::Pcd));
  models.push_back(read(scanHeader("ascii") + ascii.str(), Format::Pcd));
  for (const Model& model : models) {
    test::expectSameArrays(models.front(), model);
    EXPECT_EQ(numbers<float>(model), (std::vector<float>{1, 2, 3, 4, 5, 6}));
  }
  const Model& model = models.front();
  EXPECT_EQ(test::arraysOf(model), (std::vector<std::string>{"Normals 3 x float32", "RGB 3 x uint8",
                                                             "rgb_padding 1 x uint8",
                                                             "label 1 x int8", "RGBA 4 x uint8"}));
  EXPECT_EQ(valuesOf<std::uint8_t>(model, "RGB"),
            (std::vector<std::uint8_t>{0x10, 0x20, 0x30, 0x10, 0x20, 0x30}));
  EXPECT_EQ(valuesOf<std::uint8_t>(model, "RGBA")[3], 0xFF);
  EXPECT_EQ(test::arrayOf(model, "Normals").componentNames,
            (std::vector<std::string>{"nx", "ny", "nz"}));
  const std::string back = test::writtenAgain(model, Format::Pcd);
  expectInMessage(
      back, {"FIELDS x y z normal_x normal_y normal_z rgb label rgba\n", "TYPE F F F F F F F I U\n",
             "WIDTH 1\nHEIGHT 2\n", "VIEWPOINT 0 0 1 1 0 0 0\n"});
  test::expectSameArrays(model, read(back, Format::Pcd));
}

TEST(Pcd, FieldsOfSeveralNumbersAndOfEveryTypeComeBack) {
  const std::vector<double> xyz{0.1, 2, 3};
  const std::vector<std::int64_t> large{INT64_MIN};
  const std::vector<std::uint16_t> histogram{1, 2, 3, 4, 65535};
  PointSetView view(xyz.data(), 1);
  view.addArray(viewOf("large", ScalarType::Int64, large));
  view.addArray(viewOf("a histogram", ScalarType::UInt16, histogram, 5));
  const Model back = read(written(view, Format::Pcd), Format::Pcd);
  EXPECT_EQ(numbers<double>(back), xyz);
  EXPECT_EQ(test::arraysOf(back),
            (std::vector<std::string>{"large 1 x int64", "a_histogram 5 x uint16"}));
  EXPECT_EQ(valuesOf<std::int64_t>(back, "large"), large);
  EXPECT_EQ(valuesOf<std::uint16_t>(back, "a_histogram"), histogram);
}

TEST(Pcd, ColoursOfOtherFormatsArePacked) {
  const std::vector<float> xyz{1, 2, 3};
  const std::vector<std::uint8_t> rgb{10, 20, 30};
  PointSetView view(xyz.data(), 1);
  ArrayView colours = viewOf("RGB", ScalarType::UInt8, rgb, 3);
  colours.semantic = Semantic::Colours;
  view.addArray(colours);
  const std::string text = written(view, Format::Pcd);
  expectInMessage(text, {"FIELDS x y z rgb\n", "TYPE F F F F\n"});
  EXPECT_EQ(text.substr(text.size() - 4), std::string("\x1E\x14\x0A\0", 4));
}

TEST(Pcd, ALineTooShortForItsNumbersSetsNothingAside) {
  const std::string head =
      "FIELDS x y z n\nSIZE 4 4 4 8\nTYPE F F F F\nCOUNT 1 1 1 100000\nWIDTH 1\nDATA ascii\n";
  expectInMessage(failure(head + "1 2 3 4\n", Format::Pcd), {"100,003 numbers", "found 4"});
}

TEST(Pcd, TheLinesOfTheHeaderMayStandInAnyOrder) {
  const Model model = read(
      "TYPE F F F\r\nCOUNT 1 1 1\r\nPOINTS 1\r\nSIZE 8 8 8\r\n\r\nCOLUMNS z y x # turned\r\n"
      "DATA ascii\r\n3 2 1\r\n",
      Format::Pcd);
  EXPECT_EQ(numbers<double>(model), (std::vector<double>{1, 2, 3}));
}

TEST(Pcd, AnEmptyCloudIsRead) {
  for (const char* data : {"ascii", "binary", "binary_compressed"}) {
    const std::string text = header(kXyz, kFloats, data, "WIDTH 0\nHEIGHT 1\n");
    EXPECT_EQ(read(text, Format::Pcd).size(), 0U);
  }
}

TEST(Pcd, ZerosUpToTheEndOfAPageAreNoData) {
  for (const char* data : {"binary", "binary_compressed"}) {
    const bool isPacked = std::string(data) != "binary";
    const std::string text =
        header(kXyz, kFloats, data) + (isPacked ? compressed(byField(kTwo)) : bytesOf(kTwo));
    EXPECT_EQ(numbers<float>(read(text + std::string(5000, '\0'), Format::Pcd)), kTwo);
    expectInMessage(failure(text + std::string(2, '\0') + "x", Format::Pcd),
                    {"trailing", "byte " + std::to_string(text.size() + 2)});
  }
  expectInMessage(failure(header(kXyz, kFloats, "ascii") + "1 2 3\n4 5 6\n7 8 9\n", Format::Pcd),
                  {"trailing", "line 12"});
}

TEST(Pcd, ErrorsOfTheHeaderSayWhere) {
  const std::string three = "FIELDS x y z\nTYPE F F F\n";
  expectInMessage(failure("", Format::Pcd), {"ends", "DATA"});
  expectInMessage(failure("ply\n", Format::Pcd), {"line 1, column 1", "ply"});
  expectInMessage(failure(three + "SIZE 4 4\nWIDTH 1\nDATA ascii\n", Format::Pcd),
                  {"3 fields", "2", "SIZE"});
  expectInMessage(failure(three + "SIZE 4 four 4\n", Format::Pcd), {"line 3, column 8", "four"});
  expectInMessage(failure(three + "SIZE 4 4 3\nWIDTH 1\nDATA ascii\n", Format::Pcd),
                  {"\"z\"", "SIZE 3"});
  expectInMessage(failure(three + "SIZE 4 4 4\nDATA ascii\n", Format::Pcd), {"POINTS", "WIDTH"});
  expectInMessage(failure(three + "SIZE 4 4 4\nWIDTH 2\nPOINTS 3\nDATA ascii\n", Format::Pcd),
                  {"POINTS 3", "WIDTH 2"});
  expectInMessage(failure(three + "SIZE 4 4 4\nWIDTH 2\nDATA zip\n", Format::Pcd),
                  {"line 5, column 6", "zip"});
  expectInMessage(failure(three + "SIZE 4 4 4\nCOUNT 1 2 1\nWIDTH 1\nDATA ascii\n", Format::Pcd),
                  {"\"y\" has 2 numbers"});
  expectInMessage(
      failure("FIELDS x y w\nTYPE F F F\nSIZE 4 4 4\nWIDTH 1\nDATA ascii\n", Format::Pcd),
      {"\"z\""});
  expectInMessage(
      failure("FIELDS x y z x\nTYPE F F F F\nSIZE 4 4 4 4\nWIDTH 1\nDATA ascii\n", Format::Pcd),
      {"second field \"x\""});
  expectInMessage(failure(three + "FIELDS x y z\n", Format::Pcd), {"line 3", "second"});
}

TEST(Pcd, ErrorsOfTextSayLineAndPoint) {
  const std::string head = header(kXyz, kFloats, "ascii");
  expectInMessage(failure(head + "1 2 3\n4 x 6\n", Format::Pcd),
                  {"line 11, column 3", "\"y\" (float32) of point 2 of 2"});
  expectInMessage(failure(head + "1 2 3\n4 5\n", Format::Pcd),
                  {"line 11", "3 numbers of point 2 of 2", "found 2"});
  expectInMessage(failure(head + "1 2 3 4\n5 6 7\n", Format::Pcd),
                  {"line 10, column 7", "found more"});
  expectInMessage(failure(head + "1 2 3\n", Format::Pcd), {"ends before point 2 of 2"});
}

TEST(Pcd, ErrorsOfBinaryDataSayByteAndPoint) {
  const std::string head = header(kXyz, kFloats, "binary");
  expectInMessage(failure(head + std::string(20, '\1'), Format::Pcd),
                  {"point 2 of 2", "byte " + std::to_string(head.size() + 20)});
}

TEST(Pcd, ErrorsOfCompressedDataSayWhatIsWrong) {
  const std::string head = header(kXyz, kFloats, "binary_compressed");
  const std::string start = "byte " + std::to_string(head.size());
  const std::string good = head + compressed(byField(kTwo));
  expectInMessage(failure(head + "abc", Format::Pcd), {"ends before the sizes", start});
  expectInMessage(failure(good.substr(0, good.size() - 3), Format::Pcd),
                  {"ends inside the compressed points"});
  expectInMessage(failure(head + compressed(byField({1, 2, 3})), Format::Pcd),
                  {"12 bytes", "2 points of 12 bytes", start});
  std::string damaged = good;
  damaged[head.size() + 8] = '\xFF';  // a reference to in front of the data
  expectInMessage(failure(damaged, Format::Pcd), {"damaged", start});
  // Zeros that no LZF data of this size can make.
  std::string claim = header(kXyz, kFloats, "binary_compressed", "WIDTH 100000000\n");
  put(claim, Order::Little, std::uint32_t{5});
  put(claim, Order::Little, std::uint32_t{1200000000});
  expectInMessage(failure(claim + "12345", Format::Pcd), {"damaged"});
}

TEST(Pcd, HugeCountsCostNothing) {
  for (const char* data : {"ascii", "binary", "binary_compressed"}) {
    for (const char* points : {"18446744073709551615", "300000000"}) {
      const std::string extent = std::string("WIDTH ") + points + "\n";
      const std::string text = header(kXyz, kFloats, data, extent) + "1 2 3\n4 5 ";
      EXPECT_NE(failure(text, Format::Pcd), "");
    }
  }
  expectInMessage(
      failure(header(kXyz, kFloats, "ascii", "COUNT 1 1 1\nWIDTH 4294967296\nHEIGHT 4294967296\n"),
              Format::Pcd),
      {"too large"});
  expectInMessage(failure("FIELDS x y z n\nSIZE 4 4 4 8\nTYPE F F F F\n"
                          "COUNT 1 1 1 2305843009213693952\nWIDTH 1\nDATA binary\n",
                          Format::Pcd),
                  {"\"n\"", "1 MiB"});
}

/// Numbers of which many are the same, for LZF to find.
std::vector<float> stairs(std::size_t count) {
  std::vector<float> values(count);
  for (std::size_t i = 0; i < count; ++i) values[i] = std::floor(static_cast<float>(i) / 9);
  return values;
}

TEST(Pcd, NoMutationHarms) {
  test::expectNoMutationHarms(header(kXyz, kFloats, "ascii") + "0.1 2 -3\n4 5e-7 6\n", Format::Pcd,
                              3000);
  test::expectNoMutationHarms(header(kXyz, kFloats, "binary") + bytesOf(kTwo), Format::Pcd, 3000);
  test::expectNoMutationHarms(
      scanHeader("ascii") + "1 2 3 0.5 1e-40 0 -3 1 7\n4 5 6 0.5 1e-40 0 -3 1 4278190080\n",
      Format::Pcd, 3000, 200);
  test::expectNoMutationHarms(scanHeader("binary") + std::string(66, '\5'), Format::Pcd, 3000, 200);
  const std::vector<float> many = stairs(300);
  // LZF data may grow 88-fold, and 3 bytes become 24 where types meet in float64.
  constexpr std::size_t kGrowth = std::size_t{88} * 8;
  test::expectNoMutationHarms(
      header(kXyz, kFloats, "binary_compressed", "WIDTH 100\n") + compressed(byField(many)),
      Format::Pcd, 4000, kGrowth);
}

TEST(Pcd, NoDamageToCompressedDataHarms) {
  const std::vector<float> many = stairs(3000);
  const std::string head = header(kXyz, kFloats, "binary_compressed", "WIDTH 1000\n");
  const std::string body = compressed(byField(many));
  std::mt19937_64 random(1);
  for (int i = 0; i < 4000; ++i) {
    std::string damaged = body;
    for (int hits = 0; hits < 3; ++hits) {
      damaged[8 + random() % (body.size() - 8)] = static_cast<char>(random());
    }
    std::istringstream in(head + damaged);
    try {
      EXPECT_EQ(readModel(in, Format::Pcd).size(), 1000U);
    } catch (const FormatError& error) {
      expectInMessage(error.what(), {"damaged"});
    }
  }
}

}  // namespace

}  // namespace bspc::formats
