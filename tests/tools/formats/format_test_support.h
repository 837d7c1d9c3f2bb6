#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <memory>
#include <random>
#include <sstream>
#include <streambuf>
#include <string>
#include <utility>
#include <vector>

#include "formats/model_io.h"

namespace bspc::formats::test {

/// A stream that cannot seek, as a pipe, and gives a few bytes at a time.
class PipeBuffer : public std::streambuf {
 public:
  explicit PipeBuffer(std::string bytes) : bytes_(std::move(bytes)) {}

 protected:
  int_type underflow() override {
    if (at_ >= bytes_.size()) return traits_type::eof();
    const std::size_t size = std::min<std::size_t>(7, bytes_.size() - at_);
    setg(bytes_.data() + at_, bytes_.data() + at_, bytes_.data() + at_ + size);
    at_ += size;
    return traits_type::to_int_type(*gptr());
  }

 private:
  std::string bytes_;
  std::size_t at_ = 0;
};

enum class Order { Little, Big };

/// Appends the bytes of a number in the given order, whatever the machine's.
template <class T>
void put(std::string& out, Order order, T value) {
  std::array<char, sizeof(T)> bytes;
  std::memcpy(bytes.data(), &value, sizeof(T));
  const std::uint16_t probe = 1;
  std::uint8_t first = 0;
  std::memcpy(&first, &probe, 1);
  if ((first == 1) != (order == Order::Little)) std::reverse(bytes.begin(), bytes.end());
  out.append(bytes.data(), bytes.size());
}

/// Reads a model in pieces of `count` points.
inline Model readInPieces(std::istream& in, Format format, std::size_t count) {
  const std::unique_ptr<PointStream> points = openPointStream(in, format);
  Model model;
  std::vector<std::uint8_t> piece(count * 3 * scalarSize(points->info().type));
  const ScalarType type = points->info().type;
  std::size_t got = count;
  while (got == count) {
    got = points->read(piece.data(), count);
    const std::size_t bytes = got * piece.size() / count;
    model.positions.insert(model.positions.end(), piece.data(), piece.data() + bytes);
  }
  EXPECT_EQ(points->read(piece.data(), count), 0U);
  static_cast<ModelInfo&>(model) = points->info();
  EXPECT_EQ(model.type, type);
  return model;
}

/// Reads the text as a file, as a pipe, and in pieces, which must give the same.
inline Model read(const std::string& text, Format format) {
  std::istringstream file(text);
  Model model = readModel(file, format);
  PipeBuffer buffer(text);
  std::istream pipe(&buffer);
  std::vector<Model> others{readModel(pipe, format)};
  for (const std::size_t count : {1U, 2U, 1000U}) {
    std::istringstream again(text);
    others.push_back(readInPieces(again, format, count));
  }
  for (const Model& other : others) {
    EXPECT_EQ(model.type, other.type);
    EXPECT_EQ(model.positions, other.positions);
    EXPECT_EQ(model.otherContent, other.otherContent);
    EXPECT_EQ(model.comments, other.comments);
  }
  return model;
}

template <class T>
std::vector<T> numbers(const Model& model) {
  std::vector<T> values(model.positions.size() / sizeof(T));
  if (!values.empty()) std::memcpy(values.data(), model.positions.data(), model.positions.size());
  return values;
}

/// The message with which reading fails, "" if it does not.
inline std::string failure(const std::string& text, Format format) {
  try {
    read(text, format);
  } catch (const FormatError& error) {
    return error.what();
  }
  return "";
}

inline std::string written(const ModelView& model, Format format) {
  std::ostringstream out;
  writeModel(out, format, model);
  return out.str();
}

inline void expectInMessage(const std::string& message, const std::vector<std::string>& pieces) {
  for (const std::string& piece : pieces) {
    EXPECT_NE(message.find(piece), std::string::npos) << piece << " in: " << message;
  }
}

/// Changes, cuts and doubles pieces of a good file: each must be read or refused by FormatError. A
/// byte of a file becomes at most `bytesOfByte` bytes of positions.
inline void expectNoMutationHarms(const std::string& good, Format format, int mutations,
                                  std::size_t bytesOfByte = 24) {
  std::mt19937_64 random(good.size());
  const auto below = [&](std::size_t end) { return static_cast<std::size_t>(random() % end); };
  const std::string snippets[] = {
      "-",    "1e999",  "99999999999999999999",        "nan", "\n",
      "list", "\"\\\"", "element vertex 4294967295\n", "#",   std::string(1, '\0')};
  int refused = 0;
  for (int i = 0; i < mutations; ++i) {
    std::string text = good;
    for (std::size_t edits = 1 + below(3); edits > 0 && !text.empty(); --edits) {
      const std::size_t at = below(text.size());
      switch (below(4)) {
        case 0:
          text[at] = static_cast<char>(below(256));
          break;
        case 1:
          text.resize(at);
          break;
        case 2:
          text.insert(at, snippets[below(std::size(snippets))]);
          break;
        default:
          text.insert(at, text.substr(below(text.size()), below(40)));
      }
    }
    std::istringstream in(text);
    try {
      const Model model = readModel(in, format);
      // Memory follows the bytes that there are, not what they claim.
      EXPECT_LE(model.positions.size(), bytesOfByte * (text.size() + 1));
    } catch (const FormatError& error) {
      ++refused;
      EXPECT_NE(std::string(error.what()), "");
    }
  }
  EXPECT_GT(refused, mutations / 10);
}

}  // namespace bspc::formats::test
