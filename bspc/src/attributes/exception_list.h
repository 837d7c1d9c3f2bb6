#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "bspc/span.h"
#include "container/byte_reader.h"
#include "container/byte_writer.h"

namespace bspc::attributes {

/// Things that a lossy method cannot restore well enough, with their own bytes.
struct ExceptionList {
  std::vector<std::uint64_t> places;  ///< ascending
  Bytes contents;                     ///< of equal size each

  void add(std::uint64_t place, ByteView content) {
    places.push_back(place);
    contents.insert(contents.end(), content.begin(), content.end());
  }

  void write(container::ByteWriter& out) const {
    out.varint(places.size());
    std::uint64_t next = 0;
    for (const std::uint64_t place : places) {
      out.varint(place - next);
      next = place + 1;
    }
    out.bytes(contents);
  }

  /// Places are below `end`; each thing has `size` bytes.
  static ExceptionList read(container::ByteReader& in, std::uint64_t end, std::size_t size) {
    ExceptionList result;
    const std::uint64_t count = in.varint();
    if (count > end || count > in.remaining()) in.fail("there are more exceptions than numbers");
    std::uint64_t next = 0;
    for (std::uint64_t i = 0; i < count; ++i) {
      const std::uint64_t gap = in.varint();
      if (gap >= end - next) in.fail("an exception lies behind the last number");
      result.places.push_back(next + gap);
      next += gap + 1;
    }
    const ByteView contents = in.bytes(count * size);
    result.contents.assign(contents.begin(), contents.end());
    return result;
  }
};

}  // namespace bspc::attributes
