// Sinks and sources that fail, at every byte of small files.

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <istream>
#include <memory>
#include <optional>
#include <ostream>
#include <streambuf>
#include <thread>
#include <utility>
#include <vector>

#include "bspc/error.h"
#include "bspc/join.h"
#include "faults/small_files.h"

namespace bspc {
namespace {

using test::SmallFile;
using test::smallFiles;

/// The code of the error that an action ends with; nothing without one.
std::optional<ErrorCode> errorOf(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    EXPECT_STRNE(error.what(), "");
    return error.code();
  }
  return std::nullopt;
}

/// Every byte of files that are quick to decode, some of the others.
std::size_t stepOf(const SmallFile& file) {
  return file.options.method == Method::Kd && file.arrays.empty() ? 1 : 11;
}

/// A disk that is full after so many bytes.
class FullSink final : public ByteSink {
 public:
  explicit FullSink(std::uint64_t room) : room_(room) {}
  void write(ByteView bytes) override {
    if (bytes.size() > room_) throw Error(ErrorCode::Io, "no room is left");
    room_ -= bytes.size();
  }

 private:
  std::uint64_t room_;
};

/// The same below a stream: the last write takes some of its bytes only.
class FullBuffer final : public std::streambuf {
 public:
  explicit FullBuffer(std::streamsize room) : room_(room) {}

 protected:
  std::streamsize xsputn(const char* /*bytes*/, std::streamsize count) override {
    const std::streamsize taken = std::min(count, room_);
    room_ -= taken;
    return taken;
  }
  int_type overflow(int_type c) override {
    return room_-- > 0 ? traits_type::not_eof(c) : traits_type::eof();
  }

 private:
  std::streamsize room_;
};

/// Notes how many bytes there are after each write.
class NotingSink final : public ByteSink {
 public:
  void write(ByteView bytes) override {
    ends.push_back(bytes.size() + (ends.empty() ? 0 : ends.back()));
  }

  std::vector<std::uint64_t> ends;
};

TEST(FullDisk, IsAnErrorInEveryWrite) {
  for (const SmallFile& file : smallFiles()) {
    SCOPED_TRACE(file.name);
    NotingSink noting;
    file.encodeTo(noting);
    std::uint64_t before = 0;
    for (const std::uint64_t end : noting.ends) {
      if (end == before) continue;
      FullSink sink((before + end) / 2);
      ASSERT_EQ(errorOf([&] { file.encodeTo(sink); }), ErrorCode::Io) << before;
      before = end;
    }
    FullSink enough(before);
    EXPECT_EQ(errorOf([&] { file.encodeTo(enough); }), std::nullopt);
  }
}

TEST(FullDisk, IsNoticedBehindAStreamThatTakesAPart) {
  const SmallFile file = smallFiles().front();
  const auto size = static_cast<std::streamsize>(file.bytes().size());
  for (std::streamsize room = 0; room <= size; ++room) {
    FullBuffer buffer(room);
    std::ostream stream(&buffer);
    StreamSink sink(stream);
    const auto error = errorOf([&] { file.encodeTo(sink); });
    ASSERT_EQ(error, room < size ? std::optional(ErrorCode::Io) : std::nullopt) << room;
  }
}

TEST(FullDisk, IsAnErrorOfJoiningToo) {
  const Bytes file = smallFiles().front().bytes();
  const std::vector<std::shared_ptr<ByteSource>> files(2, std::make_shared<MemorySource>(file));
  MemorySink whole;
  join(files, whole);
  for (std::uint64_t room = 0; room < whole.bytes().size(); ++room) {
    FullSink sink(room);
    ASSERT_EQ(errorOf([&] { join(files, sink); }), ErrorCode::Io) << room;
  }
}

/// A disk that cannot read one byte.
class BadSector final : public ByteSource {
 public:
  BadSector(const Bytes& bytes, std::uint64_t bad) : bytes_(bytes), bad_(bad) {}
  std::uint64_t size() const override { return bytes_.size(); }
  void read(std::uint64_t offset, Span<std::uint8_t> into) override {
    if (offset <= bad_ && bad_ < offset + into.size()) {
      throw Error(ErrorCode::Io, "the disk cannot read it");
    }
    MemorySource(bytes_).read(offset, into);
  }

 private:
  const Bytes& bytes_;
  std::uint64_t bad_;
};

void decodeAll(const std::shared_ptr<ByteSource>& source, const OpenOptions& options = {}) {
  Decoder(source, options).decode();
}

TEST(ReadError, IsPassedOnWhereverItComes) {
  for (const SmallFile& file : smallFiles()) {
    SCOPED_TRACE(file.name);
    const Bytes bytes = file.bytes();
    OpenOptions partial;
    partial.allowPartial = true;
    for (std::uint64_t bad = 0; bad < bytes.size(); bad += stepOf(file)) {
      const auto source = std::make_shared<BadSector>(bytes, bad);
      ASSERT_EQ(errorOf([&] { decodeAll(source); }), ErrorCode::Io) << bad;
      // What is there but cannot be read is not missing.
      ASSERT_EQ(errorOf([&] { decodeAll(source, partial); }), ErrorCode::Io) << bad;
    }
  }
}

/// A file below a stream that somebody cuts after so many reads, or writes over.
class ChangingSource final : public ByteSource {
 public:
  ChangingSource(const Bytes& before, const Bytes& after, unsigned reads)
      : before_(before), after_(after), left_(reads) {}
  std::uint64_t size() const override { return (left_ > 0 ? before_ : after_).size(); }
  void read(std::uint64_t offset, Span<std::uint8_t> into) override {
    if (left_ == 0) {
      MemorySource(after_).read(offset, into);
      return;
    }
    MemorySource(before_).read(offset, into);
    --left_;
  }
  bool hasChanged() const { return left_ == 0; }

