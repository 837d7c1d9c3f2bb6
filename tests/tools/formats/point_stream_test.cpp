#include <sys/resource.h>

#include "bspc/error.h"
#include "tools/formats/format_test_support.h"

namespace bspc::formats {

namespace {

/// A long stream that is never in memory: a head, then the same piece again and again.
class RepeatingBuffer : public std::streambuf {
 public:
  RepeatingBuffer(std::string head, std::string piece, std::size_t times)
      : head_(std::move(head)), piece_(std::move(piece)), times_(times) {
    setg(head_.data(), head_.data(), head_.data() + head_.size());
  }

 protected:
  int_type underflow() override {
    if (gptr() < egptr()) return traits_type::to_int_type(*gptr());
    if (times_ == 0) return traits_type::eof();
    --times_;
    setg(piece_.data(), piece_.data(), piece_.data() + piece_.size());
    return traits_type::to_int_type(*gptr());
  }

 private:
  std::string head_;
  std::string piece_;
  std::size_t times_;
};

constexpr std::size_t kPieces = 1000;
constexpr std::size_t kPointsOfPiece = 5000;

std::string plyHead(const char* encoding, const char* further) {
  return "ply\nformat " + std::string(encoding) + " 1.0\nelement vertex " +
         std::to_string(kPieces * kPointsOfPiece) +
         "\nproperty float x\nproperty float y\nproperty float z\n" + further + "end_header\n";
}

std::string repeated(const std::string& text, std::size_t times) {
  std::string all;
  for (std::size_t i = 0; i < times; ++i) all += text;
  return all;
}

long peakKilobytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss;
}

/// Five million points, 60 MB as floats and 120 MB as doubles.
void expectMemoryStaysSmall(Format format, const std::string& head, const std::string& point) {
  RepeatingBuffer buffer(head, repeated(point, kPointsOfPiece), kPieces);
  std::istream in(&buffer);
  std::vector<std::uint8_t> block(std::size_t{24} * 4096);
  const long before = peakKilobytes();
  const auto points = openPointStream(in, format);
  std::size_t total = 0;
  std::size_t got = 0;
  do {
    got = points->read(block.data(), {}, 4096);
    total += got;
  } while (got == 4096);
  EXPECT_EQ(total, kPieces * kPointsOfPiece);
  EXPECT_LT(peakKilobytes() - before, 16 * 1024);
}

TEST(PointStream, ABinaryPlyLargerThanItsMemoryIsRead) {
  expectMemoryStaysSmall(Format::Ply, plyHead("binary_little_endian", ""), std::string(12, '\1'));
  expectMemoryStaysSmall(Format::Ply, plyHead("binary_big_endian", "property uchar red\n"),
                         std::string(13, '\1'));
}

TEST(PointStream, ScansLargerThanItsMemoryAreRead) {
  const auto points = static_cast<std::uint32_t>(kPieces * kPointsOfPiece);
  std::string las = "LASF" + std::string(20, '\0') + "\1\2" + std::string(68, '\0');
  test::put(las, test::Order::Little, std::uint16_t{227});
  test::put(las, test::Order::Little, std::uint32_t{227});
  las += std::string(5, '\0');
  test::put(las, test::Order::Little, std::uint16_t{20});
  test::put(las, test::Order::Little, points);
  las += std::string(20, '\0');
  for (int k = 0; k < 3; ++k) test::put(las, test::Order::Little, 1.0);
  las.resize(227, '\0');
  expectMemoryStaysSmall(Format::Las, las, std::string(20, '\1'));
  expectMemoryStaysSmall(
      Format::Pcd,
      "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH " + std::to_string(points) + "\nDATA binary\n",
      std::string(12, '\1'));
}

TEST(PointStream, TextLargerThanItsMemoryIsRead) {
  expectMemoryStaysSmall(Format::Ply, plyHead("ascii", ""), "1 2 3\n");
  expectMemoryStaysSmall(Format::Xyz, "", "1 2 3\n");
  expectMemoryStaysSmall(Format::Obj, "", "v 1 2 3\n");
}

TEST(PointStream, TheTypeIsKnownFromTheStartAndTheContentAtTheEnd) {
  std::istringstream in("v 1 2 3\nv 4 5 6\nf 1 2 1\n");
  const auto points = openPointStream(in, Format::Obj);
  EXPECT_EQ(points->info().type, ScalarType::Float64);
  std::vector<double> block(9);
  auto* bytes = reinterpret_cast<std::uint8_t*>(block.data());
  EXPECT_EQ(points->read(bytes, {}, 2), 2U);
  EXPECT_TRUE(points->info().otherContent.empty());
  EXPECT_EQ(points->read(bytes, {}, 3), 0U);
  EXPECT_EQ(test::contentOf(points->info()), (std::vector<std::string>{"1 face"}));
  EXPECT_EQ(block[5], 6);
}

TEST(PointStream, PointsBeforeAMistakeAreGivenOut) {
  std::istringstream in("1 2 3\n4 5 6\n7 oops 9\n");
  const auto points = openPointStream(in, Format::Xyz);
  std::vector<double> block(6);
  auto* bytes = reinterpret_cast<std::uint8_t*>(block.data());
  EXPECT_EQ(points->read(bytes, {}, 2), 2U);
  EXPECT_THROW(points->read(bytes, {}, 2), FormatError);
}

TEST(PointStream, MemoryIsSetAsideForWhatTheFileCanHold) {
  const std::string head = plyHead("binary_little_endian", "");
  std::istringstream in(head + std::string(25, '\0'));
  EXPECT_EQ(openPointStream(in, Format::Ply)->reservable(), 2U);
  test::PipeBuffer buffer(head);
  std::istream pipe(&buffer);
  EXPECT_EQ(openPointStream(pipe, Format::Ply)->reservable(), 0U);
}

TEST(PointStream, ReadingCanBeStopped) {
  RepeatingBuffer buffer("", repeated("1 2 3\n", kPointsOfPiece), kPieces);
  std::istream in(&buffer);
  int calls = 0;
  const auto points = openPointStream(in, Format::Xyz, [&calls](double) { return ++calls < 4; });
  std::vector<std::uint8_t> block(std::size_t{24} * 4096);
  const auto readAll = [&] {
    while (points->read(block.data(), {}, 4096) == 4096) {
    }
  };
  EXPECT_THROW(readAll(), Error);
}

}  // namespace

}  // namespace bspc::formats
