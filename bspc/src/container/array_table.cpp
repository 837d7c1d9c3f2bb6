#include "container/array_table.h"

#include <cmath>
#include <cstring>
#include <set>

#include "bspc/error.h"

namespace bspc::container {

namespace {

constexpr unsigned kTypeMask = 15;
constexpr unsigned kHasComponentNames = 1U << 4;
constexpr unsigned kHasUnit = 1U << 5;
constexpr unsigned kHasSemantic = 1U << 6;
constexpr unsigned kHasTolerance = 1U << 7;

std::uint64_t bitsOf(double value) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

double readTolerance(ByteReader& in) {
  const std::uint64_t bits = in.unsignedLittle(8);
  double value = 0;
  std::memcpy(&value, &bits, sizeof value);
  if (!std::isfinite(value) || !(value > 0)) in.fail("a tolerance that is not finite and positive");
  return value;
}

}  // namespace

void writeText(ByteWriter& out, const std::string& text) {
  out.varint(text.size());
  out.bytes(ByteView(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
}

std::string readText(ByteReader& in) {
  const ByteView bytes = in.bytes(in.varint());
  return {bytes.begin(), bytes.end()};
}

void writeArrayDescription(ByteWriter& out, const ArrayDescription& array) {
  writeText(out, array.name);
  out.u8(
      static_cast<unsigned>(array.type) | (array.componentNames.empty() ? 0 : kHasComponentNames) |
      (array.unit.empty() ? 0 : kHasUnit) | (array.semantic == Semantic::None ? 0 : kHasSemantic) |
      (array.tolerance > 0 ? kHasTolerance : 0));
  out.varint(array.components);
  for (const std::string& name : array.componentNames) writeText(out, name);
  if (!array.unit.empty()) writeText(out, array.unit);
  if (array.semantic != Semantic::None) out.u8(static_cast<unsigned>(array.semantic));
  if (array.tolerance > 0) out.unsignedLittle(bitsOf(array.tolerance), 8);
}

ArrayDescription readArrayDescription(ByteReader& in) {
  ArrayDescription array;
  array.name = readText(in);
  if (array.name.empty()) in.fail("an array without a name");
  const unsigned flags = in.u8();
  const unsigned type = flags & kTypeMask;
  if (type > static_cast<unsigned>(ScalarType::String)) {
    throw Error(ErrorCode::Unsupported, "the array \"" + array.name + "\" has scalar type " +
                                            std::to_string(type) +
                                            ", which this version does not know; use a newer one");
  }
  array.type = static_cast<ScalarType>(type);
  array.components = in.varint32();
  if (array.components == 0 || array.components > kMaxComponents) {
    in.fail("the array \"" + array.name + "\" has " + std::to_string(array.components) +
            " components");
  }
  if ((flags & kHasComponentNames) != 0) {
    for (std::uint32_t c = 0; c < array.components; ++c) {
      array.componentNames.push_back(readText(in));
    }
  }
  if ((flags & kHasUnit) != 0) array.unit = readText(in);
  // Meanings that this version does not know are none to it: values do not depend on them.
  if ((flags & kHasSemantic) != 0) {
    const unsigned semantic = in.u8();
    if (semantic <= static_cast<unsigned>(Semantic::Ids)) {
      array.semantic = static_cast<Semantic>(semantic);
    }
  }
  if ((flags & kHasTolerance) != 0) array.tolerance = readTolerance(in);
  return array;
}

void writeArrayTable(ByteWriter& out, const std::vector<ArrayDescription>& arrays) {
  out.varint(arrays.size());
  for (const ArrayDescription& array : arrays) writeArrayDescription(out, array);
}

std::vector<ArrayDescription> readArrayTable(ByteReader& in, const DecodeLimits& limits) {
  const std::uint64_t count = in.varint();
  if (count > limits.arrays) {
    throw Error(ErrorCode::LimitExceeded,
                "the file has " + std::to_string(count) + " arrays, more than the limit of " +
                    std::to_string(limits.arrays) + "; raise the limit if it is to be trusted");
  }
  std::vector<ArrayDescription> arrays;
  std::set<std::string> names;
  for (std::uint64_t i = 0; i < count; ++i) {
    arrays.push_back(readArrayDescription(in));
    if (!names.insert(arrays.back().name).second) {
      in.fail("two arrays have the name \"" + arrays.back().name + "\"");
    }
  }
  return arrays;
}

}  // namespace bspc::container
