#include <cmath>
#include <limits>

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

TEST(Xyz, NamedColumnsAreArraysOfTheTypesThatTheirTextsShow) {
  const Model model = read(
      "label,x,y,z,intensity,id,time,red,green,blue\n"
      "tree,1,2,3,,5000000000,0.5,255,0,1\n"
      "\"a, \"\"b\"\" # c\",4,5,6.5,7,-1,3,2,3,4\n",
      Format::Csv);
  EXPECT_EQ(numbers<double>(model), kTwo);
  EXPECT_TRUE(model.otherContent.empty());
  EXPECT_EQ(test::arraysOf(model),
            (std::vector<std::string>{"label 1 x string", "intensity 1 x float64", "id 1 x int64",
                                      "time 1 x float64", "RGB 3 x uint8"}));
  EXPECT_EQ(test::arrayOf(model, "label").strings,
            (std::vector<std::string>{"tree", "a, \"b\" # c"}));
  const std::vector<double> intensity = valuesOf<double>(model, "intensity");
  EXPECT_TRUE(std::isnan(intensity[0]));
  EXPECT_EQ(intensity[1], 7);
  EXPECT_EQ(valuesOf<std::int64_t>(model, "id"), (std::vector<std::int64_t>{5000000000, -1}));
  EXPECT_EQ(valuesOf<std::uint8_t>(model, "RGB"), (std::vector<std::uint8_t>{255, 0, 1, 2, 3, 4}));
  const Model back = read(test::writtenAgain(model, Format::Csv), Format::Csv);
  EXPECT_EQ(test::arraysOf(back), test::arraysOf(model));
  EXPECT_EQ(test::arrayOf(back, "label").strings, test::arrayOf(model, "label").strings);
}

TEST(Xyz, TheTypeOfAColumnIsThatOfAllItsLines) {
  std::string text = "x y z n\n";
  for (int i = 0; i < 1000; ++i) text += "1 2 3 4\n";
  EXPECT_EQ(test::arraysOf(read(text, Format::Xyz)), (std::vector<std::string>{"n 1 x int32"}));
  EXPECT_EQ(test::arraysOf(read(text + "1 2 3 4.5\n", Format::Xyz)),
            (std::vector<std::string>{"n 1 x float64"}));
  EXPECT_EQ(test::arraysOf(read(text + "1 2 3 -0\n", Format::Xyz)),
            (std::vector<std::string>{"n 1 x float64"}));
  EXPECT_EQ(test::arraysOf(read(text + "1 2 3 18446744073709551615\n", Format::Xyz)),
            (std::vector<std::string>{"n 1 x uint64"}));
  EXPECT_EQ(test::arraysOf(read(text + "1 2 3 four\n", Format::Xyz)),
            (std::vector<std::string>{"n 1 x string"}));
}

TEST(Xyz, OfALongPipeOnlyTheStartShowsTypes) {
  std::string text = "x y z n\n";
  while (text.size() < (std::size_t{6} << 20)) text += "1000000 2000000 3000000 40000000\n";
  test::PipeBuffer buffer(text + "1 2 3 4.5\n");
  std::istream pipe(&buffer);
  try {
    readModel(pipe, Format::Xyz);
    FAIL() << "not refused";
  } catch (const FormatError& error) {
    expectInMessage(error.what(), {"\"n\"", "int32", "\"4.5\"", "pipe"});
  }
  std::istringstream file(text + "1 2 3 4.5\n");
  EXPECT_EQ(test::arraysOf(readModel(file, Format::Xyz)),
            (std::vector<std::string>{"n 1 x float64"}));
}

TEST(Xyz, ACommentInFrontMayNameTheColumns) {
  const Model model = read("# made by hand\n# X Y Z class\n1 2 3 4\n4 5 6.5 7\n", Format::Xyz);
  EXPECT_EQ(numbers<double>(model), kTwo);
  EXPECT_EQ(valuesOf<std::int32_t>(model, "class"), (std::vector<std::int32_t>{4, 7}));
  for (const char* other : {"# x y z\n1 2 3 4\n", "# x y a b\n1 2 3 4\n"}) {
    EXPECT_EQ(contentOf(read(other, Format::Xyz)),
              (std::vector<std::string>{"column 4 without a name"}));
  }
}

