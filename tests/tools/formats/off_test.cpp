#include "tools/formats/format_test_support.h"

namespace bspc::formats {

namespace {

using test::contentOf;
using test::expectInMessage;
using test::failure;
using test::numbers;
using test::read;
using test::viewOf;
using test::written;

const std::vector<double> kTwo{1, 2, 3, 4, 5, 6.5};

TEST(Off, CountsMayStandAnywhere) {
  for (const char* text : {
           "OFF\n2 0 0\n1 2 3\n4 5 6.5\n",
           "OFF 2 0 0\n1 2 3\n4 5 6.5",
           "# first\nOFF # keyword\n# counts\n2 0\n\n1 2 3 # a\n4 5\n6.5\n# end\n",
           "OFF\r\n2 0 0\r\n1 2 3\r\n4 5 6.5\r\n",
       }) {
    const Model model = read(text, Format::Off);
    EXPECT_EQ(numbers<double>(model), kTwo) << text;
    EXPECT_TRUE(model.otherContent.empty()) << text;
  }
}

TEST(Off, EverythingElseIsNamed) {
  const Model mesh = read("OFF\n3 1 3\n0 0 0\n0 1 0\n1 0 0\n3 0 1 2 255 0 0\n", Format::Off);
  EXPECT_EQ(mesh.size(), 3U);
  EXPECT_EQ(contentOf(mesh), (std::vector<std::string>{"1 face"}));
  const Model further = read("OFF\n1 0 0\n1 2 3 0 0 1\n", Format::Off);
  EXPECT_EQ(contentOf(further), (std::vector<std::string>{"further numbers of 1 vertex"}));
}

TEST(Off, WhatTheKeywordPromisesAreArrays) {
  const Model all = read("STCNOFF\n1 0 0\n1 2 3 0 0 1 255 0 0 255 0.5 0.25\n", Format::Off);
  EXPECT_TRUE(all.otherContent.empty());
  EXPECT_EQ(test::arraysOf(all),
            (std::vector<std::string>{"Normals 3 x float64", "RGBA 4 x float64",
                                      "TextureCoordinates 2 x float64"}));
  EXPECT_EQ(test::valuesOf<double>(all, "Normals"), (std::vector<double>{0, 0, 1}));
  EXPECT_EQ(test::valuesOf<double>(all, "RGBA"), (std::vector<double>{255, 0, 0, 255}));
  EXPECT_EQ(test::valuesOf<double>(all, "TextureCoordinates"), (std::vector<double>{0.5, 0.25}));
  expectInMessage(failure("COFF\n2 0 0\n1 2 3 4 5 6\n1 2 3\n", Format::Off), {"line 4", "first"});
  // Numbers that the keyword does not promise, or fewer than it does.
  EXPECT_EQ(contentOf(read("COFF\n1 0 0\n1 2 3 4\n", Format::Off)),
            (std::vector<std::string>{"further numbers of 1 vertex"}));
  EXPECT_TRUE(read("COFF\n1 0 0\n1 2 3\n", Format::Off).otherContent.empty());
}

TEST(Off, OtherKindsAreRefusedByName) {
  expectInMessage(failure("OFF BINARY\n", Format::Off), {"binary"});
  expectInMessage(failure("4OFF\n1 0 0\n1 2 3 4\n", Format::Off), {"three dimensions"});
  expectInMessage(failure("nOFF\n3\n1 0 0\n1 2 3\n", Format::Off), {"three dimensions"});
  expectInMessage(failure("ply\n", Format::Off), {"line 1, column 1", "OFF", "ply"});
  expectInMessage(failure("", Format::Off), {"OFF"});
}

TEST(Off, ErrorsSayWhere) {
  expectInMessage(failure("OFF\n2 0 0\n1 2 3\n4 x 6\n", Format::Off),
                  {"line 4, column 3", "y of vertex 2 of 2", "x"});
  expectInMessage(failure("OFF\n2 0 0\n1 2 3\n4", Format::Off), {"vertex 2 of 2", "ends"});
  expectInMessage(failure("OFF\n-1 0 0\n", Format::Off), {"line 2, column 1", "vertices"});
  expectInMessage(failure("OFF\n1 1 0\n1 2 3\n3 0 0\n", Format::Off), {"face 1 of 1", "ends"});
  expectInMessage(failure("OFF\n1 1 0\n1 2 3\n3 0 0 1\n", Format::Off),
                  {"line 4, column 7", "face 1 of 1"});
  expectInMessage(failure("OFF\n1 0 0\n1 2 3\n4 5 6\n", Format::Off), {"line 4", "trailing"});
}

TEST(Off, HugeCountsCostNothing) {
  expectInMessage(failure("OFF\n18446744073709551615 0 0\n1 2 3\n", Format::Off), {"vertex 2 of"});
  expectInMessage(failure("OFF\n0 18446744073709551615 0\n", Format::Off), {"face 1 of"});
}

TEST(Off, WrittenFilesAreReadBack) {
  PointSetView view = PointSetView(kTwo.data(), 2);
  const std::string text = written(view, Format::Off);
  EXPECT_EQ(text, "OFF\n2 0 0\n1 2 3\n4 5 6.5\n");
  EXPECT_EQ(numbers<double>(read(text, Format::Off)), kTwo);
  EXPECT_EQ(read(written({}, Format::Off), Format::Off).size(), 0U);
  const std::vector<std::uint64_t> counts{1, 2};
  view.addArray(viewOf("PointCount", ScalarType::UInt64, counts));
  EXPECT_THROW(written(view, Format::Off), FormatError);
}

TEST(Off, NoMutationHarms) {
  test::expectNoMutationHarms("COFF\n3 1 3\n0 0 0 1 2 3\n0 1 0\n1 0 0\n3 0 1 2\n", Format::Off,
                              2000);
}

}  // namespace

}  // namespace bspc::formats
