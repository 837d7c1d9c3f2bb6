#include <limits>

#include "tools/formats/format_test_support.h"

namespace bspc::formats {

namespace {

using test::expectInMessage;
using test::failure;
using test::numbers;
using test::read;
using test::written;

const std::vector<double> kTwo{1, 2, 3, 4, 5, 6.5};

TEST(Xyz, SeparatorsAndNamesAreFound) {
  for (const char* text : {
           "1 2 3\n4 5 6.5\n",
           "1\t2\t3\r\n4\t5\t6.5",
           "# x y z\n\n  1   2 3 # first\n4 5 6.5\n",
           "1,2,3\n4, 5 ,6.5\n",
           "1;2;3\n4;5;6.5\n",
           "x,y,z\n1,2,3\n4,5,6.5\n",
           "z;\"Y\";x\n3;2;1\n6.5;5;4\n",
           "//X Y Z\n1 2 3\n4 5 6.5\n",
           "\xEF\xBB\xBF\"Points:0\",\"Points:1\",\"Points:2\"\n1,2,3\n4,5,6.5\n",
       }) {
    const Model model = read(text, Format::Xyz);
    EXPECT_EQ(model.type, ScalarType::Float64) << text;
    EXPECT_EQ(numbers<double>(model), kTwo) << text;
    EXPECT_TRUE(model.otherContent.empty()) << text;
  }
}

TEST(Xyz, FurtherColumnsAreNamed) {
  const Model named = read("label,x,y,z,intensity\ntree,1,2,3,\n,4,5,6.5,7\n", Format::Csv);
  EXPECT_EQ(numbers<double>(named), kTwo);
  EXPECT_EQ(named.otherContent,
            (std::vector<std::string>{"column \"label\"", "column \"intensity\""}));
  const Model nameless = read("1 2 3 255\n4 5 6.5 0\n", Format::Xyz);
  EXPECT_EQ(nameless.otherContent, (std::vector<std::string>{"column 4"}));
}

TEST(Xyz, EmptyFilesHoldNoPoints) {
  for (const char* text : {"", "\n\n", "# nothing\n", "x,y,z\n"}) {
    EXPECT_EQ(read(text, Format::Csv).size(), 0U) << text;
  }
}

TEST(Xyz, NumbersThatAreNotFiniteAreRead) {
  const std::vector<double> values = numbers<double>(read("nan inf -inf\n", Format::Xyz));
  ASSERT_EQ(values.size(), 3U);
  EXPECT_TRUE(std::isnan(values[0]));
  EXPECT_EQ(values[1], std::numeric_limits<double>::infinity());
  EXPECT_EQ(values[2], -std::numeric_limits<double>::infinity());
}

TEST(Xyz, ErrorsSayWhere) {
  expectInMessage(failure("1 2 3\n4 five 6\n", Format::Xyz), {"line 2, column 3", "y", "five"});
  expectInMessage(failure("1 2 3\n4 5\n", Format::Xyz), {"line 2, column 4", "3 columns"});
  expectInMessage(failure("1 2\n", Format::Xyz), {"line 1", "3 columns"});
  expectInMessage(failure("1 2 3\n4 5 6 7\n", Format::Xyz), {"line 2, column 7", "3 columns"});
  expectInMessage(failure("1;2;3\n4;5,5;6\n", Format::Csv), {"line 2, column 3", "5,5"});
  expectInMessage(failure("1,,3\n", Format::Csv), {"line 1, column 3", "nothing"});
  expectInMessage(failure("1,2,\n", Format::Csv), {"line 1, column 5", "3 columns, found 2"});
  expectInMessage(failure("a,b,c\n1,2,3\n", Format::Csv), {"line 1", "x, y and z", "a"});
  expectInMessage(failure("x,y,z,x\n1,2,3,4\n", Format::Csv), {"line 1", "second", "x"});
}

TEST(Xyz, WrittenFilesAreReadBack) {
  const std::vector<double> xyz{0.5, 1, 2, -0.0, 1e-300, 0.1};
  ModelView view;
  view.points = PointSetView(xyz.data(), 2);
  EXPECT_EQ(written(view, Format::Xyz), "0.5 1 2\n0 1e-300 0.1\n");
  EXPECT_EQ(written(view, Format::Csv), "x,y,z\n0.5,1,2\n0,1e-300,0.1\n");
  for (const Format format : {Format::Xyz, Format::Csv}) {
    EXPECT_EQ(numbers<double>(read(written(view, format), format)), xyz);
    EXPECT_EQ(read(written({}, format), format).size(), 0U);
  }
}

TEST(Xyz, ColumnsGoBesideThePositions) {
  const std::vector<float> xyz{0.1F, 1, 2, 3, 4, 5};
  const std::vector<std::uint64_t> counts{1, 18446744073709551615U};
  ModelView view;
  view.points = PointSetView(xyz.data(), 2);
  view.columns.push_back({"PointCount", counts});
  EXPECT_EQ(written(view, Format::Xyz),
            "# x y z PointCount\n0.1 1 2 1\n3 4 5 18446744073709551615\n");
  EXPECT_EQ(written(view, Format::Csv),
            "x,y,z,PointCount\n0.1,1,2,1\n3,4,5,18446744073709551615\n");
}

TEST(Xyz, NoMutationHarms) {
  test::expectNoMutationHarms("x y z i\n1 2 3 4\n5.5 -6 7e3 8\n# end\n9 10 11 12\n", Format::Xyz,
                              2000);
}

TEST(FormatNames, EndingsTellTheFormat) {
  EXPECT_EQ(formatFromPath("a/b.c/scan.PLY"), Format::Ply);
  EXPECT_EQ(formatFromPath(".obj"), Format::Obj);
  EXPECT_EQ(formatFromPath("x.off"), Format::Off);
  EXPECT_EQ(formatFromPath("x.txt"), Format::Xyz);
  EXPECT_EQ(formatFromPath("x.csv"), Format::Csv);
  EXPECT_FALSE(formatFromPath("x.bspc"));
  EXPECT_FALSE(formatFromPath("ply"));
}

}  // namespace

}  // namespace bspc::formats
