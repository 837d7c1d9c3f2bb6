// Prints for each file that is named the hash of its decoded content, or the error that it is
// refused with. Testing/Data/conformance/README.md says what is hashed;
// tests/conformance/content.py does the same in Python, from the second decoder.

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <exception>
#include <fstream>
#include <iostream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bspc/decoder.h"
#include "bspc/error.h"
#include "container/checksum.h"

namespace {

using bspc::ArrayDescription;
using bspc::ArrayValues;
using bspc::DecodedPoints;
using bspc::FileInfo;
using bspc::ScalarType;

/// What a file holds as one row of bytes that any decoder can make.
class Content {
 public:
  void number(std::uint64_t v) {
    for (unsigned i = 0; i < 8; ++i) bytes_.push_back(static_cast<std::uint8_t>(v >> (8 * i)));
  }

  void number(double v) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &v, sizeof bits);
    number(bits);
  }

  void text(const std::string& text) {
    number(std::uint64_t{text.size()});
    bytes_.insert(bytes_.end(), text.begin(), text.end());
  }

  void description(const ArrayDescription& array) {
    text(array.name);
    number(std::uint64_t{static_cast<std::uint8_t>(array.type)});
    number(std::uint64_t{array.components});
    number(std::uint64_t{array.componentNames.size()});
    for (const std::string& name : array.componentNames) text(name);
    text(array.unit);
    number(std::uint64_t{static_cast<std::uint8_t>(array.semantic)});
    number(array.tolerance);
  }

  void values(const ArrayValues& array) {
    number(array.tuples());
    for (const std::string& string : array.strings) text(string);
    bytes_.insert(bytes_.end(), array.values.begin(), array.values.end());
  }

  std::uint64_t hash() const { return bspc::container::checksum(bytes_, 8); }

 private:
  bspc::Bytes bytes_;
};

void addMetadata(Content& content, const FileInfo& info) {
  content.number(std::uint64_t{static_cast<std::uint8_t>(info.grid.scalarType)});
  content.text(info.metadata.crs);
  content.text(info.metadata.lengthUnit);
  content.number(std::uint64_t{info.metadata.entries.size()});
  for (const auto& [key, value] : info.metadata.entries) {
    content.text(key);
    content.text(value);
  }
  content.number(std::uint64_t{info.metadata.fieldData.size()});
  for (const ArrayValues& array : info.metadata.fieldData) {
    content.description(array);
    content.values(array);
  }
}

template <class T>
void addCoordinates(Content& content, const bspc::Grid& grid, const DecodedPoints& decoded) {
  std::vector<T> xyz(3 * decoded.points.size());
  bspc::restorePositions(grid, decoded, xyz.data());
  for (const T x : xyz) content.number(static_cast<double>(x));
}

void addPositions(Content& content, const bspc::Grid& grid, const DecodedPoints& decoded) {
  content.number(std::uint64_t{decoded.points.size()});
  const auto add = [&](auto zero) { addCoordinates<decltype(zero)>(content, grid, decoded); };
  switch (grid.scalarType) {
    case ScalarType::Float32:
      return add(float{});
    case ScalarType::Int8:
      return add(std::int8_t{});
    case ScalarType::UInt8:
      return add(std::uint8_t{});
    case ScalarType::Int16:
      return add(std::int16_t{});
    case ScalarType::UInt16:
      return add(std::uint16_t{});
    case ScalarType::Int32:
      return add(std::int32_t{});
    case ScalarType::UInt32:
      return add(std::uint32_t{});
    case ScalarType::Int64:
      return add(std::int64_t{});
    case ScalarType::UInt64:
      return add(std::uint64_t{});
    default:
      return add(double{});
  }
}

void addCells(Content& content, const bspc::Cells& cells) {
  content.number(std::uint64_t{cells.size()});
  for (std::size_t i = 0; i < cells.size(); ++i) {
    content.number(std::uint64_t{cells[i].size()});
    for (const std::uint32_t point : cells[i]) content.number(std::uint64_t{point});
  }
}

void addLevel(Content& content, bspc::Decoder& decoder, unsigned level) {
  bspc::DecodeOptions options;
  options.level = level;
  options.wantCounts = true;
  options.threads = 1;
  const DecodedPoints decoded = decoder.decode(options);
  addPositions(content, decoder.info().grid, decoded);
  for (const std::uint64_t count : decoded.counts) content.number(count);
  for (const ArrayValues& array : decoded.arrays) {
    content.text(array.name);
    content.values(array);
  }
  if (level + 1 < decoder.info().layers.size()) return;
  addCells(content, decoded.mesh.vertices);
  addCells(content, decoded.mesh.lines);
  addCells(content, decoded.mesh.faces);
  for (const ArrayValues& array : decoded.cellArrays) {
    content.description(array);
    content.values(array);
  }
}

/// "good", the hash and the number of points.
std::string contentOf(const std::string& name) {
  std::ifstream in(name, std::ios::binary);
  if (!in) return "missing";
  bspc::Decoder decoder(std::make_shared<bspc::StreamSource>(in));
  Content content;
  addMetadata(content, decoder.info());
  content.number(std::uint64_t{decoder.info().arrays.size()});
  for (const bspc::ArrayInfo& array : decoder.info().arrays) content.description(array);
  for (unsigned level = 0; level < decoder.info().layers.size(); ++level) {
    addLevel(content, decoder, level);
  }
  static const char* const kDigits = "0123456789abcdef";
  std::string hash;
  for (unsigned shift = 64; shift > 0; shift -= 4) {
    hash += kDigits[content.hash() >> (shift - 4) & 15];
  }
  return "good\t" + hash + '\t' + std::to_string(decoder.info().points);
}

std::string outcomeOf(const std::string& name) {
  try {
    return contentOf(name);
  } catch (const bspc::Error& error) {
    return std::string("bad\t") + bspc::errorCodeName(error.code()) + '\t' + error.what();
  } catch (const std::exception& error) {
    return std::string("failed\t") + error.what();
  }
}

}  // namespace

int main(int argc, char** argv) {
  try {
    for (int i = 1; i < argc; ++i) {
      std::cout << argv[i] << '\t' << outcomeOf(argv[i]) << '\n' << std::flush;
    }
    // Names on standard input, for callers that have new files over and over.
    for (std::string name; argc < 2 && std::getline(std::cin, name);) {
      std::cout << name << '\t' << outcomeOf(name) << '\n' << std::flush;
    }
  } catch (const std::exception& error) {
    std::cerr << "content_of: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
