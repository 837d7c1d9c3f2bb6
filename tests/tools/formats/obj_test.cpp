#include "tools/formats/format_test_support.h"

namespace bspc::formats {

namespace {

using test::contentOf;
using test::expectInMessage;
using test::failure;
using test::numbers;
using test::read;
using test::valuesOf;
using test::viewOf;
using test::written;

TEST(Obj, VerticesAreReadInAnySpelling) {
  const Model model = read(
      "# comment\n\n v  1 -2.5 +3e-2\r\nv\t0.1 .5 5. # here\no cloud\ng part\nv 1e-400 -0 7 1.0\n",
      Format::Obj);
  EXPECT_EQ(model.type, ScalarType::Float64);
  EXPECT_EQ(numbers<double>(model), (std::vector<double>{1, -2.5, 0.03, 0.1, 0.5, 5, 0, 0, 7}));
  EXPECT_TRUE(model.otherContent.empty());
}

TEST(Obj, EverythingElseIsNamed) {
  const Model model = read(
      "mtllib m\nv 0 1 0\nv 0 0 0 255 128 0\nv 1 0 0 0.5\nvn 0 0 1\nvt 0 0\nvt 1 0\nusemtl m\n"
      "f 1 2 \\\n3\nl 1 2\n",
      Format::Obj);
  EXPECT_EQ(model.size(), 3U);
  EXPECT_EQ(contentOf(model),
            (std::vector<std::string>{"1 vertex colour", "1 vertex weight", "1 face", "1 normal",
                                      "2 texture coordinates", "1 line"}));
}

TEST(Obj, ErrorsSayWhere) {
  expectInMessage(failure("v 1 2 3\nv 1 two 3\n", Format::Obj), {"line 2, column 5", "two", "y"});
  expectInMessage(failure("v 1 2\n", Format::Obj), {"line 1, column 6", "z"});
  expectInMessage(failure("v 1 2 1e999\n", Format::Obj), {"line 1, column 7", "out of range"});
  expectInMessage(failure("v 1 2 3x\n", Format::Obj), {"line 1, column 7"});
  expectInMessage(failure("\n\n\x7f"
                          "ELF\n",
                          Format::Obj),
                  {"line 3, column 1", "?ELF"});
  expectInMessage(failure("v 1 2 \\\n3\n", Format::Obj), {"line 1", "next line"});
}

TEST(Obj, WrittenFilesAreReadBack) {
  const std::vector<double> xyz{0.5, 1, 2, -0.0, 1e300, 0.1};
  PointSetView view = PointSetView(xyz.data(), 2);
  const std::string text = written(view, Format::Obj);
  EXPECT_EQ(text, "# written by bspc\nv 0.5 1 2\nv -0 1e+300 0.1\n");
  EXPECT_EQ(numbers<double>(read(text, Format::Obj)), xyz);
  EXPECT_EQ(read(written({}, Format::Obj), Format::Obj).size(), 0U);
}

TEST(Obj, ColoursOfTheVerticesAreAnArray) {
  const Model model = read("v 0 1 2 1 0.5 0\nf 1 2 2\nv 3 4 5 0 0.25 1\n", Format::Obj);
  EXPECT_EQ(numbers<double>(model), (std::vector<double>{0, 1, 2, 3, 4, 5}));
  EXPECT_EQ(valuesOf<double>(model, "RGB"), (std::vector<double>{1, 0.5, 0, 0, 0.25, 1}));
  EXPECT_EQ(test::arrayOf(model, "RGB").semantic, Semantic::Colours);
  test::expectSameArrays(model, read(test::writtenAgain(model, Format::Obj), Format::Obj));
  expectInMessage(failure("v 0 1 2 1 0.5 0\nv 3 4 5\n", Format::Obj), {"line 2", "first"});
  expectInMessage(failure("v 0 1 2 1 0 0\nv 3 4 5 1 1 1 1\n", Format::Obj), {"line 2", "first"});
}

TEST(Obj, OtherArraysAreRefused) {
  const std::vector<double> xyz{0, 0, 0};
  const std::vector<std::uint64_t> counts{1};
  PointSetView view = PointSetView(xyz.data(), 1);
  view.addArray(viewOf("PointCount", ScalarType::UInt64, counts));
  EXPECT_THROW(written(view, Format::Obj), FormatError);
}

TEST(Obj, NoMutationHarms) {
  test::expectNoMutationHarms("v 1 2 3\nv 4 5 6 1 0 0\nvn 0 0 1\nf 1 2 1\n# end\nv 7 8 9\n",
                              Format::Obj, 2000);
}

}  // namespace

}  // namespace bspc::formats