 private:
  const Bytes& before_;
  const Bytes& after_;
  unsigned left_;
};

/// Points, values and corners of faces.
struct Decoded {
  std::vector<GridPoint> points;
  std::vector<Bytes> values;
  std::vector<std::uint32_t> corners;

  bool operator==(const Decoded& other) const {
    return points == other.points && values == other.values && corners == other.corners;
  }
};

Decoded decodedFrom(const std::shared_ptr<ByteSource>& source) {
  DecodedPoints all = Decoder(source).decode();
  Decoded decoded{std::move(all.points), {}, std::move(all.mesh.faces.indices)};
  for (ArrayValues& array : all.arrays) decoded.values.push_back(std::move(array.values));
  return decoded;
}

/// Decodes while the file changes after each number of reads that there are: that is an error, or
/// gives what one of both files holds and no mixture.
void expectNoticed(const Bytes& before, const Bytes& after) {
  const Decoded good = decodedFrom(std::make_shared<MemorySource>(before));
  Decoded other = good;
  errorOf([&] { other = decodedFrom(std::make_shared<MemorySource>(after)); });
  bool changes = true;
  for (unsigned reads = 1; changes; ++reads) {
    const auto source = std::make_shared<ChangingSource>(before, after, reads);
    const auto code = errorOf([&] {
      const Decoded found = decodedFrom(source);
      ASSERT_TRUE(found == good || found == other) << reads;
    });
    ASSERT_TRUE(!code || code == ErrorCode::Io || code == ErrorCode::Corrupt ||
                code == ErrorCode::Truncated);
    changes = source->hasChanged();
    ASSERT_LT(reads, 1000U);
  }
}

TEST(OpenFile, ThatIsCutIsAnError) {
  for (const SmallFile& file : smallFiles()) {
    SCOPED_TRACE(file.name);
    const Bytes bytes = file.bytes();
    for (const std::size_t size : {std::size_t{0}, bytes.size() / 3, bytes.size() - 1}) {
      expectNoticed(bytes, Bytes(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size)));
    }
  }
}

TEST(OpenFile, ThatIsWrittenOverIsAnErrorOrReadAsItWas) {
  for (const SmallFile& file : smallFiles()) {
    SCOPED_TRACE(file.name);
    Bytes other = file.bytes();
    for (std::uint8_t& byte : other) byte ^= 0x55;
    expectNoticed(file.bytes(), other);
    // Another good file of the same size but for a point.
    SmallFile moved = file;
    moved.xyz[4] += 1;
    expectNoticed(file.bytes(), moved.bytes());
  }
}

/// A stream that ends before it said that it would, as a file does that is cut.
class CutBuffer final : public std::streambuf {
 public:
  CutBuffer(const Bytes& bytes, std::size_t size) : bytes_(bytes), size_(size) {}

 protected:
  pos_type seekoff(off_type offset, std::ios_base::seekdir from,
                   std::ios_base::openmode /*which*/) override {
    at_ = from == std::ios_base::end   ? bytes_.size() + static_cast<std::size_t>(offset)
          : from == std::ios_base::beg ? static_cast<std::size_t>(offset)
                                       : at_ + static_cast<std::size_t>(offset);
    return static_cast<pos_type>(static_cast<off_type>(at_));
  }
  pos_type seekpos(pos_type place, std::ios_base::openmode which) override {
    return seekoff(off_type(place), std::ios_base::beg, which);
  }
  std::streamsize xsgetn(char* to, std::streamsize count) override {
    const std::size_t end = std::min(size_, at_ + static_cast<std::size_t>(count));
    const std::size_t got = end > at_ ? end - at_ : 0;
    std::copy_n(bytes_.begin() + static_cast<std::ptrdiff_t>(at_), got, to);
    at_ += got;
    return static_cast<std::streamsize>(got);
  }
  int_type underflow() override { return traits_type::eof(); }

 private:
  const Bytes& bytes_;
  std::size_t size_;
  std::size_t at_ = 0;
};

TEST(ShortRead, OfAStreamIsAnErrorWhereverItComes) {
  for (const SmallFile& file : smallFiles()) {
    SCOPED_TRACE(file.name);
    const Bytes bytes = file.bytes();
    for (std::size_t missing = 0; missing <= bytes.size(); missing += stepOf(file)) {
      const std::size_t size = bytes.size() - missing;
      CutBuffer buffer(bytes, size);
      std::istream stream(&buffer);
      const auto code = errorOf([&] { decodeAll(std::make_shared<StreamSource>(stream)); });
      if (size == bytes.size()) {
        ASSERT_EQ(code, std::nullopt);
      } else {
        ASSERT_TRUE(code == ErrorCode::Io || code == ErrorCode::Truncated) << size;
      }
    }
  }
}

TEST(ConcurrentReaders, OfOneFileGetTheSame) {
  for (const SmallFile& file : smallFiles()) {
    const Bytes bytes = file.bytes();
    const auto source = std::make_shared<MemorySource>(bytes);
    const std::vector<GridPoint> points = test::open(bytes).decode().points;
    std::vector<std::thread> readers;
    std::vector<std::vector<GridPoint>> found(4);
    readers.reserve(found.size());
    for (std::vector<GridPoint>& own : found) {
      readers.emplace_back([&own, &source] {
        DecodeOptions options;
        options.threads = 2;
        own = Decoder(source).decode(options).points;
      });
    }
    for (std::thread& reader : readers) reader.join();
    for (const std::vector<GridPoint>& own : found) EXPECT_EQ(own, points) << file.name;
  }
}

}  // namespace
}  // namespace bspc
