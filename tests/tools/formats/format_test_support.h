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

#include "formats/array_tuples.h"
#include "formats/model_io.h"
#include "formats/model_writer.h"

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

/// What a model has that is neither points nor arrays, in the words of its reader.
inline std::vector<std::string> contentOf(const ModelInfo& model) {
  std::vector<std::string> phrases;
  for (const OtherContent& content : model.otherContent) phrases.push_back(content.phrase);
  return phrases;
}

/// "name 3 x float32" for each array.
inline std::vector<std::string> arraysOf(const ModelInfo& model) {
  std::vector<std::string> texts;
  for (const ArrayDescription& array : model.arrays) {
    texts.push_back(array.name + " " + std::to_string(array.components) + " x " +
                    scalarName(array.type));
  }
  return texts;
}

inline void expectSameArrays(const Model& a, const Model& b) {
  EXPECT_EQ(arraysOf(a), arraysOf(b));
  ASSERT_EQ(a.values.size(), a.arrays.size());
  ASSERT_EQ(a.values.size(), b.values.size());
  for (std::size_t i = 0; i < a.values.size(); ++i) {
    EXPECT_EQ(a.values[i].values, b.values[i].values) << a.values[i].name;
    EXPECT_EQ(a.values[i].strings, b.values[i].strings) << a.values[i].name;
    EXPECT_EQ(a.values[i].tuples(), a.size()) << a.values[i].name;
  }
}

/// The array of this name, empty if there is none.
inline ArrayValues arrayOf(const Model& model, const std::string& name) {
  for (const ArrayValues& array : model.values) {
    if (array.name == name) return array;
  }
  ADD_FAILURE() << "there is no array " << name;
  return {};
}

template <class T>
std::vector<T> valuesOf(const Model& model, const std::string& name) {
  const ArrayValues array = arrayOf(model, name);
  std::vector<T> values(array.values.size() / sizeof(T));
  if (!values.empty()) std::memcpy(values.data(), array.values.data(), array.values.size());
  return values;
}

/// An array of numbers that are in memory elsewhere.
template <class T>
ArrayView viewOf(const std::string& name, ScalarType type, const std::vector<T>& values,
                 std::uint32_t components = 1) {
  ArrayView view;
  view.name = name;
  view.type = type;
  view.components = components;
  view.tuples = values.size() / components;
  view.data = values.data();
  return view;
}

/// Reads a model in pieces of `count` points.
inline Model readInPieces(std::istream& in, Format format, std::size_t count) {
  const std::unique_ptr<PointStream> points = openPointStream(in, format);
  Model model;
  model.values = emptyArrays(points->info().arrays);
  std::vector<std::uint8_t> piece(count * 3 * scalarSize(points->info().type));
  const ScalarType type = points->info().type;
  std::size_t got = count;
  while (got == count) {
    got = points->read(piece.data(), model.values, count);
    const std::size_t bytes = got * piece.size() / count;
    model.positions.insert(model.positions.end(), piece.data(), piece.data() + bytes);
  }
  EXPECT_EQ(points->read(piece.data(), model.values, count), 0U);
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
    EXPECT_EQ(contentOf(model), contentOf(other));
    EXPECT_EQ(model.metadata.entries, other.metadata.entries);
    expectSameArrays(model, other);
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

inline std::string written(const PointSetView& points, Format format) {
  std::ostringstream out;
  writeModel(out, format, points);
  return out.str();
}

/// The same with what a model says beside points and arrays.
inline std::string writtenAgain(const Model& model, Format format) {
  ModelLayout layout;
  layout.type = model.type;
  layout.points = model.size();
  layout.arrays = model.arrays;
  layout.metadata = model.metadata;
  layout.keepsOrder = true;
  layout.lattice = model.lattice;
  layout.mayPatch = true;
  std::ostringstream out;
  ModelWriter writer(out, format, layout);
  writer.append(model.view());
  writer.finish();
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
      for (const ArrayValues& array : model.values) {
        EXPECT_LE(array.values.size(), bytesOfByte * (text.size() + 1));
        EXPECT_EQ(array.tuples(), model.size());
      }
    } catch (const FormatError& error) {
      ++refused;
      EXPECT_NE(std::string(error.what()), "");
    }
  }
  EXPECT_GT(refused, mutations / 10);
}

}  // namespace bspc::formats::test
