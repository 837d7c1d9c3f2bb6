#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "bspc/decoder.h"
#include "bspc/encoder.h"
#include "bspc/grid.h"

namespace bspc::test {

/// Grid points as an int32 point set (coordinates below 2^31).
inline std::vector<std::int32_t> asIntegers(const std::vector<GridPoint>& points) {
  std::vector<std::int32_t> xyz;
  for (const GridPoint& p : points) {
    for (const std::uint32_t v : p) xyz.push_back(static_cast<std::int32_t>(v));
  }
  return xyz;
}

inline Bytes encoded(const PointSetView& points, const EncodeOptions& options = {},
                     EncodeReport* report = nullptr) {
  MemorySink sink;
  EncodeReport r = encode(points, sink, options);
  if (report != nullptr) *report = std::move(r);
  return sink.take();
}

inline Bytes encoded(const std::vector<GridPoint>& points, const EncodeOptions& options = {}) {
  const std::vector<std::int32_t> xyz = asIntegers(points);
  return encoded(PointSetView(xyz.data(), points.size()), options);
}

/// A decoder of bytes that must outlive it.
inline Decoder open(const Bytes& bytes, const OpenOptions& options = {}) {
  return Decoder(std::make_shared<MemorySource>(bytes), options);
}

}  // namespace bspc::test
