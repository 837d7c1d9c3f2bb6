#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bspc/arrays.h"
#include "bspc/limits.h"
#include "container/byte_reader.h"
#include "container/byte_writer.h"

namespace bspc::container {

/// Most numbers (or strings) a tuple.
constexpr std::uint32_t kMaxComponents = 65536;

/// Text of any length.
void writeText(ByteWriter& out, const std::string& text);
std::string readText(ByteReader& in);

/// What the file says of an array without its values (docs/format.md, "Array table").
void writeArrayDescription(ByteWriter& out, const ArrayDescription& array);
/// Throws Error(Corrupt) for values out of range, Error(Unsupported) for unknown types.
ArrayDescription readArrayDescription(ByteReader& in);

void writeArrayTable(ByteWriter& out, const std::vector<ArrayDescription>& arrays);
/// Throws Error(LimitExceeded) too; names are unique.
std::vector<ArrayDescription> readArrayTable(ByteReader& in, const DecodeLimits& limits);

}  // namespace bspc::container
