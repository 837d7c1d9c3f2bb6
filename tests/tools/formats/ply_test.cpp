#include <cmath>
#include <ctime>

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

std::string header(const std::string& format, const std::string& elements) {
  return "ply\nformat " + format + " 1.0\ncomment a scan\n" + elements + "end_header\n";
}

const std::string kXyz = "property float x\nproperty float y\nproperty float z\n";

TEST(Ply, AsciiKeepsTheTypeOfEachProperty) {
  const std::string body = "0.1 2 3\n-4 +5 6e-2\n";
  const Model floats = read(header("ascii", "element vertex 2\n" + kXyz) + body, Format::Ply);
  EXPECT_EQ(floats.type, ScalarType::Float32);
  EXPECT_EQ(numbers<float>(floats), (std::vector<float>{0.1F, 2, 3, -4, 5, 0.06F}));
  EXPECT_EQ(metadataEntry(floats.metadata, "ply.comment"), "a scan");
  const Model doubles = read(header("ascii",
                                    "element vertex 2\nproperty double x\nproperty float64 y\n"
                                    "property double z\n") +
                                 body,
                             Format::Ply);
  EXPECT_EQ(doubles.type, ScalarType::Float64);
  EXPECT_EQ(numbers<double>(doubles), (std::vector<double>{0.1, 2, 3, -4, 5, 0.06}));
}

TEST(Ply, BothByteOrdersAreRead) {
  for (const Order order : {Order::Little, Order::Big}) {
    std::string text = header(order == Order::Little ? "binary_little_endian" : "binary_big_endian",
                              "element vertex 2\n" + kXyz);
    const std::vector<float> values{0.1F, -2, 3, 4e30F, 5, 6};
    for (const float value : values) put(text, order, value);
    EXPECT_EQ(numbers<float>(read(text, Format::Ply)), values);
  }
}

TEST(Ply, PropertiesBecomeArraysAndTheRestIsNamed) {
  std::string text =
      header("binary_big_endian",
             "element camera 1\nproperty list uchar short view\n"
             "element vertex 2\nproperty uchar red\nproperty double z\nproperty list int float w\n"
             "property double x\nproperty double y\n"
             "element face 1\nproperty list uchar int vertex_indices\nelement edge 0\n");
  put(text, Order::Big, std::uint8_t{2});
  put(text, Order::Big, std::int16_t{7});
  put(text, Order::Big, std::int16_t{8});
  for (const double base : {1.0, 10.0}) {
    put(text, Order::Big, std::uint8_t{200});
    put(text, Order::Big, base + 2);
    put(text, Order::Big, std::int32_t{1});
    put(text, Order::Big, 0.5F);
    put(text, Order::Big, base);
    put(text, Order::Big, base + 1);
  }
  put(text, Order::Big, std::uint8_t{1});
  put(text, Order::Big, std::int32_t{0});
  const Model model = read(text, Format::Ply);
  EXPECT_EQ(numbers<double>(model), (std::vector<double>{1, 2, 3, 10, 11, 12}));
  EXPECT_EQ(contentOf(model),
            (std::vector<std::string>{"1 \"camera\" element",
                                      "vertex property \"w\" (list of float32)", "1 face"}));
  EXPECT_EQ(valuesOf<std::uint8_t>(model, "red"), (std::vector<std::uint8_t>{200, 200}));
}

TEST(Ply, IntegersOfDifferentTypesMeetInOneThatHoldsThemAll) {
  const std::string text =
      header("ascii", "element vertex 1\nproperty uchar x\nproperty short y\nproperty ushort z\n") +
      "255 -32768 65535\n";
  const Model model = read(text, Format::Ply);
  EXPECT_EQ(model.type, ScalarType::Int32);
  EXPECT_EQ(numbers<std::int32_t>(model), (std::vector<std::int32_t>{255, -32768, 65535}));
}

TEST(Ply, ErrorsOfTheHeaderSayWhere) {
  expectInMessage(failure("", Format::Ply), {"ply"});
  expectInMessage(failure("OFF\n", Format::Ply), {"line 1"});
  expectInMessage(failure("ply\nformat ascii 2.0\n", Format::Ply), {"line 2, column 14", "1.0"});
  expectInMessage(failure("ply\nformat pdf 1.0\n", Format::Ply), {"line 2, column 8", "pdf"});
  expectInMessage(failure(header("ascii", "element vertex many\n"), Format::Ply),
                  {"line 4, column 16", "many"});
  expectInMessage(failure(header("ascii", "element vertex 1\nproperty quad x\n"), Format::Ply),
                  {"line 5", "quad"});
  expectInMessage(failure(header("ascii", "element face 0\n"), Format::Ply), {"vertex"});
  expectInMessage(failure(header("ascii", "element vertex 1\nproperty float x\nproperty float y\n"),
                          Format::Ply),
                  {"\"z\""});
}

