#include "container/metadata_record.h"

#include <algorithm>
#include <set>
#include <string>

#include "bspc/error.h"
#include "container/array_table.h"
#include "container/packed_bytes.h"
#include "saturating.h"

namespace bspc::container {

namespace {

/// The part of the memory that a file may take before any point is decoded.
constexpr std::uint64_t kShareOfMemory = 16;

/// What the texts of the metadata may still take in memory: much more than in the file, where most
/// are short.
class TextMemory {
 public:
  explicit TextMemory(std::uint64_t bytes) : limit_(bytes), left_(bytes) {}

  /// To be called before a text of so many bytes is kept.
  void take(std::uint64_t size) {
    // The text itself, the one beside it, their place in a set of keys, and arrays that grow.
    constexpr std::uint64_t kEach = 5 * sizeof(std::string);
    const std::uint64_t bytes = saturatingAdd(kEach, saturatingAdd(size, size));
    if (bytes > left_) {
      throw Error(ErrorCode::LimitExceeded,
                  "what a file says beside its points takes more than the limit of " +
                      std::to_string(limit_) +
                      " bytes; raise the limit of memory if the file is to be trusted");
    }
    left_ -= bytes;
  }

 private:
  std::uint64_t limit_;
  std::uint64_t left_;
};

std::string takeText(ByteReader& in, TextMemory& memory) {
  ByteReader ahead = in;
  memory.take(std::min<std::uint64_t>(ahead.varint(), ahead.remaining()));
  return readText(in);
}

void writeValues(ByteWriter& out, const ArrayValues& array) {
  out.varint(array.tuples());
  if (array.type == ScalarType::String) {
    for (const std::string& text : array.strings) writeText(out, text);
  } else {
    out.bytes(array.values);
  }
}

void readValues(ByteReader& in, TextMemory& memory, ArrayValues& array) {
  const std::uint64_t tuples = in.varint();
  // Every value takes a byte at least, so the bytes that are left bound the tuples.
  if (tuples > in.remaining()) in.fail("the field array \"" + array.name + "\" ends early");
  const std::uint64_t count = tuples * array.components;
  if (array.type == ScalarType::String) {
    for (std::uint64_t i = 0; i < count; ++i) array.strings.push_back(takeText(in, memory));
    return;
  }
  const ByteView bytes = in.bytes(count * arrayValueSize(array.type));
  array.values.assign(bytes.begin(), bytes.end());
  const bool isBit = array.type == ScalarType::Bit;
  if (isBit && std::any_of(bytes.begin(), bytes.end(), [](std::uint8_t b) { return b > 1; })) {
    in.fail("the field array \"" + array.name + "\" has bits that are neither 0 nor 1");
  }
}

}  // namespace

void writeMetadata(ByteWriter& out, const Metadata& metadata) {
  ByteWriter plain;
  writeText(plain, metadata.crs);
  writeText(plain, metadata.lengthUnit);
  plain.varint(metadata.entries.size());
  for (const auto& [key, value] : metadata.entries) {
    writeText(plain, key);
    writeText(plain, value);
  }
  plain.varint(metadata.fieldData.size());
  for (const ArrayValues& array : metadata.fieldData) {
    writeArrayDescription(plain, array);
    writeValues(plain, array);
  }
  constexpr int kBest = 19;
  writePacked(out, plain.data(), kBest);
}

Metadata readMetadata(ByteReader& in, const DecodeLimits& limits) {
  const Bytes bytes = readPacked(in, limits.memoryBytes / kShareOfMemory);
  ByteReader plain(bytes, "the metadata", ByteReader::kNoOffset);
  TextMemory memory(limits.memoryBytes / 2);
  Metadata metadata;
  metadata.crs = takeText(plain, memory);
  metadata.lengthUnit = takeText(plain, memory);
  std::set<std::string> keys;
  for (std::uint64_t left = plain.varint(); left > 0; --left) {
    std::string key = takeText(plain, memory);
    if (!keys.insert(key).second) plain.fail("two entries have the key \"" + key + "\"");
    metadata.entries.emplace_back(std::move(key), takeText(plain, memory));
  }
  const std::uint64_t arrays = plain.varint();
  if (arrays > limits.arrays) {
    throw Error(ErrorCode::LimitExceeded, "the file has " + std::to_string(arrays) +
                                              " field arrays, more than the limit of " +
                                              std::to_string(limits.arrays) +
                                              "; raise the limit if it is to be trusted");
  }
  std::set<std::string> names;
  for (std::uint64_t i = 0; i < arrays; ++i) {
    ArrayValues array;
    static_cast<ArrayDescription&>(array) = readArrayDescription(plain);
    if (!names.insert(array.name).second) {
      plain.fail("two field arrays have the name \"" + array.name + "\"");
    }
    readValues(plain, memory, array);
    metadata.fieldData.push_back(std::move(array));
  }
  plain.expectEnd();
  return metadata;
}

}  // namespace bspc::container
