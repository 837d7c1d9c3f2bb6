#include "cli/mesh_comparison.h"

#include <algorithm>

#include "formats/wording.h"

namespace bspc::cli {

namespace {

using Places = std::vector<GridPoint>;

/// The smallest of all ways to begin the cycle.
Places smallestTurn(Places cell) {
  Places best = cell;
  for (std::size_t j = 1; j < cell.size(); ++j) {
    std::rotate(cell.begin(), cell.begin() + 1, cell.end());
    best = std::min(best, cell);
  }
  return best;
}

template <class Canonical>
std::vector<Places> sortedCells(const Cells& cells, const Places& points, Canonical canonical) {
  std::vector<Places> result;
  result.reserve(cells.size());
  for (std::size_t i = 0; i < cells.size(); ++i) {
    Places cell;
    for (const std::uint32_t v : cells[i]) cell.push_back(points[v]);
    result.push_back(canonical(std::move(cell)));
  }
  std::sort(result.begin(), result.end());
  return result;
}

}  // namespace

bool sameCells(const PlacedMesh& a, const PlacedMesh& b) {
  const auto same = [&](const Cells& x, const Cells& y, auto canonical) {
    return x.size() == y.size() &&
           sortedCells(x, a.points, canonical) == sortedCells(y, b.points, canonical);
  };
  const auto asGiven = [](Places cell) { return cell; };
  const auto asSet = [](Places cell) {
    std::sort(cell.begin(), cell.end());
    return cell;
  };
  return same(a.mesh.vertices, b.mesh.vertices, asSet) &&
         same(a.mesh.lines, b.mesh.lines, asGiven) &&
         same(a.mesh.faces, b.mesh.faces, smallestTurn);
}

std::string cellsText(std::uint64_t vertices, std::uint64_t lines, std::uint64_t faces) {
  std::string text;
  const auto add = [&](std::uint64_t count, const char* one, const char* many) {
    if (count > 0) text += (text.empty() ? "" : ", ") + formats::counted(count, one, many);
  };
  add(vertices, "vertex cell", "vertex cells");
  add(lines, "line", "lines");
  add(faces, "face", "faces");
  return text;
}

}  // namespace bspc::cli