TEST(Ply, ErrorsOfTextSayLineAndColumn) {
  const std::string two = header("ascii", "element vertex 2\n" + kXyz);
  expectInMessage(failure(two + "1 2 3\n4 x 6\n", Format::Ply), {"line 10, column 3", "\"y\""});
  expectInMessage(failure(two + "1 2 3\n4 5\n", Format::Ply), {"ends", "vertex 2 of 2"});
  expectInMessage(failure(two + "1 2 3\n4 5 6\n7\n", Format::Ply), {"line 11", "trailing"});
}

TEST(Ply, ErrorsOfBinaryDataSayByteAndVertex) {
  std::string text = header("binary_little_endian", "element vertex 2\n" + kXyz);
  const std::size_t start = text.size();
  for (int i = 0; i < 5; ++i) put(text, Order::Little, 1.0F);
  expectInMessage(failure(text, Format::Ply),
                  {"vertex 2 of 2", "byte " + std::to_string(start + 20)});
  for (int i = 0; i < 2; ++i) put(text, Order::Little, 1.0F);
  expectInMessage(failure(text, Format::Ply), {"trailing", "byte " + std::to_string(start + 24)});
}

TEST(Ply, HugeCountsCostNothing) {
  for (const char* count : {"18446744073709551615", "1000000000000"}) {
    for (const char* format : {"ascii", "binary_little_endian"}) {
      const std::string text =
          header(format, std::string("element vertex ") + count + "\n" + kXyz) + "0 0 0 0 0 0 ";
      expectInMessage(failure(text, Format::Ply), {"ends"});
    }
  }
}

/// What looks at each property for each property needs minutes for this.
TEST(Ply, ManyPropertiesCostLittle) {
  std::string properties;
  for (int i = 0; i < 200000; ++i) properties += "property uchar p" + std::to_string(i) + "\n";
  const std::clock_t start = std::clock();
  const Model model = read(
      header("ascii", "element vertex 0\n" + kXyz + "element other 0\n" + properties), Format::Ply);
  EXPECT_EQ(model.size(), 0U);
  EXPECT_LT((std::clock() - start) / CLOCKS_PER_SEC, 20);
  expectInMessage(
      failure(header("ascii", "element other 0\n" + properties + "property int p7\n"), Format::Ply),
      {"second property", "p7"});
  expectInMessage(failure(header("ascii", "element a 0\nelement b 0\nelement a 0\n"), Format::Ply),
                  {"second element"});
}

template <class T>
void expectWrittenIsRead(ScalarType type, const std::vector<T>& values) {
  PointSetView view = PointSetView(values.data(), type, values.size() / 3, 0);
  const Model back = read(written(view, Format::Ply), Format::Ply);
  EXPECT_EQ(back.type, type);
  EXPECT_EQ(numbers<T>(back), values);
  EXPECT_TRUE(back.otherContent.empty());
}

TEST(Ply, WrittenFilesAreReadBackInTheirType) {
  expectWrittenIsRead<float>(ScalarType::Float32, {0.1F, 2, 3, 4, 5, 6e-40F});
  expectWrittenIsRead<double>(ScalarType::Float64, {0.1, 2, 3});
  expectWrittenIsRead<std::int8_t>(ScalarType::Int8, {-128, 0, 127});
  expectWrittenIsRead<std::uint8_t>(ScalarType::UInt8, {255, 0, 1});
  expectWrittenIsRead<std::int16_t>(ScalarType::Int16, {-32768, 0, 1});
  expectWrittenIsRead<std::uint16_t>(ScalarType::UInt16, {65535, 0, 1});
  expectWrittenIsRead<std::int32_t>(ScalarType::Int32, {INT32_MIN, 0, 1});
  expectWrittenIsRead<std::uint32_t>(ScalarType::UInt32, {UINT32_MAX, 0, 1});
  expectWrittenIsRead<float>(ScalarType::Float32, {});
}