TEST(Xyz, ColumnsWithoutNamesAreNotArrays) {
  const Model nameless = read("1 2 3 255\n4 5 6.5 0\n", Format::Xyz);
  EXPECT_EQ(contentOf(nameless), (std::vector<std::string>{"column 4 without a name"}));
  EXPECT_EQ(test::arraysOf(read("x,y,z,,b\n1,2,3,4,5\n", Format::Csv)),
            (std::vector<std::string>{"column 4 1 x int32", "b 1 x int32"}));
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
  expectInMessage(failure("x,y,z,a,a\n1,2,3,4,5\n", Format::Csv), {"line 1", "second", "a"});
  expectInMessage(failure("x,y,z,a\n1,2,3,4\n1,2,3\n", Format::Csv), {"line 3", "4 columns"});
}

TEST(Xyz, WrittenFilesAreReadBack) {
  const std::vector<double> xyz{0.5, 1, 2, -0.0, 1e-300, 0.1};
  PointSetView view = PointSetView(xyz.data(), 2);
  EXPECT_EQ(written(view, Format::Xyz), "0.5 1 2\n-0 1e-300 0.1\n");
  EXPECT_EQ(written(view, Format::Csv), "x,y,z\n0.5,1,2\n-0,1e-300,0.1\n");
  for (const Format format : {Format::Xyz, Format::Csv}) {
    EXPECT_EQ(numbers<double>(read(written(view, format), format)), xyz);
    EXPECT_EQ(read(written({}, format), format).size(), 0U);
  }
}

TEST(Xyz, ArraysGoBesideThePositions) {
  const std::vector<float> xyz{0.1F, 1, 2, 3, 4, 5};
  const std::vector<std::uint64_t> counts{1, 18446744073709551615U};
  PointSetView view = PointSetView(xyz.data(), 2);
  view.addArray(viewOf("PointCount", ScalarType::UInt64, counts));
  EXPECT_EQ(written(view, Format::Xyz),
            "# x y z PointCount\n0.1 1 2 1\n3 4 5 18446744073709551615\n");
  EXPECT_EQ(written(view, Format::Csv),
            "x,y,z,PointCount\n0.1,1,2,1\n3,4,5,18446744073709551615\n");
}

TEST(Xyz, ZerosKeepTheirSign) {
  const std::vector<float> xyz{-0.0F, 1, 2};
  const std::vector<double> zeros{-0.0};
  PointSetView view(xyz.data(), 1);
  view.addArray(viewOf("t", ScalarType::Float64, zeros));
  EXPECT_EQ(written(view, Format::Csv), "x,y,z,t\n-0,1,2,-0\n");
}

TEST(Xyz, TextsWithBlanksAreWordsInXyzFiles) {
  const std::vector<float> xyz{0, 1, 2, 3, 4, 5};
  const std::vector<std::string> texts{"big tree #1", ""};
  PointSetView view(xyz.data(), 2);
  view.addArray(viewOf("a label", ScalarType::String, texts));
  EXPECT_EQ(written(view, Format::Xyz), "# x y z a_label\n0 1 2 big_tree__1\n3 4 5 _\n");
  EXPECT_EQ(written(view, Format::Csv), "x,y,z,\"a label\"\n0,1,2,\"big tree #1\"\n3,4,5,\"\"\n");
}

TEST(Xyz, NoMutationHarms) {
  test::expectNoMutationHarms("x,y,z,n,t,s\n1,2,3,4,0.5,\"a,b\"\n5,-6,7e3,8,1e3,c\n9,10,11,12,,\n",
                              Format::Csv, 2000);
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
