#include "tools/formats/format_test_support.h"

namespace bspc::formats {

namespace {

using test::expectInMessage;
using test::failure;
using test::numbers;
using test::Order;
using test::put;
using test::read;
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
  EXPECT_EQ(floats.comments, (std::vector<std::string>{"a scan"}));
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

TEST(Ply, PropertiesAndElementsBesideThePositionsAreNamedAndPassedOver) {
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
  EXPECT_EQ(model.otherContent,
            (std::vector<std::string>{"1 \"camera\" element", "vertex property \"red\" (uint8)",
                                      "vertex property \"w\" (list of float32)", "1 face"}));
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

template <class T>
void expectWrittenIsRead(ScalarType type, const std::vector<T>& values) {
  ModelView view;
  view.points = PointSetView(values.data(), type, values.size() / 3, 0);
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
  ModelView view;
  view.points = PointSetView(values.data(), ScalarType::Int64, 1, 0);
  const Model back = read(written(view, Format::Ply), Format::Ply);
  EXPECT_EQ(numbers<double>(back), (std::vector<double>{1152921504606846976.0, -3, 0}));
  values[1] = (std::int64_t{1} << 53) + 1;
  EXPECT_THROW(written(view, Format::Ply), FormatError);
}

TEST(Ply, ColumnsBecomeProperties) {
  const std::vector<float> xyz{1, 2, 3, 4, 5, 6};
  const std::vector<std::uint64_t> counts{7, 8};
  ModelView view;
  view.points = PointSetView(xyz.data(), 2);
  view.columns.push_back({"PointCount", counts});
  const Model back = read(written(view, Format::Ply), Format::Ply);
  EXPECT_EQ(numbers<float>(back), xyz);
  EXPECT_EQ(back.otherContent,
            (std::vector<std::string>{"vertex property \"PointCount\" (uint32)"}));
}

TEST(Ply, ColumnsMustFitThePoints) {
  const std::vector<std::uint64_t> counts{7, 8};
  ModelView view;
  view.columns.push_back({"PointCount", counts});
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
