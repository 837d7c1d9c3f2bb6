#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "bspc/grid.h"
#include "bspc/span.h"

namespace bspc::attributes {

/// Bits per axis of a Morton code.
constexpr unsigned kMortonBits = 21;

/// The lower 21 bits of v, two zero bits behind each.
constexpr std::uint64_t spreadBits(std::uint64_t v) {
  v &= 0x1FFFFF;
  v = (v | v << 32) & 0x1F00000000FFFFULL;
  v = (v | v << 16) & 0x1F0000FF0000FFULL;
  v = (v | v << 8) & 0x100F00F00F00F00FULL;
  v = (v | v << 4) & 0x10C30C30C30C30C3ULL;
  v = (v | v << 2) & 0x1249249249249249ULL;
  return v;
}

constexpr std::uint64_t mortonCode(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  return spreadBits(x) | spreadBits(y) << 1 | spreadBits(z) << 2;
}

/// A point's code and its place among the points.
struct MortonEntry {
  std::uint64_t code = 0;
  std::uint32_t index = 0;
};

/// Bits that the greatest coordinate of the points takes; 0 for no points.
unsigned coordinateBits(Span<const GridPoint> points);

/// The codes of the points in ascending order, equal ones by index. Of coordinates of more than 21
/// bits the leading 21 count, `bits` being coordinateBits(points).
std::vector<MortonEntry> mortonOrder(Span<const GridPoint> points, unsigned bits);

/// Bits to cut off so that cells of points with equal remaining codes hold at least `mean` points
/// on average; at most 20 a coordinate. The result counts bits per coordinate.
unsigned cellShift(const std::vector<MortonEntry>& order, unsigned mean);

}  // namespace bspc::attributes