TEST(Ply, SixtyFourBitIntegersBecomeDoublesWhereThatIsExact) {
  std::vector<std::int64_t> values{std::int64_t{1} << 60, -3, 0};
  PointSetView view = PointSetView(values.data(), ScalarType::Int64, 1, 0);
  const Model back = read(written(view, Format::Ply), Format::Ply);
  EXPECT_EQ(numbers<double>(back), (std::vector<double>{1152921504606846976.0, -3, 0}));
  values[1] = (std::int64_t{1} << 53) + 1;
  EXPECT_THROW(written(view, Format::Ply), FormatError);
}

TEST(Ply, ArraysBecomeProperties) {
  const std::vector<float> xyz{1, 2, 3, 4, 5, 6};
  const std::vector<std::uint64_t> counts{7, 8};
  PointSetView view = PointSetView(xyz.data(), 2);
  view.addArray(viewOf("PointCount", ScalarType::UInt64, counts));
  const Model back = read(written(view, Format::Ply), Format::Ply);
  EXPECT_EQ(numbers<float>(back), xyz);
  EXPECT_EQ(valuesOf<double>(back, "PointCount"), (std::vector<double>{7, 8}));
}

TEST(Ply, ArraysMustFitThePoints) {
  const std::vector<std::uint64_t> counts{7, 8};
  PointSetView view;
  view.addArray(viewOf("PointCount", ScalarType::UInt64, counts));
  EXPECT_THROW(written(view, Format::Ply), FormatError);
}

std::string everyType(const std::string& encoding) {
  return header(encoding,
                "element vertex 2\nproperty uchar a\n" + kXyz +
                    "property char b\nproperty short c\nproperty ushort d\nproperty int e\n"
                    "property uint f\nproperty float g\nproperty double h\n");
}

TEST(Ply, ArraysKeepTheirTypesInEveryEncoding) {
  std::vector<Model> models;
  models.push_back(read(everyType("ascii") +
                            "255 1 2 3 -128 -32768 65535 -2147483648 4294967295 0.1 0.1\n"
                            "0 4 5 6 127 32767 0 2147483647 0 -0 1e300\n",
                        Format::Ply));
  for (const Order order : {Order::Little, Order::Big}) {
    std::string text =
        everyType(order == Order::Little ? "binary_little_endian" : "binary_big_endian");
    for (const bool first : {true, false}) {
      put(text, order, static_cast<std::uint8_t>(first ? 255 : 0));
      for (int k = 0; k < 3; ++k) put(text, order, static_cast<float>(k + (first ? 1 : 4)));
      put(text, order, static_cast<std::int8_t>(first ? -128 : 127));
      put(text, order, static_cast<std::int16_t>(first ? -32768 : 32767));
      put(text, order, static_cast<std::uint16_t>(first ? 65535 : 0));
      put(text, order, first ? INT32_MIN : INT32_MAX);
      put(text, order, first ? UINT32_MAX : 0U);
      put(text, order, first ? 0.1F : -0.0F);
      put(text, order, first ? 0.1 : 1e300);
    }
    models.push_back(read(text, Format::Ply));
  }
  for (const Model& model : models) test::expectSameArrays(models.front(), model);
  EXPECT_EQ(
      test::arraysOf(models.front()),
      (std::vector<std::string>{"a 1 x uint8", "b 1 x int8", "c 1 x int16", "d 1 x uint16",
                                "e 1 x int32", "f 1 x uint32", "g 1 x float32", "h 1 x float64"}));
  EXPECT_EQ(valuesOf<std::uint32_t>(models.front(), "f"),
            (std::vector<std::uint32_t>{UINT32_MAX, 0}));
  EXPECT_TRUE(std::signbit(valuesOf<float>(models.front(), "g")[1]));
  test::expectSameArrays(models.front(),
                         read(test::writtenAgain(models.front(), Format::Ply), Format::Ply));
}

