#include "attributes/string_coder.h"

#include <algorithm>
#include <cstring>
#include <numeric>
#include <unordered_map>

#include "attributes/byte_planes.h"
#include "attributes/float_bytes.h"
#include "attributes/number_coder.h"

namespace bspc::attributes {

namespace {

enum class StringKind : std::uint8_t {
  Each = 0,   ///< the strings, one after the other
  Table = 1,  ///< the different strings, then the number of each point's
};

constexpr int kStringLevel = 9;

using StringList = std::vector<const std::string*>;

/// Lengths as varints, then all characters.
void writeList(const StringList& strings, container::ByteWriter& out) {
  container::ByteWriter lengths;
  Bytes text;
  for (const std::string* s : strings) {
    lengths.varint(s->size());
    text.insert(text.end(), s->begin(), s->end());
  }
  PlaneWriter planes(kStringLevel);
  out.varint(lengths.size());
  planes.write(lengths.data(), out);
  planes.write(text, out);
}

std::vector<std::string> readList(container::ByteReader& in, std::uint64_t count,
                                  MemoryBudget& budget) {
  constexpr std::uint64_t kLongestVarint = 10;
  const std::uint64_t lengthBytes = in.varint();
  if (lengthBytes < count || lengthBytes > kLongestVarint * count) {
    in.fail("the lengths of " + std::to_string(count) + " strings have " +
            std::to_string(lengthBytes) + " bytes");
  }
  PlaneReader planes;
  const Bytes packedLengths = planes.readClaimed(in, lengthBytes, budget);
  container::ByteReader lengthReader(packedLengths, "the lengths of strings",
                                     container::ByteReader::kNoOffset);
  budget.take(count, sizeof(std::uint64_t) + sizeof(std::string));
  std::vector<std::uint64_t> lengths(count);
  std::uint64_t total = 0;
  for (std::uint64_t& length : lengths) {
    length = lengthReader.varint();
    if (length > budget.left() - std::min(budget.left(), total)) {
      budget.take(total);
      budget.take(length);  // throws
    }
    total += length;
  }
  lengthReader.expectEnd();
  const Bytes text = planes.readClaimed(in, total, budget);
  budget.take(total);
  std::vector<std::string> strings;
  strings.reserve(lengths.size());
  std::size_t at = 0;
  for (const std::uint64_t length : lengths) {
    strings.emplace_back(text.begin() + static_cast<std::ptrdiff_t>(at),
                         text.begin() + static_cast<std::ptrdiff_t>(at + length));
    at += static_cast<std::size_t>(length);
  }
  return strings;
}

std::size_t indexSize(std::size_t count) {
  if (count <= 0x100) return 1;
  return count <= 0x10000 ? 2 : 4;
}

using StringIndex = std::unordered_map<std::string, std::uint32_t>;

void writeIndex(const StringIndex& index, const std::string& s, std::size_t size,
                std::uint8_t* word) {
  const auto found = index.find(s);
  const std::uint32_t number = found != index.end() ? found->second : 0;
  std::memcpy(word, &number, size);
}

}  // namespace

EncodedArray encodeStrings(const ArrayShape& shape, const std::vector<std::string>& strings,
                           TilePoints& points, unsigned effort) {
  const std::size_t first = points.known() * shape.components;
  StringIndex index;
  StringList different;
  StringList all;
  for (std::size_t i = first; i < strings.size(); ++i) {
    all.push_back(&strings[i]);
    if (index.emplace(strings[i], static_cast<std::uint32_t>(different.size())).second) {
      different.push_back(&strings[i]);
    }
  }
  container::ByteWriter out;
  writeMethod(ArrayMethod::Strings, out);
  if (different.size() > all.size() / 2) {
    out.u8(static_cast<unsigned>(StringKind::Each));
    writeList(all, out);
    return {out.take(), 0, false};
  }
  out.u8(static_cast<unsigned>(StringKind::Table));
  out.varint(different.size());
  writeList(different, out);
  const std::size_t size = indexSize(different.size());
  Bytes words(strings.size() * size);
  for (std::size_t i = 0; i < strings.size(); ++i) {
    writeIndex(index, strings[i], size, words.data() + i * size);
  }
  const NumberShape inner{unsignedType(size), shape.components, 0};
  const Bytes coded = encodeNumbers(inner, words, points, effort);
  out.bytes(coded);
  return {out.take(), 0, followsInput(coded)};
}

void decodeStrings(const ArrayShape& shape, container::ByteReader& in, TilePoints& points,
                   MemoryBudget& budget, std::vector<std::string>& strings) {
  const std::size_t first = points.known() * shape.components;
  const std::size_t count = points.added() * shape.components;
  const unsigned kind = in.u8();
  if (kind > static_cast<unsigned>(StringKind::Table)) {
    in.fail("strings are stored in the unknown way " + std::to_string(kind));
  }
  if (kind == static_cast<unsigned>(StringKind::Each)) {
    std::vector<std::string> added = readList(in, count, budget);
    std::move(added.begin(), added.end(), std::back_inserter(strings));
    in.expectEnd();
    return;
  }
  const std::uint64_t tableSize = in.varint();
  if (tableSize == 0 || tableSize > count) in.fail("a table has more strings than the array");
  const std::vector<std::string> table = readList(in, tableSize, budget);
  StringIndex index;
  for (std::size_t i = 0; i < table.size(); ++i) {
    index.emplace(table[i], static_cast<std::uint32_t>(i));
  }
  const std::size_t size = indexSize(table.size());
  budget.take(strings.size() + count, size);
  Bytes words((strings.size() + count) * size);
  for (std::size_t i = 0; i < first; ++i) {
    writeIndex(index, strings[i], size, words.data() + i * size);
  }
  const NumberShape inner{unsignedType(size), shape.components, 0};
  decodeNumbers(inner, in, points, budget, words);
  budget.take(count, sizeof(std::string));
  strings.reserve(first + count);
  for (std::size_t i = 0; i < count; ++i) {
    std::uint32_t number = 0;
    std::memcpy(&number, words.data() + (first + i) * size, size);
    if (number >= table.size()) in.fail("a string's number is beyond the table");
    budget.take(table[number].size());
    strings.push_back(table[number]);
  }
}

}  // namespace bspc::attributes
