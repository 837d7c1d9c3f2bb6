#pragma once

#include <cstdint>
#include <vector>

#include "bspc/span.h"

namespace bspc::connectivity {

/// Lists of vertices, one after the other: list i has the vertices indices[ends[i − 1]] …
/// indices[ends[i] − 1], the first one from 0 on.
struct Cells {
  std::vector<std::uint32_t> indices;
  std::vector<std::uint32_t> ends;

  std::size_t size() const { return ends.size(); }
  bool empty() const { return ends.empty(); }
  std::uint32_t first(std::size_t i) const { return i == 0 ? 0 : ends[i - 1]; }
  Span<const std::uint32_t> operator[](std::size_t i) const {
    return {indices.data() + first(i), ends[i] - std::size_t{first(i)}};
  }
  void add(Span<const std::uint32_t> cell) {
    indices.insert(indices.end(), cell.begin(), cell.end());
    ends.push_back(static_cast<std::uint32_t>(indices.size()));
  }
};

}  // namespace bspc::connectivity