TEST(Ply, NormalsColoursAndTextureCoordinatesAreArraysAndComeBackAsProperties) {
  const std::string properties =
      "property uchar blue\nproperty float nx\nproperty float ny\nproperty float nz\n"
      "property uchar red\nproperty uchar green\nproperty double u\nproperty double v\n"
      "property float alpha\nproperty int v:0\nproperty int v:1\n";
  const Model model = read(header("ascii", "element vertex 1\n" + kXyz + properties) +
                               "1 2 3 30 0 0.5 1 10 20 0.25 0.75 0.1 7 8\n",
                           Format::Ply);
  EXPECT_EQ(test::arraysOf(model),
            (std::vector<std::string>{"RGB 3 x uint8", "Normals 3 x float32",
                                      "TextureCoordinates 2 x float64", "alpha 1 x float32",
                                      "v:0 1 x int32", "v:1 1 x int32"}));
  EXPECT_EQ(valuesOf<std::uint8_t>(model, "RGB"), (std::vector<std::uint8_t>{10, 20, 30}));
  EXPECT_EQ(test::arrayOf(model, "RGB").semantic, Semantic::Colours);
  EXPECT_EQ(test::arrayOf(model, "Normals").semantic, Semantic::Normals);
  EXPECT_EQ(test::arrayOf(model, "Normals").componentNames,
            (std::vector<std::string>{"nx", "ny", "nz"}));
  const std::string back = test::writtenAgain(model, Format::Ply);
  for (const char* line :
       {"property uchar red\nproperty uchar green\nproperty uchar blue\n", "property float nx\n",
        "property double u\n", "property int v:1\n", "comment a scan\n"}) {
    EXPECT_NE(back.find(line), std::string::npos) << back;
  }
  test::expectSameArrays(model, read(back, Format::Ply));
}

TEST(Ply, NumberedPropertiesAreOneArray) {
  const Model model =
      read(header("ascii", "element vertex 1\n" + kXyz + "property int id:0\nproperty int id:1\n") +
               "1 2 3 7 8\n",
           Format::Ply);
  EXPECT_EQ(test::arraysOf(model), (std::vector<std::string>{"id 2 x int32"}));
  test::expectSameArrays(model, read(test::writtenAgain(model, Format::Ply), Format::Ply));
}

TEST(Ply, ArraysOfOtherMakersGetNamesThatPlyCanHold) {
  const std::vector<float> xyz{1, 2, 3};
  const std::vector<float> three{4, 5, 6};
  PointSetView view(xyz.data(), 1);
  view.addArray(viewOf("Point Normals", ScalarType::Float32, three, 3));
  view.addArray(viewOf("velocity", ScalarType::Float32, three, 3));
  const std::string text = written(view, Format::Ply);
  EXPECT_NE(text.find("property float Point_Normals:2\n"), std::string::npos);
  ArrayView normals = viewOf("N", ScalarType::Float32, three, 3);
  normals.semantic = Semantic::Normals;
  view.addArray(normals);
  EXPECT_NE(written(view, Format::Ply).find("property float nx\n"), std::string::npos);
  EXPECT_EQ(test::arraysOf(read(text, Format::Ply)),
            (std::vector<std::string>{"Point_Normals 3 x float32", "velocity 3 x float32"}));
}

TEST(Ply, NamesThatWouldClashAreRefused) {
  const std::vector<float> xyz{1, 2, 3};
  PointSetView view(xyz.data(), 1);
  view.addArray(viewOf("x", ScalarType::Float32, std::vector<float>{1}));
  try {
    written(view, Format::Ply);
    FAIL() << "not refused";
  } catch (const FormatError& error) {
    expectInMessage(error.what(), {"\"x\""});
  }
}

TEST(Ply, TextsAreRefused) {
  const std::vector<float> xyz{1, 2, 3};
  const std::vector<std::string> texts{"tree"};
  PointSetView view(xyz.data(), 1);
  view.addArray(viewOf("label", ScalarType::String, texts));
  EXPECT_THROW(written(view, Format::Ply), FormatError);
}

TEST(Ply, NoMutationHarms) {
  const std::string mesh = "element vertex 3\n" + kXyz +
                           "property uchar red\nelement face 1\n"
                           "property list uchar int vertex_indices\n";
  test::expectNoMutationHarms(header("ascii", mesh) + "1 2 3 4\n5 6 7 8\n9 10 11 12\n3 0 1 2\n",
                              Format::Ply, 2000);
  std::string binary = header("binary_little_endian", mesh);
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) put(binary, Order::Little, 1.5F);
    put(binary, Order::Little, std::uint8_t{9});
  }
  put(binary, Order::Little, std::uint8_t{3});
  for (std::int32_t i = 0; i < 3; ++i) put(binary, Order::Little, i);
  test::expectNoMutationHarms(binary, Format::Ply, 2000);
}

}  // namespace

}  // namespace bspc::formats
