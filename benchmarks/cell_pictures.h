#pragma once

#include <string>
#include <vector>

#include "paper_support.h"

namespace bspc::paper {

/// The points of a model, to be coloured by the cells of a coding.
struct ColouredCells {
  const GriddedModel* model = nullptr;
  const Coding* coding = nullptr;
  bool restored = false;  ///< where the decoder puts the points, not where they were
};

/// Writes the points as a binary PLY file with a colour and the number of the cell for each, the
/// points of one cell in one colour, as in the paper's Figures 1, 2, 6 and 7; several sets stand
/// side by side along x. Throws std::runtime_error naming the file.
void writeColoured(const std::string& path, const std::vector<ColouredCells>& sets);

}  // namespace bspc::paper
